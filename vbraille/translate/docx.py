"""A DOCX file as a tree of HTML: styles, lists, tables, notes, links, languages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.archive import Archive
from vbraille.translate.formulas import omml_text
from vbraille.translate.numbering import whole
from vbraille.translate.office import (
    FONTS,
    HIDDEN,
    Draft,
    Flow,
    Level,
    Look,
    Numbering,
    Style,
    Styles,
    dublin_core,
    heading_level,
    put_picture,
    symbol,
    tag_of,
    within,
)
from vbraille.translate.trees import Element

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
_TAGS = {"b": "b", "i": "i", "strike": "s", "dstrike": "s", "vanish": HIDDEN}
_SMALL = {"superscript": "sup", "subscript": "sub"}
_OFF = frozenset(("0", "false", "none", "off"))
# What is not read: deleted text, what is kept for other programs, properties.
_SKIPPED = frozenset(
    [
        "del",
        "moveFrom",
        "delText",
        "instrText",
        "Fallback",
        "pPr",
        "rPr",
        "sdtPr",
        "tblPr",
        "trPr",
        "tcPr",
        "sectPr",
        "tblGrid",
        "footnoteRef",
        "endnoteRef",
        "annotationRef",
    ]
)
_DRAWN = frozenset(("drawing", "pict", "object"))


def read_docx(source: Source) -> Iterator[Block]:
    """Read a DOCX file.

    Raises
    ------
    InputError
        If a part that is needed is missing, damaged or too large.
    """
    return _Reader(Archive(source.stream, source.name)).read(source)


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._draft = Draft()
        member = self._main()
        self._folder, _, self._name = member.rpartition("/")
        self._root = archive.xml(member)
        self._links = self._relations(self._name)
        self._about = archive.xml("docProps/core.xml", needed=False)
        self._styles = Styles()
        styles = self._part("styles.xml")
        for style in styles.iter("style"):
            self._styles[style.get("styleId")] = _style_of(style, "basedOn")
        default = _find(styles, "docDefaults/rPrDefault/rPr/lang")
        usual = "" if default is None else tag_of(default.get("val"))
        self._usual = Look(usual or dublin_core(self._about, "language"))
        self._lists = _Lists(self._part("numbering.xml"))
        self._fields: list[str] = []  # instructions of the fields around the run
        self._links_open: list[Element] = []  # those of the paragraph's fields

    def read(self, source: Source) -> Iterator[Block]:
        self._blocks(self._root, self._draft.body)
        for key, item in self._draft.note_items():
            kind, _, number = key.partition("-")
            self._links = self._relations(f"{kind}s.xml")
            for note in self._part(f"{kind}s.xml").iter(kind):
                if note.get("id") == number:
                    self._blocks(note, item)
        source.title = dublin_core(self._about, "title")
        return self._draft.blocks(source, self._usual.language)

    def _main(self) -> str:
        """Name of the member with the text."""
        for relation in self._archive.xml("_rels/.rels", needed=False).iter("Relationship"):
            target = relation.get("Target").lstrip("/")
            if relation.get("Type").endswith("/officeDocument") and self._archive.find(target):
                return target
        return "word/document.xml"

    def _part(self, name: str) -> Element:
        return self._archive.xml(f"{self._folder}/{name}", needed=False)

    def _relations(self, name: str) -> dict[str, str]:
        """Addresses in a part of the document, by their keys there."""
        found = self._part(f"_rels/{name}.rels").iter("Relationship")
        return {relation.get("Id"): relation.get("Target") for relation in found}

    def _blocks(self, holder: Element, into: Element) -> None:
        """Read the blocks of a body, of a cell or of a note."""
        flow = Flow(into)
        begun = Element("p")  # bookmarks and text of a paragraph whose own mark is deleted
        for element in within(holder, ("p", "tbl", "bookmarkStart"), _SKIPPED):
            if element.name == "bookmarkStart":
                _put_bookmark(element, begun)
            elif element.name == "tbl":
                flow.add_table(self._table(element))
            else:
                goes_on = _goes_on(element) and element is not holder.children[-1]
                begun = self._paragraph(element, flow, begun, goes_on=goes_on)
        if begun.text:
            flow.add(begun, [], 0, None)

    def _paragraph(self, element: Element, flow: Flow, block: Element, *, goes_on: bool) -> Element:
        """Read a paragraph into an element, and give the element for the next."""
        own = _style_of(element, "pPr/pStyle")
        styles = [own, *self._styles.chain(own.based)]
        self._links_open, outer = [], self._links_open
        self._runs(element, block, self._styles.look(own.based).within(self._usual))
        self._links_open = outer
        if goes_on:
            return block
        level = heading_level(styles)
        key = next((style.listed for style in styles if style.listed is not None), "0")
        at = min(next((style.at for style in styles if style.at is not None), 0), 8)
        marker = self._lists.marker(key, at) if key != "0" and (block.text or level) else None
        item = None if marker is None or level else (key, at, marker)
        if level and marker and not marker.startswith("•"):
            block.children.insert(0, marker)
        flow.add(block, styles, level, item)
        return Element("p")

    def _table(self, element: Element) -> Element:
        """Read a table; a cell that goes on from the one above widens that."""
        table = Element("table")
        rows = list(within(element, ("tr",), _SKIPPED))
        look = _find(element, "tblPr/tblLook") or Element("tblLook")
        bits = look.get("val", "0")
        old = int(bits, 16) >> 5 & 1 if bits.isalnum() and len(bits) == 4 and _is_hex(bits) else 0
        first = look.get("firstRow", str(old))
        above: dict[int, Element] = {}
        for number, row in enumerate(rows):
            usual = "0" if number or len(rows) == 1 else first
            is_head = _value(row, "trPr/tblHeader", usual) not in _OFF
            line = (table.add("thead") if is_head else table).add("tr")
            column = whole(_value(row, "trPr/gridBefore"), 0)
            if column > 0:
                line.add("td", colspan=str(column))
            for cell in within(row, ("tc",), _SKIPPED):
                columns = max(whole(_value(cell, "tcPr/gridSpan"), 1), 1)
                goes_on = _value(cell, "tcPr/vMerge", "restart") != "restart"
                if goes_on and column in above:
                    over = above[column]
                    over.attributes["rowspan"] = str(whole(over.get("rowspan"), 1) + 1)
                else:
                    name = "th" if is_head else "td"
                    above[column] = line.add(name, colspan=str(columns))
                    self._blocks(cell, above[column])
                column += columns
        return table

    def _runs(self, holder: Element, into: Element, around: Look) -> None:
        """Read what is in a paragraph, or in a link."""
        for element in holder.elements:
            match element.name:
                case "r":
                    self._run(element, into, around)
                case "hyperlink":
                    anchor = element.get("anchor")
                    address = self._links.get(element.get("id"), "")
                    address += f"#{anchor}" if anchor else ""
                    self._runs(element, _put_link(into, address), around)
                case "bookmarkStart":
                    _put_bookmark(element, into)
                case "oMath" | "oMathPara":
                    into.add("math", alttext=omml_text(element))
                case "fldSimple":
                    link = _put_link(into, _field_target(element.get("instr")))
                    self._runs(element, link, around)
                case name if name not in _SKIPPED:
                    self._runs(element, into, around)

    def _run(self, run: Element, into: Element, around: Look) -> None:
        """Read a run of text that looks the same."""
        style = self._styles.look(_value(run, "rPr/rStyle"))
        look = _look_of(run).within(style).within(around)
        for element in run.elements:
            place = self._links_open[-1] if self._links_open else into
            if element.name == "fldChar":
                self._field(element, place)
            elif element.name == "instrText" and self._fields:
                self._fields[-1] += element.text
            elif HIDDEN not in look.on:
                self._piece(element, place, look)

    def _field(self, mark: Element, into: Element) -> None:
        """Begin a field, its text, or its end."""
        kind = mark.get("fldCharType")
        if kind == "begin":
            self._fields.append("")
            box = _find(mark, "ffData/checkBox")
            if box is not None:
                state = _value(box, "checked", _value(box, "default", "0"))
                into.say("☐" if state in _OFF else "☑")
        elif kind == "separate" and self._fields:
            link = _put_link(into, _field_target(self._fields[-1]))
            if link is not into:
                self._links_open.append(link)
        elif kind == "end" and self._fields and _field_target(self._fields.pop()):
            del self._links_open[-1:]

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read what stands in a run: text, a sign, a break, a note, a drawing."""
        match element.name:
            case "t":
                self._draft.say(into, element.text, look)
            case "noBreakHyphen":
                self._draft.say(into, "\u2011", look)
            case "tab" | "ptab":
                self._draft.say(into, "\t", look)
            case "sym":
                code = element.get("char", "0")
                sign = symbol(int(code, 16) if _is_hex(code) else 0, element.get("font"))
                self._draft.say(into, sign, look)
                if not sign:
                    put_picture(into, "", "symbol")
            case "footnoteReference" | "endnoteReference" as name:
                kind = name.removesuffix("Reference")
                self._draft.refer(into, f"{kind}-{element.get('id')}")
            case "br" | "cr" if element.get("type") != "page":
                into.add("br")
            case "ruby":
                base, above = _find(element, "rubyBase"), _find(element, "rt")
                ruby = into.add("ruby", "" if base is None else base.text)
                ruby.add("rt", "" if above is None else above.text)
            case "AlternateContent":
                # What this program knows, or else what is there for older ones.
                choice = _find(element, "Choice") or Element("Choice")
                drawn = [each for each in choice.elements if each.name in _DRAWN]
                for inner in drawn or element.iter("t", "sym"):
                    self._piece(inner, into, look)
            case name if name in _DRAWN:
                self._drawing(element, into)

    def _drawing(self, element: Element, into: Element) -> None:
        """Read a picture by its text, a box by what is in it; mark all else."""
        for box in element.iter("txbxContent"):
            self._blocks(box, into.add("div"))
            return
        kinds = [data.get("uri") for data in element.iter("graphicData")]
        described = [each.get("descr") for each in element.iter("docPr")]
        described += [each.get("alt") for each in element.iter("shape")]
        if element.name == "object":
            what = "embedded object"
        elif any("/chart" in kind for kind in kinds):
            what = "chart"
        elif any(kind.endswith("/diagram") for kind in kinds):
            what = "diagram"
        else:
            has_picture = next(element.iter("pic", "imagedata"), None) is not None
            what = "picture" if has_picture else "drawing"
        put_picture(into, next(filter(None, described), ""), what)


