"""Lines of cells: blocks broken into them, as full as they can be, by the rules of their script."""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.translate import Block, BrailleTable

_LINES = 1 << 20  # more than a block has
_SOLID = 0xFF  # in a search for blanks: a cell at which a line must not break
_NO_BREAK_SPACE = "\u00a0"
# Scripts that are written without spaces: Thai, Lao, Tibetan, Burmese, Khmer, kana and Han.
_SPACELESS = re.compile(
    "[\u0e01-\u0fff\u1000-\u109f\u1780-\u17ff\u3001-\u30ff\u3400-\u9fff\uff01-\uff65]"
)
_OPENING = frozenset("([{「『（《〈【〔“‘«เแโใไເແໂໃໄ")
_CLOSING = frozenset(
    ")]}」』）》〉】〕”’»,.;:!?，。、．；：！？·・ーぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮ々ๆໆ។៕ៗฯ།"
)
_JOINERS = frozenset("\u17d2\u1039\u103a\u0f84\u200d")  # what stacks the next letter below


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a page.

    Parameters
    ----------
    block : Block
        Block that the line is part of.
    index : int
        Which line of its block it is, from 0.
    indent : int
        Number of blank cells before the line's cells.
    cells : Cells
        Cells of the line after the indent; they stand for places in the source.
    first, after : int
        Index of the first character of the block's text on the line, and one past the last.
    """

    block: Block
    index: int
    indent: int
    cells: Cells
    first: int
    after: int

    @property
    def id(self) -> int:
        """Number that no other line of the layout has, above 0; growing along the book."""
        return self.block.number * _LINES + self.index + 1

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Line) and self.id == other.id

    def __hash__(self) -> int:
        return self.id

    @property
    def place(self) -> int:
        """Place of the source at which the line begins."""
        return self.block.start + self.first

    @property
    def end(self) -> int:
        """Place one past the line's text."""
        return self.block.start + self.after

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line from its first cell on, uint8[indent + cells]."""
        return np.concatenate((np.zeros(self.indent, np.uint8), self.cells.masks))

    def __len__(self) -> int:
        return self.indent + len(self.cells)

    @property
    def printed(self) -> Cells:
        """Line as it would be embossed: its indent and its cells, without their way to the text."""
        return Cells.bare(self.masks)

    @property
    def text(self) -> str:
        """Text that the line stands for; the lines of a block together are the block's text.

        White space at which a line ends belongs to that line. A character whose cells do not
        find room on one line belongs to the first of its lines.
        """
        return self.block.text[self.first : self.after]

    def source(self, cell: int) -> tuple[int, int] | None:
        """Places of the text of a cell as [first, one past the last); None off the text."""
        if not self.indent <= cell < len(self):
            return None
        return self.cells.source(cell - self.indent)

    def word(self, cell: int) -> str:
        """The whole word that a cell is part of, on this line or not; empty at a blank."""
        span = self.source(cell)
        at = -1 if span is None else span[0] - self.block.start
        text = self.block.text.replace(chr(UNICODE_BLANK), " ")
        words = (found for found in re.finditer(r"\S+", text) if found.end() > at >= found.start())
        return next((found[0] for found in words), "")


def wrap(
    block: Block,
    cells: Cells,
    width: int,
    indents: tuple[int, int] = (0, 0),
    table: BrailleTable | None = None,
    before: bytes = b"",
) -> list[Line]:
    """Break a block into lines.

    A word is cut only where it is longer than a line, and a text without spaces only where a line
    may begin; the cells of one character stay together, unless there are more than a line has.

    Parameters
    ----------
    block, cells
        The block, and its cells.
    width
        Number of cells in a line.
    indents
        Numbers of blank cells before the first line and before the others; less than the width.
    table
        Table that has the cells at which a word is cut; None where words are cut without a sign.
    before
        Cells that are put before the first line's own.
    """
    text, (indent, runover) = block.text, indents
    places = (cells.starts - block.start).tolist()
    solid = bytes(
        mask or _SOLID * (text[place] == _NO_BREAK_SPACE)
        for mask, place in zip(cells.masks.tolist(), places, strict=True)
    )
    ends, end = _ends(solid, places, text), len(solid.rstrip(b"\0"))
    # Deep indents of the source's own must leave room for words: half a line, and the first whole.
    leading = end - len(solid[:end].lstrip(b"\0"))
    word = len(solid[leading:].split(b"\0", 1)[0])
    start = leading - min(leading, width // 2, max(0, width - indent - word))
    lines: list[Line] = []
    first = 0
    while start < end or not lines:
        full = max(start + width - indent - len(before), start + 1)
        last = bisect_right(ends, (full, end)) - 1
        stop, following = ends[last] if last >= 0 else (start, start)
        after, begin = b"", b""
        if end <= full:
            stop = following = full
        elif stop <= start:
            cut = full - (table is not None and full - start > 2)
            stop = bisect_left(places, places[cut], start, cut)  # where a character begins
            stop = stop if stop > start else cut
            if table is not None and stop < full and places[stop - 1] != places[stop]:
                rest = cells.masks[stop:end].tobytes().split(b"\0", 1)[0]
                after, begin = table.divide(text, places[stop], rest)
            following = end - len(solid[stop:end].lstrip(b"\0"))
        own = cells[start:stop]
        to = own.end - block.start
        while to < len(text) and (following >= end or text[to].isspace()):
            to += 1
        lines.append(Line(block, len(lines), indent, _signed(own, before, after), first, to))
        first, start, indent, before = to, following, runover, begin
    return lines


def _ends(solid: bytes, places: Sequence[int], text: str) -> list[tuple[int, int]]:
    """Places where a line may end: one past its last cell, and the cell where the next begins."""
    ends, stop = [], 0
    is_spaceless = _SPACELESS.search(text) is not None
    for at in (cell for cell, mask in enumerate(solid) if mask):
        is_blank = stop < at
        if stop and places[stop - 1] != places[at] and (is_blank or is_spaceless):
            before, after = text[places[at] - 1], text[places[at]]
            if is_blank:  # which is the table's own before a closing mark
                may_begin = before.isspace() or after not in _CLOSING
            else:
                may_begin = _may_begin(before, after)
            if may_begin:
                ends.append((stop, at))
        stop = at + 1
    return ends


def _may_begin(before: str, after: str) -> bool:
    """Tell whether a line of a script without spaces may begin between two characters."""
    if not _SPACELESS.search(before + after):
        return False
    is_mark = unicodedata.category(after)[0] == "M"
    return not (is_mark or after in _CLOSING or before in _OPENING or before in _JOINERS)


def _signed(cells: Cells, before: bytes, after: bytes) -> Cells:
    """Cells of a line between those that say that a word was cut."""
    if not before and not after:
        return cells
    masks = np.frombuffer(before + cells.masks.tobytes() + after, np.uint8)
    starts = np.pad(cells.starts, (len(before), len(after)), mode="edge")
    return Cells(masks, starts, cells.end)
