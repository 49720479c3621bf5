"""What the page and the text have in common: which rows they show, in which words."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.analysis.schemas import NOTE, Kind, to_print

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.analysis.results import ReportFigure
    from vbraille.analysis.schemas import ResultTable, Value

ROWS = 60  # of a table that a report shows: more are heard by nobody, and its CSV has all
WARNINGS = "Read this first"
FINDINGS = "What was found"
ABOUT = "Data, versions and what was left out"
KINDS = ("svg", "png", "pdf")  # of a figure's files
ABOVE = "This figure stands at the head of the report:"
CONTENTS = "Contents"
UNKNOWN = "What cannot be said here"
NO_ROWS = "This table has no rows."
FILES = "Files beside this report"


def in_report(table: ResultTable) -> ResultTable:
    """Return the table without its notes, if no row has one: empty cells are a noise in speech.

    Of a confusion matrix rare answers are gathered.
    """
    table = table.gathered()
    if not table.rows or table.columns[-1].name != NOTE or any(row[-1] for row in table.rows):
        return table
    kept = tuple(row[:-1] for row in table.rows)
    return replace(table, columns=table.columns[:-1], rows=kept)


def rows(table: ResultTable) -> Sequence[tuple[Value, ...]]:
    """Rows that are shown."""
    return table.rows[:ROWS]


def caption(table: ResultTable) -> str:
    """Title of a table, and how many rows it has."""
    return f"{table.title}: {_count(table)}"


def numbers(table: ResultTable) -> str:
    """Where all of a table is, before the name of its file."""
    if len(table.rows) > ROWS:
        return f"Shown are {_count(table)}. All rows, in full precision:"
    return "In full precision:"


def marking(table: ResultTable) -> str:
    """How errors of a confusion matrix are marked; empty if none are."""
    if not table.marks:
        return ""
    above = " and ".join(f"above {mark}" for mark in table.marks)
    return f"Marked are counts of wrong answers {above}."


def heads(table: ResultTable) -> int:
    """How many of the first columns head a row: the fewest of words that tell the rows apart."""
    words = 1
    while words < len(table.columns) and table.columns[words].kind is Kind.TEXT:
        if table.columns[words].name == NOTE or _tell_apart(table, words):
            break
        words += 1
    return words


def values(table: ResultTable, row: Sequence[Value]) -> list[str]:
    """Texts of a row, a missing value in words."""
    return [to_print(value, column.kind) for value, column in zip(row, table.columns, strict=True)]


def alternative(figure: ReportFigure) -> str:
    """What stands for a figure, next to its text."""
    return f"Figure: {figure.title}. What it shows is told beside it."


def csv_name(table: ResultTable) -> str:
    """Path of a table's file in the report's directory."""
    return f"tables/{table.name}.csv"


def figure_name(figure: ReportFigure, kind: str) -> str:
    """Path of a figure's file in the report's directory."""
    return f"figures/{figure.name}.{kind}"


def _tell_apart(table: ResultTable, columns: int) -> bool:
    return len({row[:columns] for row in table.rows}) == len(table.rows)


def _count(table: ResultTable) -> str:
    if len(table.rows) > ROWS:
        return f"the first {ROWS} of {len(table.rows)} rows"
    return "1 row" if len(table.rows) == 1 else f"{len(table.rows)} rows"
