"""How BANA's literary layout places each kind of block on an embossed page.

The rules are those of *Braille Formats: Principles of Print-to-Braille Transcription, 2016* of the
Braille Authority of North America, read with DAISY's braille style sheet for them; each row of the
table names the subject under which the rule is. Cells are counted from 1 there, and "3-1" says that
a first line begins in cell 3 and the others in cell 1. What is our own choice says so.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from vbraille.translate.source import Block

# Headings: a centered heading leaves three cells blank on either side.
CENTRED_MARGIN = 3
# Braille Page Numbers, Print Page Numbers: at least three blank cells between a line's text and the
# number of a page on the same line.
BEFORE_NUMBER = 3


@dataclass(frozen=True, slots=True)
class PlacingRule:
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
    # Headings: centered, a blank line before and after.
    PlacingRule(0, 0, centred=True, before=True, after=True, keeps=True),
    # Headings: cell-5 heading, blocked in cell 5, a blank line before and none after.
    PlacingRule(4, 4, before=True, keeps=True),
    # Headings: cell-7 heading, blocked in cell 7, a blank line before and none after.
    PlacingRule(6, 6, before=True, keeps=True),
)
# Paragraph Format: paragraphs are indented, 3-1, without blank lines.
_PARAGRAPH = PlacingRule(2, 0)
# Tables: our choice of rows as a list, 1-3, blank lines around it.
_ROW = PlacingRule(0, 2, before=True, after=True, apart=True)
# Poetry: each line of verse 1-3, blank lines around them.
_LINE = PlacingRule(0, 2, before=True, after=True, apart=True)
# Notes: our choice for a note that stands in the text, 7-5, as transcribers' notes are.
_NOTE = PlacingRule(6, 4)


def placing(block: Block, deepest: int = 1) -> PlacingRule:
    """PlacingRule of a block that is no page.

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
            # Lists: 1-3; in a list of several levels each begins two cells further in,
            # and all run over two cells beyond the deepest beginning (1-5, 3-5 for two levels).
            first = 2 * (block.level - 1)
            return PlacingRule(
                first, 2 * max(deepest, block.level), before=True, after=True, apart=True
            )
        case BlockKind.QUOTE:
            # Displayed Material: 3-1 like a paragraph, blank lines around it; that a quotation
            # within one stands two cells further in is our choice.
            inset = 2 * (block.level - 1)
            return PlacingRule(inset + 2, inset, before=True, after=True, apart=True)
        case BlockKind.ROW:
            return _ROW
        case BlockKind.LINE:
            return _LINE
        case BlockKind.NOTE:
            return _NOTE
        case BlockKind.PARAGRAPH | BlockKind.PAGE:
            return _PARAGRAPH
