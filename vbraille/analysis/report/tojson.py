"""Results as JSON: all numbers in full precision."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.results import Results
    from vbraille.analysis.schemas import ResultTable

# One value a line, for whoever compares two files; json's own indenting takes ten times as long.
_SEPARATOR = ",\n"
_ENCODE = json.JSONEncoder(
    ensure_ascii=False, allow_nan=False, separators=(_SEPARATOR, ": ")
).encode
_AT_ONCE = 5_000  # rows


def to_json(results: Results) -> Iterator[str]:
    """Text of the results, table by table in the report's order; a missing value is null."""
    head = {
        "title": results.title,
        "warnings": results.warnings,
        "findings": results.findings,
        "about": dict(results.about),
        "main_figure": results.main or None,
        "figures": {
            figure.name: {"title": figure.title, "text": figure.text, "table": figure.table}
            for figure in results.figures()
        },
    }
    yield f'{_ENCODE(head)[:-1]},\n"tables": {{'
    for number, table in enumerate(results.result_tables()):
        yield f"{',' * bool(number)}\n{_ENCODE(table.name)}: "
        yield from _table(table)
    yield "}}\n"


def _table(table: ResultTable) -> Iterator[str]:
    """Text of a table, some rows at a time: all at once take much memory."""
    head = {
        "title": table.title,
        "about": table.schema.about,
        "columns": {column.name: column.meaning for column in table.columns},
        "notes": table.notes,
    }
    yield f'{_ENCODE(head)[:-1]},\n"rows": ['
    for first in range(0, len(table), _AT_ONCE):
        part = replace(table, frame=table.frame.iloc[first : first + _AT_ONCE])
        yield f"{_SEPARATOR * bool(first)}{_ENCODE(part.records())[1:-1]}"
    yield "]}"
