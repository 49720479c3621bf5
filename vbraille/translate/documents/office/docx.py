"""A DOCX file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.translate.documents.office.htmltree import (
    HIDDEN,
    BlockFlow,
    Draft,
    Level,
    Look,
    Numbering,
    OfficeTable,
    Styles,
    TextStyle,
    dublin_core,
    field_target,
    heading_level,
    put,
    put_page,
    put_page_break,
    put_picture,
    put_ruby,
    put_text,
    put_unshown,
    symbol,
    tag_of,
    within,
)

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

    from vbraille.translate.documents.markup.archive import Archive

_FORMS = {
    "bullet": "bullet",
    "none": "none",
    "lowerLetter": "a",
    "upperLetter": "A",
    "lowerRoman": "i",
    "upperRoman": "I",
}
_TAGS = {"b": "b", "i": "i", "strike": "s", "dstrike": "s", "vanish": HIDDEN}
_SMALL = {"superscript": "sup", "subscript": "sub"}
_OFF = frozenset(("0", "false", "none", "off"))
# What is not read: deleted text, what is kept for other programs, properties.
_SKIPPED_NAMES = (
    "del moveFrom delText instrText Fallback pPr rPr sdtPr tblPr trPr tcPr sectPr tblGrid "
    "footnoteRef endnoteRef annotationRef"
)
_SKIPPED = frozenset(_SKIPPED_NAMES.split())
_BLOCKS = frozenset(("p", "tbl", "bookmarkStart"))
_DRAWN = frozenset(("drawing", "pict", "object"))


def read_docx(archive: Archive) -> tuple[Element, str, str]:
    """Read a DOCX file.

    Returns
    -------
    root
        Root of the tree of HTML.
    title, language
        Title, and tag of the language that most of the text is in; empty if it does not say.

    Raises
    ------
    InputError
        If a part that is needed is missing, damaged or too large.
    """
    return _Reader(archive).read()


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._draft = Draft()
        member = self._main()
        self._folder, _, name = member.rpartition("/")
        self._root = archive.plain(member)
        self._links = self._relations(name)
        self._about = archive.plain("docProps/core.xml", needed=False)
        self._styles = Styles()
        styles = self._part("styles.xml")
        for style in styles.iter("style"):
            self._styles[style.get("styleId", "")] = _style_of(style, "basedOn")
        default = styles.find("docDefaults/rPrDefault/rPr/lang")
        usual = "" if default is None else tag_of(default.get("val"))
        self._usual = Look(usual or dublin_core(self._about, "language"))
        self._lists = _read_lists(self._part("numbering.xml"))
        self._is_laid_out = next(self._root.iter("lastRenderedPageBreak"), None) is not None
        start = self._root.find(".//sectPr/pgNumType")
        self._pages = count(_whole(None if start is None else start.get("start"), 1) + 1)
        self._fields: list[str] = []  # instructions of the fields around the run
        self._links_open: list[Element] = []  # those of the paragraph's fields

    def read(self) -> tuple[Element, str, str]:
        self._blocks(self._root, self._draft.body)
        for key, item in self._draft.notes():
            kind, _, number = key.partition("-")
            self._links = self._relations(f"{kind}s.xml")
            for note in self._part(f"{kind}s.xml").iterfind(kind):
                if note.get("id") == number:
                    self._blocks(note, item)
        language = self._draft.finish(self._usual.language)
        return self._draft.html, dublin_core(self._about, "title"), language

    def _main(self) -> str:
        """Name of the member with the text."""
        for relation in self._archive.plain("_rels/.rels", needed=False).iter("Relationship"):
            target = relation.get("Target", "").lstrip("/")
            if relation.get("Type", "").endswith("/officeDocument") and target in self._archive:
                return target
        return "word/document.xml"

    def _part(self, name: str) -> Element:
        return self._archive.plain(f"{self._folder}/{name}", needed=False)

    def _relations(self, name: str) -> dict[str, str]:
        """Addresses in a part of the document, by their keys there."""
        found = self._part(f"_rels/{name}.rels").iter("Relationship")
        return {relation.get("Id", ""): relation.get("Target", "") for relation in found}

    def _blocks(self, holder: Element, into: Element) -> None:
        """Read the blocks of a body, of a cell or of a note."""
        flow = BlockFlow(into)
        pending: list[Element] = []  # bookmarks between paragraphs, which are those of the next
        for element in within(holder, _BLOCKS, _SKIPPED):
            if element.tag == "bookmarkStart":
                pending.append(element)
            elif element.tag == "p":
                self._paragraph(element, flow, pending)
                pending = []
            else:
                flow.add_table(self._table(element))

    def _paragraph(self, element: Element, flow: BlockFlow, bookmarks: list[Element]) -> None:
        own = _style_of(element, "pPr/pStyle")
        styles = [own, *self._styles.chain(own.based)]
        level = heading_level(styles)
        key = next((style.listed for style in styles if style.listed is not None), "0")
        at = min(next((style.at for style in styles if style.at is not None), 0), 8)
        item = None
        block = etree.Element("p")
        for bookmark in bookmarks:
            _put_bookmark(bookmark, block)
        if own.begins_page and not self._is_laid_out:
            put_page(block)
        if key in self._lists and at in self._lists[key].levels:
            item = key, at, self._lists[key].marker(at)
            if level and self._lists[key].levels[at].form != "bullet":
                put_text(block, item[2] or "")
        outer, self._links_open = self._links_open, []
        self._runs(element, block, self._styles.look(own.based).within(self._usual))
        self._links_open = outer
        flow.add(block, styles, level, item)

    def _table(self, element: Element) -> OfficeTable:
        rows = list(within(element, ("tr",), _SKIPPED))
        look = element.find("tblPr/tblLook")
        told = {} if look is None else look.attrib
        first = told.get("firstRow", str(_whole(told.get("val"), 0, base=16) >> 5 & 1))
        table = OfficeTable()
        for number, row in enumerate(rows):
            usual = "0" if number or len(rows) == 1 else first
            table.row(is_head=(_value(row, "trPr/tblHeader", usual) or "") not in _OFF)
            before = _whole(_value(row, "trPr/gridBefore"), 0)
            if before > 0:
                table.cell(before)
            for cell in within(row, ("tc",), _SKIPPED):
                goes_on = _value(cell, "tcPr/vMerge", "restart") != "restart"
                columns = max(_whole(_value(cell, "tcPr/gridSpan"), 1), 1)
                self._blocks(cell, table.cell(columns, goes_on=goes_on))
        return table

    def _runs(self, holder: Element, into: Element, around: Look) -> None:
        """Read what is in a paragraph, or in a link."""
        for element in holder:
            match element.tag:
                case "r":
                    self._run(element, into, around)
                case "hyperlink":
                    anchor = element.get("anchor")
                    address = self._links.get(element.get("id", ""), "")
                    address += f"#{anchor}" if anchor else ""
                    self._runs(element, _put_link(into, address), around)
                case "bookmarkStart":
                    _put_bookmark(element, into)
                case "oMath" | "oMathPara":
                    put(into, "math", alttext=tex_of(element))
                case "fldSimple":
                    link = _put_link(into, field_target(element.get("instr", "")))
                    self._runs(element, link, around)
                case name if name not in _SKIPPED:
                    self._runs(element, into, around)

    def _run(self, run: Element, into: Element, around: Look) -> None:
        """Read a run of text that looks the same."""
        style = self._styles.look(_value(run, "rPr/rStyle") or "")
        look = _look_of(run).within(style).within(around)
        for element in run:
            place = self._links_open[-1] if self._links_open else into
            if element.tag == "fldChar":
                self._field(element, place)
            elif element.tag == "instrText" and self._fields:
                self._fields[-1] += element.text or ""
            elif HIDDEN not in look.tags:
                self._piece(element, place, look)

    def _field(self, mark: Element, into: Element) -> None:
        """Begin a field, its text, or its end."""
        kind = mark.get("fldCharType")
        if kind == "begin":
            self._fields.append("")
            box = mark.find("ffData/checkBox")
            if box is not None:
                state = _value(box, "checked", _value(box, "default", "0"))
                put_text(into, "☐" if state in _OFF else "☑")
        elif kind == "separate" and self._fields:
            link = _put_link(into, field_target(self._fields[-1]))
            if link is not into:
                self._links_open.append(link)
        elif kind == "end" and self._fields and field_target(self._fields.pop()):
            del self._links_open[-1:]

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read what stands in a run: text, a sign, a break, a note, a drawing."""
        match element.tag:
            case "t":
                self._draft.say(into, element.text, look)
            case "noBreakHyphen":
                self._draft.say(into, "\u2011", look)
            case "tab" | "ptab":
                self._draft.say(into, "\t", look)
            case "sym":
                sign = symbol(_whole(element.get("char"), 0, base=16), element.get("font", ""))
                self._draft.say(into, sign, look)
                if not sign:
                    put_unshown(into, "symbol")
            case "footnoteReference" | "endnoteReference" as name:
                kind = name.removesuffix("Reference")
                self._draft.refer(into, f"{kind}-{element.get('id', '')}")
            case "lastRenderedPageBreak":
                put_page(into, str(next(self._pages)))
            case "br" | "cr":
                if element.get("type") != "page":
                    put(into, "br")
                elif not self._is_laid_out:
                    put_page_break(into)
            case "ruby":
                put_ruby(into, _text_of(element.find("rubyBase")), _text_of(element.find("rt")))
            case "AlternateContent":
                # What this program knows, or else what is there for older ones.
                choice = element.find("Choice")
                drawn = [] if choice is None else [e for e in choice if e.tag in _DRAWN]
                for inner in drawn or element.iter("t", "sym"):
                    self._piece(inner, into, look)
            case name if name in _DRAWN:
                self._drawing(element, into)

    def _drawing(self, element: Element, into: Element) -> None:
        """Read a picture by its text, a box by what is in it; mark all else."""
        box = next(element.iter("txbxContent"), None)
        if box is not None:
            self._blocks(box, put(into, "div"))
            return
        kinds = [data.get("uri", "") for data in element.iter("graphicData")]
        described = [e.get("descr") or "" for e in element.iter("docPr")]
        described += [e.get("alt") or "" for e in element.iter("shape")]
        if element.tag == "object":
            what = "embedded object"
        elif any("/chart" in kind for kind in kinds):
            what = "chart"
        elif any(kind.endswith("/diagram") for kind in kinds):
            what = "diagram"
        else:
            has_picture = next(element.iter("pic", "imagedata"), None) is not None
            what = "picture" if has_picture else "drawing"
        put_picture(into, next(filter(None, described), ""), what)


