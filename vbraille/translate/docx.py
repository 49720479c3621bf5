"""A DOCX file as a tree of HTML: styles, lists, tables, notes, links, languages."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from vbraille.translate.numbering import BULLET, whole
from vbraille.translate.office import (
    FONTS,
    HIDDEN,
    Document,
    Level,
    Look,
    Numbering,
    Style,
    name_by_style,
    put_picture,
    symbol,
    tag_of,
    within,
)
from vbraille.translate.trees import Element, names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_FORMS = {
    "bullet": "bullet",
    "none": "none",
    "lowerLetter": "a",
    "upperLetter": "A",
    "lowerRoman": "i",
    "upperRoman": "I",
    "decimalZero": "01",
}
_LOOKS = {"b": "b", "i": "i", "u": "u", "strike": "s", "dstrike": "s", "vanish": HIDDEN}
_RAISED = {"superscript": "sup", "subscript": "sub"}
_TEXTS = {"noBreakHyphen": "\u2011", "tab": "\t", "ptab": "\t"}
_OFF = frozenset(("0", "false", "none", "off"))
_NAMES = names("docx")
_SKIPPED, _DRAWN = _NAMES["skipped"], _NAMES["drawn"]
_LINK = re.compile(
    r'\s*HYPERLINK\s+(?:"([^"]*)"|([^\s\\]\S*))?(?:.*\\l\s+"?([^"\s]*))?', re.I | re.S
)


def read_docx(source: Source) -> Iterator[Block]:
    """Read a DOCX file.

    Raises
    ------
    InputError
        If a part that is needed is missing, damaged or too large.
    """
    return _Docx(source).read()


class _Docx(Document):
    """Reads one document."""

    def __init__(self, source: Source) -> None:
        super().__init__(source)
        self._source = source
        member = "word/document.xml"
        for relation in self.archive.xml("_rels/.rels", needed=False).iter("Relationship"):
            target = relation.get("Target").lstrip("/")
            if relation.get("Type").endswith("/officeDocument") and self.archive.find(target):
                member = target
        self._folder, _, self._name = member.rpartition("/")
        self._root = self.archive.xml(member)
        styles = self._part("styles.xml")
        for style in styles.iter("style"):
            self.styles[style.get("styleId")] = _style_of(style, "basedOn")
        self.usual = tag_of(_value(styles, "docDefaults/rPrDefault/rPr/lang"))
        self._lists = _lists_of(self._part("numbering.xml"))
        self._fields: list[str] = []  # instructions of the fields around the run
        self._link: Element | None = None  # that of a field of the paragraph
        self._begun: Element | None = None  # a paragraph that is one with the next

    def read(self) -> Iterator[Block]:
        self._links = self._links_of(self._name)
        self._inner(self._root, self.body, {})
        for key, item in self.note_items():
            kind, _, number = key.partition("-")
            self._links = self._links_of(f"{kind}s.xml")
            for note in self._part(f"{kind}s.xml").iter(kind):
                if note.get("id") == number:
                    self._inner(note, item, {})
        return self.blocks(self._source, self.archive.xml("docProps/core.xml", needed=False))

    def _part(self, name: str) -> Element:
        return self.archive.xml(f"{self._folder}/{name}", needed=False)

    def _links_of(self, name: str) -> dict[str, str]:
        """Addresses in a part of the document, by their keys there."""
        found = self._part(f"_rels/{name}.rels").iter("Relationship")
        return {relation.get("Id"): relation.get("Target") for relation in found}

    def _inner(self, holder: Element, into: Element, look: Look) -> None:
        """Read what is in an element, whatever holds it there."""
        for element in holder.elements:
            if element.name not in _SKIPPED:
                self._piece(element, into, look)

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read a block, what stands in a paragraph, or what stands in a run."""
        match element.name:
            case "p":
                self._paragraph(element, into)
            case "tbl":
                into.children.append(self._table(element))
            case "r":
                look = look | self.look_of(_value(element, "rPr/rStyle")) | _look_of(element)
                for child in element.elements:
                    if not look.get(HIDDEN) or child.name in ("fldChar", "instrText"):
                        self._piece(child, self._link or into, look)
            case "hyperlink":
                anchor = element.get("anchor")
                address = self._links.get(element.get("id"), "") + (f"#{anchor}" if anchor else "")
                self._inner(element, into.add("a", href=address), look)
            case "fldSimple":
                self._inner(element, into.add("a", href=_target(element.get("instr"))), look)
            case "fldChar":
                self._field(element, into)
            case "instrText" if self._fields:
                self._fields[-1] += element.text
            case "bookmarkStart" if element.get("name") not in ("", "_GoBack"):
                into.add("a", id=element.get("name"))
            case "oMath" | "oMathPara":
                into.add("math").children.append(element)
            case "t" | "noBreakHyphen" | "tab" | "ptab":
                self.say(into, _TEXTS.get(element.name, element.text), look)
            case "sym":
                sign = symbol(_hexadecimal(element.get("char")), element.get("font"))
                self.say(into, sign, look)
                if not sign:
                    put_picture(into, [], "symbol")
            case "footnoteReference" | "endnoteReference" as name:
                self.refer(into, f"{name.removesuffix('Reference')}-{element.get('id')}")
            case "br" | "cr":
                if element.get("type") != "page":
                    into.add("br")
            case "ruby":
                ruby = into.add("ruby", _find(element, "rubyBase").text)
                ruby.add("rt", _find(element, "rt").text)
            case "AlternateContent":
                # What this program knows, or else what is there for older ones.
                drawn = [e for e in _find(element, "Choice").elements if e.name in _DRAWN]
                for inner in drawn or element.iter("t", "sym"):
                    self._piece(inner, into, look)
            case name if name in _DRAWN:
                self._drawing(element, into)
            case _:
                self._inner(element, into, look)

    def _paragraph(self, element: Element, into: Element) -> None:
        """Read a paragraph, which may be a heading or an item of a list."""
        own = _style_of(element, "pPr/pStyle")
        styles = [own, *self.chain(own.based)]
        block, self._begun = self._begun or Element("p"), None
        outer, self._link = self._link, None
        self._inner(element, block, self.usual | self.look_of(own.based))
        self._link = outer
        # One whose own mark is deleted, and a drop cap, is one with the next.
        drop_cap = _find(element, "pPr/framePr").get("dropCap", "none") != "none"
        if drop_cap or _find(element, "pPr/rPr/del").name:
            self._begun = block
            return
        name_by_style(block, styles)
        key = next((style.listed for style in styles if style.listed is not None), "0")
        at = next((style.at for style in styles if style.at is not None), 0)
        numbering = self._lists.get(key)
        if numbering is not None and at in numbering.levels and block.text:
            marker = numbering.marker(at)
            if block.name.startswith("h"):
                block.children.insert(0, marker if marker != BULLET else "")
            else:
                last = into.children[-1] if into.children else None
                if not isinstance(last, Element) or not (
                    last.name == "ul" and (at or last.get("class") == key)
                ):
                    last = into.add("ul", class_=key)
                block.name, into = "li", last
                block.attributes |= {"data-level": str(at + 1), "data-marker": marker}
        if block.children:
            into.children.append(block)

    def _table(self, element: Element) -> Element:
        """Read a table; a cell that goes on from the one above widens that."""
        table = Element("table")
        rows = list(within(element, ("tr",), _SKIPPED))
        look = _find(element, "tblPr/tblLook")
        first = look.get("firstRow", str(_hexadecimal(look.get("val")) >> 5 & 1))
        above: dict[int, Element] = {}
        for number, row in enumerate(rows):
            usual = "0" if number or len(rows) == 1 else first
            is_head = _value(row, "trPr/tblHeader", usual) not in _OFF
            line = (table.add("thead") if is_head else table).add("tr")
            column = max(whole(_value(row, "trPr/gridBefore"), 0), 0)
            if column:
                line.add("td", colspan=str(column))
            for cell in within(row, ("tc",), _SKIPPED):
                columns = max(whole(_value(cell, "tcPr/gridSpan")), 1)
                goes_on = _value(cell, "tcPr/vMerge", "restart") != "restart"
                if goes_on and column in above:
                    rowspan = whole(above[column].get("rowspan")) + 1
                    above[column].attributes["rowspan"] = str(rowspan)
                else:
                    above[column] = line.add("th" if is_head else "td", colspan=str(columns))
                    self._inner(cell, above[column], {})
                column += columns
        return table

    def _field(self, mark: Element, into: Element) -> None:
        """Begin a field, its text, or its end."""
        kind = mark.get("fldCharType")
        if kind == "begin":
            self._fields.append("")
            box = _find(mark, "ffData/checkBox")
            if box.children:
                state = _value(box, "checked", _value(box, "default", "0"))
                into.say("☐" if state in _OFF else "☑")
        elif kind == "separate" and self._fields and _target(self._fields[-1]):
            self._link = into.add("a", href=_target(self._fields[-1]))
        elif kind == "end" and self._fields and _target(self._fields.pop()):
            self._link = None

    def _drawing(self, element: Element, into: Element) -> None:
        """Read a picture by its text, a box by what is in it; mark all else."""
        for box in element.iter("txbxContent"):
            self._inner(box, into.add("div"), {})
            return
        kinds = " ".join(data.get("uri") for data in element.iter("graphicData"))
        what = "drawing"
        if element.name == "object":
            what = "embedded object"
        elif "/chart" in kinds or "/diagram" in kinds:
            what = "chart" if "/chart" in kinds else "diagram"
        elif any(element.iter("pic", "imagedata")):
            what = "picture"
        described = [each.get("descr") for each in element.iter("docPr")]
        put_picture(into, described + [each.get("alt") for each in element.iter("shape")], what)


