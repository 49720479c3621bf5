r"""Results of an analysis: tables, of which one description serves all files, figures, chapters.

>>> who = Column("participant", "participant", "pseudonym")
>>> share = Column("share", "share (%)", "right by answered", Kind.PERCENT)
>>> schema = Schema("shares", "Shares", "", (who, share))
>>> table = schema.fill([{"participant": "S1", "share": 0.5}])
>>> table.frame.dtypes["share"]
dtype('float64')
>>> to_csv(table.frame)
'participant,share\nS1,0.5\n'
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from decimal import MAX_PREC, ROUND_HALF_UP, Context, Decimal
from enum import Enum
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from vbraille.braille.spelling import UNREAD
from vbraille.errors import InputError
from vbraille.files import no_formula

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.pictures.charts import Chart

Value = str | int | float | None
Row = dict[str, Any]  # a row's values, by the columns' names
NOTE = "note"
OTHER = "."  # heading of the column of rare answers, as in the source
_DIGITS = 12  # more digits than a measurement has, fewer than rounding in binary spoils


class Kind(Enum):
    """Kind of a column's values, by which the report prints them; other files have all digits."""

    TEXT = "text"
    COUNT = "count"
    VALUE = "value"  # a number as short as it can be: the value of a parameter
    PERCENT = "percent"
    NUMBER = "number"
    TENTHS = "tenths"
    P = "p"


