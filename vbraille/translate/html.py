"""HTML, XHTML and DTBook, and all that is made into such a tree, as blocks."""

from __future__ import annotations

import re
from itertools import count
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import unquote

from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind, cut_marks
from vbraille.translate.encodings import tidy
from vbraille.translate.formulas import formula_text
from vbraille.translate.grids import EMPHASES, joined, table_blocks
from vbraille.translate.numbering import BULLET, Numbering, html_list, whole
from vbraille.translate.spellings import LOWERED, RAISED, small
from vbraille.translate.trees import Element, inside, names, read_tree

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.source import Source

_NAMES = names("html")
_EMPHASES = {
    name: MarkKind(kind) for kind, told in _NAMES["emphases"].items() for name in told.split()
}
_SMALL = {MarkKind.SUPERSCRIPT: RAISED, MarkKind.SUBSCRIPT: LOWERED}
_EMPHATIC = (BlockKind.HEADING, BlockKind.QUOTE)
_WORD_NOTE = re.compile(r"#_(?:ftn|edn)\d+$")
_BLANKS = re.compile(r"[\t\r\n\f][ \t\r\n\f]*| [ \t\r\n\f]+")  # but single spaces
_PLAIN = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_LONGEST_NUMBER = 6  # of a note, with its brackets


def read_html(source: Source, encoding: str | None = None) -> Iterator[Block]:
    """Read a page of HTML, or DTBook, the markup of DAISY 3."""
    root = read_tree(source.stream.read(), source.name, source.note, encoding)
    return tree_blocks(source, root)


def tree_blocks(source: Source, root: Element) -> Iterator[Block]:
    """Blocks of a tree, which says the title and the language unless they are known."""
    tags = [element.get("lang").strip() for element in root.iter("html", "body", "dtbook", "book")]
    metas = (e.get("content") for e in root.iter("meta") if e.get("name").lower() == "dc:title")
    source.title = source.title or root.said("title", "doctitle") or next(metas, "").strip()
    source.language = source.language or next(filter(None, tags), "").replace("_", "-")
    return iter(Walker(source.language).read(root))


class _Role(NamedTuple):
    """Role of the next text, by the elements around it."""

    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    group: int = 0
    items: int = 0  # lists around it
    quotes: int = 0
    sections: int = 0
    quoting: bool = False  # a quotation in the line is around it
    language: str = ""
    notes: bool = False  # items of lists are notes here
    refers: bool = False  # a link is a reference to a note
    lines: bool = False  # white space is kept
    numbering: Numbering = Numbering()


