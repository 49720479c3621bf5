"""Cells on a virtual page: wrapped into lines, from the book's beginning or from deep in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.layout.lines import Line, locate, place_of
from vbraille.layout.runs import LaidRun
from vbraille.translate.source import share_before

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout.blocks import LaidBlock
    from vbraille.translate.book import Book

__all__ = ["NEAR", "Layout", "Line", "locate", "place_of"]

# Number of characters; what is no farther away is laid out from where blocks are already, and so
# has its number. What is farther away would take longer than somebody waits for a line.
NEAR = 65_536
# Lines that nobody has counted are numbered from a multiple of this; no book has half as many.
_PROVISIONAL = 1 << 40
_RUNS = 256


class Layout:
    """A book laid out in lines of a width, only as far as somebody looks.

    Words wrap whole; a word that is longer than a line is cut between two of its characters and
    goes on in the next line. The indent depends on the kind of block. A paragraph begins with two
    blank cells. A line that is kept as the source has it begins at the margin, and what runs over
    is indented.

    What is asked for far away from all that is laid out is not reached by laying out what is
    between: the layout begins there once more, and goes backward and forward from there. As long
    as nobody has counted the lines before, lines there have provisional numbers, far above any
    true number; they follow each other in the same way. A very long paragraph that is entered in
    its middle begins on a line of its own.

    Parameters
    ----------
    book
        Cells of the book.
    width
        Number of cells in a line, at least 1.
    start
        Number of the block at which the layout begins, from 0.
    lines_before
        Number of lines before that block; None if they have not been counted.

    Raises
    ------
    ValueError
        If the width is below 1, or there is no such block.
    """

    def __init__(
        self, book: Book, width: int, *, start: int = 0, lines_before: int | None = 0
    ) -> None:
        if width < 1:
            raise ValueError(f"width is {width} cells; it must be at least 1")
        self.book = book
        self.width = width
        self._start = start
        self._known = {}  # numbers of lines before blocks, as they were counted
        if start and lines_before is not None:
            self._known[start] = lines_before
        self._begun = 0
        self._front = LaidRun(book, width)  # where the book begins
        self._runs = [self._front]  # the one that was used last stands last
        self._home = self._begin(start) if start else self._front

    @property
    def counted(self) -> bool:
        """Tell whether the lines that were looked at last have their true numbers."""
        return self._runs[-1].counted

    @property
    def first_line(self) -> int:
        """Number of the first line of the block at which the layout begins."""
        return self._home.before(self._start) + 1

    def count_from(self, block: int, lines: int) -> None:
        """Take over how many lines stand before a block, and number the lines around it by that.

        The provisional numbers of those lines still lead to the same lines, which then tell their
        true numbers.
        """
        self._known[block] = lines
        for run in self._runs:
            if not run.counted and run.first <= block <= run.after:
                run.count_from(block, lines)

    def lines_to(self, number: int) -> int:
        """Number of lines that would have to be laid out to reach the line of a number."""
        found = self._of_number(number)
        return 0 if found is None else found[0].lines_to(found[1])

    def line(self, number: int) -> Line | None:
        """Line of a number, from 1; None past the end, and before the beginning."""
        found = self._of_number(number)
        if found is None:
            return None
        run, number = found
        return self._use(run).line(number)

    def laid_near(self, line: Line, step: int) -> Line | None:
        """Line that is some steps after a line of this layout, if it costs nothing to give it.

        Parameters
        ----------
        line
            The line.
        step
            Number of lines by which the other one is after it; negative for before.

        Returns
        -------
        Line or None
            The other line; None if there is none, or its block would have to be laid out.
        """
        found = self._of_number(line.number)
        return None if found is None else found[0].laid_line(found[1] + step)

    def lines(self, first: int = 1, last: int | None = None) -> Iterator[Line]:
        """Lines of a range of numbers, both ends included."""
        number = max(first, 1)
        while last is None or number <= last:
            line = self.line(number)
            if line is None:
                return
            yield line
            number += 1

    def count(self) -> int:
        """Number of lines in all; this lays out the whole book."""
        while self._front.extend():
            pass
        return self._front.numbers[1]

    def blocks(self) -> Iterator[LaidBlock]:
        """Blocks in lines, from the book's first to its last, for who shows them all."""
        number = 0
        while self._front.reach_block(number):
            laid = self._front.laid(number)
            assert laid is not None, "a block that was reached"
            yield laid
            number += 1

    def place(self, character: int) -> tuple[Line, int] | None:
        """Line and cell that a source character is on; None past the end.

        A character that no cell stands for, such as a blank at a wrap, gives the next cell
        after it.
        """
        block = self.book.source.block_at(character)
        while block is not None:
            run = self._towards(block, character)
            if not run.reach_block(block):
                return None
            for n in range(run.before(block + 1) - run.before(block)):
                line = run.line_of(block, n)
                if len(line.cells) and character < line.cells.end:
                    return line, line.cell_of(max(character, int(line.cells.starts[0])))
            block += 1
        return None

    def block_of(self, line: Line) -> int:
        """Number of the block that a line of this layout is of."""
        found = self._of_number(line.number)
        assert found is not None, "a line of this layout"
        return found[0].block_of(found[1])

    def number_of(self, line: Line) -> int:
        """Number that a line of this layout has now, which may have been counted since."""
        found = self._of_number(line.number)
        return line.number if found is None else found[1]

    def lines_before(self, line: Line) -> int | None:
        """Number of lines before the block that a line is of; None if they were not counted."""
        found = self._of_number(line.number)
        assert found is not None, "a line of this layout"
        run, number = found
        return run.before(run.block_of(number)) if run.counted else None

    def progress(self, line: Line) -> float:
        """Tell how much of the book stands before a line, 0 to 1; see `share_before`."""
        return share_before(self.book.source, line.place)

    def _of_number(self, number: int) -> tuple[LaidRun, int] | None:
        """Find the run that a line's number leads to, and the number that it has there now."""
        key = (number + _PROVISIONAL // 2) // _PROVISIONAL
        if key > 0:  # given before the lines were counted, if they are counted now
            run = next((s for s in self._runs if s.key == key), None)
            return None if run is None else (run, number + run.shift)
        counted = (run for run in reversed(self._runs) if run.counted)
        return min(counted, key=lambda run: run.lines_to(number)), number

    def _towards(self, block: int, character: int) -> LaidRun:
        """LaidRun from which a block is reached soonest, which may be a new one."""
        latest = self._runs[::-1]
        holding = next((run for run in latest if run.holds(block)), None)
        if holding is None:
            nearest = min(latest, key=lambda run: run.characters_to(character))
            holding = nearest if nearest.characters_to(character) <= NEAR else None
        if holding is None:
            return self._begin(block)
        return self._use(holding)

    def _begin(self, block: int) -> LaidRun:
        """Begin anew at a block."""
        lines = self._known.get(block)
        if lines is None:
            self._begun += 1
            key, lines = self._begun, self._begun * _PROVISIONAL
        else:
            key = 0
        run = LaidRun(self.book, self.width, block, lines, key=key)
        self._runs[-1].forget()
        self._runs.append(run)
        if len(self._runs) > _RUNS:
            kept = (self._front, self._home)
            self._runs.remove(next(s for s in self._runs if s not in kept))
        return run

    def _use(self, run: LaidRun) -> LaidRun:
        """Keep what is laid out of this run, and of no other."""
        if run is not self._runs[-1]:
            self._runs[-1].forget()
            self._runs.remove(run)
            self._runs.append(run)
        return run
