"""A structured file as blocks: what its reader makes of each chapter, numbered and placed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_left, bisect_right
from dataclasses import dataclass, replace
from itertools import count, islice
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vbraille.translate.source import Block, BlockKind, Index, Mark, Text, to_codes

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.braille.cells import Cells

# A longer block is passed on in pieces: no text may grow with the file.
LONGEST_BLOCK = 8_192
# A chapter is read in pieces of at least so many characters, or more blocks than this.
_PIECE_CHARACTERS, _PIECE_BLOCKS = 65_536, 2_000
_REMEMBERED = 3  # pieces


@dataclass(frozen=True, slots=True)
class Passage:
    """A block as the reader of a format makes it, before it has its place in the source.

    Parameters
    ----------
    text
        The block's text, with white space folded as it is to be read.
    kind, level, language, anchors, headers
        As in `Block`.
    marks
        Marks whose places are indices into the text.
    group
        Number of the list, of the table or of the counted page within the chapter, from 1; 0 for
        other blocks.
    cells
        Cells of a source that is braille already, with places that are indices into the text.
    continues
        Whether the passage goes on where the one right before it broke off, since the two are a
        very long one.
    """

    text: str
    kind: BlockKind = BlockKind.PARAGRAPH
    level: int = 0
    marks: tuple[Mark, ...] = ()
    language: str = ""
    anchors: tuple[str, ...] = ()
    group: int = 0
    headers: tuple[str, ...] = ()
    cells: Cells | None = None
    continues: bool = False


class _Start(NamedTuple):
    """Start of a piece.

    Parameters
    ----------
    block, character
        Numbers of its first block and character in the source.
    chapter, passage
        Number of its chapter, and number in that of its first passage.
    groups, group
        Numbers of lists and tables, or of counted pages, before the chapter and before the piece.
    """

    block: int = 0
    character: int = 0
    chapter: int = 0
    passage: int = 0
    groups: int = 0
    group: int = 0


class ChapterSource(ABC):
    """A `Source` in chapters, such as those of an EPUB, each of which can be read by itself.

    A subclass says how many chapters there are and reads one. They are read in pieces, when these
    are asked for, and forgotten again. The places of a block are those of its text in the whole
    source, in which one character stands between two blocks.

    Parameters
    ----------
    name
        Name of the source in messages.
    sizes
        Size of each chapter, in any unit, from which progress is estimated.
    digest
        SHA-256 of the bytes that the source was read from, in hexadecimal.
    title, language
        As in `Source`.
    in_cells
        Whether all blocks have ready cells.
    """

    def __init__(
        self,
        name: str,
        sizes: Iterable[int],
        digest: str,
        *,
        title: str = "",
        language: str = "",
        in_cells: bool = False,
    ) -> None:
        self.name = name
        self.title = title
        self.language = language
        self.in_cells = in_cells
        self._digest = digest
        self._shares = np.cumsum([0, *sizes], dtype=np.float64)
        self._starts = [_Start()]  # of each piece that is known, and of the next
        self._recent: dict[int, list[Block]] = {}
        self._coming: Iterator[Passage] = iter(())
        self._comes: tuple[int, int] | None = None  # chapter, and number of the passage that comes

    @abstractmethod
    def passages(self, chapter: int) -> Iterable[Passage]:
        """Read a chapter.

        Raises
        ------
        InputError
            If the chapter cannot be read.
        """

    def piece(
        self, chapter: int, passage: int, character: int, groups: int
    ) -> tuple[list[Block], int | None]:
        """Make the blocks of a piece; a format with many small blocks may have a faster way.

        Parameters
        ----------
        chapter, passage
            Number of the chapter, and number in it of the piece's first passage.
        character
            Place of the first character in the source.
        groups
            Number of lists and tables, or of counted pages, in the chapters before.

        Returns
        -------
        blocks
            Blocks of the piece.
        passages
            Number of passages that they were made of; None if the chapter ends with them.
        """
        if self._comes != (chapter, passage):
            self._coming = islice(self.passages(chapter), passage, None)
        self._comes = None  # as long as it is not known whether it can be read
        blocks: list[Block] = []
        end = character
        for taken, found in enumerate(self._coming, 1):
            for block in _blocks(found, end, groups):
                blocks.append(block)
                end = block.text.end
            if end - character > _PIECE_CHARACTERS or len(blocks) > _PIECE_BLOCKS:
                self._comes = chapter, passage + taken
                return blocks, taken
        return blocks, None

    def anchored(self, name: str) -> int | None:  # noqa: ARG002
        """Give the number of the chapter that has an anchor, if it is told without reading."""
        return None

    @property
    def chapters(self) -> int:
        """Number of chapters."""
        return self._shares.size - 1

    @property
    def complete(self) -> bool:
        """Tell whether all chapters have been read once."""
        return self._starts[-1].chapter >= self.chapters

    @property
    def end(self) -> int:
        """One past the last character of what has been read."""
        return self._starts[-1].character

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past the end."""
        if number < 0:
            return None
        while number >= self._starts[-1].block and not self.complete:
            self._read(len(self._starts) - 1)
        if number >= self._starts[-1].block:
            return None
        piece = bisect_right(self._starts, number, key=lambda start: start.block) - 1
        return self._read(piece)[number - self._starts[piece].block]

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        while character >= self._starts[-1].character and not self.complete:
            self._read(len(self._starts) - 1)
        if character >= self._starts[-1].character:
            return None
        piece = bisect_right(self._starts, max(character, 0), key=lambda start: start.character) - 1
        ends = [block.text.end for block in self._read(piece)]
        return self._starts[piece].block + bisect_right(ends, character)

    def anchor(self, name: str) -> int | None:
        """Place of the first character of the block with an anchor; None if there is none."""
        chapter = self.anchored(name)
        for piece in count():
            while piece >= len(self._starts) - 1 and not self.complete:
                self._read(len(self._starts) - 1)
            if piece >= len(self._starts) - 1:
                return None
            start = self._starts[piece]
            if chapter is not None and start.chapter != chapter:
                if start.chapter > chapter:
                    return None
                continue
            for block in self._read(piece):
                if name in block.anchors:
                    return int(block.text.places[0]) if len(block.text) else block.text.end - 1
        return None

    def index(self) -> Index:
        """Tell where each piece that was read begins."""
        return Index(*self._fits(), tuple(self._starts), self.complete)

    def adopt(self, index: Index) -> None:
        """Take over where pieces begin, if the index is of this file and knows more."""
        if (index.form, index.fits) == self._fits() and len(index.rows) > len(self._starts):
            self._starts = [_Start(*map(int, row)) for row in index.rows]

    def progress(self, number: int) -> float:
        """About how much of the source stands before a block that was read, 0 to 1."""
        starts = self._starts
        piece = bisect_right(starts, number, key=lambda start: start.block) - 1
        start = starts[piece]
        if start.chapter >= self.chapters:
            return 1.0
        first = bisect_left(starts, start.chapter, key=lambda start: start.chapter)
        after = bisect_right(starts, start.chapter, key=lambda start: start.chapter)
        here, next_share = self._shares[start.chapter : start.chapter + 2]
        begun = starts[first].block
        if after < len(starts):  # the whole chapter is known
            share = (number - begun) / max(starts[after].block - begun, 1)
        else:
            read = self.end - starts[first].character
            blocks = max(starts[-1].block, number + 1) - begun
            share = (number - begun) / blocks * min(read / max(next_share - here, read, 1), 1.0)
        return float((here + share * (next_share - here)) / max(self._shares[-1], 1))

    def note(self) -> str | None:
        """Note on the source, given once after its cause is found; None if there is none."""
        return None

    def sha256(self) -> str:
        """SHA-256 of the bytes that the source was read from, in hexadecimal."""
        return self._digest

    def close(self) -> None:
        """Let go of the file, where one is open; further calls do nothing."""

    def _fits(self) -> tuple[str, tuple[str | int, ...]]:
        return f"{type(self).__name__} 5", (self._digest, self.chapters)

    def _read(self, piece: int) -> list[Block]:
        """Blocks of a piece; where the next piece begins is known after that."""
        blocks = self._recent.get(piece)
        if blocks is not None:
            return blocks
        start = self._starts[piece]
        blocks, taken = self.piece(start.chapter, start.passage, start.character, start.groups)
        group = max(start.group, *(block.group for block in blocks), 0)
        character = blocks[-1].text.end if blocks else start.character
        chapter, passage, groups = start.chapter, start.passage + (taken or 0), start.groups
        if taken is None:
            chapter, passage, groups = start.chapter + 1, 0, group
        if piece == len(self._starts) - 1:
            number = start.block + len(blocks)
            self._starts.append(_Start(number, character, chapter, passage, groups, group))
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        self._recent[piece] = blocks
        return blocks