# Python strings: pandas may keep text in Arrow instead, which refuses undecodable file names.
_DTYPES = {Kind.TEXT: pd.StringDtype("python", na_value=np.nan), Kind.COUNT: pd.Int64Dtype()}
_FACTORS = {Kind.PERCENT: 100}
_DECIMALS = {
    Kind.PERCENT: 1,
    Kind.TENTHS: 1,
    Kind.NUMBER: 3,
    Kind.P: 3,
}


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table.

    Parameters
    ----------
    name
        Name of the column in CSV and JSON, with the unit: "duration_s".
    heading
        Heading of the column in the report, with the unit that is printed: "legibility (%)".
    meaning
        What the column holds, for the document.
    kind
        How the column's values are kept and printed.
    """

    name: str
    heading: str
    meaning: str
    kind: Kind = Kind.TEXT

    @property
    def dtype(self) -> Any:
        """Type of the column in a data frame; numbers that are no counts are float64."""
        return _DTYPES.get(self.kind, np.float64)


# Column of a table where a value may be missing: it says why.
NOTE_COLUMN = Column(NOTE, "note", "why a value is missing, or what to know of the row")
PARTICIPANT = Column("participant", "participant", "pseudonym")
CONDITION = Column("condition", "condition", "name, as in the protocol")
PROTOCOL = Column("protocol", "protocol", "name of the protocol")
SESSION = Column("session", "session", "name of the session")
TRIAL = Column("trial", "trial", "its number in the session", Kind.COUNT)
PARTICIPANTS = Column("participants", "participants", "how many", Kind.COUNT)


def ends(
    kind: Kind = Kind.NUMBER, name: str = "", heading: str = "", of: str = "95 % interval"
) -> tuple[Column, Column]:
    """Columns of the ends of an interval of the column before them.

    Parameters
    ----------
    name, heading
        What the names and the headings of the two begin with.
    of
        Words for the interval.
    """
    unit = " (%)" if kind is Kind.PERCENT else ""
    return (
        Column(f"{name}low", f"{heading}from{unit}", f"lower end of its {of}", kind),
        Column(f"{name}high", f"{heading}to{unit}", "upper end", kind),
    )


@dataclass(frozen=True, slots=True)
class Schema:
    """Description of a table before any trial: name, title, columns.

    Parameters
    ----------
    name
        Name of the table's CSV file, and its key in the JSON: "legibility".
    title
        What the table shows, in a line.
    about
        How the table's numbers were found, in sentences.
    columns
        Columns in their order.
    grows
        What further columns there are, where that depends on the trials; otherwise empty.
    empty
        Note of a table without rows that has no other.
    """

    name: str
    title: str
    about: str
    columns: tuple[Column, ...]
    grows: str = ""
    empty: str = ""

    @property
    def names(self) -> list[str]:
        """Names of the columns."""
        return [column.name for column in self.columns]

    def fill(
        self,
        rows: Sequence[Row] | pd.DataFrame,
        notes: Sequence[str] = (),
        more: Sequence[Column] = (),
        marks: Sequence[int] = (),
    ) -> ResultTable:
        """Make a table of these columns.

        Parameters
        ----------
        rows
            Values by the names of columns; a name that is left out is a missing value.
        notes, marks
            What they are in `ResultTable`.
        more
            Further columns after those of the schema.

        Raises
        ------
        ValueError
            If a row names an unknown column, or `ResultTable` refuses the rows.
        """
        schema = replace(self, columns=(*self.columns, *more))
        given = pd.DataFrame(rows)
        if unknown := set(given) - set(schema.names):
            raise ValueError(f"table {self.name} has no columns {unknown}")
        if not isinstance(rows, pd.DataFrame):
            _refuse_nan(self.name, rows)
        given = given.reindex(columns=schema.names)
        if NOTE in given:
            given[NOTE] = given[NOTE].astype(object).fillna("")
        frame = given.astype({column.name: column.dtype for column in schema.columns})
        if frame.empty and self.empty:
            notes = notes or (self.empty,)
        return ResultTable(schema, frame, tuple(notes), tuple(marks))


@dataclass(frozen=True, slots=True, eq=False)
class ResultTable:
    """A table of results: a schema, and rows that follow it.

    Parameters
    ----------
    schema
        What the columns are.
    frame
        The rows, each column of its `Column.dtype`; numbers are finite or missing.
    notes
        What cannot be said, with the reason; a table without rows has at least one note.
    marks
        Counts in ascending order, for a confusion matrix: errors above each of them are marked
        in the report. In such a table all columns of counts are answers, except the first: that
        is what was presented.

    Raises
    ------
    ValueError
        If a number is not finite, if a value is missing without a note, or if the table has
        neither rows nor notes.
    """

    schema: Schema
    frame: pd.DataFrame
    notes: tuple[str, ...] = ()
    marks: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.frame.empty and not self.notes:
            raise ValueError(f"table {self.name} has no rows, and no note that says why")
        endless = self.frame.select_dtypes("float64").abs().eq(math.inf).any(axis=1)
        self._refuse(endless, "has a number that is not finite")
        missing = self.frame.isna().any(axis=1)
        if NOTE in self.frame:
            missing &= self.frame[NOTE] == ""
        self._refuse(missing, "misses a value without a word")

    def _refuse(self, wrong: pd.Series, why: str) -> None:
        if wrong.any():
            row = tuple(self.frame[wrong].iloc[0])
            raise ValueError(f"table {self.name}: {row} {why}")

    def __len__(self) -> int:
        return len(self.frame)

    @property
    def name(self) -> str:
        """Name of the table; see `Schema`."""
        return self.schema.name

    @property
    def title(self) -> str:
        """Title of the table."""
        return self.schema.title

    @property
    def columns(self) -> tuple[Column, ...]:
        """Columns in their order."""
        return self.schema.columns

    @property
    def rows(self) -> tuple[tuple[Value, ...], ...]:
        """Values in the columns' order; None where one is missing."""
        return tuple(self._plain().itertuples(index=False, name=None))

    def records(self) -> list[Row]:
        """Row by row, by the columns' names; None where a value is missing."""
        names = self.schema.names
        return [dict(zip(names, row, strict=True)) for row in self.rows]

    def _plain(self) -> pd.DataFrame:
        return self.frame.astype(object).where(self.frame.notna(), None)

    def is_right(self, row: Sequence[Value], at: int) -> bool:
        """True if a column of a confusion matrix counts a row's right answers."""
        return bool(self.marks) and at > 0 and self.columns[at].heading == row[0]

    def wrong(self) -> list[tuple[int, str, str]]:
        """Wrong answers of a confusion matrix: how often, what was presented, what was answered."""
        return [
            (number, str(row[0]), column.heading)
            for row in self.rows
            for at, (number, column) in enumerate(zip(row, self.columns, strict=True))
            if at and isinstance(number, int) and number and not self.is_right(row, at)
        ]

    def gathered(self) -> ResultTable:
        """Confusion matrix as it is shown: rare answers that were never presented share a column.

        That column, `OTHER`, is the last, as in Lévesque 2009, table 4.1. An answer is rare if none
        of its counts is above the first of the marks. A single rare answer keeps its own column,
        and a table without marks keeps all.
        """
        if not self.marks:
            return self
        known = {*self.frame.iloc[:, 0], UNREAD}
        rare = [
            column
            for column in self.columns[1:]
            if column.heading not in known and not (self.frame[column.name] > self.marks[0]).any()
        ]
        if len(rare) < 2:
            return self
        other = Column(f"answered {OTHER}", OTHER, "times answered otherwise", Kind.COUNT)
        kept = [column for column in self.columns if column not in rare]
        about = (
            f"Column {OTHER} gathers {len(rare)} answers that were never presented, and for none "
            f"of the rows given more than {self.marks[0]} times: "
            f"{', '.join(column.heading for column in rare)}."
        )
        return replace(
            self,
            schema=replace(
                self.schema, columns=(*kept, other), about=f"{self.schema.about} {about}".strip()
            ),
            frame=self.frame[[column.name for column in kept]].assign(
                **{other.name: self.frame[[column.name for column in rare]].sum(axis=1)}
            ),
        )


