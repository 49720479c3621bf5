"""A block in lines: which cells and which text each has, and what is left for its next piece."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.braille.dots import mask_of
from vbraille.layout.wrapping import breaks_of, indents, wrap
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from vbraille.translate.source import Block
    from vbraille.translate.text import Text

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
        """Where a line's text begins: its cells begin at `start`, those before end at `stop`."""
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