def _blocks(passage: Passage, character: int, groups: int) -> Iterable[Block]:
    """Blocks of a passage that begins at a place of the source, more than one if it is long."""
    codes = to_codes(passage.text)
    alphabet = frozenset(np.unique(codes).tolist())
    marks = tuple(
        Mark(mark.kind, mark.start + character, mark.end + character, mark.target)
        for mark in passage.marks
    )
    group = groups + passage.group if passage.group else 0
    ready = passage.cells
    start = 0
    while True:
        stop = codes.size if ready is not None else _cut(passage.text, start)
        last = stop == codes.size
        first, after = character + start, character + stop + last
        text = Text(codes[start:stop], np.arange(first, character + stop), after, alphabet)
        cells = None
        if ready is not None:
            cells = replace(ready, starts=ready.starts + character, end=after)
        yield Block(
            text,
            passage.kind,
            passage.level,
            cells,
            continues=start > 0 or passage.continues,
            marks=tuple(mark for mark in marks if mark.start < after and mark.end > first),
            language=passage.language,
            anchors=passage.anchors if start == 0 else (),
            group=group,
            headers=passage.headers,
        )
        if last:
            return
        start = stop


def _cut(text: str, start: int) -> int:
    """End of the piece of a text that begins at an index: after a blank, if it has one."""
    full = start + LONGEST_BLOCK
    if full >= len(text):
        return len(text)
    blank = text.rfind(" ", start, full)
    return blank + 1 if blank > start else full