def mean_or_none(values: Sequence[float]) -> float | None:
    """Mean of some values; None if there are none."""
    return float(np.mean(values)) if len(values) else None


def to_csv(frame: pd.DataFrame) -> str:
    """Text of a table as CSV: numbers in full precision, a missing value empty, no formulas."""
    safe = frame.copy(deep=False)
    for name, values in frame.select_dtypes(["object", "string", "category"]).items():
        texts = (text for text in values.unique() if isinstance(text, str))
        spelled = {text: cell for text in texts if (cell := no_formula(text)) != text}
        if spelled:
            safe[name] = values.map(lambda text, spelled=spelled: spelled.get(text, text))
    return safe.to_csv(index=False, lineterminator="\n")


def to_print(value: Value, kind: Kind) -> str:
    """Text of a value in the report. Numbers are rounded half up here, and only here.

    Rounding half to even would print 86.25 % as 86.2, where Lévesque 2009, table 3.1, has 86.3.

    >>> to_print(0.8625, Kind.PERCENT), to_print(2.0, Kind.VALUE), to_print(None, Kind.COUNT)
    ('86.3', '2', 'not known')
    """
    if value is None:
        return "not known"
    if isinstance(value, str):
        return value
    if kind not in _DECIMALS:
        return f"{value:g}" if isinstance(value, float) else str(value)
    if kind is Kind.P and value < 0.001:
        return "< 0.001"
    return round_half_up(value * _FACTORS.get(kind, 1), _DECIMALS[kind])


def round_half_up(value: float, decimals: int) -> str:
    """Text of a number rounded half away from 0, as if the decimal that is meant were exact."""
    exact = Decimal(f"{value:.{_DIGITS}g}")
    rounded = exact.quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP, Context(MAX_PREC))
    return f"{abs(rounded) if rounded == 0 else rounded}".replace("-", "−")


def _refuse_nan(table: str, rows: Sequence[Row]) -> None:
    """Raise ValueError for NaN, since a missing value is None."""
    for row in rows:
        if any(isinstance(value, float) and math.isnan(value) for value in row.values()):
            raise ValueError(f"table {table}: {row} has a number that is not finite")


@dataclass(frozen=True, slots=True)
class ShownTable:
    """A table of the report's first layer: headings, and rows of text."""

    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


def parameter_words(name: str) -> tuple[str, str]:
    """Words for a parameter or a level, and its unit after a space."""
    return name.removesuffix("_mm").replace("_", " "), " mm" if name.endswith("_mm") else ""


