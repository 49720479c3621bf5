"""EPUB 2 and 3 and eBraille: chapters in their order, each read when it is come to."""

from __future__ import annotations

import posixpath
import re
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING
from urllib.parse import unquote

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, masks_of
from vbraille.errors import InputError
from vbraille.translate.archive import MOST_MARKUP, Archive
from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind
from vbraille.translate.markup import Walker
from vbraille.translate.tables import BrailleTable
from vbraille.translate.trees import Element, read_tree
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


@dataclass(frozen=True, slots=True)
class _Item:
    """A file of the book: its name in the archive, its type, and what the package says of it."""

    member: str
    kind: str
    properties: tuple[str, ...]
    fallback: str


class _Package:
    """Chapters, title, language and contents of an EPUB."""

    def __init__(self, archive: Archive) -> None:
        self.archive = archive
        member = self._find()
        root = self._tree(member)
        self.title = _said(root, "title")
        self.language = _said(root, "language").replace("_", "-")
        self.is_braille = archive.read_if("mimetype").strip() == _EBRAILLE or any(
            meta.get("property") == "a11y:brailleSystem" for meta in root.iter("meta")
        )
        self.items: dict[str, _Item] = {}
        for item in root.iter("item"):
            self.items.setdefault(
                item.get("id"),
                _Item(
                    inside(member, item.get("href")),
                    item.get("media-type").strip().lower(),
                    tuple(item.get("properties").split()),
                    item.get("fallback"),
                ),
            )
        references = list(root.iter("itemref"))
        references.sort(key=lambda each: each.get("linear") == "no")
        chapters = [self._readable(each.get("idref")) for each in references]
        self.chapters = list(dict.fromkeys(each for each in chapters if each is not None))
        if not self.chapters:
            raise InputError(
                f"{archive.name} does not say what its chapters are: its spine is empty; get "
                f"another copy of the book"
            )
        if not any(archive.find(chapter.member) for chapter in self.chapters):
            raise InputError(f"{archive.name} has none of its chapters; get the book again")

    def _find(self) -> str:
        """Member with the package, as the container says, or else one with its usual name."""
        if self.archive.find(_CONTAINER) is not None:
            for file in self._tree(_CONTAINER).iter("rootfile"):
                member = posixpath.normpath(unquote(file.get("full-path")))
                if self.archive.find(member) is not None:
                    return member
        for member in _PACKAGES:
            if self.archive.find(member) is not None:
                return member
        raise InputError(f"{self.archive.name} is no EPUB: it has no package; give a book")

    def _tree(self, member: str) -> Element:
        """Tree of a part; a raw "&" or a tag that is not closed does not spoil it."""
        return read_tree(self.archive.read(member, MOST_MARKUP), member, xml=True)[0]

    def _readable(self, identity: str) -> _Item | None:
        """Item of the manifest, or the one to fall back to that is markup."""
        item = first = self.items.get(identity)
        for _ in range(10):
            if item is None or item.kind in _TEXTS:
                return item or first
            item = self.items.get(item.fallback)
        return first

    def contents(self) -> list[tuple[int, str, str]]:
        """Level, title and anchor of each entry of the table of contents: the nav, or the NCX."""
        navs = [item for item in self.items.values() if "nav" in item.properties]
        for item in navs:
            if self.archive.find(item.member) is None:
                continue
            for nav in self._tree(item.member).iter("nav"):
                if "toc" in nav.get("type").split() or "doc-toc" in nav.get("role").split():
                    found = _nav_entries(nav, item.member, 0)
                    if found:
                        return found
        for tree, member in self._ncx():
            found = [each for top in tree.iter("navmap") for each in _ncx_entries(top, member, 0)]
            if found:
                return found
        return []

    def pages(self) -> dict[str, str]:
        """Numbers of pages of print by the anchors where they begin, of the nav or the NCX."""
        found: dict[str, str] = {}
        for item in self.items.values():
            if "nav" not in item.properties or self.archive.find(item.member) is None:
                continue
            for nav in self._tree(item.member).iter("nav"):
                if "page-list" in nav.get("type").split():
                    for link in nav.iter("a"):
                        found[inside(item.member, link.get("href"))] = link.text.strip()
        for tree, member in () if found else self._ncx():
            for target in tree.iter("pagetarget"):
                label, place = _ncx_parts(target)
                found[inside(member, place)] = label
        return found

    def _ncx(self) -> Iterator[tuple[Element, str]]:
        for item in self.items.values():
            if item.kind == _NCX and self.archive.find(item.member) is not None:
                yield self._tree(item.member), item.member


def inside(member: str, address: str) -> str:
    """Name of the anchor that an address in a member means."""
    path, hash_, anchor = address.strip().partition("#")
    path = unquote(path.partition("?")[0])
    if path:
        member = posixpath.normpath(posixpath.join(posixpath.dirname(member), path))
    return f"{member}{hash_}{unquote(anchor)}"


def _said(root: Element, name: str) -> str:
    """First text of the metadata with a name."""
    for element in root.iter(name):
        text = " ".join(element.text.split())
        if text:
            return text
    return ""


def _nav_entries(element: Element, member: str, level: int) -> list[tuple[int, str, str]]:
    found = []
    for child in element.elements:
        if child.name == "a" and child.get("href"):
            title = " ".join(child.text.split())
            found.append((max(level, 1), title, inside(member, child.get("href"))))
        else:
            found += _nav_entries(child, member, level + (child.name in ("ol", "ul")))
    return found


