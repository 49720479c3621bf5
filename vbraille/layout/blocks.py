"""A block broken into lines: the cells and the text of each, and the rest for its next piece."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, mask_of
from vbraille.translate.source import NO_BREAK_SPACE, BlockKind, to_text

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.translate.source import Block, Text


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line of a page.

    Parameters
    ----------
    number : int
        Number of the line in the book, from 1.
    indent : int
        Number of blank cells before the line's cells.
    cells : Cells
        Cells of the line after the indent.
    block : Block
        Block that the line is part of.
    first, after : int
        Index of the first character of the block's text on the line, and one past the last.
    """

    number: int
    indent: int
    cells: Cells
    block: Block
    first: int
    after: int

    @property
    def place(self) -> int:
        """Place of the source at which the line begins."""
        if len(self.cells):
            return int(self.cells.starts[0])
        places = self.block.text.places
        return int(places[self.first]) if self.first < places.size else max(self.cells.end - 1, 0)

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line from its first cell on, uint8[indent + cells]."""
        masks = np.zeros(len(self), np.uint8)
        masks[self.indent :] = self.cells.masks
        return masks

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
        return to_text(self.block.text.codes[self.first : self.after])

    def source(self, cell: int) -> tuple[int, int] | None:
        """Source characters of a cell as [first, one past the last); None off the text."""
        if not self.indent <= cell < len(self):
            return None
        return self.cells.source(cell - self.indent)

    def cell_of(self, character: int) -> int:
        """First cell of a source character.

        Raises
        ------
        IndexError
            If the character is not on this line.
        """
        return self.indent + self.cells.of_source(character)[0]

    def word(self, cell: int) -> str:
        """The whole word that a cell is part of, on this line or not; empty at a blank."""
        span = self.source(cell)
        if span is None:
            return ""
        at = self.block.text.index(span[0])
        text = str(self.block.text).replace(chr(UNICODE_BLANK), " ")
        if at >= len(text) or text[at].isspace():
            return ""
        before = text[:at].split(None)[-1:] if at and not text[at - 1].isspace() else []
        return "".join(before) + text[at:].split(None, 1)[0]


def locate(line: Line, geometry: Geometry, x_mm: float) -> int | None:
    """Cell of a line at a place on the surface; None if there is none.

    Parameters
    ----------
    x_mm
        Place on the surface: for a column of actuators, the carriage's position plus the column's
        offset. The space after a cell counts as the cell's.
    """
    cell = math.floor(x_mm / geometry.cell_pitch_mm)
    return cell if 0 <= cell < len(line) else None


def place_of(cell: int, geometry: Geometry) -> float:
    """Middle of a cell of a line on the surface, in mm; `locate` finds the cell there."""
    middle = (geometry.dot_spacing_mm + geometry.dot_width_mm) / 2
    return cell * geometry.cell_pitch_mm + min(middle, geometry.cell_pitch_mm / 2)


_SOLID = 0xFF  # in a search for blanks: a cell at which a line must not break


def breaks_of(text: Text, cells: Cells) -> bytes:
    """Cells as bytes that are zero where a line may break: at blanks, except no-break spaces."""
    if NO_BREAK_SPACE not in text.alphabet:
        return cells.masks.tobytes()
    no_break = text.places[text.codes == NO_BREAK_SPACE]
    solid = np.isin(cells.starts, no_break) & (cells.masks == 0)
    return np.where(solid, _SOLID, cells.masks).astype(np.uint8).tobytes()


def wrap(
    breaks: bytes,
    width: int,
    indent: int = 0,
    runover: int = 0,
    starts: Sequence[int] | memoryview | None = None,
) -> list[tuple[int, int, int]]:
    """Break a block into lines, each as full as it can be.

    The cells of one source character stay together, if need be at the cost of the indent. They are
    cut only if they are more than a line's width, where the line is full.

    Parameters
    ----------
    breaks
        One byte for each cell, zero where a line may break; what stands at a break is dropped.
    width
        Number of cells in a line.
    indent, runover
        Numbers of blank cells before the first line and before the others; less than the width.
    starts
        Source character of each cell, never decreasing; by default each cell has its own.

    Returns
    -------
    list of (start, stop, indent)
        Cells of each line, as [start, stop), and the number of blank cells before them.
    """
    end = len(breaks)
    leading = end - len(breaks.lstrip(b"\0"))
    if leading == end:
        return [(0, 0, 0)]
    if starts is None:
        starts = range(end)
    # Deep indents of the source's own must leave room for words: half a line, and the first whole.
    word = len(breaks[leading:].split(b"\0", 1)[0])
    start = leading - min(leading, width // 2, max(0, width - indent - word))
    bounds = []
    while end - start > width - indent:
        full = start + width - indent
        if indent and starts[start] == starts[full]:
            own = bisect_right(starts, starts[start], start) - start
            if own <= width:  # without so much of an indent, its cells stay together
                indent = width - own
                continue
        stop, following = _cut(breaks, start, full, starts)
        bounds.append((start, stop, indent))
        start = following
        indent = runover
    if start < end:
        bounds.append((start, end, indent))
    return bounds


def _cut(
    breaks: bytes, start: int, full: int, starts: Sequence[int] | memoryview
) -> tuple[int, int]:
    """Cell at which a full line ends, and the cell at which the next line begins."""
    at = breaks.rfind(0, start, full + 1)
    while at > start:
        stop, following = _around(breaks, start, at)
        if stop == start:
            break
        if following == len(breaks) or starts[stop - 1] != starts[following]:
            return stop, following
        at = breaks.rfind(0, start, stop)  # that blank was within a character's cells
    at = full
    while at > start and starts[at - 1] == starts[at]:
        at -= 1
    stop, following = _around(breaks, start, at)
    return (stop, following) if stop > start else _around(breaks, start, full)


def _around(breaks: bytes, start: int, at: int) -> tuple[int, int]:
    """One past the last cell before a place that is not blank, and the first such cell after it."""
    stop = start + len(breaks[start:at].rstrip(b"\0"))
    return stop, len(breaks) - len(breaks[at:].lstrip(b"\0"))


STEP = 2  # cells


def indents(block: Block, width: int) -> tuple[int, int]:
    """Numbers of blank cells before a block's first line and before its other lines.

    They are less than half of a line, so that there is room for words: a larger indent of the
    kind is cut to the largest even number of cells that is.

    Parameters
    ----------
    width
        Number of cells in a line.
    """
    match block.kind:
        case BlockKind.PARAGRAPH | BlockKind.NOTE:
            first, others = STEP, 0
        case BlockKind.QUOTE:
            first, others = (block.level + 1) * STEP, block.level * STEP
        case BlockKind.HEADING:
            first, others = 2 * STEP, 2 * STEP
        case BlockKind.ITEM:
            first, others = (block.level - 1) * STEP, block.level * STEP
        case BlockKind.ROW | BlockKind.LINE:
            first, others = 0, STEP
        case BlockKind.PAGE:
            first, others = 0, 0
    most = (width - 1) // (2 * STEP) * STEP
    return min(first, most), min(others, most)


# Where a page of the printed book begins, braille books have a row of dots 3 and 6 and then the
# page's number. A whole line of them would only be a long way to the number under one finger.
_RULE = mask_of((3, 6))
_RULE_CELLS = 4


@dataclass(frozen=True, slots=True)
class Carried:
    """Unfinished line that a piece of a long block leaves for the next piece.

    Parameters
    ----------
    indent
        Number of blank cells before the line.
    text, cells
        What is on the line so far.
    character
        First source character whose text is on the line.
    """

    indent: int
    text: Text
    cells: Cells
    character: int


class LaidBlock:
    """A block, or a piece of a block with what the piece before left, in lines.

    Parameters
    ----------
    block, cells
        Block that is laid out, and its cells.
    width
        Number of cells in a line.
    carried
        What the piece before left; None if the block begins here, or begins a line here.
    goes_on
        Whether another piece follows.

    Attributes
    ----------
    bounds : list of (start, stop, indent)
        Cells of each line, as [start, stop), and the number of blank cells before them.
    carries : Carried or None
        What is left for the next piece.
    """

    def __init__(
        self, block: Block, cells: Cells, width: int, carried: Carried | None, *, goes_on: bool
    ) -> None:
        indent, runover = indents(block, width)
        self._first = 0
        if block.continues:
            indent = runover
        if carried is not None:
            indent = carried.indent
            block = replace(block, text=carried.text + block.text)
            cells = carried.cells + cells
            self._first = block.text.index(carried.character)
        elif block.kind is BlockKind.PAGE and block.cells is None and len(cells):
            cells = _after_rule(cells, width)
        self.block = block
        self.cells = cells
        breaks = breaks_of(block.text, cells)
        self.bounds = wrap(breaks, width, indent, runover, cells.starts.data)
        self._rest: int | None = None  # where the cells that are left begin
        self.carries: Carried | None = None
        if goes_on:
            self.carries = self._carry(indent, runover)
        elif self.bounds == [(0, 0, 0)] and (carried is not None or block.kind is BlockKind.PAGE):
            self.bounds.clear()  # nothing but blanks is left, or the page has no number

    @cached_property
    def edges(self) -> list[int]:
        """Index of the character at which each line begins, and one past the last line's."""
        starts = [start for start, _, _ in self.bounds[1:]]
        starts += [] if self._rest is None or not self.bounds else [self._rest]
        after = [stop for _, stop, _ in self.bounds]
        edges = [self._edge(start, stop) for start, stop in zip(starts, after, strict=False)]
        last = [] if len(edges) == max(len(self.bounds), 1) else [len(self.block.text)]
        return [self._first, *edges, *last]

    def _edge(self, start: int, stop: int) -> int:
        """Start of a line's text: its cells begin at `start`, those before end at `stop`."""
        text, starts = self.block.text, self.cells.starts
        if start == starts.size:
            return len(text)
        character = int(starts[start])
        if stop and starts[stop - 1] == character:  # the character's text is on the line before
            character = self.cells.source(start)[1]
        at = text.index(character)
        while at < len(text) and chr(text.codes[at]).isspace():
            at += 1
        return at

    def _carry(self, indent: int, runover: int) -> Carried:
        """Unfinished line; nothing of what is before it is kept in memory."""
        text, cells = self.block.text, self.cells
        start, stop, its_indent = self.bounds.pop()
        if start == stop:  # the line is blank so far
            start, its_indent = len(cells), indent
        elif stop < len(cells):  # the blanks after the line have filled it
            self.bounds.append((start, stop, its_indent))
            start, its_indent = len(cells), runover
        self._rest = start
        first = int(cells.starts[start]) if start < len(cells) else text.end
        edge = self.edges[-1]
        character = int(text.places[edge]) if edge < len(text) else text.end
        rest = Cells(cells.masks[start:].copy(), cells.starts[start:].copy(), cells.end)
        return Carried(its_indent, text.since(first), rest, character)


def _after_rule(cells: Cells, width: int) -> Cells:
    """Put a row of dots before a page's number, as far as it finds room on the number's line."""
    rule = np.full(max(0, min(_RULE_CELLS, width - len(cells))), _RULE, np.uint8)
    starts = np.concatenate((np.full(rule.size, cells.starts[0]), cells.starts))
    return Cells(np.concatenate((rule, cells.masks)), starts, cells.end)
