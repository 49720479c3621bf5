"""A file of HTML or DTBook as a source: one tree, read in chapters of our own making."""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, BinaryIO
from urllib.parse import unquote

from vbraille.errors import InputError
from vbraille.translate.documents.chapters import ChapterSource
from vbraille.translate.documents.markup.attributes import named
from vbraille.translate.documents.markup.reader import (
    BLOCKS,
    DTBOOK_BLOCKS,
    MarkupReader,
    title_and_language,
)
from vbraille.translate.documents.markup.tree import MOST_BYTES, read_tree

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import Self

    from lxml.etree import _Element as Element

    from vbraille.translate.documents.chapters import Passage

    Way = tuple[int, ...]  # index of each element on the way in the one around it

_CHAPTER_CHARACTERS = 65_536
_DEEPEST = 20  # elements around a chapter's first
# Elements that the next chapter may begin within: what they say of their text is in their
# attributes alone, and in how many of them are around it.
_AROUND_NAMES = (
    "html body div section article main dtbook book frontmatter bodymatter rearmatter level "
    "level1 level2 level3 level4 level5 level6"
)
_AROUND = frozenset(_AROUND_NAMES.split())


class HtmlBook(ChapterSource):
    """A tree of HTML or DTBook as a `Source`.

    Parameters
    ----------
    root
        Root of the tree.
    name
        Name of the source in messages.
    digest
        SHA-256 of the file, in hexadecimal.
    is_dtbook
        Whether the names of elements are those of DTBook.
    title, language
        Title and language that are given beside the markup, and go before what it says.
    note
        Note on the file, which is given once.

    Raises
    ------
    InputError
        If it holds no text.
    """

    def __init__(
        self,
        root: Element,
        name: str,
        digest: str,
        *,
        is_dtbook: bool = False,
        title: str = "",
        language: str = "",
        note: str | None = None,
    ) -> None:
        self._root = root
        self._is_dtbook = is_dtbook
        self._given = language
        self._note = note
        found = title_and_language(root)
        # Where each chapter begins, and how many characters it has.
        self._ways, sizes = _cut(root, DTBOOK_BLOCKS if is_dtbook else BLOCKS)
        super().__init__(
            name, sizes, digest, title=title or found[0], language=language or found[1]
        )
        self.block(0)  # a file that shows nothing is refused at once

    @classmethod
    def open(
        cls,
        stream: BinaryIO,
        name: str,
        encoding: str | None = None,
        *,
        is_dtbook: bool = False,
    ) -> Self:
        """Read a file.

        Parameters
        ----------
        stream
            Bytes of the file, which is read from its start and closed.
        name
            Name of the file in messages.
        encoding
            Name of an encoding that overrides what the bytes say.
        is_dtbook
            Whether it is DTBook.

        Raises
        ------
        InputError
            If it cannot be read, is empty, or the encoding is unknown.
        """
        content = read_whole(stream, name)
        is_xml = content[:64].removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<?xml")
        root, note = read_tree(content, name, xml=is_xml, encoding=encoding)
        digest = hashlib.sha256(content).hexdigest()
        return cls(root, name, digest, is_dtbook=is_dtbook, note=note)

    def passages(self, chapter: int) -> Iterator[Passage]:
        """Read a chapter.

        Raises
        ------
        InputError
            If the whole file holds no text.
        """
        reader = MarkupReader(
            local_target, language=self._given or self.language, is_dtbook=self._is_dtbook
        )
        ways = [*self._ways, ()]
        any_text = False
        for passage in reader.read(self._root, ways[chapter], ways[chapter + 1]):
            any_text = any_text or bool(passage.text)
            yield passage
        if not any_text and chapter == self.chapters - 1 and not self._starts[-1].block:
            raise InputError(
                f"{self.name} holds no text that can be read: all of it is hidden, or made by "
                f"scripts; give a file that has its text in it"
            )

    def note(self) -> str | None:
        """Note on bytes that are not of the encoding, given once."""
        note, self._note = self._note, None
        return note


def local_target(address: str) -> str:
    """Target of a link: an anchor's name is written as itself, another address as it is."""
    return f"#{unquote(address[1:])}" if address.startswith("#") else address


def read_whole(stream: BinaryIO, name: str) -> bytes:
    """All bytes of a file, which is closed.

    Raises
    ------
    InputError
        If it cannot be read, or is empty or too large for markup.
    """
    try:
        with stream:
            stream.seek(0)
            content = stream.read(MOST_BYTES + 1)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None
    if not content:
        raise InputError(f"{name} is empty; give a file with text in it")
    return content


def _cut(root: Element, blocks: frozenset[str]) -> tuple[list[Way], list[int]]:
    """Cut a tree into chapters: the way to the beginning of each, and its size in characters.

    A chapter begins with a block that stands after another one with text, so that nothing of the
    one goes on in the other.
    """
    ways: list[Way] = [()]
    sizes = [0]

    def cut(element: Element, way: Way) -> None:
        before = False
        for index, child in enumerate(element):
            name = named(child.tag)
            if before and sizes[-1] > _CHAPTER_CHARACTERS and name in blocks and name != "hr":
                ways.append((*way, index))
                sizes.append(0)
            size = sum(map(len, child.itertext()))
            before = name in blocks and name != "hr" and not (child.tail or "").strip() and size > 0
            if name in _AROUND and size > _CHAPTER_CHARACTERS and len(way) < _DEEPEST:
                cut(child, (*way, index))
            else:
                sizes[-1] += size

    cut(root, ())
    return ways, [max(size, 1) for size in sizes]
