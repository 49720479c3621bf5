"""The lines of a book that somebody reads: all of them, or a range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.layout.pages import Layout
from vbraille.reading.whereabouts import first_character

if TYPE_CHECKING:
    from vbraille.layout.pages import Line
    from vbraille.translate import Book


@dataclass(frozen=True, slots=True)
class LineRange:
    """Lines of a layout from one number to another.

    Parameters
    ----------
    layout : Layout
        Lines of the book.
    first, last : int or None
        Numbers of the first and last line, from 1; None for the end.
    """

    layout: Layout
    first: int = 1
    last: int | None = None

    def line(self, number: int) -> Line | None:
        """Line of a number; None if it is none of these."""
        return self.layout.line(number) if self._has(number) else None

    def place(self, character: int) -> tuple[Line, int] | None:
        """Line and cell of a place of the source; None if it is on none of these lines."""
        found = self.layout.place(character)
        return None if found is None or not self._has(found[0].number) else found

    def following(self, number: int, step: int, *, skip_blank: bool) -> Line | None:
        """Next line after one, or before it where the step is -1, perhaps one that has dots."""
        line = self.line(number + step)
        while skip_blank and line is not None and not line.masks.any():
            line = self.line(line.number + step)
        return line

    def relaid(self, book: Book, width: int) -> LineRange:
        """Lay out the same text in other cells or another width."""
        layout = Layout(book, width)
        numbers: list[int | None] = []
        for number in (self.first, self.last):
            line = self.layout.line(number) if number is not None and number > 1 else None
            place = None if line is None else layout.place(first_character(line))
            numbers.append(number if place is None else place[0].number)
        return LineRange(layout, numbers[0] or 1, numbers[1])

    def _has(self, number: int) -> bool:
        if self.first == 1 and self.last is None:
            return True  # lines may have provisional numbers
        return self.first <= number and (self.last is None or number <= self.last)