@dataclass(frozen=True, slots=True)
class ReportFigure:
    """A figure of the report.

    Parameters
    ----------
    name
        Name of its files: "legibility".
    title
        What the figure shows, in a line.
    text
        What is to be seen in it, in sentences, for readers who do not see it.
    table
        Name of the table that has the figure's numbers.
    chart
        Chart that is drawn.
    """

    name: str
    title: str
    text: str
    table: str
    chart: Chart


@dataclass(frozen=True, slots=True)
class Chapter:
    """A part of the report.

    Parameters
    ----------
    title
        Heading of the chapter.
    tables, figures
        What the chapter has, in order.
    """

    title: str
    tables: tuple[ResultTable, ...]
    figures: tuple[ReportFigure, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Results:
    """All that an analysis reports.

    Parameters
    ----------
    title
        Heading of the report.
    about
        What was analysed, as pairs of a word and a sentence: data, sessions, versions, rules.
    warnings
        What the reader must know before all numbers: damage, what is simulated.
    chapters
        Tables and figures, the primary analysis first.
    question
        Primary analysis in a line, and sentences on where it departs from what was planned.
    findings
        Result of the primary analysis, in sentences.
    shown
        Table of the result; None without a primary analysis.
    notes
        Reasons why something in that table is missing.
    main
        Name of the figure that is shown beside the findings; empty for none.
    methods
        Paragraph on what was done and how it was analysed.
    excluded
        What was left out, with the reasons, in clauses.
    trials
        Trials that were analysed, with all columns that were given; None if there were none.
    faults
        What is damaged in the sessions, in clauses.
    """

    title: str
    about: tuple[tuple[str, str], ...]
    warnings: tuple[str, ...]
    chapters: tuple[Chapter, ...]
    question: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()
    shown: ShownTable | None = None
    notes: tuple[str, ...] = ()
    main: str = ""
    methods: str = ""
    excluded: tuple[str, ...] = ()
    trials: pd.DataFrame | None = None
    faults: tuple[str, ...] = ()

    @property
    def tables(self) -> dict[str, pd.DataFrame]:
        """All tables as data frames, by name, in the order of the report."""
        return {table.name: table.frame for table in self.result_tables()}

    def table(self, name: str) -> pd.DataFrame:
        """One table as a data frame: docs/tables.md describes its columns.

        Raises
        ------
        InputError
            If there is no table of this name.
        """
        if name not in self.tables:
            raise InputError(f"there is no table {name!r}; there are {', '.join(self.tables)}")
        return self.tables[name]

    def plot(self, name: str = "") -> Any:
        """Draw a figure of the results: a `matplotlib.figure.Figure`.

        Parameters
        ----------
        name
            Name of one of `figures`; that of the primary analysis if it is empty.

        Raises
        ------
        InputError
            If there is no figure of this name, or no primary analysis.
        """
        from vbraille.pictures.drawcharts import draw_chart  # loads matplotlib

        drawn = {figure.name: figure for figure in self.figures()}
        if (name or self.main) not in drawn:
            raise InputError(
                f"there is no figure {name or 'of a primary analysis'!r}; there are "
                f"{', '.join(drawn) or 'none'}"
            )
        return draw_chart(drawn[name or self.main].chart)

    def _repr_html_(self) -> str:
        """Results for a notebook: title, warnings and findings as a list, and their table."""
        told = "".join(f"<li>{escape(each)}</li>" for each in (*self.warnings, *self.findings))
        table = ""
        if self.shown is not None:
            rows = pd.DataFrame(self.shown.rows, columns=[*self.shown.headings])
            table = rows.to_html(index=False, border=0)
        return f"<h3>{escape(self.title)}</h3><ul>{told}</ul>{table}"

    def result_tables(self) -> Iterator[ResultTable]:
        """All tables with titles, columns and notes, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.tables

    def figures(self) -> Iterator[ReportFigure]:
        """All figures, in the order of the report."""
        for chapter in self.chapters:
            yield from chapter.figures
