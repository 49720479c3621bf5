"""An ODT file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

import posixpath
from copy import deepcopy
from itertools import count
from typing import TYPE_CHECKING

from lxml import etree

from vbraille.errors import InputError
from vbraille.translate.documents.markup.tables import whole
from vbraille.translate.documents.office.htmltree import (
    HIDDEN,
    PLAIN,
    BlockFlow,
    Draft,
    Level,
    Look,
    Numbering,
    OfficeTable,
    Styles,
    TextStyle,
    dublin_core,
    heading_level,
    put,
    put_page,
    put_picture,
    put_ruby,
    put_text,
    put_unshown,
    tag_of,
    within,
)

if TYPE_CHECKING:
    from lxml.etree import _Element as Element

    from vbraille.translate.documents.markup.archive import Archive

_DRAWN = frozenset(("custom-shape", "rect", "ellipse", "line", "path", "polygon", "g"))
_BLOCKS = _DRAWN | {"p", "h", "list", "table", "soft-page-break", "frame"}
# What is not read: comments, deleted text, what only programs need.
_SKIPPED_NAMES = (
    "annotation annotation-end tracked-changes forms sequence-decls variable-decls "
    "user-field-decls dde-connection-decls alphabetical-index-auto-mark-file bookmark-end "
    "reference-mark-end note-citation hidden-text hidden-paragraph toc-mark-start toc-mark-end "
    "desc script index-source table-of-content-source illustration-index-source "
    "table-index-source object-index-source user-index-source alphabetical-index-source "
    "bibliography-source list-header-source event-listeners"
)
_SKIPPED = frozenset(_SKIPPED_NAMES.split())
_MOST_REPEATED = 1_000  # columns, rows or blanks
# What properties of text say by one value, and otherwise by their others.
_LOOKS = {
    "font-weight": ("b", "normal"),
    "font-style": ("i", "normal"),
    "text-underline-style": ("u", "none"),
    "text-line-through-style": ("s", "none"),
}


def read_odt(archive: Archive) -> tuple[Element, str, str]:
    """Read an ODT file.

    Returns
    -------
    root
        Root of the tree of HTML.
    title, language
        Title, and tag of the language that most of the text is in; empty if it does not say.

    Raises
    ------
    InputError
        If a part that is needed is missing, locked, damaged or too large.
    """
    if b"encryption-data" in archive.read_if("META-INF/manifest.xml"):
        raise InputError(
            f"{archive.name} is locked with a password; open it with that and save it without one"
        )
    return _Reader(archive).read()


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._draft = Draft()
        self._root = archive.plain("content.xml")
        self._about = archive.plain("meta.xml", needed=False)
        self._usual = Look(dublin_core(self._about, "language"))
        self._styles = Styles()
        self._lists: dict[str, Numbering] = {}
        for part in (archive.plain("styles.xml", needed=False), self._root):
            self._read_styles(part)
        self._boxes = {box.get("id", ""): box for box in self._root.iter("checkbox")}
        self._notes: dict[str, Element] = {}
        self._pages = count(2)
        self._is_laid_out = next(self._root.iter("soft-page-break"), None) is not None
        self._pending = 0  # pages that begin with the next paragraph
        self._is_first = True

    def read(self) -> tuple[Element, str, str]:
        for text in self._root.iterfind("body/text"):
            self._blocks(text, self._draft.body, self._usual)
        for key, item in self._draft.notes():
            self._blocks(self._notes[key], item, self._usual)
        language = self._draft.finish(self._usual.language)
        return self._draft.html, dublin_core(self._about, "title"), language

    def _read_styles(self, part: Element) -> None:
        for style in part.iter("default-style"):
            if style.get("family") == "paragraph":
                self._usual = _look_of(style).within(self._usual)
        for style in part.iter("list-style"):
            levels = {whole(e.get("level"), 1) - 1: _level_of(e) for e in style if e.get("level")}
            self._lists[style.get("name", "")] = Numbering(levels)
        for style in part.iter("style"):
            name = style.get("name", "")
            properties = style.find("paragraph-properties")
            breaks = properties is not None and properties.get("break-before") == "page"
            self._styles[name] = TextStyle(
                name.replace("_20_", " ").lower(),
                style.get("parent-style-name", ""),
                _look_of(style),
                listed=style.get("list-style-name") or None,
                begins_page=breaks or bool(style.get("master-page-name")),
            )

    def _look(self, element: Element, around: Look) -> Look:
        return self._styles.look(element.get("style-name", "")).within(around)

    def _blocks(
        self, holder: Element, into: Element, around: Look, outer: tuple[str, int] = ("", 0)
    ) -> None:
        """Read the blocks of a body, of a cell, of a note, or of an item of an outer list."""
        flow = BlockFlow(into)
        for element in within(holder, _BLOCKS, _SKIPPED):
            match element.tag:
                case "list":
                    self._list(element, into, around, *outer)
                case "table":
                    flow.add_table(self._table(element, around))
                case "soft-page-break":
                    self._pending += 1
                case "p" | "h":
                    self._paragraph(element, flow, around)
                case _:
                    block = etree.Element("p")
                    self._piece(element, block, around)
                    flow.add(block)

    def _paragraph(self, element: Element, flow: BlockFlow, around: Look) -> None:
        style = element.get("style-name", "")
        styles = self._styles.chain(style)
        look = self._look(element, around)
        if HIDDEN in look.tags:
            return
        level = heading_level(styles)
        block = etree.Element("p")
        if not self._is_first and styles and styles[0].begins_page:
            self._pending += 1
        self._is_first = False
        for _ in range(self._pending):
            put_page(block, str(next(self._pages)) if self._is_laid_out else "")
        self._pending = 0
        if element.tag == "h":  # tables of contents find it by its text
            level = max(whole(element.get("outline-level"), 1), 1)
            put(block, "a", id="".join(map(str, element.itertext())))
        self._inner(element, block, look)
        flow.add(block, styles, level)

    def _inner(self, element: Element, into: Element, look: Look) -> None:
        """Read the text of an element and what stands in it."""
        self._draft.say(into, element.text, look)
        for child in element:
            if child.tag not in _SKIPPED:
                self._piece(child, into, look)
            self._draft.say(into, child.tail, look)

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read an element within a paragraph."""
        match element.tag:
            case "span":
                inner = self._look(element, look)
                if HIDDEN not in inner.tags:
                    self._inner(element, into, inner)
            case "a":
                address = element.get("href", "")
                address = address.removesuffix("|outline") if address[:1] == "#" else address
                link = put(into, "a", href=address) if address else into
                self._inner(element, link, self._look(element, look))
            case "s":
                blanks = min(whole(element.get("c"), 1), _MOST_REPEATED)
                self._draft.say(into, " " * blanks, look)
            case "tab":
                put_text(into, "\t")
            case "line-break":
                put(into, "br")
            case "soft-page-break":
                put_page(into, str(next(self._pages)))
            case "bookmark" | "bookmark-start" | "reference-mark" | "reference-mark-start":
                put(into, "a", id=element.get("name", ""))
            case "note":
                key = element.get("id") or f"note-{len(self._notes)}"
                body = element.find("note-body")
                self._notes[key] = element if body is None else body
                self._draft.refer(into, key)
            case "frame":
                self._frame(element, into, look)
            case "ruby":
                parts = ["".join(map(str, part.itertext())) for part in element]
                put_ruby(into, "".join(parts[:1]), "".join(parts[1:]))
            case "control":
                box = self._boxes.get(element.get("control", ""))
                if box is None:
                    put_unshown(into, "form field")
                else:
                    state = box.get("current-state") or box.get("state")
                    put_text(into, "☑" if state == "checked" else "☐")
            case name if name in _DRAWN:
                if next(element.iter("p"), None) is not None:
                    self._blocks(element, put(into, "div"), look)
                else:
                    put_unshown(into, "drawing")
            case _:
                self._inner(element, into, look)

    def _frame(self, frame: Element, into: Element, look: Look) -> None:
        """Read a picture by its text, a formula, a box by what is in it; mark all else."""
        box = frame.find("text-box")
        if box is not None:
            self._blocks(box, put(into, "div"), look)
        elif (formula := self._formula(frame)) is not None:
            into.append(formula)
        else:
            told = [*frame.iterfind("desc"), *frame.iterfind("title")]
            texts = ("".join(map(str, element.itertext())).strip() for element in told)
            what = "picture" if frame.find("object") is None else "embedded object"
            put_picture(into, next(filter(None, texts), ""), what)

    def _formula(self, frame: Element) -> Element | None:
        """Formula in MathML that a frame holds, or that another part of the archive is."""
        inside = next(frame.iter("math"), None)
        for element in frame.iterfind("object"):
            member = posixpath.normpath(f"{element.get('href', '')}/content.xml")
            if inside is None and element.get("href"):
                inside = self._archive.plain(member, needed=False)
        if inside is None or inside.tag != "math":
            return None
        math = deepcopy(inside)
        math.tail = None
        notes = list(math.iter("annotation"))
        in_tex = [note for note in notes if "tex" in note.get("encoding", "").lower()]
        for note in notes:
            if in_tex and note not in in_tex:  # StarMath says the same once more
                note.tag = "annotation-xml"
        return math

    def _list(self, element: Element, into: Element, around: Look, style: str, at: int) -> None:
        """Read a list of a level, with the style of the one around it unless it has another."""
        first = next(element.iter("p", "h"), None)
        chained = self._styles.chain("" if first is None else first.get("style-name", ""))
        usual = style or next((one.listed for one in chained if one.listed), "")
        style = element.get("style-name") or usual
        numbering = self._lists.get(style, Numbering({}))
        if element.get("continue-numbering") != "true":
            numbering.restart(at)
        listed = put(into, "ul")
        for item in element:
            if item.tag == "list-item":
                number = whole(item.get("start-value"), -1)
                marker = numbering.marker(at, number if number >= 0 else None)
                made = put(listed, "li", data_marker=marker or "")
                self._blocks(item, made, around, (style, at + 1))
            elif item.tag == "list-header":
                self._blocks(item, put(listed, "div"), around, (style, at + 1))

    def _table(self, element: Element, around: Look) -> OfficeTable:
        table = OfficeTable()
        for row in within(element, ("table-row",), _SKIPPED):
            around_row = row.getparent()
            is_told = around_row is not None and around_row.tag == "table-header-rows"
            table.row(is_head=is_told or self._is_heading_row(row))
            for cell in row.iterfind("table-cell"):
                columns = whole(cell.get("number-columns-spanned"), 1)
                rows = whole(cell.get("number-rows-spanned"), 1)
                repeated = whole(cell.get("number-columns-repeated"), 1)
                for _ in range(min(repeated, _MOST_REPEATED)):
                    self._blocks(cell, table.cell(max(columns, 1), rows=rows), around)
        return table

    def _is_heading_row(self, row: Element) -> bool:
        """Tell whether the paragraphs of a row have the style of a table's head."""
        styles = [self._styles.chain(e.get("style-name", "")) for e in row.iter("p")]
        return bool(styles) and all(
            any(style.name.startswith("table heading") for style in chained) for chained in styles
        )


