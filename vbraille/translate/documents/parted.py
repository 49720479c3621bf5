"""A structured file as blocks: what its reader makes of each part, numbered and placed."""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_right
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.source import Block, BlockKind, Index, Mark
from vbraille.translate.text import Text, to_codes

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.braille.cells import Cells

# A longer block is passed on in pieces: no text may grow with the file.
PIECE_CHARACTERS = 8_192
_REMEMBERED = 3  # parts


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
        Number of the list, of the table or of the counted page within the part, from 1; 0 for
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


@dataclass(frozen=True, slots=True)
class _Start:
    """What comes before a part: numbers of blocks, characters, and groups as blocks have them."""

    block: int
    character: int
    group: int


class PartedSource(ABC):
    """A `Source` in parts, such as the chapters of an EPUB, each of which can be read by itself.

    A subclass says how many parts there are and reads one; a part is read when it is asked for,
    and forgotten again. The places of a block are those of its text in the whole source, in which
    one character stands between two blocks.

    Parameters
    ----------
    name
        Name of the source in messages.
    sizes
        Size of each part, in any unit, from which progress is estimated.
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
        self._starts = [_Start(0, 0, 0)]  # of each part that is known, and of the next
        self._recent: dict[int, list[Block]] = {}

    @abstractmethod
    def passages(self, part: int) -> Iterable[Passage]:
        """Read a part.

        Raises
        ------
        InputError
            If the part cannot be read.
        """

    def made(self, part: int, character: int, group: int) -> list[Block]:
        """Make the blocks of a part; a format with many small blocks may have a faster way.

        Parameters
        ----------
        part
            Number of the part, from 0.
        character
            Place of its first character in the source.
        group
            Number of lists and tables, or of counted pages, in the parts before it.
        """
        blocks: list[Block] = []
        for passage in self.passages(part):
            for block in _pieces(passage, character, group):
                blocks.append(block)
                character = block.text.end
        return blocks

    def anchored(self, name: str) -> int | None:  # noqa: ARG002
        """Give the number of the part that has an anchor, if the format tells without reading."""
        return None

    @property
    def parts(self) -> int:
        """Number of parts."""
        return self._shares.size - 1

    @property
    def complete(self) -> bool:
        """Whether all parts have been read once."""
        return len(self._starts) > self.parts

    @property
    def end(self) -> int:
        """One past the last character of the parts that have been read."""
        return self._starts[-1].character

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past the end."""
        if number < 0:
            return None
        while number >= self._starts[-1].block and not self.complete:
            self._read(len(self._starts) - 1)
        if number >= self._starts[-1].block:
            return None
        part = bisect_right(self._starts, number, key=lambda start: start.block) - 1
        return self._read(part)[number - self._starts[part].block]

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        while character >= self._starts[-1].character and not self.complete:
            self._read(len(self._starts) - 1)
        if character >= self._starts[-1].character:
            return None
        part = bisect_right(self._starts, max(character, 0), key=lambda start: start.character) - 1
        blocks = self._read(part)
        ends = [block.text.end for block in blocks]
        return self._starts[part].block + bisect_right(ends, character)

    def anchor(self, name: str) -> int | None:
        """Place of the first character of the block with an anchor; None if there is none."""
        told = self.anchored(name)
        for part in range(self.parts) if told is None else (told,):
            while part >= len(self._starts):
                self._read(len(self._starts) - 1)
            for block in self._read(part):
                if name in block.anchors:
                    return int(block.text.places[0]) if len(block.text) else block.text.end - 1
        return None

    def index(self) -> Index:
        """Tell where each part that was read begins."""
        rows = tuple((start.block, start.character, start.group) for start in self._starts)
        return Index(*self._fits(), rows, self.complete)

    def adopt(self, index: Index) -> None:
        """Take over where parts begin, if the index is of this file and knows more."""
        if (index.form, index.fits) == self._fits() and len(index.rows) > len(self._starts):
            self._starts = [_Start(*map(int, row)) for row in index.rows]

    def progress(self, number: int) -> float:
        """About how much of the source stands before a block that was read, 0 to 1."""
        part = bisect_right(self._starts, number, key=lambda start: start.block) - 1
        if part >= self.parts:
            return 1.0
        begun = self._starts[part].block
        blocks = (
            self._starts[part + 1].block - begun if part + 1 < len(self._starts) else number + 1
        )
        share = (number - begun) / max(blocks, 1)
        here, after = self._shares[part : part + 2]
        return float((here + share * (after - here)) / max(self._shares[-1], 1))

    def note(self) -> str | None:
        """Note on the source, given once after its cause is found; None if there is none."""
        return None

    def sha256(self) -> str:
        """SHA-256 of the bytes that the source was read from, in hexadecimal."""
        return self._digest

    def close(self) -> None:
        """Let go of the file, where one is open; further calls do nothing."""

    def _fits(self) -> tuple[str, tuple[str | int, ...]]:
        return f"{type(self).__name__} 4", (self._digest, self.parts)

    def _read(self, part: int) -> list[Block]:
        """Blocks of a part; where the next part begins is known after that."""
        blocks = self._recent.get(part)
        if blocks is not None:
            return blocks
        start = self._starts[part]
        blocks = self.made(part, start.character, start.group)
        if part == len(self._starts) - 1:
            groups = max((block.group for block in blocks), default=0)
            after = _Start(
                start.block + len(blocks),
                blocks[-1].text.end if blocks else start.character,
                max(start.group, groups),
            )
            self._starts.append(after)
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        self._recent[part] = blocks
        return blocks


def _pieces(passage: Passage, character: int, groups: int) -> Iterable[Block]:
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
    """Where a piece of a text ends that begins at an index: after a blank, if it has one."""
    full = start + PIECE_CHARACTERS
    if full >= len(text):
        return len(text)
    blank = text.rfind(" ", start, full)
    return blank + 1 if blank > start else full
