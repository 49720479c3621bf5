"""Tables of results: one description for the CSV, the JSON, the report and the document."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass, replace
from decimal import MAX_PREC, ROUND_HALF_UP, Context, Decimal
from enum import Enum
from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import UNREAD

if TYPE_CHECKING:
    from collections.abc import Sequence

Value = str | int | float | None
Row = dict[str, Any]  # a row's values, by the columns' names
NOTE = "note"
OTHER = "."  # heads the column of rare answers, as in the source
_DIGITS = 12  # more than a measurement has, fewer than rounding in binary spoils


class Kind(Enum):
    """How a column's values are printed; its CSV and JSON have them in full.

    The value is the number of decimals, after the factor of `_FACTORS`.
    """

    TEXT = "text"
    COUNT = "count"
    PERCENT = "percent"
    SECONDS = "seconds"
    NUMBER = "number"
    SPEED = "speed"
    P = "p"


_FACTORS = {Kind.PERCENT: 100}
_DECIMALS = {
    Kind.PERCENT: 1,
    Kind.SECONDS: 1,
    Kind.SPEED: 1,
    Kind.NUMBER: 3,
    Kind.P: 3,
}


@dataclass(frozen=True, slots=True)
class Column:
    """One column.

    Parameters
    ----------
    name
        In CSV and JSON, with the unit: "duration_s".
    heading
        In the report, with the unit that is printed: "legibility (%)".
    meaning
        What it holds, for the document.
    kind
        How its values are printed.
    """

    name: str
    heading: str
    meaning: str
    kind: Kind = Kind.TEXT


# Where a value may be missing: why it is.
NOTE_COLUMN = Column(NOTE, "note", "why a value is missing, or what to know of the row")


@dataclass(frozen=True, slots=True)
class ResultTable:
    """Rows of one kind.

    Parameters
    ----------
    name
        Of its CSV file and its key in the JSON: "legibility".
    title
        What it shows, in a line.
    about
        How its numbers were found, in sentences.
    columns
        In their order.
    rows
        Values in the columns' order; numbers are finite, and None is a value that is not known.
    notes
        What cannot be said, with the reason; for a table without rows at least one.
    marks
        Of a confusion matrix, in ascending order: errors above each are marked in the report.
        All columns of counts are answers then, but for the first column, what was presented.

    Raises
    ------
    ValueError
        If a row has another length, a number that is not finite or a missing value without
        a word, or a table has neither rows nor notes.
    """

    name: str
    title: str
    about: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Value, ...], ...]
    notes: tuple[str, ...] = ()
    marks: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if not self.rows and not self.notes:
            raise ValueError(f"table {self.name} has no rows, and no note that says why")
        noted = self.names.index(NOTE) if NOTE in self.names else None
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(f"table {self.name}: {row} has not {len(self.columns)} values")
            if not math.isfinite(sum([value for value in row if isinstance(value, float)])):
                raise ValueError(f"table {self.name}: {row} has a number that is not finite")
            if None in row and (noted is None or not row[noted]):
                raise ValueError(f"table {self.name}: {row} misses a value without a word")

    @property
    def names(self) -> tuple[str, ...]:
        """Of the columns."""
        return tuple(column.name for column in self.columns)

    def column(self, name: str) -> list[Value]:
        """Values of a column."""
        at = self.names.index(name)
        return [row[at] for row in self.rows]

    def records(self) -> list[Row]:
        """Row by row, by the columns' names."""
        names = self.names
        return [dict(zip(names, row, strict=True)) for row in self.rows]

    def is_right(self, row: Sequence[Value], at: int) -> bool:
        """Whether a column of a confusion matrix has a row's right answers."""
        return bool(self.marks) and at > 0 and self.columns[at].heading == row[0]

    def mark(self, row: Sequence[Value], at: int) -> int | None:
        """Largest of `marks` that a row's count of a wrong answer is above; None if none is."""
        count = row[at]
        answers = at > 0 and self.columns[at].kind is Kind.COUNT and not self.is_right(row, at)
        if not answers or not isinstance(count, int):
            return None
        return max((mark for mark in self.marks if count > mark), default=None)

    def gathered(self) -> ResultTable:
        """Confusion matrix as it is shown: rare answers that were never presented in one column.

        That is the last, `OTHER`, as in Lévesque 2009, table 4.1. An answer is rare if none of its
        counts is above the first of the marks. Where an answer for itself would be no more
        than that column it stays; a table without marks does.
        """
        if not self.marks:
            return self
        known = {row[0] for row in self.rows} | {UNREAD}
        rare = [
            at
            for at, column in enumerate(self.columns)
            if at > 0
            and column.heading not in known
            and all(self.mark(row, at) is None for row in self.rows)
        ]
        if len(rare) < 2:
            return self
        kept = [at for at in range(len(self.columns)) if at not in set(rare)]
        names = ", ".join(self.columns[at].heading for at in rare)
        other = Column(f"answered {OTHER}", OTHER, "times answered otherwise", Kind.COUNT)
        rows = tuple(
            (*(row[at] for at in kept), sum(_count(row[at]) for at in rare)) for row in self.rows
        )
        about = (
            f"Column {OTHER} gathers {len(rare)} answers that were never presented, and for none "
            f"of the rows given more than {self.marks[0]} times: {names}."
        )
        return replace(
            self,
            about=f"{self.about} {about}".strip(),
            columns=(*(self.columns[at] for at in kept), other),
            rows=rows,
        )

    def to_csv(self) -> str:
        """Text of its CSV: full precision, a missing value empty."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.names)
        writer.writerows(
            ["" if value is None else _plain(value) for value in row] for row in self.rows
        )
        return text.getvalue()


@dataclass(frozen=True, slots=True)
class Schema:
    """What a table has in every analysis: name, title and columns are known before any trial.

    Parameters
    ----------
    name, title, about, columns
        As of `ResultTable`.
    grows
        What the columns after these are, where that depends on the trials; else empty.
    """

    name: str
    title: str
    about: str
    columns: tuple[Column, ...]
    grows: str = ""

    def fill(
        self,
        rows: Sequence[Row],
        notes: Sequence[str] = (),
        more: Sequence[Column] = (),
    ) -> ResultTable:
        """Make a table of rows by the columns' names; a name left out is a missing value."""
        columns = (*self.columns, *more)
        names = [column.name for column in columns]
        empty: Row = {name: "" if name == NOTE else None for name in names}
        filled = []
        for row in rows:
            whole = empty | row
            if len(whole) > len(names):
                raise ValueError(f"table {self.name} has no columns {row.keys() - set(names)}")
            filled.append(tuple(whole.values()))
        return ResultTable(self.name, self.title, self.about, columns, tuple(filled), tuple(notes))


def to_print(value: Value, kind: Kind) -> str:
    """Text of a value in the report; numbers are rounded half up, which nothing else is.

    Half to even would print 86.25 % as 86.2, where Lévesque 2009, table 3.1, has 86.3.
    """
    if value is None:
        return "not known"
    if isinstance(value, str):
        return value
    if kind in (Kind.TEXT, Kind.COUNT):
        return f"{value:g}" if isinstance(value, float) else str(value)
    decimals = _DECIMALS[kind]
    if kind is Kind.P and value < 0.001:
        return "< 0.001"
    return round_half_up(value * _FACTORS.get(kind, 1), decimals)


def round_half_up(value: float, decimals: int) -> str:
    """Text of a number rounded half away from 0: of the decimal that was meant, not the binary."""
    exact = Decimal(f"{value:.{_DIGITS}g}")
    rounded = exact.quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP, Context(MAX_PREC))
    return f"{abs(rounded) if rounded == 0 else rounded}".replace("-", "−")


def _count(value: Value) -> int:
    return value if isinstance(value, int) else 0


def _plain(value: Any) -> Any:
    return repr(float(value)) if isinstance(value, float) else value