class _Lists:
    """Lists of the document; those of one abstract list count on, unless they begin anew."""

    def __init__(self, root: Element) -> None:
        abstract = {each.get("abstractNumId"): _levels(each) for each in root.iter("abstractNum")}
        counts: dict[str, Numbering] = {}
        self._lists: dict[str, Numbering] = {}
        self._restarts: dict[str, dict[int, int]] = {}
        for number in root.iter("num"):
            key, based = number.get("numId"), _value(number, "abstractNumId")
            usual = abstract.get(based, {})
            own: dict[int, Level] = {}
            starts: dict[int, int] = {}
            for override in number.elements:
                start = _value(override, "startOverride")
                if start:
                    starts[whole(override.get("ilvl"), 0)] = whole(start, 1)
                own |= _levels(override, whole(override.get("ilvl"), 0))
            self._restarts[key] = starts
            if own:
                self._lists[key] = Numbering(usual | own)
            else:
                self._lists[key] = counts.setdefault(based, Numbering(usual))

    def marker(self, key: str, at: int) -> str | None:
        """Count an item, and give what stands before it; None if there is no such list."""
        numbering = self._lists.get(key)
        if numbering is None or at not in numbering.levels:
            return None
        start = self._restarts[key].pop(at, None)
        if start is not None:
            numbering.restart(at, start)
        return numbering.marker(at)


