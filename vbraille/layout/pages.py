"""Cells on a virtual page: wrapped into lines, from the book's beginning or from deep in it."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING

from vbraille.layout.blocks import LaidBlock, Line, locate, place_of
from vbraille.translate.source import share_before

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout.blocks import Carried
    from vbraille.translate.book import Book
    from vbraille.translate.source import Text


_REMEMBERED = 16  # blocks
# Pieces of a long block before the one that is entered: if its beginning is among them, the block
# is laid out from there; otherwise the piece begins on a line of its own.
_PIECES_BACK = 2


class LaidRun:
    """Blocks in lines, without a gap, as many as were looked at.

    Parameters
    ----------
    book
        Cells of the book.
    width
        Number of cells in a line.
    start
        Number of the block that is looked at first.
    before
        Number of lines before that block, or a provisional number.
    key
        Number by which the run is found again as long as its lines have provisional numbers;
        0 if `before` is the true number.

    Attributes
    ----------
    counted : bool
        Whether lines have their true numbers.
    shift : int
        What has been added to provisional numbers since.
    begins, ends : int
        Characters of the source between which the blocks are.

    Raises
    ------
    ValueError
        If there is no such block.
    """

    def __init__(
        self, book: Book, width: int, start: int = 0, before: int = 0, key: int = 0
    ) -> None:
        self.key = key
        self.counted = key == 0
        self.shift = 0
        self._book = book
        self._width = width
        self._recent: dict[int, LaidBlock] = {}
        # Unfinished line of a long block that comes in pieces, by the number of the next piece.
        self._carried: dict[int, Carried] = {}
        self._severed: set[int] = set()  # pieces that begin on a line of their own
        self._anchor = self._beginning(start) if start else 0
        # Number of lines from the anchor up to each block after it, and back to each before it;
        # the last of the first is that of the next block.
        self._after = array("q", [0])
        self._back = array("q", [0])
        self._before = before
        self._complete = False
        self.begins = self.ends = 0
        if start:
            block = book.source.block(self._anchor)
            assert block is not None, "a block before one that is there"
            self.begins = self.ends = _first_character(block.text)
            while self.after < start:
                self.extend()
            self._before -= self._after[start - self._anchor]

    @property
    def first(self) -> int:
        """Number of the first block."""
        return self._anchor + 1 - len(self._back)

    @property
    def after(self) -> int:
        """Number of the block after the last."""
        return self._anchor - 1 + len(self._after)

    @property
    def numbers(self) -> tuple[int, int]:
        """Numbers of lines before the first block, and up to the last."""
        return self._before - self._back[-1], self._before + self._after[-1]

    def holds(self, block: int) -> bool:
        """Tell whether a block is among those that are laid out."""
        return self.first <= block < self.after

    def before(self, block: int) -> int:
        """Number of lines before a block that is laid out, or the one after the last."""
        place = block - self._anchor
        return self._before + (self._after[place] if place >= 0 else -self._back[-place])

    def count_from(self, block: int, lines: int) -> None:
        """Take over how many lines there are before such a block."""
        change = lines - self.before(block)
        self._before += change
        self.shift += change
        self.counted = True

    def line(self, number: int) -> Line | None:
        """Line of a number; None past either end of the book."""
        self.reach(number)
        lowest, highest = self.numbers
        if not lowest < number <= highest:
            return None
        block = self.block_of(number)
        return self.line_of(block, number - 1 - self.before(block))

    def laid_line(self, number: int) -> Line | None:
        """Line of a number, if its block was broken into lines lately; None otherwise."""
        lowest, highest = self.numbers
        if not lowest < number <= highest:
            return None
        block = self.block_of(number)
        if block not in self._recent:
            return None
        return self.line_of(block, number - 1 - self.before(block))

    def lines_to(self, number: int) -> int:
        """Number of lines that would have to be laid out to reach a line."""
        lowest, highest = self.numbers
        return max(number - highest, lowest + 1 - number, 0)

    def characters_to(self, character: int) -> int:
        """Number of characters that would have to be laid out to reach a character."""
        return max(character - self.ends, self.begins - character, 0)

    def reach(self, number: int) -> None:
        """Lay out blocks as far as the line of a number, if there is one."""
        while number > self.numbers[1] and self.extend():
            pass
        while number <= self.numbers[0] and self.extend_back():
            pass

    def reach_block(self, block: int) -> bool:
        """Lay out blocks as far as a block; tell whether there is one."""
        while block >= self.after and self.extend():
            pass
        while block < self.first and self.extend_back():
            pass
        return self.holds(block)

    def block_of(self, number: int) -> int:
        """Number of the block that a line is of, which is laid out."""
        past = number - 1 - self._before
        if past >= 0:
            return self._anchor + bisect_right(self._after, past) - 1
        return self._anchor - bisect_left(self._back, -past)

    def line_of(self, block: int, index: int) -> Line:
        """Line of a block that is laid out, by its index in the block."""
        laid = self.laid(block)
        assert laid is not None, "only blocks already laid out are asked for"
        start, stop, indent = laid.bounds[index]
        first, after = laid.edges[index : index + 2]
        number = self.before(block) + index + 1
        return Line(number, indent, laid.cells[start:stop], laid.block, first, after)

    def extend(self) -> bool:
        """Lay out the block after the last; tell whether there is one."""
        laid = None if self._complete else self.laid(self.after)
        if laid is None:
            self._complete = True
            return False
        self._after.append(self._after[-1] + len(laid.bounds))
        self.ends = laid.block.text.end
        return True

    def extend_back(self) -> bool:
        """Lay out the block before the first, a long one with its pieces; tell whether it is."""
        if self.first == 0:
            return False
        first = self.first
        beginning = self._beginning(first - 1)
        lines = []
        for number in range(beginning, first):
            laid = self.laid(number)
            assert laid is not None, "a block before one that is there"
            lines.append(len(laid.bounds))
            if number == beginning:
                self.begins = _first_character(laid.block.text)
        for count in reversed(lines):
            self._back.append(self._back[-1] + count)
        return True

    def laid(self, number: int) -> LaidBlock | None:
        """Break a block, or a piece of one, into lines; None past the end."""
        laid = self._recent.get(number)
        if laid is not None:
            return laid
        found = self._book.block(number)
        if found is None:
            return None
        goes_on = number + 1 not in self._severed and self._book.continues(number + 1)
        carried = self._carried.get(number)
        laid = LaidBlock(*found, self._width, carried, goes_on=goes_on)
        if laid.carries is not None:
            self._carried[number + 1] = laid.carries
        if len(self._recent) >= _REMEMBERED:
            del self._recent[next(iter(self._recent))]
        self._recent[number] = laid
        return laid

    def forget(self) -> None:
        """Keep only how many lines each block has."""
        self._recent.clear()

    def _beginning(self, number: int) -> int:
        """Piece of a long block with which laying it out begins; other blocks have one piece."""
        for piece in range(number, max(number - _PIECES_BACK, 0) - 1, -1):
            block = self._book.source.block(piece)
            if block is None:
                raise ValueError(f"there is no block {piece} in {self._book.source.name}")
            if not block.continues:
                return piece
        self._severed.add(number)
        return number


def _first_character(text: Text) -> int:
    """Place of a text's first character; of an empty one, the last place that belongs to it."""
    return int(text.places[0]) if len(text) else text.end - 1


__all__ = ["NEAR", "Layout", "Line", "locate", "place_of"]

# Number of characters; what is no farther away is laid out from where blocks are already, and so
# has its number. What is farther away would take longer than a reader waits for a line.
NEAR = 65_536
# Lines that were not counted are numbered from a multiple of this; no book has half as many.
_PROVISIONAL = 1 << 40
_RUNS = 256


class Layout:
    """A book laid out in lines of a width, only as far as its lines are looked at.

    Words wrap whole; a word that is longer than a line is cut between two of its characters and
    goes on in the next line. The indent depends on the kind of block. A paragraph begins with two
    blank cells. A line that is kept as the source has it begins at the margin, and what runs over
    is indented.

    What is asked for far away from all that is laid out is not reached by laying out what is
    between: the layout begins there once more, and goes backward and forward from there. As long as
    the lines before are not counted, lines there have provisional numbers, far above any
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
