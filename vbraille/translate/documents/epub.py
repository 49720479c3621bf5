"""An EPUB or an eBraille publication as a source, of which only the chapters read are parsed."""

from __future__ import annotations

from bisect import bisect_right
from functools import partial
from itertools import accumulate
from typing import TYPE_CHECKING, BinaryIO
from weakref import finalize

from vbraille.errors import InputError
from vbraille.translate.documents.html import digest_of
from vbraille.translate.documents.markup.archive import Archive
from vbraille.translate.documents.markup.dtbooknames import DTBOOK
from vbraille.translate.documents.markup.elements import BEGINS
from vbraille.translate.documents.markup.locks import check_unlocked
from vbraille.translate.documents.markup.package import (
    anchor_of,
    read_outline,
    read_package,
    read_page_list,
)
from vbraille.translate.documents.markup.parsing import Parsing, parts_of
from vbraille.translate.documents.markup.reader import MarkupReader
from vbraille.translate.documents.markup.ready import Spelling
from vbraille.translate.documents.parted import PartedSource, Passage
from vbraille.translate.source import Mark, MarkKind
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from typing import Self

    from vbraille.translate.documents.markup.package import BookPart

_OPEN = 3  # chapters whose parsing is kept


class EpubBook(PartedSource):
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
        _, digest = digest_of(stream, name)
        self._archive = Archive(stream, name)
        check_unlocked(self._archive)
        self._package = read_package(self._archive)
        sizes = [self._archive.size(chapter.member) for chapter in self._package.chapters]
        parts = [parts_of(size) for size in sizes]
        self._starts_of = [0, *accumulate(parts)]  # first part of each chapter
        self._chapters = {c.member: number for number, c in enumerate(self._package.chapters)}
        self._open: dict[int, Parsing] = {}
        self._pages = read_page_list(self._archive, self._package)
        self._spelling = Spelling() if self._package.is_braille else None
        self._told = 0
        self._any = False
        super().__init__(
            name,
            [max(size // n, 1) for size, n in zip(sizes, parts, strict=True) for _ in range(n)],
            digest,
            title=self._package.title,
            language=self._package.language,
            in_cells=self._package.is_braille,
        )

    @classmethod
    def open(cls, stream: BinaryIO, name: str) -> Self:
        """Open a file, whose stream is the book's from then on.

        Raises
        ------
        InputError
            If it is no EPUB, damaged, or locked.
        """
        return cls(stream, name)

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

    def passages(self, part: int) -> Iterable[Passage]:
        """Read a part, which is a chapter or a piece of a long one.

        Raises
        ------
        InputError
            If it cannot be read, or the whole book holds no text.
        """
        number = bisect_right(self._starts_of, part) - 1
        chapter = self._package.chapters[number]
        if chapter.member not in self._archive:
            found = [self._remark(f"missing chapter: {chapter.member}", "chapter", chapter)]
        elif not chapter.is_text:
            what = "picture" if chapter.kind.startswith("image/") else "page"
            found = [self._remark(f"{what}: {chapter.kind}", what, chapter)]
        else:
            found = self._parsing(number, chapter).part(part - self._starts_of[number])
        self._any = self._any or any(passage.text for passage in found)
        if not self._any and part == self.parts - 1 == len(self._starts) - 1 and self._is_empty():
            raise InputError(f"{self.name} holds no text that can be read; give another book")
        return found if self._spelling is None else self._spelling.ready(found)

    def anchored(self, name: str) -> int | None:
        """Give the number of the part that has an anchor; None if no part can have it."""
        member, _, fragment = name.partition("#")
        number = self._chapters.get(member)
        if number is None:
            return None
        first, after = self._starts_of[number : number + 2]
        if fragment and after - first > 1:
            for part in range(first, after):
                if any(name in passage.anchors for passage in self.passages(part)):
                    return part
        return first

    def anchor(self, name: str) -> int | None:
        """Place of an anchor; that of its chapter's beginning if the chapter has no such name."""
        part = self.anchored(name)
        if part is None:
            return None
        found = super().anchor(name)
        return self._starts[part].character if found is None else found

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
        if wrong <= self._told:
            return None
        told, self._told = self._told, wrong
        if told:
            return None
        return (
            f"{self.name} should be all braille and has {count(wrong, 'other character')} so far; "
            f"they are shown as full cells"
        )

    def close(self) -> None:
        """Close the file; it is closed in any case when the book is forgotten."""
        self._stream.close()

    def _is_empty(self) -> bool:
        """Whether all parts that were read have no block."""
        return self._starts[-1].block == 0

    def _parsing(self, number: int, chapter: BookPart) -> Parsing:
        """Parsing of a chapter; a few are kept, since a long chapter is parsed from its start."""
        parsing = self._open.get(number)
        if parsing is None:
            first, after = self._starts_of[number : number + 2]
            parsing = Parsing(
                partial(self._archive.open, chapter.member),
                after - first,
                f"{self.name} ({chapter.member})",
                partial(
                    MarkupReader,
                    partial(anchor_of, chapter.member),
                    f"{chapter.member}#",
                    (chapter.member,),
                    self.language,
                    DTBOOK if chapter.is_dtbook else BEGINS,
                    self._spell,
                    self._pages,
                ),
                xml=True,
            )
            if len(self._open) >= _OPEN:
                del self._open[next(iter(self._open))]
            self._open[number] = parsing
        return parsing

    def _remark(self, text: str, what: str, chapter: BookPart) -> Passage:
        """Remark on a chapter that cannot be shown."""
        text = self._spell(f"[{text}]")
        mark = Mark(MarkKind.UNSHOWN, 0, len(text), what)
        return Passage(text, marks=(mark,), anchors=(chapter.member,))

    @property
    def _spell(self) -> Callable[[str], str]:
        return str if self._spelling is None else self._spelling.of_print