def _lists_of(root: Element) -> dict[str, Numbering]:
    """Lists of a document; those of one abstract list count on."""
    abstract = {each.get("abstractNumId"): (_levels(each), {}) for each in root.iter("abstractNum")}
    lists: dict[str, Numbering] = {}
    for number in root.iter("num"):
        levels, counts = abstract.get(_value(number, "abstractNumId"), ({}, {}))
        numbering = lists[number.get("numId")] = Numbering(levels, counts)
        for override in number.elements:
            at, start = whole(override.get("ilvl"), 0), _value(override, "startOverride")
            numbering.levels = numbering.levels | _levels(override, at)
            numbering.starts |= {at: whole(start)} if start else {}
    return lists


def _levels(holder: Element, following: int = 0) -> dict[int, Level]:
    """Levels of a list; one that does not say its number is the next."""
    levels: dict[int, Level] = {}
    for level in holder.elements:
        if level.name == "lvl":
            at = whole(level.get("ilvl"), following)
            following = at + 1
            form = _FORMS.get(_value(level, "numFmt"), "1")
            legal = _value(level, "isLgl", "0") not in _OFF
            levels[at] = Level(form, _value(level, "lvlText"), whole(_value(level, "start")), legal)
    return levels


def _style_of(holder: Element, based: str) -> Style:
    """Style of an element, or of a paragraph; the key of what it is based on stands at a path."""
    outline, at = _value(holder, "pPr/outlineLvl"), _value(holder, "pPr/numPr/ilvl")
    return Style(
        _value(holder, "name").lower(),
        _value(holder, based),
        _look_of(holder),
        (whole(outline, 9) + 1) % 10 if outline else None,
        _value(holder, "pPr/numPr/numId") or None,
        whole(at, 0) if at else None,
    )


