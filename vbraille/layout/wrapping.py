"""Where the lines of a block of cells begin and end, and how far they are indented."""

from __future__ import annotations

from bisect import bisect_right
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.source import BlockKind
from vbraille.translate.text import NO_BREAK_SPACE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.braille.cells import Cells
    from vbraille.translate.source import Block
    from vbraille.translate.text import Text

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
