"""EPUB 2 and 3 and eBraille: chapters in their order, each read when it is come to."""

from __future__ import annotations

import posixpath
import re
from itertools import count
from typing import TYPE_CHECKING
from urllib.parse import unquote

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError
from vbraille.translate.archive import Archive
from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind
from vbraille.translate.html import Walker
from vbraille.translate.tables import BrailleTable
from vbraille.translate.trees import Element, inside, read_tree
from vbraille.wording import count as counted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Source

_CONTAINER = "META-INF/container.xml"
_PACKAGES = ("package.opf", "content.opf", "OEBPS/content.opf", "OPS/content.opf")
_EBRAILLE = b"application/ebrl+zip"
_NCX = "application/x-dtbncx+xml"
_TEXTS = frozenset(
    ("application/xhtml+xml", "text/html", "text/x-oeb1-document", "application/x-dtbook+xml",
     "image/svg+xml")
)  # fmt: skip
_NEAR = 3  # blocks after an entry of the contents among which its heading is
_FULL = chr(UNICODE_BLANK + 0x3F)  # for what is no braille
_SPACES = re.compile("[\t\u00a0\u2000-\u200a\u202f\u3000]")


def read_epub(source: Source) -> Iterator[Block]:
    """Read an EPUB or an eBraille publication.

    An anchor is named by its file and its name there, as "OEBPS/two.xhtml#note"; a file alone is
    its beginning.

    Raises
    ------
    InputError
        If it is damaged or locked.
    """
    return _Epub(source).blocks()


class _Epub:
    """A book, and its chapters as items of its manifest."""

    def __init__(self, source: Source) -> None:
        self.source, self.archive = source, Archive(source.stream, source.name)
        named = [file.get("full-path") for file in self._tree(_CONTAINER).iter("rootfile")]
        named = [posixpath.normpath(unquote(name)) for name in named]
        member = next(filter(self.archive.find, (*named, *_PACKAGES)), "")
        if not member:
            raise InputError(f"{source.name} is no EPUB: it has no package; give a book")
        root = self._tree(member)
        source.title = root.said("title")
        source.language = root.said("language").replace("_", "-")
        source.in_cells = self.archive.read_if("mimetype").strip() == _EBRAILLE or any(
            meta.get("property") == "a11y:brailleSystem" for meta in root.iter("meta")
        )
        source.members = self.archive.read
        self.items: dict[str, Element] = {}
        for item in root.iter("item"):
            item.attributes["href"] = inside(member, item.get("href"))
            self.items.setdefault(item.get("id"), item)
        spine = sorted(root.iter("itemref"), key=lambda each: each.get("linear") == "no")
        chapters = [self._readable(each.get("idref")) for each in spine]
        self.chapters = list(dict.fromkeys(each for each in chapters if each is not None))
        found = [self.archive.find(chapter.get("href")) for chapter in self.chapters]
        source.expected = sum(info.file_size for info in found if info is not None) * 3 // 4
        if not any(found):
            raise InputError(f"{source.name} has none of its chapters; get the book again")

    def _tree(self, member: str) -> Element:
        """Tree of a part that may be missing; a raw "&" or an open tag does not spoil it."""
        return read_tree(self.archive.read_if(member), member, lambda _: None)

    def _readable(self, identity: str) -> Element | None:
        """Item of the manifest, or the one to fall back to that is markup."""
        item = first = self.items.get(identity)
        for _ in range(10):
            if item is None or _kind(item) in _TEXTS:
                return item or first
            item = self.items.get(item.get("fallback"))
        return first

    def _entries(self, *kinds: str) -> dict[str, tuple[int, str]]:
        """Level and title of each entry of a list of the nav, or else of the NCX, by its anchor.

        Parameters
        ----------
        *kinds
            Types or roles of the list in the nav, and its name in the NCX.
        """
        items = self.items.values()
        navs = [item for item in items if "nav" in item.get("properties").split()]
        for item in [*navs, *(item for item in items if _kind(item) == _NCX)]:
            for listed in self._tree(item.get("href")).iter("nav", "navmap", "pagelist"):
                found = list(_entries(listed, item.get("href")))
                if found and {listed.name, *listed.words}.intersection(kinds):
                    return dict(reversed(found))  # the first of an anchor counts
        return {}

    def blocks(self) -> Iterator[Block]:
        """Blocks of all chapters, with what the contents and the list of pages tell of them."""
        contents = self._entries("toc", "doc-toc", "navmap")
        pages = self._entries("page-list", "doc-pagelist", "pagelist")
        groups = count(1)
        wrong = 0
        for chapter in self.chapters:
            blocks = self._chapter(chapter, groups)
            kinds = [block.kind for block in blocks]
            for number, block in enumerate(blocks):
                anchors = block.anchors if number else (chapter.get("href"), *block.anchors)
                entry = next((contents[name] for name in anchors if name in contents), None)
                if BlockKind.HEADING in kinds[number : number + _NEAR]:
                    entry = None  # which the text has itself
                if BlockKind.PAGE not in kinds:
                    yield from (Block(pages[n][1], BlockKind.PAGE) for n in anchors if n in pages)
                cells, text = None, block.text
                if self.source.in_cells:
                    text, strange = re.subn("[^ -~⠀-⣿]", _FULL, _SPACES.sub(" ", text))
                    cells, wrong = Cells.from_brf(text), wrong + strange
                yield block.replace(anchors=anchors, entry=entry, text=text, cells=cells)
        if wrong:
            self.source.note(
                f"{self.source.name} should be all braille and has "
                f"{counted(wrong, 'other character')}, shown as full cells"
            )

    def _chapter(self, chapter: Element, groups: Iterator[int]) -> list[Block]:
        """Blocks of a chapter, or a remark on one that cannot be shown."""
        source, member, kind = self.source, chapter.get("href"), _kind(chapter)
        spell = _in_braille if source.in_cells else str
        what = "chapter"
        if self.archive.find(member) is None:
            said = f"[missing chapter: {member}]"
        elif kind not in _TEXTS:
            what = "picture" if kind.startswith("image/") else "page"
            said = f"[{what}: {kind}]"
        else:
            try:
                name = f"{source.name} ({member})"
                root = read_tree(self.archive.read(member), name, source.note)
                return Walker(source.language, member, spell, groups).read(root)
            except InputError as error:
                if len(self.chapters) == 1:
                    raise
                source.note(str(error))
                said = f"[damaged chapter: {member}]"
        said = spell(said)
        return [Block(said, marks=(Mark(MarkKind.UNSHOWN, 0, len(said), what),))]


def _kind(item: Element) -> str:
    return item.get("media-type").strip().lower()


def _entries(holder: Element, member: str, level: int = 0) -> Iterator[tuple[str, tuple[int, str]]]:
    title = ""
    for child in holder.elements:
        title = child.said("a", "navlabel") or title  # a label stands before its address
        address = child.get("href") or child.get("src")
        if title and address:
            yield inside(member, address), (max(level, 1), title)
        yield from _entries(child, member, level + (child.name in ("ol", "ul", "navpoint")))


def _in_braille(text: str) -> str:
    """Cells of words that are added to the markup, in Unified English Braille."""
    return BrailleTable("en-ueb-g1.ctb").translate(text).to_unicode()