def _style_of(holder: Element, based: str) -> TextStyle:
    """Tell what a style says, or a paragraph; and what that is based on, which stands at a path."""
    outline = _value(holder, "pPr/outlineLvl") or ""
    level = _whole(outline, 9) + 1
    return TextStyle(
        (_value(holder, "name") or "").lower(),
        _value(holder, based) or "",
        _look_of(holder),
        None if not outline.isdigit() else level if level < 10 else 0,
        _value(holder, "pPr/numPr/numId"),
        None if (at := _value(holder, "pPr/numPr/ilvl")) is None else max(_whole(at, 0), 0),
        _value(holder, "pPr/pageBreakBefore", "0") not in _OFF,
    )


def _look_of(holder: Element) -> Look:
    """Look that a style or a run says that it has."""
    language, on, off = "", set[str](), set[str]()
    for element in holder.iterfind("rPr/*"):
        value = element.get("val", "")
        match element.tag:
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
    return Look(language, frozenset(on), frozenset(off - on))


def _read_lists(root: Element) -> dict[str, Numbering]:
    """Lists of the document, by the keys by which their paragraphs name them."""
    abstract = {element.get("abstractNumId"): element for element in root.iter("abstractNum")}
    found = {}
    for number in root.iter("num"):
        levels: dict[int, Level] = {}
        usual = abstract.get(_value(number, "abstractNumId"))
        holders = [] if usual is None else [usual]
        for holder in (*holders, *number.iterfind("lvlOverride")):
            for level in holder.iterfind("lvl"):
                levels[_whole(level.get("ilvl"), 0)] = Level(
                    _FORMS.get(_value(level, "numFmt") or "", "1"),
                    _value(level, "lvlText") or "",
                    _whole(_value(level, "start"), 1),
                )
            start, at = _value(holder, "startOverride"), _whole(holder.get("ilvl"), 0)
            if start is not None and at in levels:
                levels[at] = Level(levels[at].form, levels[at].text, _whole(start, 1))
        found[number.get("numId", "")] = Numbering(levels)
    return found