def _levels(holder: Element, first: int = 0) -> dict[int, Level]:
    """Levels of a list; one that does not say its number is the next."""
    levels: dict[int, Level] = {}
    following = first
    for level in holder.elements:
        if level.name != "lvl":
            continue
        at = whole(level.get("ilvl"), following)
        following = at + 1
        levels[at] = Level(
            _FORMS.get(_value(level, "numFmt"), "1"),
            _value(level, "lvlText"),
            whole(_value(level, "start"), 1),
            _find(level, "isLgl") is not None and _value(level, "isLgl", "1") not in _OFF,
        )
    return levels


def _goes_on(paragraph: Element) -> bool:
    """Tell whether a paragraph is one with the next: its mark is deleted, or it is a drop cap."""
    deleted = _find(paragraph, "pPr/rPr/del") is not None
    frame = _find(paragraph, "pPr/framePr")
    return deleted or (frame is not None and frame.get("dropCap") in ("drop", "margin"))


def _style_of(holder: Element, based: str) -> Style:
    """Style of an element, or of a paragraph; the key of what it is based on stands at a path."""
    outline, at = _value(holder, "pPr/outlineLvl"), _value(holder, "pPr/numPr/ilvl")
    level = whole(outline, 9) + 1
    return Style(
        _value(holder, "name").lower(),
        _value(holder, based),
        _look_of(holder),
        None if not outline else level if level < 10 else 0,
        _value(holder, "pPr/numPr/numId") or None,
        max(whole(at, 0), 0) if at else None,
    )


