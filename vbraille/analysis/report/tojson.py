"""Results as JSON: all numbers in full precision."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from vbraille.analysis.results import Results
    from vbraille.analysis.tables import Table


def to_json(results: Results) -> str:
    """Text of the results, in the report's order; a missing value is null."""
    content: dict[str, Any] = {
        "title": results.title,
        "about": dict(results.about),
        "warnings": results.warnings,
        "tables": {table.name: _table(table) for table in results.tables()},
        "figures": {
            picture.name: {"title": picture.title, "text": picture.text, "table": picture.table}
            for picture in results.pictures()
        },
    }
    return json.dumps(content, ensure_ascii=False, allow_nan=False, indent=1) + "\n"


def _table(table: Table) -> dict[str, Any]:
    return {
        "title": table.title,
        "about": table.about,
        "columns": {column.name: column.meaning for column in table.columns},
        "notes": table.notes,
        "rows": table.records(),
    }