def _put_link(into: Element, address: str) -> Element:
    """Put a link, for the text of one; without an address the text stands where it is."""
    return put(into, "a", href=address) if address else into


def _put_bookmark(mark: Element, into: Element) -> None:
    name = mark.get("name", "")
    if name != "_GoBack":  # where the author wrote last
        put(into, "a", id=name)


def _text_of(element: Element | None) -> str:
    return "" if element is None else "".join(text.text or "" for text in element.iter("t"))


def _value(holder: Element, path: str, otherwise: str | None = None) -> str | None:
    """Value of an element at a path; "" if it has none, the other one if it is not there."""
    found = holder.find(path)
    return otherwise if found is None else found.get("val", "")


def _whole(text: str | None, otherwise: int, base: int = 10) -> int:
    try:
        return int(text or "", base) if len(text or "") < 9 else otherwise
    except ValueError:
        return otherwise


# Formulas of Office's own markup (OMML) as TeX: what is made of the parts of an element, by the
# names of these.
_DEEPEST = 60
_NARY = {"∑": "\\sum", "∫": "\\int", "∏": "\\prod", "": "\\int"}
_FORMULAS = {
    "f": "\\frac{{{num}}}{{{den}}}",
    "sSup": "{e}^{{{sup}}}",
    "sSub": "{e}_{{{sub}}}",
    "sSubSup": "{e}_{{{sub}}}^{{{sup}}}",
    "sPre": "{{}}_{{{sub}}}^{{{sup}}}{e}",
    "limLow": "{e}_{{{lim}}}",
    "limUpp": "{e}^{{{lim}}}",
    "func": "{fName} {e}",
    "bar": "\\overline{{{e}}}",
    "groupChr": "\\underbrace{{{e}}}",
}
_PARTS = ("num", "den", "e", "sup", "sub", "lim", "fName", "deg")


