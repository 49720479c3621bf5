"""A tree of HTML, or of DTBook's markup, as blocks: one walk for all formats that are trees."""

from __future__ import annotations

import posixpath
import re
from itertools import count
from typing import TYPE_CHECKING, NamedTuple
from urllib.parse import unquote

from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind
from vbraille.translate.encodings import tidy
from vbraille.translate.formulas import formula_text
from vbraille.translate.grids import joined, table_blocks
from vbraille.translate.numbering import list_markers
from vbraille.translate.spellings import lowered, raised

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.trees import Element

_SKIPPED = frozenset(
    [
        "script",
        "style",
        "template",
        "noscript",
        "head",
        "rp",
        "datalist",
        "colgroup",
        "col",
        "source",
        "track",
        "frames",
        "smilref",
        "linkgroup",
        "metadata",
        "title",
    ]
)
_BLOCKS = frozenset(
    [
        "address",
        "article",
        "aside",
        "blockquote",
        "body",
        "caption",
        "center",
        "dd",
        "details",
        "dialog",
        "div",
        "dl",
        "dt",
        "fieldset",
        "figcaption",
        "figure",
        "footer",
        "form",
        "h1",
        "h2",
        "h3",
        "h4",
        "h5",
        "h6",
        "header",
        "hgroup",
        "hr",
        "html",
        "legend",
        "li",
        "main",
        "menu",
        "nav",
        "ol",
        "optgroup",
        "p",
        "pre",
        "section",
        "summary",
        "table",
        "tbody",
        "tfoot",
        "thead",
        "td",
        "th",
        "tr",
        "ul",
        "annotation",
        "author",
        "bodymatter",
        "book",
        "bridgehead",
        "byline",
        "covertitle",
        "dateline",
        "docauthor",
        "doctitle",
        "epigraph",
        "frontmatter",
        "hd",
        "imggroup",
        "level",
        "level1",
        "level2",
        "level3",
        "level4",
        "level5",
        "level6",
        "line",
        "linegroup",
        "list",
        "note",
        "poem",
        "prodnote",
        "rearmatter",
        "sidebar",
    ]
)
_EMPHASES = {
    **dict.fromkeys(("em", "i", "cite", "dfn", "var"), MarkKind.ITALIC),
    **dict.fromkeys(("strong", "b"), MarkKind.BOLD),
    **dict.fromkeys(("u", "ins"), MarkKind.UNDERLINE),
    **dict.fromkeys(("code", "kbd", "samp", "tt"), MarkKind.CODE),
    **dict.fromkeys(("sup", "super", "superscript"), MarkKind.SUPERSCRIPT),
    **dict.fromkeys(("sub", "subscript"), MarkKind.SUBSCRIPT),
}
_STYLES = {
    "font-style:italic": MarkKind.ITALIC,
    "font-weight:bold": MarkKind.BOLD,
    "text-decoration:underline": MarkKind.UNDERLINE,
    "vertical-align:super": MarkKind.SUPERSCRIPT,
    "vertical-align:sub": MarkKind.SUBSCRIPT,
}
_SMALL = {MarkKind.SUPERSCRIPT: raised, MarkKind.SUBSCRIPT: lowered}
_UNSHOWN = {
    "canvas": "drawing",
    "audio": "sound",
    "video": "film",
    "object": "embedded object",
    "embed": "embedded object",
    "iframe": "embedded page",
    "select": "form field",
    "textarea": "form field",
}
_NOTES = frozenset(
    [
        "footnote",
        "endnote",
        "rearnote",
        "doc-footnote",
        "doc-endnote",
        "sdfootnote",
        "sdendnote",
        "MsoFootnoteText",
        "MsoEndnoteText",
    ]
)
_NOTE_LISTS = frozenset(["footnotes", "endnotes", "rearnotes", "doc-endnotes"])
_REFERENCES = frozenset(["noteref", "doc-noteref", "footnote-ref", "sdfootnoteanc", "sdendnoteanc"])
_BACK = frozenset(["backlink", "doc-backlink", "footnote-back", "footnote-backref"])
_WORD_NOTE = re.compile(r"#_(?:ftn|edn)\d+$")
_PAGE_BREAKS = frozenset(("pagebreak", "doc-pagebreak"))
# Quotation marks of quotations and of those in them, by language; English ones elsewhere.
_QUOTES = {"de": "„“‚‘", "fr": "«»“”", "es": "«»“”", "it": "«»“”", "ru": "«»„“", "pl": "„”«»"}
_BLANKS = re.compile(r"[\t\r\n\f][ \t\r\n\f]*| [ \t\r\n\f]+")  # but single spaces
_PLAIN = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")
_NEW_LINE, _NEW_PAGE = "\n", "\f"
_BULLET = "• "
_LONGEST_NUMBER = 6  # of a note, with its brackets


