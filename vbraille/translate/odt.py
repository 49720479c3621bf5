"""An ODT file as a tree of HTML: styles, lists, tables, notes, links, languages."""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING

from vbraille.translate.numbering import Level, Numbering, counted, whole
from vbraille.translate.office import (
    Document,
    Look,
    font_of,
    heading,
    role_of,
    tag_of,
)
from vbraille.translate.trees import Element, names

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_NAMES = names("odt")
_MOST_COPIES = 20_000  # of rows and cells of tables
_NUMBERED = ("list-level-style-number", "outline-level-style")


def read_odt(source: Source) -> Iterator[Block]:
    """Read an ODT file.

    Raises
    ------
    InputError
        If a part that is needed is missing, locked, damaged or too large.
    """
    return _Odt(source).blocks_of(source)


class _Odt(Document):
    """Reads one document."""

    names = _NAMES

    def blocks_of(self, source: Source) -> Iterator[Block]:
        root = self.archive.xml("content.xml")
        for part in (self.archive.xml("styles.xml", needed=False), root):
            self._read_styles(part)
        self._copies = 0
        for body in root.iter("body"):
            self.inner(body, self.body, self.usual)
        return self.blocks(source, self.archive.xml("meta.xml", needed=False))

    def _read_styles(self, part: Element) -> None:
        for style in part.iter("default-style"):
            if style.get("family") == "paragraph":
                self.usual |= _look_of(style)
        for style in part.iter("list-style", "outline-style"):
            levels = {whole(each.get("level")) - 1: _level_of(each) for each in style.elements}
            self.lists[style.get("name")] = Numbering(levels)
        for style in part.iter("style"):
            self.styles[style.get("name")] = _look_of(style)

    def _styled(self, element: Element) -> Look:
        return self.look_of({"based": element.get("style-name")})

    def read_own(self, element: Element, into: Element, look: Look) -> None:
        """Read a block, or what stands in a paragraph."""
        match element.name:
            case "p" | "h" as name:
                own = self._styled(element)
                if name == "h":
                    own |= heading(counted(element.get("outline-level")))
                look = look | own
                if look.get("hidden"):
                    return
                block = into.add(own.get("role") or "p")
                self.inner(element, block, look)
            case "list":
                self._list(element, into, look)
            case "table-row":
                # So do writers mark a table's head that does not go on at its next page.
                roles = {self._styled(each).get("role") for each in element.iter("p")}
                into = into.add("thead") if roles == {"th"} else into
                for _ in range(
                    self._times(element.get("number-rows-repeated")) if element.text.strip() else 1
                ):
                    self.inner(element, into.add("tr"), look)
            case "table-cell":
                columns = element.get("number-columns-spanned")
                rows = element.get("number-rows-spanned")
                for _ in range(self._times(element.get("number-columns-repeated"))):
                    self.inner(element, into.add("td", colspan=columns, rowspan=rows), look)
            case "a" | "span":
                address = element.get("href")
                into = into.add("a", href=address) if address else into
                self.inner(element, into, look | self._styled(element))
            case "s":
                self.say(into, " " * counted(element.get("c")), look)
            case "note":
                key = element.get("id") or f"note-{len(self.bodies)}"
                self.bodies[key] = next(element.iter("note-body"), element)
                self.refer(into, key)
            case "frame":
                self._frame(element, into, look)
            case name if name in self.names["drawn"] and not any(element.iter("p")):
                into.add("canvas")
            case name:
                self.inner(element, into.add("div") if name in self.names["drawn"] else into, look)

    def _times(self, said: str) -> int:
        """Number of times that a row or a cell stands, within what a book can have."""
        times = counted(said)
        self._copies += times - 1
        return times if self._copies < _MOST_COPIES else 1

    def _frame(self, frame: Element, into: Element, look: Look) -> None:
        """Read a picture by its text, a formula, a box by what is in it; mark all else."""
        named = {element.name: element for element in frame.elements}
        formula = next(frame.iter("math"), None)
        for element in frame.iter("object"):
            if formula is None and element.get("href"):
                member = posixpath.normpath(f"{element.get('href')}/content.xml")
                formula = next(self.archive.xml(member, needed=False).iter("math"), None)
        if "text-box" in named:
            self.inner(named["text-box"], into.add("div"), look)
        elif formula is not None:
            into.children.append(formula)
        else:
            told = frame.said("desc") or frame.said("title")
            into.add("object" if "object" in named and not told else "img", title=told)

    def _list(self, element: Element, into: Element, look: Look) -> None:
        """Read a list, with the style of the one around it unless it has another."""
        first = next(element.iter("p", "h"), element)
        usual = look.get("list") or self._styled(first).get("listed", "")
        style, at = element.get("style-name") or usual, whole(look.get("at"), 0)
        numbering = self.lists.setdefault(style, Numbering())
        if element.get("continue-numbering") != "true" and not element.get("continue-list"):
            numbering.restart(at)
        listed = into.add("ul")
        look = look | {"list": style, "at": str(at + 1)}
        for item in element.elements:
            only_lists = all(child.name == "list" for child in item.elements)
            has_marker = item.name == "list-item" and not only_lists
            marker = numbering.marker(at, item.get("start-value")) if has_marker else ""
            self.inner(item, listed.add("li", data_marker=marker), look)


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
    look = role_of(style.get("name").replace("_20_", " "))
    look["based"] = style.get("parent-style-name")
    if style.get("list-style-name"):
        look["listed"] = style.get("list-style-name")
    for properties in style.iter("text-properties"):
        for name, (tag, usual) in _NAMES["emphases"].items():
            value = properties.get(name)
            if value:
                look[tag] = "" if value in usual.split() else tag
        place = properties.get("text-position")
        if place and not place.startswith("0"):
            tag = "sub" if place.startswith(("sub", "-")) else "sup"
            look[tag] = tag
        if properties.get("display"):
            look["hidden"] = "hidden" if properties.get("display") == "none" else ""
        look |= font_of(properties.get("font-name"))
        look |= tag_of(f"{properties.get('language')}-{properties.get('country')}")
    return look
