"""How far the lines of a block are indented, by its kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from vbraille.translate.source import Block

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
