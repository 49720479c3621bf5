"""An ODT file as a tree of HTML: styles, lists, tables, notes, links, languages, pages."""

from __future__ import annotations

import posixpath
from itertools import count
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.numbering import whole
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
    tag_of,
    within,
)
from vbraille.translate.trees import Element, names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_NAMES = names("odt")
_DRAWN, _SKIPPED = _NAMES["drawn"], _NAMES["skipped"]
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
    return _Odt(source).read(source)


class _Odt(Document):
    """Reads one document."""

    def read(self, source: Source) -> Iterator[Block]:
        if b"encryption-data" in self.archive.read_if("META-INF/manifest.xml"):
            raise InputError(
                f"{source.name} is locked with a password; open it with that and save it without "
                f"one"
            )
        root = self.archive.xml("content.xml")
        self._lists: dict[str, Numbering] = {}
        for part in (self.archive.xml("styles.xml", needed=False), root):
            self._read_styles(part)
        self._boxes = {box.get("id"): box for box in root.iter("checkbox")}
        self._bodies: dict[str, Element] = {}  # of notes
        self._pages = count(2)
        self._list_around = ("", 0)  # style, and the level of a list in it
        for body in root.iter("body"):
            self._inner(body, self.body, self.usual)
        for key, item in self.note_items():
            self._inner(self._bodies[key], item, self.usual)
        return self.blocks(source, self.archive.xml("meta.xml", needed=False))

    def _read_styles(self, part: Element) -> None:
        for style in part.iter("default-style"):
            if style.get("family") == "paragraph":
                self.usual |= _look_of(style)
        for style in part.iter("list-style", "outline-style"):
            levels = [each for each in style.elements if each.get("level")]
            self._lists[style.get("name")] = Numbering(
                {whole(each.get("level")) - 1: _level_of(each) for each in levels}
            )
        for style in part.iter("style"):
            name = style.get("name")
            self.styles[name] = Style(
                name.replace("_20_", " ").lower(),
                style.get("parent-style-name"),
                _look_of(style),
                listed=style.get("list-style-name") or None,
            )

    def _inner(self, holder: Element, into: Element, look: Look) -> None:
        """Read the text of an element and what stands in it."""
        for child in holder.children:
            if isinstance(child, str):
                self.say(into, child, look)
            elif child.name not in _SKIPPED:
                self._piece(child, into, look)

    def _piece(self, element: Element, into: Element, look: Look) -> None:
        """Read a block, or what stands in a paragraph."""
        styles = self.chain(element.get("style-name"))
        match element.name:
            case "p" | "h":
                look = look | self.look_of(element.get("style-name"))
                if look.get(HIDDEN):
                    return
                block = into.add("p")
                is_heading = element.name == "h"
                if is_heading:  # tables of contents find it by its text
                    block.add("a", id=element.text)
                self._inner(element, block, look)
                name_by_style(
                    block, styles, is_heading * max(whole(element.get("outline-level")), 1)
                )
            case "list":
                self._list(element, into, look)
            case "table":
                self._table(element, into.add("table"), look)
            case "a" | "span":
                look = look | self.look_of(element.get("style-name"))
                address = element.get("href").removesuffix("|outline")
                self._inner(element, into.add("a", href=address) if address else into, look)
            case "s":
                self.say(into, " " * min(whole(element.get("c")), _MOST_REPEATED), look)
            case "tab":
                into.say("\t")
            case "line-break":
                into.add("br")
            case "soft-page-break":
                into.add("span", role="doc-pagebreak", aria_label=str(next(self._pages)))
            case "bookmark" | "bookmark-start" | "reference-mark" | "reference-mark-start":
                into.add("a", id=element.get("name"))
            case "note":
                key = element.get("id") or f"note-{len(self._bodies)}"
                self._bodies[key] = next(element.iter("note-body"), element)
                self.refer(into, key)
            case "frame":
                self._frame(element, into, look)
            case "ruby-text":
                into.add("rt", element.text)
            case "control":
                box = self._boxes.get(element.get("control"), Element("input"))
                checked = (box.get("current-state") or box.get("state")) == "checked"
                into.say("☑" if checked else "☐") if box.name == "checkbox" else into.add("input")
            case name if name in _DRAWN and not any(element.iter("p")):
                put_picture(into, [], "drawing")
            case name:
                self._inner(element, into.add("div") if name in _DRAWN else into, look)

    def _frame(self, frame: Element, into: Element, look: Look) -> None:
        """Read a picture by its text, a formula, a box by what is in it; mark all else."""
        named = {element.name: element for element in frame.elements}
        formula = next(frame.iter("math"), None)
        for element in frame.iter("object"):
            if formula is None and element.get("href"):
                member = posixpath.normpath(f"{element.get('href')}/content.xml")
                formula = next(self.archive.xml(member, needed=False).iter("math"), None)
        if "text-box" in named:
            self._inner(named["text-box"], into.add("div"), look)
        elif formula is not None:
            into.children.append(formula)
        else:
            told = [named[name].text for name in ("desc", "title") if name in named]
            put_picture(into, told, "embedded object" if "object" in named else "picture")

    def _list(self, element: Element, into: Element, look: Look) -> None:
        """Read a list, with the style of the one around it unless it has another."""
        first = next(element.iter("p", "h"), element)
        usual = next((s.listed for s in self.chain(first.get("style-name")) if s.listed), "")
        around, at = self._list_around
        style = element.get("style-name") or around or usual
        numbering = self._lists.setdefault(style, Numbering({}))
        if element.get("continue-numbering") != "true" and not element.get("continue-list"):
            numbering.restart(at)
        listed = into.add("ul")
        self._list_around = style, at + 1
        for item in element.elements:
            if item.get("start-value"):
                numbering.starts[at] = whole(item.get("start-value"))
            only_lists = all(child.name == "list" for child in item.elements)
            has_marker = item.name == "list-item" and not only_lists
            marker = numbering.marker(at) if has_marker else ""
            self._inner(item, listed.add("li", data_marker=marker), look)
        self._list_around = around, at

    def _table(self, element: Element, table: Element, look: Look) -> None:
        heads = {id(row) for rows in element.iter("table-header-rows") for row in rows.elements}
        for row in within(element, ("table-row",), _SKIPPED):
            is_head = id(row) in heads or self._is_heading_row(row)
            for _ in range(_repeated(row, "rows") if row.text.strip() else 1):
                line = (table.add("thead") if is_head else table).add("tr")
                for cell in row.elements:
                    # One of another name is covered by another.
                    times = _repeated(cell, "columns") if cell.name == "table-cell" else 0
                    for _ in range(times):
                        into = line.add(
                            "th" if is_head else "td",
                            colspan=cell.get("number-columns-spanned"),
                            rowspan=cell.get("number-rows-spanned"),
                        )
                        self._inner(cell, into, look)

    def _is_heading_row(self, row: Element) -> bool:
        """Tell whether the paragraphs of a row have the style of a table's head."""
        styles = [self.chain(each.get("style-name")) for each in row.iter("p")]
        return bool(styles) and all(
            any(style.name.startswith("table heading") for style in chained) for chained in styles
        )


def _repeated(element: Element, what: str) -> int:
    return min(max(whole(element.get(f"number-{what}-repeated")), 1), _MOST_REPEATED)


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
    look: Look = {}
    for properties in style.elements:
        if properties.name != "text-properties":
            continue
        for name, (tag, usual) in _LOOKS.items():
            value = properties.get(name)
            if value:
                is_usual = value == usual or (value.isdigit() and int(value) < 600)
                look[tag] = "" if is_usual else tag
        place = properties.get("text-position").split(" ")[0]
        if place.startswith(("sub", "-")):
            look["sub"] = "sub"
        elif place == "super" or place.rstrip("%").strip("0").isdigit():
            look["sup"] = "sup"
        font = properties.get("font-name").lower().split(" ")[0]
        if font in FONTS:
            look["font"] = font
        if properties.get("display"):
            look[HIDDEN] = HIDDEN if properties.get("display") == "none" else ""
        look |= tag_of(properties.get("language"), properties.get("country"))
    return look
