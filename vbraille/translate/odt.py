"""An ODT file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

import posixpath
from itertools import count
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.archive import Archive
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
    tag_of,
    within,
)
from vbraille.translate.trees import Element

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_DRAWN = frozenset(("custom-shape", "rect", "ellipse", "line", "path", "polygon", "g"))
_BLOCKS = _DRAWN | {"p", "h", "list", "table", "soft-page-break", "frame"}
# What is not read: comments, deleted text, what only programs need.
_SKIPPED = frozenset(
    [
        "annotation",
        "annotation-end",
        "tracked-changes",
        "forms",
        "sequence-decls",
        "variable-decls",
        "user-field-decls",
        "dde-connection-decls",
        "alphabetical-index-auto-mark-file",
        "bookmark-end",
        "reference-mark-end",
        "note-citation",
        "hidden-text",
        "hidden-paragraph",
        "toc-mark-start",
        "toc-mark-end",
        "desc",
        "script",
        "index-source",
        "table-of-content-source",
        "illustration-index-source",
        "table-index-source",
        "object-index-source",
        "user-index-source",
        "alphabetical-index-source",
        "bibliography-source",
        "list-header-source",
        "event-listeners",
    ]
)
_MOST_REPEATED = 1_000  # columns, rows or blanks
_NUMBERED = ("list-level-style-number", "outline-level-style")
# What properties of text say by one value, and otherwise by their others.
_LOOKS = {
    "font-weight": ("b", "normal"),
    "font-style": ("i", "normal"),
    "text-underline-style": ("u", "none"),
    "text-line-through-style": ("s", "none"),
}


def read_odt(source: Source) -> Iterator[Block]:
    """Read an ODT file.

    Raises
    ------
    InputError
        If a part that is needed is missing, locked, damaged or too large.
    """
    archive = Archive(source.stream, source.name)
    if b"encryption-data" in archive.read_if("META-INF/manifest.xml"):
        raise InputError(
            f"{source.name} is locked with a password; open it with that and save it without one"
        )
    return _Reader(archive).read(source)


class _Reader:
    """Reads one document."""

    def __init__(self, archive: Archive) -> None:
        self._archive = archive
        self._draft = Draft()
        self._root = archive.xml("content.xml")
        self._about = archive.xml("meta.xml", needed=False)
        self._usual = Look(dublin_core(self._about, "language"))
        self._styles = Styles()
        self._lists: dict[str, Numbering] = {}
        for part in (archive.xml("styles.xml", needed=False), self._root):
            self._read_styles(part)
        self._boxes = {box.get("id"): box for box in self._root.iter("checkbox")}
        self._notes: dict[str, Element] = {}
        self._pages = count(2)
        self._pending = 0  # pages that begin with the next paragraph

    def read(self, source: Source) -> Iterator[Block]:
        for body in self._root.iter("body"):
            for text in body.elements:
                self._blocks(text, Flow(self._draft.body), self._usual)
        for key, item in self._draft.note_items():
            self._blocks(self._notes[key], Flow(item), self._usual)
        source.title = dublin_core(self._about, "title")
        return self._draft.blocks(source, self._usual.language)

    def _read_styles(self, part: Element) -> None:
        for style in part.iter("default-style"):
            if style.get("family") == "paragraph":
                self._usual = _look_of(style).within(self._usual)
        for style in part.iter("list-style", "outline-style"):
            levels = {
                whole(e.get("level")) - 1: _level_of(e) for e in style.elements if e.get("level")
            }
            self._lists[style.get("name")] = Numbering(levels)
        for style in part.iter("style"):
            name = style.get("name")
            self._styles[name] = Style(
                name.replace("_20_", " ").lower(),
                style.get("parent-style-name"),
                _look_of(style),
                listed=style.get("list-style-name") or None,
            )

    def _look(self, element: Element, around: Look) -> Look:
        return self._styles.look(element.get("style-name")).within(around)

    def _blocks(
        self, holder: Element, flow: Flow, around: Look, item: tuple[str, int, str] | None = None
    ) -> None:
        """Read the blocks of a body, of a cell, of a note, or of an item of a list."""
        for element in within(holder, _BLOCKS, _SKIPPED):
            match element.name:
                case "list":
                    style, at = (item[0], item[1] + 1) if item else ("", 0)
                    self._list(element, flow, around, style, at)
                case "table":
                    flow.add_table(self._table(element, around))
                case "soft-page-break":
                    self._pending += 1
                case "p" | "h":
                    if self._paragraph(element, flow, around, item) and item:
                        item = (item[0], item[1], "")  # what follows in the item has no number
                case _:
                    block = Element("p")
                    self._piece(element, block, around)
                    flow.add(block, [], 0, None)

    def _paragraph(
        self, element: Element, flow: Flow, around: Look, item: tuple[str, int, str] | None
    ) -> bool:
        """Read a paragraph; tell whether there was something to show."""
        styles = self._styles.chain(element.get("style-name"))
        look = self._look(element, around)
        if HIDDEN in look.on:
            return False
        level = heading_level(styles)
        block = Element("p")
        for _ in range(self._pending):
            _put_page(block, next(self._pages))
        self._pending = 0
        if element.name == "h":  # tables of contents find it by its text
            level = max(whole(element.get("outline-level")), 1)
            block.add("a", id=element.text)
            if item and item[2]:
                block.say(item[2])
        self._inner(element, block, look)
        flow.add(block, styles, level, None if level else item)
        return bool(block.text)

    def _inner(self, element: Element, into: Element, look: Look) -> None:
        """Read the text of an element and what stands in it."""
        for child in element.children:
            if isinstance(child, str):
                self._draft.say(into, child, look)
            elif child.name not in _SKIPPED:
                self._piece(child, into, look)

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read an element within a paragraph."""
        match element.name:
            case "span":
                inner = self._look(element, look)
                if HIDDEN not in inner.on:
                    self._inner(element, into, inner)
            case "a":
                address = element.get("href")
                address = address.removesuffix("|outline") if address[:1] == "#" else address
                link = into.add("a", href=address) if address else into
                self._inner(element, link, self._look(element, look))
            case "s":
                blanks = min(whole(element.get("c")), _MOST_REPEATED)
                self._draft.say(into, " " * blanks, look)
            case "tab":
                into.say("\t")
            case "line-break":
                into.add("br")
            case "soft-page-break":
                _put_page(into, next(self._pages))
            case "bookmark" | "bookmark-start" | "reference-mark" | "reference-mark-start":
                into.add("a", id=element.get("name"))
            case "note":
                key = element.get("id") or f"note-{len(self._notes)}"
                body = next(element.iter("note-body"), element)
                self._notes[key] = body
                self._draft.refer(into, key)
            case "frame":
                self._frame(element, into, look)
            case "ruby":
                texts = [part.text for part in element.elements]
                ruby = into.add("ruby", "".join(texts[:1]))
                ruby.add("rt", "".join(texts[1:]))
            case "control":
                box = self._boxes.get(element.get("control"))
                if box is None:
                    into.add("input")
                else:
                    checked = (box.get("current-state") or box.get("state")) == "checked"
                    into.say("☑" if checked else "☐")
            case name if name in _DRAWN:
                if next(element.iter("p"), None) is not None:
                    self._blocks(element, Flow(into.add("div")), look)
                else:
                    put_picture(into, "", "drawing")
            case _:
                self._inner(element, into, look)

    def _frame(self, frame: Element, into: Element, look: Look) -> None:
        """Read a picture by its text, a formula, a box by what is in it; mark all else."""
        named = {element.name: element for element in frame.elements}
        if "text-box" in named:
            self._blocks(named["text-box"], Flow(into.add("div")), look)
        elif (formula := self._formula(frame)) is not None:
            into.children.append(formula)
        else:
            told = [named[name].text.strip() for name in ("desc", "title") if name in named]
            what = "embedded object" if "object" in named else "picture"
            put_picture(into, next(filter(None, told), ""), what)

    def _formula(self, frame: Element) -> Element | None:
        """Formula in MathML that a frame holds, or that another part of the archive is."""
        inside = next(frame.iter("math"), None)
        for element in frame.iter("object"):
            member = posixpath.normpath(f"{element.get('href')}/content.xml")
            if inside is None and element.get("href"):
                root = self._archive.xml(member, needed=False)
                inside = root if root.name == "math" else None
        return inside

    def _list(self, element: Element, flow: Flow, around: Look, style: str, at: int) -> None:
        """Read a list of a level, with the style of the one around it unless it has another."""
        first = next(element.iter("p", "h"), None)
        chained = self._styles.chain("" if first is None else first.get("style-name"))
        usual = style or next((one.listed for one in chained if one.listed), "")
        style = element.get("style-name") or usual
        numbering = self._lists.setdefault(style, Numbering({}))
        if element.get("continue-numbering") != "true" and not element.get("continue-list"):
            numbering.restart(at)
        for item in element.elements:
            if item.name == "list-header":
                self._blocks(item, flow, around, (style, at, ""))
            elif item.name == "list-item":
                if item.get("start-value"):
                    numbering.restart(at, whole(item.get("start-value")))
                only_lists = all(child.name == "list" for child in item.elements)
                marker = "" if only_lists else numbering.marker(at)
                self._blocks(item, flow, around, (style, at, marker))

    def _table(self, element: Element, around: Look) -> Element:
        table = Element("table")
        heads = {id(row) for rows in element.iter("table-header-rows") for row in rows.elements}
        for row in within(element, ("table-row",), _SKIPPED):
            is_head = id(row) in heads or self._is_heading_row(row)
            shown = any(cell.text.strip() for cell in row.elements)
            repeated = min(whole(row.get("number-rows-repeated")), _MOST_REPEATED)
            for _ in range(max(repeated, 1) if shown else 1):
                line = (table.add("thead") if is_head else table).add("tr")
                self._row(row, line, around, "th" if is_head else "td")
        return table

    def _row(self, row: Element, line: Element, around: Look, name: str) -> None:
        for cell in row.elements:
            if cell.name != "table-cell":  # one that another covers
                continue
            repeated = whole(cell.get("number-columns-repeated"))
            for _ in range(min(max(repeated, 1), _MOST_REPEATED)):
                into = line.add(
                    name,
                    colspan=cell.get("number-columns-spanned", "1"),
                    rowspan=cell.get("number-rows-spanned", "1"),
                )
                self._blocks(cell, Flow(into), around)

    def _is_heading_row(self, row: Element) -> bool:
        """Tell whether the paragraphs of a row have the style of a table's head."""
        styles = [self._styles.chain(each.get("style-name")) for each in row.iter("p")]
        return bool(styles) and all(
            any(style.name.startswith("table heading") for style in chained) for chained in styles
        )


