"""The codebook: what each column of each table holds."""

from __future__ import annotations

from pathlib import Path

from pandas import DataFrame

from vbraille.csvfiles import read_csv

MOST_VALUES = 12
MEANINGS = dict(read_csv(Path(__file__).with_name("columns.csv")).rows)


def codebook(tables: dict[str, DataFrame]) -> DataFrame:
    """Return a row for each column of each table: its meaning, and its values if they are few."""
    from vbraille.sessions.record.trials import COLUMNS

    of_trials = MEANINGS | {name: column.meaning for name, column in COLUMNS.items()}
    rows = []
    for name, table in tables.items():
        own = of_trials if name == "trials" else MEANINGS
        for column in map(str, table):
            known = table[column].dropna().unique()
            text = table[column].dtype.kind not in "fiub" and len(known) <= MOST_VALUES
            values = "; ".join(sorted(map(str, known))) if text else ""
            rows.append((name, column, own.get(column) or _other(name, column), values))
    return DataFrame(rows, columns=["table", "column", "meaning", "values"])


def _other(table: str, column: str) -> str:
    """Return the meaning of a column that has the name of a cell, a factor or an answer."""
    if table.startswith(("confusion", "answers")):
        return f"answers {column}"
    if table == "primary_people":
        return f"value in the cell {column}"
    return "column of the trials as they were given"