class Walker:
    """Reads the blocks of a tree.

    Parameters
    ----------
    language
        Tag of the book's language.
    member
        Name of the file in the book, which stands before the names of its anchors.
    spell
        Function that makes the words that are added here fit the book, as cells of one in braille.
    groups
        Numbers of lists and tables, from 1.
    """

    def __init__(
        self,
        language: str = "",
        member: str = "",
        spell: Callable[[str], str] = str,
        groups: Iterator[int] | None = None,
    ) -> None:
        self._blocks: list[Block] = []
        self._language, self._member, self._spell = language, member, spell
        self._prefix = f"{member}#" if member else ""  # of anchors
        self._groups = groups or count(1)
        self._role = _Role()
        self._anchors: list[str] = []
        self._lead = ""  # what stands before the next text, as the number of an item
        self._broken = False  # a line of stars stands before the next text
        self._begin()

    def read(self, element: Element) -> list[Block]:
        """Read an element, and give its blocks."""
        self._inside(element)
        self._end()
        return self._blocks

    # The text of a block: a line feed begins a line in it, a form feed a page of print.

    def _begin(self) -> None:
        self._text: list[str] = []  # characters
        self._blank = False  # is due before the next
        self._marks: list[Mark] = []
        self._pages: list[Block] = []

    def _say(self, text: str) -> None:
        """Add text of the tree, with its blanks folded."""
        if self._role.lines:
            self._add(text.replace("\r\n", "\n").expandtabs())
            return
        words = _BLANKS.sub(" ", text)
        self._blank = self._blank or words.startswith(" ")
        if words.strip(" "):
            self._add(words.strip(" "))
            self._blank = words.endswith(" ")

    def _add(self, text: str) -> None:
        """Add text as it is, after a blank if one is due."""
        text = tidy(text).replace("\f", " ")
        if self._next > len(self._text) and self._text[-1] not in "\n ":
            text = f" {text}"
        self._blank = False
        self._text += text

    def _add_apart(self, text: str, kind: MarkKind, target: str = "") -> None:
        """Add text with blanks around it, and a mark on it.

        A picture of one letter may be the first of a word.
        """
        apart = kind is not MarkKind.IMAGE or len(text) > 1
        self._blank = self._blank or apart
        self._add(text)
        self._marks.append(Mark(kind, len(self._text) - len(text), len(self._text), target))
        self._blank = apart

    def _unshown(self, what: str, label: str = "") -> None:
        """Mark something that cannot be shown."""
        said = self._spell(f"[{what}: {label}]" if label else f"[{what}]")
        self._add_apart(said, MarkKind.UNSHOWN, what.split()[-1])

    @property
    def _next(self) -> int:
        """Index at which the next text will stand."""
        return len(self._text) + (self._blank and bool(self._text))

    def _end(self) -> None:
        """Write the block, the lines in it and the pages that begin in it."""
        # A page begins after a word that it cuts.
        text = re.sub(r"\f(\S+)", "\\1\f", "".join(self._text).removesuffix("\n"))
        pages, marks, role = iter(self._pages), self._marks, self._role
        self._begin()
        start, written, inner = 0, False, role
        for piece in re.split("([\n\f])", text):
            if piece == "\f":
                self._put(next(pages))
            elif piece != "\n" and (piece.strip(" ") or (role.lines and written)):
                goes_on = written and inner is role and role.kind is not BlockKind.LINE
                self._put(_clipped(piece, start, marks, inner).replace(continues=goes_on))
                written = True
            elif written and role.kind in (BlockKind.PARAGRAPH, BlockKind.ITEM):
                inner = role._replace(kind=BlockKind.LINE, level=0)
            start += len(piece)

    def _put(self, block: Block) -> None:
        if block.text and block.kind is not BlockKind.PAGE:
            last = self._blocks[-1] if self._blocks else Block("")
            if last.text == block.text and Mark(MarkKind.IMAGE, 0, len(last.text)) in last.marks:
                return  # a caption that repeats the words of its picture
            if self._broken and block.kind not in (BlockKind.HEADING, BlockKind.NOTE):
                self._blocks.append(Block(self._spell("* * *")))
            self._broken = False
            if self._lead:
                block = joined([Block(self._spell(self._lead)), block], "", block)
                self._lead = ""
                if block.kind is BlockKind.ITEM:
                    self._become(BlockKind.PARAGRAPH)
        if self._anchors:
            anchors = tuple(dict.fromkeys((*self._anchors, *block.anchors)))
            block, self._anchors = block.replace(anchors=anchors), []
        self._blocks.append(block)

    # Elements

    def _become(self, kind: BlockKind | None = None, level: int = 0, **changes: Any) -> None:
        """Change the role of the text that follows in the element."""
        if kind is not None:
            changes |= {"kind": kind, "level": level}
        self._role = self._role._replace(**changes)

    def _inside(self, element: Element) -> None:
        for child in element.children:
            if isinstance(child, str):
                self._say(child)
            else:
                self._walk(child)

    def _walk(self, element: Element) -> None:
        traits = _traits(element)
        is_note, lists_notes = traits & _NAMES["notes"], traits & _NAMES["note_lists"]
        hidden = traits & _NAMES["hidden"] and not is_note and not lists_notes
        if hidden or traits & _NAMES["skipped"]:
            return
        if traits & _NAMES["pages"]:
            self._page(element)
            return
        before = self._role
        is_block = bool(is_note or traits & _NAMES["blocks"])
        if is_block:
            self._end()
        identity = element.get("id") or (element.get("name") if element.name == "a" else "")
        if identity:
            self._anchors.append(self._prefix + identity)
        tag = element.get("lang").strip().replace("_", "-")
        if tag and is_block:
            self._become(language="" if _same(tag, self._language) else tag)
        if is_note:
            self._become(BlockKind.NOTE)
        elif lists_notes:
            self._become(notes=True)
        if traits & _NAMES["references"]:
            self._become(refers=True)
        start, known = self._next, len(self._marks)
        self._read(element)
        if len(self._text) > start:
            if tag and not is_block and not _same(tag, self._role.language or self._language):
                self._marks.append(Mark(MarkKind.LANGUAGE, start, len(self._text), tag))
            large = is_block or any(mark.kind is MarkKind.NOTE for mark in self._marks[known:])
            for kind in [_EMPHASES[name] for name in _EMPHASES if name in traits]:
                if kind in _SMALL and large:
                    continue
                if kind in _SMALL:
                    self._text[start:] = small("".join(self._text[start:]), _SMALL[kind])
                self._marks.append(Mark(kind, start, len(self._text)))
        if is_block:
            self._end()
        self._role, role = before, self._role
        if before.kind is BlockKind.ITEM and role.kind is BlockKind.PARAGRAPH:
            self._become(BlockKind.PARAGRAPH)  # the item's first block is written

    def _read(self, element: Element) -> None:
        """Read an element by its name."""
        role, words, kind = self._role, element.words, element.get("type")
        match element.name:
            case "br":
                self._blank = False
                self._add(" " if role.kind is BlockKind.HEADING else "\n")
            case "hr":
                self._broken = bool(self._blocks)
            case "del" if element.text.strip():
                self._blank = True
                self._surround(element, self._spell("[deleted:") + " ", self._spell("]"))
                self._blank = True
                return
            case "q":
                language = (role.language or self._language).partition("-")[0].lower()
                marks = _NAMES["quotes"].get(language, "“”‘’")[2 * role.quoting :]
                self._become(quoting=not role.quoting)
                self._surround(element, marks[0], marks[1])
                return
            case "rt":
                self._surround(element, "(", ")")
                return
            case "lic" if self._text:
                self._blank = False
                self._add("  ")
            case "pre" | "line" as name:
                self._become(BlockKind.LINE, lines=name == "pre")
            case "blockquote" if role.kind is not BlockKind.NOTE:
                self._become(BlockKind.QUOTE, role.quotes + 1, quotes=role.quotes + 1)
            case "doctitle" | "hd" | "bridgehead":
                self._become(BlockKind.HEADING, max(role.sections, 1))
            case "ul" | "ol" | "list" | "menu" | "dl":
                group = role.group if role.items else next(self._groups)
                numbering = html_list(element)
                self._become(items=role.items + 1, group=group, numbering=numbering)
            case "li":
                self._item(element)
                return
            case "dt" | "dd":
                self._become(BlockKind.ITEM, max(role.items, 1) + (element.name == "dd"))
            case "a" | "noteref" | "annoref":
                self._link(element)
                return
            case "input" if kind == "checkbox" and "disabled" in element.attributes:
                self._say("☒ " if "checked" in element.attributes else "☐ ")
            case "input" if kind != "image":
                self._unshown("form field", _label(element) or element.get("value"))
            case "img" | "input":
                self._img(element)
            case "svg":
                self._svg(element)
                return
            case "math":
                self._math(element)
                return
            case "table":
                self._table(element)
                return
            case name if name in _NAMES["unshown"]:
                self._unshown(_NAMES["unshown"][name], _label(element))
                if name in ("select", "textarea", "iframe"):
                    return
            case name if "heading" in words or re.fullmatch("h[1-6]", name):
                level = whole(element.get("aria-level") or name[1:], 2)
                self._become(BlockKind.HEADING, min(max(level, 1), 9))
            case name if name.startswith("level"):
                self._become(sections=whole(name[5:], role.sections + 1))
            case _ if "img" in words and _label(element):
                self._add_apart(_label(element), MarkKind.IMAGE)
                return
        self._inside(element)

    def _surround(self, element: Element, before: str, after: str) -> None:
        """Read an element between two marks."""
        self._add(before)
        self._inside(element)
        self._blank = False
        self._add(after)

    def _item(self, element: Element) -> None:
        marker = self._role.numbering.marker(said=element.get("value"))
        lead = element.get("data-marker", marker)
        self._lead = self._lead + lead if self._lead not in ("", BULLET) else lead
        if self._role.notes or self._role.kind is BlockKind.NOTE:
            self._become(BlockKind.NOTE, notes=False)
        else:
            level = whole(element.get("data-level"), max(self._role.items, 1))
            self._become(BlockKind.ITEM, level)
        self._inside(element)
        self._end()
        self._lead = ""

    def _link(self, element: Element) -> None:
        address = element.get("href") or "#" + element.get("idref").lstrip("#")
        refers = self._role.refers or _WORD_NOTE.match(address) is not None
        start, known = self._next, len(self._marks)
        self._inside(element)
        inner = [mark for mark in self._marks[known:] if mark.kind is not MarkKind.UNDERLINE]
        self._marks[known:] = [] if refers else inner
        told = "".join(self._text[start:])
        if address == "#" or not told:
            return
        in_note = self._role.kind is BlockKind.NOTE or self._role.notes
        if refers:  # its number stands in brackets, and not raised
            told = told.translate(_PLAIN)
            in_brackets = self._text[start - 1 : start] in (["["], ["("])
            if told[0].isalnum() and not in_brackets:
                told = f"{self._spell('[')}{told}{self._spell(']')}"
            self._text[start:] = told
        elif in_note and not re.search(r"\w", told):  # an arrow back to the text
            del self._text[start:]
            return
        elif in_note and not start and len(told) < _LONGEST_NUMBER:  # the number of the note
            self._blank = True
            return
        kind = MarkKind.NOTE if refers else MarkKind.LINK
        if address.startswith("#") or (self._member and ":" not in address):
            address = "#" + inside(self._member, address).removeprefix("#")
        self._marks.append(Mark(kind, start, len(self._text), address))

    def _img(self, element: Element) -> None:
        path = re.split("[?#]", element.get("src"))[0].strip()
        said = _label(element)
        decoration = "alt" in element.attributes and not said
        if path.lower().endswith((".scene", ".svg")) and ":" not in path and not decoration:
            self._end()
            title = self._spell(f"figure: {said or unquote(PurePosixPath(path).stem)}")
            self._become(BlockKind.LINE)
            self._add_apart(title, MarkKind.IMAGE, inside(self._member, path))
            self._end()
        elif said:
            self._add_apart(said, MarkKind.IMAGE)
        elif not decoration and not element.words & {"presentation", "none"}:
            self._unshown("picture")

    def _svg(self, element: Element) -> None:
        title = _label(element) or element.said("title")
        text = " ".join(each.text for each in element.iter("text"))
        pictures = [*element.iter("image")]
        if title:
            self._add_apart(title, MarkKind.IMAGE)
        elif text.strip():
            self._say(f" {text} ")
        elif pictures:
            self._img(pictures[0])
        else:
            self._unshown("drawing")

    def _math(self, element: Element) -> None:
        text = formula_text(element)
        if not text:
            self._unshown("formula")
        elif text[0].isalnum() or text[0] == "\\":
            self._blank = self._blank or "".join(self._text[-1:]).isalnum()
        self._add(text)

    def _table(self, element: Element) -> None:
        group = next(self._groups)
        for caption in element.elements:
            if caption.name == "caption":
                self._walk(caption)
        for block in table_blocks(element, self._cell):
            if block.kind is BlockKind.ROW:
                block = block.replace(group=group, language=self._role.language)
            self._put(block)

    def _cell(self, element: Element) -> list[Block]:
        return Walker(self._language, self._member, self._spell, self._groups).read(element)

    def _page(self, element: Element) -> None:
        """A page of print begins."""
        told = _label(element) or " ".join(element.text.split())
        told = re.sub(r"(?i)^page | *\.$", "", told)
        anchors = (self._prefix + element.get("id"),) if element.get("id") else ()
        page = Block(told, BlockKind.PAGE, anchors=anchors)
        if self._text:
            self._pages.append(page)
            self._text.append("\f")
        else:
            self._put(page)