def _put_page(into: Element, number: int) -> None:
    into.add("span", role="doc-pagebreak", aria_label=str(number))


def _level_of(element: Element) -> Level:
    """Level of a list, by the element that says how its items begin."""
    if element.name not in _NUMBERED:
        return Level("bullet", element.get("bullet-char") or "•")
    level, shown = whole(element.get("level")), whole(element.get("display-levels"))
    form = element.get("num-format")
    numbers = ".".join(f"%{n}" for n in range(max(level + 1 - shown, 1), level + 1)) if form else ""
    text = f"{element.get('num-prefix')}{numbers}{element.get('num-suffix')}"
    return Level(form or "none", text, whole(element.get("start-value")))


def _look_of(style: Element) -> Look:
    """Look that a style says that its text has."""
    properties = next((e for e in style.elements if e.name == "text-properties"), None)
    if properties is None:
        return Look()
    on, off = set[str](), set[str]()
    for name, (tag, usual) in _LOOKS.items():
        value = properties.get(name)
        if value:
            is_usual = value == usual or (value.isdigit() and int(value) < 600)
            (off if is_usual else on).add(tag)
    raised = properties.get("text-position").split(" ")[0]
    if raised.startswith(("sub", "-")):
        on.add("sub")
    elif raised == "super" or (raised.rstrip("%").isdigit() and raised != "0%"):
        on.add("sup")
    font = properties.get("font-name").lower().split(" ")[0]
    display = properties.get("display")
    if display:
        (on if display == "none" else off).add(HIDDEN)
    tag = tag_of(properties.get("language"), properties.get("country"))
    return Look(tag, frozenset(on), frozenset(off), font if font in FONTS else "")