class _Role(NamedTuple):
    """Role of the next text, by the elements around it."""

    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    group: int = 0
    items: int = 0  # lists around it
    quotes: int = 0
    sections: int = 0
    spoken: int = 0  # quotations in the line around it
    language: str = ""
    notes: bool = False  # items of lists are notes here
    lines: bool = False  # white space is kept


class Walker:
    """Reads the blocks of a tree.

    Parameters
    ----------
    language
        Tag of the book's language.
    prefix
        What stands before the names of anchors, such as "chapter.xhtml#".
    figures
        Function that makes the address of a figure from that in the markup.
    spell
        Function that makes the words that are added here fit the book, as cells of one in braille.
    groups
        Numbers of lists and tables, from 1.

    Attributes
    ----------
    blocks : list of Block
        Blocks so far.
    """

    def __init__(
        self,
        language: str = "",
        prefix: str = "",
        figures: Callable[[str], str] = str,
        spell: Callable[[str], str] = str,
        groups: Iterator[int] | None = None,
    ) -> None:
        self.blocks: list[Block] = []
        self._language, self._prefix = language, prefix
        self._figures, self._spell = figures, spell
        self._groups = groups or count(1)
        self._role = _Role()
        self._anchors: list[str] = []
        self._lead = ""  # what stands before the next text, as the number of an item
        self._marker: Callable[[Element], str] | None = None
        self._referring = False  # a link is a reference to a note, by the element around it
        self._broken = False  # a line of stars stands before the next text
        self._begin()

    def read(self, element: Element) -> list[Block]:
        """Read an element, and give all blocks."""
        self._inside(element)
        self._end()
        return self.blocks

    # The text of a block: a line feed begins a line in it, a form feed a page of print.

    def _begin(self) -> None:
        self._parts: list[str] = []
        self._length = 0
        self._blank = False
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
        text = tidy(text).replace(_NEW_PAGE, " ")
        if self._blank and self._length and self._parts[-1][-1:] not in (_NEW_LINE, " "):
            text = f" {text}"
        self._blank = False
        if text:
            self._parts.append(text)
            self._length += len(text)

    def _add_marked(self, text: str, kind: MarkKind, target: str = "") -> None:
        self._add(text)
        self._marks.append(Mark(kind, self._length - len(text), self._length, target))

    def _unshown(self, what: str, label: str = "") -> None:
        """Mark something that cannot be shown."""
        said = self._spell(f"[{what}: {label}]" if label else f"[{what}]")
        self._blank = True
        self._add_marked(said, MarkKind.UNSHOWN, what.split()[-1])
        self._blank = True

    @property
    def _next(self) -> int:
        """Index at which the next text will stand."""
        return self._length + (self._blank and self._length > 0)

    def _end(self) -> None:
        """Write the block, the lines in it and the pages that begin in it."""
        text, pages, marks, role = "".join(self._parts), iter(self._pages), self._marks, self._role
        self._begin()
        if not text.strip(f"{_NEW_LINE} ") and not (role.lines and text):
            return
        if not text.startswith(_NEW_PAGE):
            text = re.sub(r"\f(\S+)", "\\1\f", text)  # a page begins after a word that it cuts
        start, written, inner = 0, False, role
        for piece in re.split("([\n\f])", text):
            if piece == _NEW_PAGE:
                self._put(next(pages))
            elif piece != _NEW_LINE and (piece.strip(" ") or (role.lines and start)):
                block = _clipped(piece, start, marks, inner)
                self._put(block.replace(continues=written and piece is not text and inner is role))
                written = True
            if (
                piece == _NEW_LINE
                and role.kind in (BlockKind.PARAGRAPH, BlockKind.ITEM)
                and written
            ):
                inner = role._replace(kind=BlockKind.LINE, level=0)
            start += len(piece)

    def _put(self, block: Block) -> None:
        last = self.blocks[-1] if self.blocks else None
        if last is not None and last.text == block.text and _is_picture(last):
            return  # a caption that repeats the words of its picture
        if block.text and block.kind is not BlockKind.PAGE:
            if self._broken and block.kind not in (BlockKind.HEADING, BlockKind.NOTE):
                self.blocks.append(Block(self._spell("* * *")))
            self._broken = False
            if self._lead:
                led = joined([Block(self._spell(self._lead)), block], "")
                block = block.replace(text=led.text, marks=led.marks)
                self._lead = ""
                if block.kind is BlockKind.ITEM:
                    self._role = self._role._replace(kind=BlockKind.PARAGRAPH, level=0)
        if self._anchors:
            names = dict.fromkeys((*self._anchors, *block.anchors))
            block, self._anchors = block.replace(anchors=tuple(names)), []
        self.blocks.append(block)

    # Elements

    def _inside(self, element: Element) -> None:
        for child in element.children:
            if isinstance(child, str):
                self._say(child)
            else:
                self._walk(child)

    def _walk(self, element: Element) -> None:
        name = element.name
        words = {*element.get("class").split(), *element.get("type").split()}
        words.update(element.get("role").split())
        kept = words & (_NOTES | _NOTE_LISTS)
        if name in _SKIPPED or words & _BACK or (_is_hidden(element) and not kept):
            return
        if name == "pagenum" or words & _PAGE_BREAKS:
            self._page(element)
            return
        before, is_block = self._role, name in _BLOCKS
        if is_block:
            self._end()
        identity = element.get("id") or (element.get("name") if name == "a" else "")
        if identity:
            self._anchors.append(self._prefix + identity)
        tag = element.get("lang").strip().replace("_", "-")
        if tag and is_block:
            self._role = self._role._replace(language="" if _same(tag, self._language) else tag)
        if words & _NOTES:
            self._end()
            self._role = self._role._replace(kind=BlockKind.NOTE, level=0)
        elif words & _NOTE_LISTS:
            self._role = self._role._replace(notes=True)
        start = self._next
        handler = getattr(self, f"_do_{name}", None) or (
            self._do_heading if re.fullmatch("h[1-6]", name) else self._do_other
        )
        handler(element, words)
        if self._length > start:
            if tag and not is_block and not _same(tag, self._role.language or self._language):
                self._marks.append(Mark(MarkKind.LANGUAGE, start, self._length, tag))
            for kind in _emphases(element, words):
                self._emphasise(kind, start)
        if is_block:
            self._end()
        passed = before.kind is BlockKind.ITEM and self._role.kind is BlockKind.PARAGRAPH
        self._role = before._replace(kind=BlockKind.PARAGRAPH, level=0) if passed else before

    def _do_other(self, element: Element, words: set[str]) -> None:
        name = element.name
        if name.startswith("level"):
            depth = int(name[5:]) if name[5:].isdigit() else self._role.sections + 1
            self._role = self._role._replace(sections=depth)
        elif name in _UNSHOWN:
            self._unshown(_UNSHOWN[name], _label(element))
            if name in ("iframe", "select", "textarea"):
                return
        elif "heading" in words:
            self._do_heading(element, words)
            return
        elif "img" in words and _label(element):
            self._add_marked(_label(element), MarkKind.IMAGE)
            return
        self._inside(element)

    def _emphasise(self, kind: MarkKind, start: int) -> None:
        small = _SMALL.get(kind)
        if small is not None:
            if any(mark.kind is MarkKind.NOTE and mark.start >= start for mark in self._marks):
                return
            text = "".join(self._parts)
            self._parts = [text[:start] + small(text[start:])]
            self._length = len(self._parts[0])
        self._marks.append(Mark(kind, start, self._length))

    def _do_heading(self, element: Element, _words: set[str]) -> None:
        self._end()
        level = element.get("level") or element.get("aria-level") or element.name[1:]
        level = int(level) if level.isdigit() and int(level) > 0 else 2
        self._role = self._role._replace(kind=BlockKind.HEADING, level=min(level, 9))
        self._inside(element)
        self._end()

    def _do_hd(self, element: Element, _words: set[str]) -> None:
        level = 1 if element.name == "doctitle" else max(self._role.sections, 1)
        self._role = self._role._replace(kind=BlockKind.HEADING, level=level)
        self._inside(element)

    _do_doctitle = _do_bridgehead = _do_hd

    def _do_note(self, element: Element, _words: set[str]) -> None:
        self._role = self._role._replace(kind=BlockKind.NOTE, level=0)
        self._inside(element)

    _do_annotation = _do_note

    def _do_br(self, _element: Element, _words: set[str]) -> None:
        self._blank = False
        self._add(" " if self._role.kind in (BlockKind.HEADING, BlockKind.ROW) else _NEW_LINE)

    def _do_hr(self, _element: Element, _words: set[str]) -> None:
        self._broken = bool(self.blocks)

    def _do_del(self, element: Element, _words: set[str]) -> None:
        if element.text.strip():
            self._blank = True
            self._add(self._spell("[deleted:"))
            self._blank = True
            self._inside(element)
            self._blank = False
            self._add(self._spell("]"))
            self._blank = True

    def _do_q(self, element: Element, _words: set[str]) -> None:
        language = (self._role.language or self._language).partition("-")[0].lower()
        marks = _QUOTES.get(language, "“”‘’")
        depth = 2 * (self._role.spoken % 2)
        self._role = self._role._replace(spoken=self._role.spoken + 1)
        self._say(marks[depth])
        self._inside(element)
        self._blank = False
        self._say(marks[depth + 1])
        self._role = self._role._replace(spoken=self._role.spoken - 1)

    def _do_rt(self, element: Element, _words: set[str]) -> None:
        self._say("(")
        self._inside(element)
        self._say(")")

    def _do_lic(self, element: Element, _words: set[str]) -> None:
        if self._length:
            self._blank = False
            self._add("  ")
        self._inside(element)

    def _do_pre(self, element: Element, _words: set[str]) -> None:
        self._role = self._role._replace(kind=BlockKind.LINE, level=0, lines=True)
        first = element.children[:1]
        if first and isinstance(first[0], str):
            element.children[0] = first[0].removeprefix("\r").removeprefix("\n")
        self._inside(element)
        if self._parts and self._parts[-1].endswith("\n"):
            self._parts[-1] = self._parts[-1][:-1]

    def _do_line(self, element: Element, _words: set[str]) -> None:
        self._role = self._role._replace(kind=BlockKind.LINE, level=0)
        self._inside(element)

    def _do_blockquote(self, element: Element, _words: set[str]) -> None:
        quotes = self._role.quotes + 1
        if self._role.kind is not BlockKind.NOTE:
            self._role = self._role._replace(kind=BlockKind.QUOTE, level=quotes, quotes=quotes)
        self._inside(element)

    def _do_ul(self, element: Element, _words: set[str]) -> None:
        group = self._role.group if self._role.items else next(self._groups)
        outer, self._marker = self._marker, list_markers(element)
        self._role = self._role._replace(items=self._role.items + 1, group=group)
        self._inside(element)
        self._marker = outer

    _do_ol = _do_list = _do_menu = _do_ul

    def _do_li(self, element: Element, _words: set[str]) -> None:
        lead = element.get("data-marker") if "data-marker" in element.attributes else None
        if lead is None:
            lead = self._marker(element) if self._marker else _BULLET
        self._lead = self._lead + lead if self._lead not in ("", _BULLET) else lead
        if self._role.notes or self._role.kind is BlockKind.NOTE:
            self._role = self._role._replace(kind=BlockKind.NOTE, level=0, notes=False)
        else:
            level = element.get("data-level") or str(max(self._role.items, 1))
            self._role = self._role._replace(kind=BlockKind.ITEM, level=int(level))
        self._inside(element)
        self._end()
        self._lead = ""

    def _do_dl(self, element: Element, _words: set[str]) -> None:
        group = self._role.group or next(self._groups)
        self._role = self._role._replace(items=self._role.items + 1, group=group)
        self._inside(element)

    def _do_dt(self, element: Element, _words: set[str]) -> None:
        level = max(self._role.items, 1) + (element.name == "dd")
        self._role = self._role._replace(kind=BlockKind.ITEM, level=level)
        self._inside(element)

    _do_dd = _do_dt

    def _do_a(self, element: Element, words: set[str]) -> None:
        address = element.get("href") or "#" + element.get("idref").lstrip("#")
        refers = words & _REFERENCES or element.name != "a" or _WORD_NOTE.match(address)
        refers = bool(refers) or self._referring
        start = self._next
        self._inside(element)
        self._marks = [
            mark
            for mark in self._marks
            if mark.kind is not MarkKind.UNDERLINE or mark.start < start
        ]
        text = "".join(self._parts)
        if address == "#" or self._length <= start:
            return
        in_note = self._role.kind is BlockKind.NOTE or self._role.notes
        if refers:
            self._refer(text[:start], text[start:])
        elif in_note and not re.search(r"\w", text[start:]):  # an arrow back to the text
            self._parts, self._length = [text[:start].rstrip(" ")], len(text[:start].rstrip(" "))
            return
        elif in_note and not start and len(text) < _LONGEST_NUMBER:  # the number of the note
            self._blank = True
            return
        if address.startswith("#"):
            address = f"#{self._prefix}{unquote(address[1:])}"
        elif ":" not in address and self._prefix:
            address = f"#{_member(self._prefix, address)}"
        kind = MarkKind.NOTE if refers else MarkKind.LINK
        self._marks.append(Mark(kind, start, self._length, address))

    _do_noteref = _do_annoref = _do_a

    def _do_sup(self, element: Element, words: set[str]) -> None:
        outer, self._referring = self._referring, bool(words & _REFERENCES)
        self._inside(element)
        self._referring = outer

    def _refer(self, before: str, number: str) -> None:
        """Put the number of a note in brackets, and take away how it was raised."""
        number = number.translate(_PLAIN)
        if number[:1].isalnum() and not before.endswith(("[", "(")):
            number = f"{self._spell('[')}{number}{self._spell(']')}"
        self._parts, self._length = [before + number], len(before + number)
        self._marks = [mark for mark in self._marks if mark.start < len(before)]

    def _do_img(self, element: Element, words: set[str]) -> None:
        path = re.split("[?#]", element.get("src"))[0].strip()
        said = element.get("aria-label") or element.get("alt") or element.get("title")
        has_words = bool(said.strip())
        decoration = "alt" in element.attributes and not has_words
        if path.lower().endswith((".scene", ".svg")) and ":" not in path and not decoration:
            self._end()
            stem = posixpath.splitext(posixpath.basename(path))[0]
            self._role = self._role._replace(kind=BlockKind.LINE, level=0)
            title = " ".join((said if has_words else unquote(stem)).split())
            self._add_marked(self._spell(f"figure: {title}"), MarkKind.IMAGE, self._figures(path))
            self._end()
        elif has_words:
            self._picture(said)
        elif not decoration and not words & {"presentation", "none"}:
            self._unshown("picture")

    def _picture(self, said: str) -> None:
        """Words for a picture, apart from the text beside; a letter may be the first of a word."""
        words = " ".join(said.split())
        apart = len(words) > 1
        self._blank = self._blank or apart
        self._add_marked(words, MarkKind.IMAGE)
        self._blank = apart

    def _do_svg(self, element: Element, _words: set[str]) -> None:
        title = _label(element) or next((each.text for each in element.iter("title")), "")
        texts = [" ".join(each.text.split()) for each in element.iter("text")]
        if title.strip():
            self._picture(title)
        elif any(texts):
            for text in filter(None, texts):
                self._blank = True
                self._add(text)
                self._blank = True
        else:
            for picture in element.iter("image"):
                self._unshown("picture", _label(picture))
                return
            self._unshown("drawing")

    def _do_math(self, element: Element, _words: set[str]) -> None:
        text = formula_text(element)
        if not text:
            self._unshown("formula")
            return
        if text[0].isalnum() or text.startswith("\\"):
            joins = self._length and self._parts[-1][-1:].isalnum()
            self._blank = self._blank or bool(joins)
        self._add(text)

    def _do_input(self, element: Element, words: set[str]) -> None:
        kind = element.get("type").lower()
        if kind == "image":
            self._do_img(element, words)
        elif kind == "checkbox" and "disabled" in element.attributes:
            self._add("☒" if "checked" in element.attributes else "☐")
            self._blank = True
        elif kind != "hidden":
            self._unshown("form field", _label(element) or element.get("value"))

    def _do_table(self, element: Element, words: set[str]) -> None:
        group = next(self._groups)
        for caption in element.elements:
            if caption.name == "caption":
                self._walk(caption)
        lays_out = bool(words & {"presentation", "none"})
        for block in table_blocks(element, self._cell, lays_out=lays_out):
            if block.kind is BlockKind.ROW:
                block = block.replace(group=group, language=self._role.language)
            self._put(block)

    def _cell(self, element: Element) -> list[Block]:
        inner = Walker(self._language, self._prefix, self._figures, self._spell, self._groups)
        return inner.read(element)

    def _page(self, element: Element) -> None:
        """A page of print begins."""
        told = element.get("title") or element.get("aria-label") or element.text
        told = re.sub(r"^page\s+", "", " ".join(told.split()), flags=re.I).strip(" .")
        anchors = (self._prefix + element.get("id"),) if element.get("id") else ()
        page = Block(told, BlockKind.PAGE, anchors=anchors)
        if self._length:
            self._pages.append(page)
            self._parts.append(_NEW_PAGE)
            self._length += 1
        else:
            self._put(page)


