"""An EPUB or an eBraille publication as a source, of which only the chapters read are parsed."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, BinaryIO
from weakref import finalize

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, masks_of
from vbraille.errors import InputError
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.documents.markup.archive import MOST_BYTES, Archive
from vbraille.translate.documents.markup.package import (
    anchor_of,
    read_outline,
    read_package,
    read_page_list,
)
from vbraille.translate.documents.markup.reader import MarkupReader
from vbraille.translate.documents.markup.tree import read_tree
from vbraille.translate.source import NO_BREAK_SPACE, SPACE, Mark, MarkKind, to_codes, to_text
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vbraille.translate.documents.markup.package import BookPart


class EpubBook(ChapterSource):
    """An EPUB 2 or 3, or an eBraille publication, as a `Source`.

    An anchor is named by its document and its name there, as "OEBPS/two.xhtml#note"; a document
    alone is its beginning.

    Parameters
    ----------
    stream
        Bytes of the file; the stream must be able to seek.
    name
        Name of the book in messages.

    Raises
    ------
    InputError
        If it is no EPUB, damaged, or locked.
    """

    def __init__(self, stream: BinaryIO, name: str) -> None:
        self._stream = stream
        finalize(self, stream.close)  # before the collector looks at the stream, and complains
        digest = digest_of(stream, name)
        self._archive = Archive(stream, name)
        self._archive.check_unlocked()
        self._package = read_package(self._archive)
        sizes = [self._archive.size(chapter.member) for chapter in self._package.chapters]
        self._chapters = {c.member: number for number, c in enumerate(self._package.chapters)}
        self._pages = read_page_list(self._archive, self._package)
        self._spelling = Spelling() if self._package.is_braille else None
        self._told = False
        super().__init__(
            name,
            [max(size, 1) for size in sizes],
            digest,
            title=self._package.title,
            language=self._package.language,
            in_cells=self._package.is_braille,
        )

    def outline(self) -> tuple[tuple[int, str, str], ...]:
        """Table of contents, as the book has it, without its chapters being read.

        Returns
        -------
        tuple of (level, title, target)
            Entries in their order: depth from 1, text, and "#" with the name of an anchor. It is
            empty if the book has no table of contents.

        Raises
        ------
        InputError
            If it is damaged.
        """
        return read_outline(self._archive, self._package)

    def passages(self, chapter: int) -> Iterable[Passage]:
        """Read a chapter.

        Raises
        ------
        InputError
            If it cannot be read, or the whole book holds no text.
        """
        part = self._package.chapters[chapter]
        any_text = False
        for passage in self._read_part(part):
            any_text = any_text or bool(passage.text)
            yield passage if self._spelling is None else self._spelling.with_cells(passage)
        if not any_text and chapter == self.chapters - 1 and not self._starts[-1].block:
            raise InputError(f"{self.name} holds no text that can be read; give another book")

    def _read_part(self, part: BookPart) -> Iterable[Passage]:
        if part.member not in self._archive:
            return [self._remark(f"missing chapter: {part.member}", "chapter", part)]
        if not part.is_text:
            what = "picture" if part.kind.startswith("image/") else "page"
            return [self._remark(f"{what}: {part.kind}", what, part)]
        content = self._archive.read(part.member, MOST_BYTES)
        root, _ = read_tree(content, f"{self.name} ({part.member})", xml=True)
        reader = MarkupReader(
            partial(anchor_of, part.member),
            f"{part.member}#",
            (part.member,),
            self.language,
            is_dtbook=part.is_dtbook,
            spell=self._spell,
            pages=self._pages,
        )
        return reader.read(root)

    def anchored(self, name: str) -> int | None:
        """Give the number of the chapter that has an anchor; None if none can have it."""
        return self._chapters.get(name.partition("#")[0])

    def anchor(self, name: str) -> int | None:
        """Place of an anchor; that of its chapter's beginning if the chapter has no such name."""
        chapter = self.anchored(name)
        if chapter is None:
            return None
        found = super().anchor(name)
        if found is None:
            found = next(s.character for s in self._starts if s.chapter == chapter)
        return found

    def member(self, name: str) -> bytes:
        """Give the bytes of a file of the container, such as those of a picture.

        Raises
        ------
        InputError
            If there is none, or it cannot be read, or is too large for a picture.
        """
        return self._archive.read(name)

    def note(self) -> str | None:
        """Note on characters that are no braille in a book in braille, given once."""
        wrong = 0 if self._spelling is None else self._spelling.wrong
        if not wrong or self._told:
            return None
        self._told = True
        return (
            f"{self.name} should be all braille and has {count(wrong, 'other character')} so far; "
            f"they are shown as full cells"
        )

    def close(self) -> None:
        """Close the file; it is closed in any case when the book is forgotten."""
        self._stream.close()

    def _remark(self, text: str, what: str, chapter: BookPart) -> Passage:
        """Remark on a chapter that cannot be shown."""
        text = self._spell(f"[{text}]")
        mark = Mark(MarkKind.UNSHOWN, 0, len(text), what)
        return Passage(text, marks=(mark,), anchors=(chapter.member,))

    @property
    def _spell(self) -> Callable[[str], str]:
        return str if self._spelling is None else self._spelling.of_print