def _traits(element: Element) -> set[str]:
    """Name, words, attributes and look of an element, as `names.toml` has them."""
    words = (f".{word}" for word in element.words)
    attributes = map(":".join, element.attributes.items())
    style = element.get("style").lower().replace(" ", "")
    return {element.name, *words, *attributes, *re.split("[;!]", style)}


def _clipped(text: str, start: int, marks: list[Mark], role: _Role) -> Block:
    """Block of a part of a text, with what is marked in that part.

    Emphasis that all of a heading or of a quotation has is what it looks like, and left out.
    """
    body = text if role.lines else text.strip(" ")
    start += text.index(body)
    language, kept = role.language, []
    for mark in cut_marks(marks, start, start + len(body)):
        is_whole = (mark.start, mark.end) == (0, len(body))
        if mark.kind is MarkKind.LANGUAGE and is_whole:
            language = mark.target
        elif not (is_whole and mark.kind in EMPHASES and role.kind in _EMPHATIC):
            kept.append(mark)
    kept.sort(key=lambda mark: (mark.start, -mark.end))
    return Block(body, role.kind, role.level, None, tuple(kept), language, group=role.group)


def _label(element: Element) -> str:
    labels = map(element.get, ("aria-label", "alt", "title"))
    return " ".join(next(filter(None, labels), "").split())


def _same(one: str, other: str) -> bool:
    """Tell whether two tags are of one language, or the first of none."""
    one, other = f"{one.lower()}-", f"{other.lower()}-"
    return one.startswith(other) or other.startswith(one) or one in ("und-", "zxx-")