def _emphases(element: Element, words: set[str]) -> list[MarkKind]:
    """Kinds of emphasis that an element gives its text."""
    style = element.get("style").lower().replace(" ", "")
    kinds = [kind for css, kind in _STYLES.items() if css in style]
    if element.name in _EMPHASES:
        kinds.insert(0, _EMPHASES[element.name])
    elif element.name == "span":
        kinds += [
            _EMPHASES[word] for word in words if word[:3] in ("sup", "sub") and word in _EMPHASES
        ]
    return kinds


def _clipped(text: str, start: int, marks: list[Mark], role: _Role) -> Block:
    """Block of a part of a text, with what is marked in that part."""
    body = text.rstrip("\n") if role.lines else text.strip(" ")
    start += text.index(body) if body else 0
    own = [
        Mark(mark.kind, max(mark.start - start, 0), min(mark.end - start, len(body)), mark.target)
        for mark in marks
        if mark.start < start + len(body) and mark.end > start
    ]
    language = role.language
    for mark in own:
        if mark.kind is MarkKind.LANGUAGE and (mark.start, mark.end) == (0, len(body)):
            language = mark.target
    own = [mark for mark in own if mark.kind is not MarkKind.LANGUAGE or mark.target != language]
    own.sort(key=lambda mark: (mark.start, -mark.end))
    return Block(body, role.kind, role.level, None, tuple(own), language, group=role.group)


def _is_picture(block: Block) -> bool:
    """Tell whether a block is the words of a picture and nothing else."""
    marks = [(mark.kind, mark.start, mark.end) for mark in block.marks]
    return (MarkKind.IMAGE, 0, len(block.text)) in marks and block.text != ""


def _label(element: Element) -> str:
    return " ".join((element.get("aria-label") or element.get("title")).split())


def _member(prefix: str, address: str) -> str:
    """Name of an anchor in another file of the same book."""
    path, hash_, anchor = address.partition("#")
    folder = posixpath.dirname(prefix)
    path = posixpath.normpath(posixpath.join(folder, unquote(path)))
    return f"{path}{hash_}{unquote(anchor)}"


def _same(one: str, other: str) -> bool:
    """Tell whether two tags are of one language, or the first of none."""
    one, other = one.lower(), other.lower()
    related = one.startswith(f"{other}-") or other.startswith(f"{one}-")
    return one == other or related or one in ("und", "zxx")


def _is_hidden(element: Element) -> bool:
    style = element.get("style").lower().replace(" ", "")
    said = "hidden" in element.attributes or element.get("aria-hidden") == "true"
    return said or "display:none" in style or "visibility:hidden" in style