def digest_of(stream: BinaryIO, name: str) -> str:
    """SHA-256 of a file, in hexadecimal.

    Raises
    ------
    InputError
        If it is empty or cannot be read.
    """
    digest = hashlib.sha256()
    try:
        stream.seek(0)
        while piece := stream.read(131_072):
            digest.update(piece)
        size = stream.tell()
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None
    if not size:
        raise InputError(f"{name} is empty; give a file with text in it")
    return digest.hexdigest()


_FULL = 0x28FF & ~0xC0  # dots 1 to 6, for what is no braille
_LETTERS = "abcdefghijklmnopqrstuvwxyz"
# Unified English Braille without contractions, for the few words that a reader of markup adds.
_SPELT = {
    **dict(zip(_LETTERS, Cells.from_brf(_LETTERS).to_unicode(), strict=True)),
    **dict(zip("1234567890", Cells.from_brf("ABCDEFGHIJ").to_unicode(), strict=True)),
    **dict(zip(".,:;?!-'", "⠲⠂⠒⠆⠦⠖⠤⠄", strict=True)),
    "(": "⠐⠣",
    ")": "⠐⠜",
    "[": "⠨⠣",
    "]": "⠨⠜",
    "•": "⠸⠲",
    "*": "⠐⠔",
    "/": "⠸⠌",
    "“": "⠘⠦",
    "”": "⠘⠴",
}
_NUMBER, _CAPITAL = "⠼", "⠠"


class Spelling:
    """Makes cells of the text of a book in braille.

    Attributes
    ----------
    wrong : int
        Number of characters so far that are no braille and are shown as full cells.
    """

    def __init__(self) -> None:
        self.wrong = 0

    def of_print(self, text: str) -> str:
        """Spell what is in print, in Unified English Braille; braille stays as it is."""
        cells, before = [], ""
        for character in text:
            if character.isdigit() and not before.isdigit():
                cells.append(_NUMBER)
            elif character.isascii() and character.isupper():
                cells.append(_CAPITAL)
            cells.append(_SPELT.get(character.lower(), character))
            before = character
        return "".join(cells)

    def with_cells(self, passage: Passage) -> Passage:
        """Give a passage its cells."""
        codes = to_codes(passage.text).copy()
        spaces = np.isin(codes, (0x09, NO_BREAK_SPACE, 0x202F, 0x3000))
        codes[spaces | ((codes >= 0x2000) & (codes <= 0x200A))] = SPACE
        braille = (codes >= UNICODE_BLANK) & (codes < UNICODE_BLANK + 0x100)
        wrong = ~braille & ((codes < SPACE) | (codes > 0x7E))
        codes[wrong] = _FULL
        self.wrong += int(wrong.sum())
        cells = Cells(masks_of(codes), np.arange(codes.size), codes.size)
        return replace(passage, text=to_text(codes), cells=cells)
