"""A DOCX file as a tree of HTML: styles, lists, tables, notes, links, languages."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, BinaryIO

from vbraille.translate.numbering import BULLET, Level, Numbering, whole
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

_NAMES = names("docx")
_BODY = re.compile(r"word/document\d*\.xml")
_OFF = frozenset(("0", "false", "none", "off"))
_LINK = re.compile(
    r'\s*HYPERLINK\s+(?:"([^"]*)"|([^\s\\]\S*))?(?:.*\\l\s+"?([^"\s]*))?', re.I | re.S
)


def read_docx(source: Source, stream: BinaryIO | None = None) -> Iterator[Block]:
    """Read a DOCX file, or a stream of one that a source was made into.

    Raises
    ------
    InputError
        If a part that is needed is missing, damaged or too large.
    """
    return _Docx(source, stream).blocks_of(source)


class _Docx(Document):
    """Reads one document."""

    names = _NAMES

    def blocks_of(self, source: Source) -> Iterator[Block]:
        bodies = (member for member in self.archive.members if _BODY.fullmatch(member))
        root = self._part(next(bodies, "word/document.xml"))
        styles = self._part("word/styles.xml")
        self.styles = {each.get("styleid"): _look_of(each) for each in styles.iter("style")}
        self.usual = tag_of(_value(styles, "docdefaults/rprdefault/rpr/lang"))
        self.lists = _lists_of(self._part("word/numbering.xml"))
        for kind in ("footnote", "endnote"):
            for note in self._part(f"word/{kind}s.xml").iter(kind):
                self.bodies[f"{kind}-{note.get('id')}"] = note
        self._fields: list[str] = []  # instructions of the fields around the run
        self._link: Element | None = None  # that of a field of the paragraph
        self._begun: Element | None = None  # a paragraph that is one with the next
        self.inner(root, self.body, {})
        return self.blocks(source, self._part("docProps/core.xml"))

    def _part(self, member: str) -> Element:
        """Part of the document, with the addresses of its links; only its text must be there."""
        is_body = _BODY.fullmatch(member) is not None
        root = self.archive.xml(member, needed=is_body)
        addresses = member.replace("word/", "word/_rels/") + ".rels"
        found = self.archive.xml(addresses, needed=False).iter("relationship")
        links = {relation.get("id"): relation.get("target") for relation in found}
        for link in root.iter("hyperlink"):
            link.attributes["href"] = links.get(link.get("id"), "")
        return root

    def read_own(self, element: Element, into: Element, look: Look) -> None:
        """Read a block, what stands in a paragraph, or what stands in a run."""
        match element.name:
            case "p":
                self._paragraph(element, into)
            case "tbl":  # whose look may say that its first row is its head
                said = _find(element, "tblpr/tbllook")
                first = said.get("firstrow", str(_hexadecimal(said.get("val")) >> 5 & 1))
                self.inner(element, into.add("table"), {"head": "" if first in _OFF else first})
            case "tr":
                is_head = _value(element, "trpr/tblheader", "0") not in _OFF
                is_head |= bool(look.get("head")) and not into.children
                line = (into.add("thead") if is_head else into).add("tr")
                before = _value(element, "trpr/gridbefore")
                if whole(before, 0) > 0:
                    line.add("td", colspan=before)
                self.inner(element, line, {})
            case "tc":
                goes_on = _value(element, "tcpr/vmerge", "restart") != "restart"
                columns = _value(element, "tcpr/gridspan")
                cell = into.add("above" if goes_on else "td", colspan=columns)
                self.inner(element, cell, {})
                cell.children += [self._begun] if self._begun else []
                self._begun = None
            case "r":
                look = look | self.look_of(_look_of(element))
                for child in element.elements:
                    if not look.get("hidden") or child.name in ("fldchar", "instrtext"):
                        self.read(child, self._link or into, look)
            case "hyperlink":
                anchor = element.get("anchor")
                address = element.get("href") + (f"#{anchor}" if anchor else "")
                self.inner(element, into.add("a", href=address), look)
            case "fldsimple":
                self.inner(element, into.add("a", href=_target(element.get("instr"))), look)
            case "fldchar":
                self._field(element.get("fldchartype"), into)
                self.inner(element, into, look)  # a check box of a form
            case "instrtext" if self._fields:
                self._fields[-1] += element.text
            case "omath" | "omathpara":
                into.add("math").children.append(element)
            case "sym":
                sign = chr(_hexadecimal(element.get("char")) or 0xFFFD)
                self.say(into, sign, look | font_of(element.get("font")))
            case "footnotereference" | "endnotereference" as name:
                self.refer(into, f"{name.removesuffix('reference')}-{element.get('id')}")
            case name if name in _NAMES["drawn"]:
                self._drawing(element, into)
            case _:
                self.inner(element, into, look)

    def _paragraph(self, element: Element, into: Element) -> None:
        """Read a paragraph, which may be a heading or an item of a list."""
        look = self.usual | self.look_of(_look_of(element))
        block, self._begun = self._begun or Element("p"), None
        outer, self._link = self._link, None
        self.inner(element, block, look)
        self._link = outer
        # One whose own mark is deleted, and a drop cap, is one with the next.
        drop_cap = _find(element, "ppr/framepr").get("dropcap", "none") != "none"
        if drop_cap or _find(element, "ppr/rpr/del").name:
            self._begun = block
            return
        block.name = look.get("role") or "p"
        key, at = look.get("numid", "0"), whole(look.get("ilvl"), 0)
        numbering = self.lists.get(key)
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

    def _field(self, mark: str, into: Element) -> None:
        """Begin a field, its text, or its end."""
        if mark == "begin":
            self._fields.append("")
        address = _target(self._fields[-1]) if self._fields else ""
        if address:
            self._link = into.add("a", href=address) if mark == "separate" else None
        if mark == "end":
            self._fields = self._fields[:-1]

    def _drawing(self, element: Element, into: Element) -> None:
        """Read a picture by its text, a box by what is in it; mark all else."""
        for box in element.iter("txbxcontent"):
            self.inner(box, into.add("div"), {})
            return
        name = "img" if any(element.iter("pic", "imagedata")) else "canvas"
        name = "object" if element.name == "object" else name
        described = element.iter("docpr", "shape")
        told = " ".join(each.get("descr") or each.get("alt") for each in described).strip()
        into.add("img" if told else name, title=told)


def _lists_of(root: Element) -> dict[str, Numbering]:
    """Lists of a document; those of one abstract list count on."""
    abstract = {each.get("abstractnumid"): (_levels(each), {}) for each in root.iter("abstractnum")}
    lists: dict[str, Numbering] = {}
    for number in root.iter("num"):
        levels, counts = abstract.get(_value(number, "abstractnumid"), ({}, {}))
        numbering = lists[number.get("numid")] = Numbering(levels, counts)
        for override in number.elements:
            at, start = whole(override.get("ilvl"), 0), _value(override, "startoverride")
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
            form = _NAMES["forms"].get(_value(level, "numfmt"), "1")
            legal = _value(level, "islgl", "0") not in _OFF
            levels[at] = Level(form, _value(level, "lvltext"), whole(_value(level, "start")), legal)
    return levels


def _look_of(holder: Element) -> Look:
    """Look that a style, a paragraph or a run says that it has."""
    look: Look = {}
    properties = [_find(holder, path) for path in ("ppr", "ppr/numpr", "rpr")]
    for element in (each for part in (holder, *properties) for each in part.elements):
        value = element.get("val")
        match element.name:
            case "name":
                look |= role_of(value)
            case "basedon" | "pstyle" | "rstyle":
                look["based"] = value
            case "numid" | "ilvl" if value:
                look[element.name] = value
            case "outlinelvl" if value != "9" or look.get("role", "h").startswith("h"):
                look |= heading((whole(value, 9) + 1) % 10)
            case "vertalign":
                look |= {
                    tag: tag if name == value else "" for name, tag in _NAMES["raised"].items()
                }
            case "lang":
                look |= tag_of(value)
            case "rfonts":
                look |= font_of(element.get("ascii"))
            case name if name in _NAMES["emphases"]:
                is_off = value in _OFF or (name == "u" and not value)
                look[_NAMES["emphases"][name]] = "" if is_off else name
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