def _ncx_entries(element: Element, member: str, level: int) -> list[tuple[int, str, str]]:
    found = []
    for point in element.elements:
        if point.name == "navpoint":
            title, place = _ncx_parts(point)
            if title and place:
                found.append((level + 1, title, inside(member, place)))
            found += _ncx_entries(point, member, level + 1)
    return found


def _ncx_parts(element: Element) -> tuple[str, str]:
    """Label and address of an entry of an NCX."""
    label = place = ""
    for child in element.elements:
        if child.name == "navlabel" and not label:
            label = " ".join(child.text.split())
        elif child.name == "content" and not place:
            place = child.get("src")
    return label, place


def read_epub(source: Source) -> Iterator[Block]:
    """Read an EPUB or an eBraille publication.

    An anchor is named by its file and its name there, as "OEBPS/two.xhtml#note"; a file alone is
    its beginning.

    Raises
    ------
    InputError
        If it is damaged or locked.
    """
    archive = Archive(source.stream, source.name)
    archive.check_unlocked()
    package = _Package(archive)
    source.title, source.language = package.title, package.language
    source.in_cells = package.is_braille
    source.members = archive.read
    source.expected = sum(archive.size(chapter.member) for chapter in package.chapters) * 3 // 4
    return _chapters(source, package)


def _chapters(source: Source, package: _Package) -> Iterator[Block]:
    spelling = _Spelling(source) if package.is_braille else None
    contents: dict[str, tuple[int, str]] = {}
    for level, title, anchor in package.contents():
        contents.setdefault(anchor, (level, title))
    pages = package.pages()
    groups = count(1)
    texts = 0
    for chapter in package.chapters:
        blocks = _chapter(source, package, chapter, spelling, groups)
        if blocks:
            blocks[0] = blocks[0].replace(anchors=(chapter.member, *blocks[0].anchors))
        blocks = _with_entries(_with_pages(blocks, pages), contents)
        texts += any(block.text for block in blocks)
        for block in blocks:
            yield block if spelling is None else spelling.with_cells(block)
    if not texts:
        raise InputError(f"{source.name} holds no text that can be read; give another book")
    if spelling is not None:
        spelling.say()


def _chapter(
    source: Source,
    package: _Package,
    chapter: _Item,
    spelling: _Spelling | None,
    groups: Iterator[int],
) -> list[Block]:
    """Blocks of a chapter, or a remark on one that cannot be shown."""
    archive, member = package.archive, chapter.member
    spell = str if spelling is None else spelling.of_print
    if archive.find(member) is None:
        return [_remark(spell(f"[missing chapter: {member}]"), "chapter")]
    if chapter.kind not in _TEXTS:
        what = "picture" if chapter.kind.startswith("image/") else "page"
        return [_remark(spell(f"[{what}: {chapter.kind}]"), what)]
    try:
        content = archive.read(member, MOST_MARKUP)
        root, notes = read_tree(content, f"{source.name} ({member})", xml=True)
    except InputError as error:
        if len(package.chapters) == 1:
            raise
        source.note(str(error))
        return [_remark(spell(f"[damaged chapter: {member}]"), "chapter")]
    for note in notes:
        source.note(note)
    walker = Walker(source.language, f"{member}#", lambda path: inside(member, path), spell, groups)
    return walker.read(root)


def _remark(text: str, what: str) -> Block:
    """Remark on something that cannot be shown."""
    return Block(text, marks=(Mark(MarkKind.UNSHOWN, 0, len(text), what),))


def _with_pages(blocks: list[Block], pages: dict[str, str]) -> list[Block]:
    """Blocks with the pages of print that only a list of pages tells of."""
    if not pages or any(block.kind is BlockKind.PAGE for block in blocks):
        return blocks
    found = []
    for block in blocks:
        numbers = [pages[anchor] for anchor in block.anchors if anchor in pages]
        found += [Block(number, BlockKind.PAGE) for number in numbers]
        found.append(block)
    return found


def _with_entries(blocks: list[Block], contents: dict[str, tuple[int, str]]) -> list[Block]:
    """Blocks with the entries of the contents that lead to them and have no heading there."""
    found = []
    for number, block in enumerate(blocks):
        entry = next((contents[name] for name in block.anchors if name in contents), None)
        following = blocks[number : number + _NEAR]
        if entry is not None and not any(b.kind is BlockKind.HEADING for b in following):
            block = block.replace(entry=entry)
        found.append(block)
    return found


_FULL = chr(UNICODE_BLANK + 0x3F)  # for what is no braille
_SPACES = re.compile("[\t\u00a0\u2000-\u200a\u202f\u3000]")


class _Spelling:
    """Makes cells of the text of a book in braille, and counts what is none."""

    def __init__(self, source: Source) -> None:
        self._source, self._wrong = source, 0

    def of_print(self, text: str) -> str:
        """Cells of words that are added to the markup, in Unified English Braille."""
        return BrailleTable("en-ueb-g1.ctb").translate(text).to_unicode()

    def with_cells(self, block: Block) -> Block:
        """Give a block its cells."""
        text = _SPACES.sub(" ", block.text)
        text, wrong = re.subn("[^ -~⠀-⣿]", _FULL, text)
        self._wrong += wrong
        codes = np.frombuffer(text.encode("utf-32-le"), np.uint32)
        return block.replace(text=text, cells=Cells.bare(masks_of(codes)))

    def say(self) -> None:
        if self._wrong:
            self._source.note(
                f"{self._source.name} should be all braille and has "
                f"{counted(self._wrong, 'other character')}, shown as full cells"
            )
