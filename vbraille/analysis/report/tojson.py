"""Results as JSON: all numbers in full precision."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.results import Results
    from vbraille.analysis.schemas import ResultTable

# One value a line, for whoever compares two files; json's own indenting takes ten times as long.
_ENCODE = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",\n", ": ")).encode


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
        yield _ENCODE(_table(table))
    yield "}}\n"


def _table(table: ResultTable) -> dict[str, Any]:
    return {
        "title": table.title,
        "about": table.schema.about,
        "columns": {column.name: column.meaning for column in table.columns},
        "notes": table.notes,
        "rows": table.records(),
    }
