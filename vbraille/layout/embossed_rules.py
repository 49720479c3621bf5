"""How BANA's literary layout places each kind of block on an embossed page.

The rules are those of *Braille Formats: Principles of Print-to-Braille Transcription, 2016* of the
Braille Authority of North America; each row of the table names the section that has it. Cells are
counted from 1 there, and "3-1" says that a first line begins in cell 3 and the others in cell 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from vbraille.translate.source import Block

# Section 4, Headings: a centered heading leaves three cells blank on either side.
CENTRED_MARGIN = 3
# Section 1, General Formatting: at least three blank cells between a line's text and the number
# of a page on the same line.
BEFORE_NUMBER = 3


@dataclass(frozen=True, slots=True)
class Placing:
    """How a block is placed.

    Parameters
    ----------
    first, others
        Numbers of blank cells before the block's first line and before its other lines.
    centred
        Whether each line stands in the middle, whatever the two say.
    before, after
        Whether a blank line stands before and after the block, except at a page's top.
    apart
        Whether the blank lines stand around neighbours of the same kind and group together, and
        not around each.
    keeps
        Whether a line of what follows must stand on the same page.
    """

    first: int
    others: int
    centred: bool = False
    before: bool = False
    after: bool = False
    apart: bool = False
    keeps: bool = False


_HEADINGS = (
    # Section 4, Headings: centered, a blank line before and after.
    Placing(0, 0, centred=True, before=True, after=True, keeps=True),
    # Section 4: cell-5 heading, blocked in cell 5, a blank line before and none after.
    Placing(4, 4, before=True, keeps=True),
    # Section 4: cell-7 heading, blocked in cell 7, a blank line before and none after.
    Placing(6, 6, before=True, keeps=True),
)
# Section 1, General Formatting: paragraphs are indented, 3-1, without blank lines.
_PARAGRAPH = Placing(2, 0)
# Section 11, Tables: a table as rows is a list of them, 1-3, blank lines around it.
_ROW = Placing(0, 2, before=True, after=True, apart=True)
# Section 13, Poetry: each line of verse 1-3, blank lines around them.
_LINE = Placing(0, 2, before=True, after=True, apart=True)
# Section 16, Notes: a note that stands in the text, 7-5, a blank line around it is not required.
_NOTE = Placing(6, 4)


def placing(block: Block, deepest: int = 1) -> Placing:
    """Placing of a block that is no page.

    Parameters
    ----------
    block
        The block.
    deepest
        For an item: the deepest level of its list.
    """
    match block.kind:
        case BlockKind.HEADING:
            return _HEADINGS[min(block.level, len(_HEADINGS)) - 1]
        case BlockKind.ITEM:
            # Section 8, Lists: 1-3; in a list of several levels each begins two cells further in,
            # and all run over two cells beyond the deepest beginning (1-5, 3-5 for two levels).
            first = 2 * (block.level - 1)
            return Placing(
                first, 2 * max(deepest, block.level), before=True, after=True, apart=True
            )
        case BlockKind.QUOTE:
            # Section 9, Displayed material: margins moved two cells in, blank lines around it.
            inset = 2 * block.level
            return Placing(inset + 2, inset, before=True, after=True, apart=True)
        case BlockKind.ROW:
            return _ROW
        case BlockKind.LINE:
            return _LINE
        case BlockKind.NOTE:
            return _NOTE
        case BlockKind.PARAGRAPH | BlockKind.PAGE:
            return _PARAGRAPH
