"""Neighbouring blocks of a book in lines, from a block on, backward and forward."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from typing import TYPE_CHECKING

from vbraille.layout.blocks import LaidBlock
from vbraille.layout.lines import Line

if TYPE_CHECKING:
    from vbraille.layout.blocks import Carried
    from vbraille.translate.book import Book
    from vbraille.translate.text import Text

_REMEMBERED = 16  # blocks
# Pieces of a long block before the one that is entered: if its beginning is among them, the block
# is laid out from there; otherwise the piece begins on a line of its own.
_PIECES_BACK = 2


class LaidRun:
    """Blocks in lines, without a gap, as many as somebody has looked at.

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