def _look_of(holder: Element) -> Look:
    """Look that a style or a run says that it has."""
    look: Look = {}
    for element in _find(holder, "rPr").elements:
        value = element.get("val")
        if element.name in _LOOKS:
            tag = _LOOKS[element.name]
            is_off = value in _OFF or (tag == "u" and not value)
            look[tag] = "" if is_off else tag
        elif element.name == "vertAlign":
            look |= {tag: tag if name == value else "" for name, tag in _RAISED.items()}
        elif element.name == "lang":
            look |= tag_of(value)
        elif element.name == "rFonts":
            font = element.get("ascii").lower().split(" ")[0]
            look |= {"font": font} if font in FONTS else {}
    return look


def _find(holder: Element, path: str) -> Element:
    """First element at a path of names; one with nothing in it if there is none."""
    for name in path.split("/"):
        holder = next((each for each in holder.elements if each.name == name), Element(""))
    return holder


def _value(holder: Element, path: str, otherwise: str = "") -> str:
    """Value of the element at a path; "" for one without a value, and another for none."""
    found = _find(holder, path)
    return found.get("val") if found.name else otherwise


def _target(instruction: str) -> str:
    """Address of the link that a field makes of its text; empty if it makes none."""
    found = _LINK.match(instruction)
    if found is None:
        return ""
    anchor = f"#{found[3]}" if found[3] else ""
    return (found[1] or found[2] or "") + anchor


def _hexadecimal(text: str) -> int:
    return int(text, 16) if re.fullmatch("[0-9A-Fa-f]{1,4}", text) else 0