def _level_of(element: Element) -> Level:
    """Level of a list, by the element that says how its items begin."""
    if element.tag != "list-level-style-number":
        return Level("bullet", element.get("bullet-char") or "•")
    level = whole(element.get("level"), 1)
    shown = whole(element.get("display-levels"), 1)
    form = element.get("num-format", "")
    numbers = ".".join(f"%{n}" for n in range(max(level + 1 - shown, 1), level + 1)) if form else ""
    text = f"{element.get('num-prefix', '')}{numbers}{element.get('num-suffix', '')}"
    return Level(form or "1", text, whole(element.get("start-value"), 1))


def _look_of(style: Element) -> Look:
    """Look that a style says that its text has."""
    properties = style.find("text-properties")
    if properties is None:
        return PLAIN
    on, off = set[str](), set[str]()
    for name, (tag, usual) in _LOOKS.items():
        value = properties.get(name)
        if value is not None:
            is_usual = value == usual or (value.isdigit() and int(value) < 600)
            (off if is_usual else on).add(tag)
    position = properties.get("text-position", "").split()[:1]
    raised = position[0] if position else ""
    if raised.startswith(("sub", "-")):
        on.add("sub")
    elif raised == "super" or (raised.rstrip("%").isdigit() and raised != "0%"):
        on.add("sup")
    display = properties.get("display")
    if display is not None:
        (on if display == "none" else off).add(HIDDEN)
    tag = tag_of(properties.get("language"), properties.get("country"))
    return Look(tag, frozenset(on), frozenset(off))