def tex_of(element: Element, depth: int = 0) -> str:
    """TeX of a formula or a part of one; what has no form of its own is the text in it."""
    name = element.tag
    if name == "t" or depth > _DEEPEST:
        return "".join(map(str, element.itertext()))
    inner = [child for child in element if not child.tag.endswith("Pr")]
    texts = [tex_of(child, depth + 1) for child in inner]
    parts = dict.fromkeys(_PARTS, "") | {e.tag: tex for e, tex in zip(inner, texts, strict=True)}
    match name:
        case "d":
            signs = (("begChr", "("), ("sepChr", "|"), ("endChr", ")"))
            first, between, last = (_value(element, f"dPr/{sign}", usual) for sign, usual in signs)
            return f"{first}{(between or '').join(texts)}{last}"
        case "mr":
            return " & ".join(texts)
        case "m":
            return "\\begin{matrix} " + " \\\\ ".join(texts) + " \\end{matrix}"
        case "eqArr":
            return " \\\\ ".join(texts)
        case "rad":
            degree = f"[{parts['deg']}]" if parts["deg"] else ""
            return f"\\sqrt{degree}{{{parts['e']}}}"
        case "nary":
            sign = _value(element, "naryPr/chr", "∫") or ""
            below = f"_{{{parts['sub']}}}" if parts["sub"] else ""
            above = f"^{{{parts['sup']}}}" if parts["sup"] else ""
            return f"{_NARY.get(sign, sign)}{below}{above} {parts['e']}"
        case "acc":
            return parts["e"] + (_value(element, "accPr/chr", "\u0302") or "")
        case _ if name in _FORMULAS:
            return _FORMULAS[name].format(**parts)
    return "".join(texts)
