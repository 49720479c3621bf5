"""Figures of confusion matrices, with what they show in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.input.trials import UNREAD, times
from vbraille.analysis.results import ReportFigure
from vbraille.analysis.schemas import OTHER
from vbraille.pictures.charts import Matrix
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.analysis.schemas import ResultTable

MOST_ROWS = 30  # rows of a matrix that fits upon A4


def confusion(table: ResultTable) -> ReportFigure:
    """Matrix of counts: Lévesque 2009, tables 3.4, 3.5 and 4.1.

    If there are more rows than a page has room for, the figure shows those with the most errors.
    """
    shown = table.gathered()
    errors = table.wrong()
    text = "No answer was wrong."
    if errors:
        worst = sorted(errors, key=lambda error: -error[0])[:3]
        said = "; ".join(
            f"{row} for which {column} was answered, {times(n)}" for n, row, column in worst
        )
        text = f"{count(len(errors), 'kind')} of confusion. Most frequent: {said}."
    headings = [column.heading for column in shown.columns[1:]]
    rows, columns, part = list(shown.rows), list(range(len(headings))), ""
    if len(rows) > MOST_ROWS:
        rows, columns = _worst(shown)
        part = (
            f" Of {len(shown.rows)} rows the figure has the {len(rows)} with the most errors, and "
            f"the {len(columns)} most frequent answers to them."
        )
    names = [headings[at] for at in columns]
    known = {name: at for at, name in enumerate(names)}
    return ReportFigure(
        table.name,
        table.title,
        f"Rows are what was presented, columns what was answered; {UNREAD} is not read."
        f"{_other(shown, table)}{part} {text}",
        table.name,
        Matrix(
            table.title,
            "presented",
            "answered",
            tuple(str(row[0]) for row in rows),
            tuple(names),
            tuple(tuple(_whole(row[at + 1]) for at in columns) for row in rows),
            table.marks,
            tuple(known.get(str(row[0])) for row in rows),
        ),
    )


def _worst(table: ResultTable) -> tuple[list[tuple], list[int]]:
    """Rows of a matrix with the most errors, in their order, and the columns they use most."""
    wrong = [
        sum(_whole(count) for at, count in enumerate(row) if at and not table.is_right(row, at))
        for row in table.rows
    ]
    chosen = sorted(sorted(range(len(wrong)), key=lambda n: -wrong[n])[:MOST_ROWS])
    rows = [table.rows[n] for n in chosen]
    used = [sum(_whole(row[at]) for row in rows) for at in range(1, len(table.columns))]
    columns = sorted(sorted(range(len(used)), key=lambda at: -used[at])[:MOST_ROWS])
    return rows, columns


def _other(shown: ResultTable, table: ResultTable) -> str:
    if shown is table:
        return ""
    number = len(table.columns) - len(shown.columns) + 1
    return f" {OTHER} gathers {number} rare answers that were never presented."


def _whole(value: object) -> int:
    return value if isinstance(value, int) else 0