def _look_of(holder: Element) -> Look:
    """Look that a style or a run says that it has."""
    properties = _find(holder, "rPr")
    if properties is None:
        return Look()
    language = font = ""
    on, off = set[str](), set[str]()
    for element in properties.elements:
        value = element.get("val")
        match element.name:
            case name if name in _TAGS:
                (off if value in _OFF else on).add(_TAGS[name])
            case "u":
                (off if value in ("", "none") else on).add("u")
            case "vertAlign" if value in _SMALL:
                on.add(_SMALL[value])
            case "vertAlign":
                off |= {"sup", "sub"}
            case "lang":
                language = tag_of(value)
            case "rFonts":
                named = element.get("ascii").lower().split(" ")[0]
                font = named if named in FONTS else ""
    return Look(language, frozenset(on), frozenset(off - on), font)


def _find(holder: Element, path: str) -> Element | None:
    """First element at a path of names."""
    found: Element | None = holder
    for name in path.split("/"):
        found = next((each for each in found.elements if each.name == name), None)
        if found is None:
            return None
    return found


def _value(holder: Element, path: str, otherwise: str = "") -> str:
    """Value of the element at a path; "" for one without a value, and another for none."""
    found = _find(holder, path)
    return otherwise if found is None else found.get("val")


def _put_link(into: Element, address: str) -> Element:
    """Put a link, for the text of one; without an address the text stands where it is."""
    return into.add("a", href=address) if address else into


def _put_bookmark(mark: Element, into: Element) -> None:
    name = mark.get("name")
    if name and name != "_GoBack":
        into.add("a", id=name)


def _field_target(instruction: str) -> str:
    """Address of the link that a field makes of its text; empty if it makes none."""
    words = instruction.split()
    if not words or words[0].upper() != "HYPERLINK":
        return ""
    told = [word.strip('"') for word in words[1:] if not word.startswith("\\") or word == "\\l"]
    if "\\l" in told:
        place = told.index("\\l")
        return f"{''.join(told[:place])}#{''.join(told[place + 1 : place + 2])}"
    return told[0] if told else ""


def _is_hex(text: str) -> bool:
    return text != "" and all(sign in "0123456789abcdefABCDEF" for sign in text)
