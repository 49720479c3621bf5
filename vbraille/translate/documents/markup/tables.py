"""Lists and tables: numbers before items, rows, and which header stands above each cell."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

BETWEEN = "  "  # between two cells of a row
_MOST_COLUMNS = 1_000


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell of a row: its part of the row's text, its columns, and whether it is a header."""

    start: int
    end: int
    column: int
    span: int
    is_header: bool


@dataclass(slots=True)
class TableState:
    """A table that is being read.

    A table that lays out a page, as other tables in its cells show, has no rows.

    Parameters
    ----------
    group
        Number of the table within its part.
    """

    group: int
    lays_out: bool = False
    in_head: bool = False
    in_row: bool = False
    _cells: list[Cell] = field(default_factory=list)
    _column: int = 0
    _opened: tuple[int, int, bool] | None = None  # where, number of columns, whether a header
    _headers: dict[int, str] = field(default_factory=dict)
    _after_data: bool = False
    _taken: dict[int, int] = field(default_factory=dict)  # columns taken by cells above, for rows
    _spans: dict[int, int] = field(default_factory=dict)
    _kept: tuple[str, ...] = ()

    def begin_row(self) -> None:
        """Begin a row with no cells."""
        self.in_row = True
        self._cells, self._column, self._opened = [], 0, None
        self._taken = {c: rows - 1 for c, rows in self._spans.items() if rows > 0}
        self._spans = dict(self._taken)

    def begin_cell(self, start: int, *, columns: int, rows: int, is_header: bool) -> None:
        """Begin a cell at an index of the row's text."""
        self.end_cell(start)
        while self._taken.get(self._column, -1) >= 0:
            self._column += 1
        columns = min(max(columns, 1), _MOST_COLUMNS)
        if rows > 1 and self._column < _MOST_COLUMNS:
            self._spans |= dict.fromkeys(range(self._column, self._column + columns), rows - 1)
        self._opened = start, columns, is_header

    def end_cell(self, end: int) -> None:
        """End the cell that is open, if any, at an index of the row's text."""
        if self._opened is None:
            return
        start, span, is_header = self._opened
        self._cells.append(Cell(start, end, self._column, span, is_header))
        self._column += span
        self._opened = None

    def end_row(self, text: str) -> tuple[str, ...]:
        """End the row, and tell the headers of its cells that have text.

        Parameters
        ----------
        text
            The row, whose cells with text are separated by `BETWEEN`.
        """
        self.in_row = False
        # A cell without text ends where it began, before the blanks of the next one.
        shown = [(cell, text[cell.start : cell.end].strip()) for cell in self._cells]
        shown = [(cell, words) for cell, words in shown if words]
        if self.in_head or (len(shown) > 1 and all(cell.is_header for cell, _ in shown)):
            if self._after_data:
                self._headers.clear()
            self._after_data = False
            for cell, words in shown:
                for column in range(cell.column, min(cell.column + cell.span, _MOST_COLUMNS)):
                    above = self._headers.get(column)
                    self._headers[column] = f"{above} {words}" if above else words
            return ()
        self._after_data = True
        if not self._headers:
            return ()
        headers = tuple(self._headers.get(cell.column, "") for cell, _ in shown)
        # Rows with the same headers share them.
        self._kept = headers if headers != self._kept else self._kept
        return self._kept


BULLET = "• "
_STYLES = {
    "decimal": "1",
    "decimal-leading-zero": "1",
    "lower-alpha": "a",
    "lower-latin": "a",
    "upper-alpha": "A",
    "upper-latin": "A",
    "lower-roman": "i",
    "upper-roman": "I",
}
_ROMANS = (
    (1000, "m"),
    (900, "cm"),
    (500, "d"),
    (400, "cd"),
    (100, "c"),
    (90, "xc"),
    (50, "l"),
    (40, "xl"),
    (10, "x"),
    (9, "ix"),
    (5, "v"),
    (4, "iv"),
    (1, "i"),
)


@dataclass(slots=True)
class ListNumbers:
    """Numbers of the items of a list that is being read.

    Parameters
    ----------
    style
        Style of the numbers: "1", "a", "A", "i" or "I"; "•" for bullets, empty for nothing.
    number
        Number of the next item.
    step
        What is added to the number from item to item.
    """

    style: str
    number: int = 1
    step: int = 1

    def marker(self, attributes: Mapping[str, str]) -> str:
        """Text before the next item, which has these attributes."""
        if not self.style:
            return ""
        if self.style == "•":
            return BULLET
        self.number = whole(attributes.get("value"), self.number)
        number, self.number = self.number, self.number + self.step
        return f"{numeral(number, attributes.get('type') or self.style)}. "


def numbering_of(name: str, attributes: Mapping[str, str]) -> ListNumbers:
    """Numbering of the list that an element begins."""
    style = attributes.get("style", "")
    numbering = "1" if name == "ol" else "•"
    if "list-style" in style:
        words = style.partition("list-style")[2].partition(";")[0].replace(":", " ").split()
        if "none" in words:
            return ListNumbers("")
        numbering = next((_STYLES[word] for word in words if word in _STYLES), numbering)
    if name != "ol":
        return ListNumbers(numbering)
    numbering = attributes.get("type") or attributes.get("enum") or numbering
    if numbering not in {"1", "a", "A", "i", "I"}:
        numbering = "1"
    if "reversed" not in attributes:
        return ListNumbers(numbering, whole(attributes.get("start"), 1))
    # How many items a list has, from which it would count down, is not known where it begins.
    if "start" not in attributes:
        return ListNumbers("•")
    return ListNumbers(numbering, whole(attributes.get("start"), 1), -1)


def whole(text: str | None, otherwise: int) -> int:
    """Whole number of an attribute; the other value if it has none of at most nine digits."""
    digits = (text or "").strip()
    plain = digits.removeprefix("-")
    return int(digits) if plain.isascii() and plain.isdigit() and len(plain) < 10 else otherwise


def numeral(number: int, numbering: str) -> str:
    """Numeral of a list's item.

    >>> [numeral(28, numbering) for numbering in "1aAiI"]
    ['28', 'ab', 'AB', 'xxviii', 'XXVIII']
    """
    if numbering in "aA" and number > 0:
        letters = ""
        while number:
            number, letter = divmod(number - 1, 26)
            letters = chr(ord(numbering) + letter) + letters
        return letters
    if numbering in "iI" and 0 < number < 4000:
        roman = ""
        for value, sign in _ROMANS:
            roman += sign * (number // value)
            number %= value
        return roman if numbering == "i" else roman.upper()
    return str(number)
