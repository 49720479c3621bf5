"""What the page and the text have in common: which rows they show, in which words."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.analysis.schemas import NOTE, Kind, to_print
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.analysis.results import ReportFigure
    from vbraille.analysis.schemas import ResultTable, Value

ROWS = 60  # rows of a table that a report shows: nobody listens to more, and the CSV has all
WARNINGS = "Read this first"
FINDINGS = "What was found"
ABOUT = "Data, versions and what was left out"
KINDS = ("svg", "png", "pdf")  # kinds of files that a figure is written as
ABOVE = "This figure stands at the head of the report:"
CONTENTS = "Contents"
UNKNOWN = "What cannot be said here"
NO_ROWS = "This table has no rows."
FILES = "Files beside this report"


def in_report(table: ResultTable) -> ResultTable:
    """Return the table as it is shown: empty notes left out, as empty cells are noise in speech.

    In a confusion matrix rare answers are gathered.
    """
    table = table.gathered()
    if not len(table) or table.columns[-1].name != NOTE or table.frame[NOTE].any():
        return table
    schema = replace(table.schema, columns=table.columns[:-1])
    return replace(table, schema=schema, frame=table.frame.drop(columns=NOTE))


def rows(table: ResultTable) -> Sequence[tuple[Value, ...]]:
    """Rows of a table that the report shows."""
    return replace(table, frame=table.frame.head(ROWS)).rows


def caption(table: ResultTable) -> str:
    """Title of a table, with the number of its rows."""
    return f"{table.title}: {_how_many(table)}"


def numbers(table: ResultTable) -> str:
    """Sentence on where all rows of a table are; the name of the file follows it."""
    if len(table) > ROWS:
        return f"Shown are {_how_many(table)}. All rows, in full precision:"
    return "In full precision:"


def marking(table: ResultTable) -> str:
    """Sentence on how errors of a confusion matrix are marked; empty if none are."""
    if not table.marks:
        return ""
    above = " and ".join(f"above {mark}" for mark in table.marks)
    return f"Marked are counts of wrong answers {above}."


def heads(table: ResultTable) -> int:
    """Number of first columns that head a row: the fewest columns of words that tell rows apart."""
    words = 1
    while words < len(table.columns) and table.columns[words].kind is Kind.TEXT:
        if table.columns[words].name == NOTE or _tell_apart(table, words):
            break
        words += 1
    return words


def values(table: ResultTable, row: Sequence[Value]) -> list[str]:
    """Texts of a row's values, a missing one in words."""
    return [to_print(value, column.kind) for value, column in zip(row, table.columns, strict=True)]


def alternative(figure: ReportFigure) -> str:
    """Words that stand for a figure, next to its text."""
    return f"Figure: {figure.title}. What it shows is told beside it."


def csv_name(table: ResultTable) -> str:
    """Path of a table's file in the report's directory."""
    return f"tables/{table.name}.csv"


def figure_name(figure: ReportFigure, kind: str) -> str:
    """Path of a figure's file in the report's directory."""
    return f"figures/{figure.name}.{kind}"


def _tell_apart(table: ResultTable, columns: int) -> bool:
    return not table.frame.iloc[:, :columns].duplicated().any()


def _how_many(table: ResultTable) -> str:
    if len(table) > ROWS:
        return f"the first {ROWS} of {len(table)} rows"
    return count(len(table), "row")
