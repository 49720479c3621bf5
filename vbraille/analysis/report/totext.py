"""Results as JSON, with all numbers in full precision; and one line a thing, for a terminal."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.analysis.results import NOTE, to_print
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.results import Column, Results, ResultTable, Value

ROWS = 60  # rows of a table that a terminal shows: more is too long to listen to
# One value a line, so that two files can be compared; json's own indenting takes ten times as long.
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
        "question": results.question,
        "findings": results.findings,
        "methods": results.methods,
        "excluded": results.excluded,
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
        yield from _json_table(table)
    yield "}}\n"


def _json_table(table: ResultTable) -> Iterator[str]:
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


def to_lines(results: Results) -> Iterator[str]:
    """Lines of text, each of them a heading or a row.

    A row says its first columns as they are, the others with their headings. Of tables with over
    `ROWS` rows only the number of rows is told. What each number means is left to the report.
    """
    yield results.title
    for warning in results.warnings:
        yield f"warning: {warning}"
    for word, sentences in (
        ("question", results.question),
        ("found", results.findings),
        ("methods", (results.methods,) if results.methods else ()),
        ("left out", results.excluded),
    ):
        for sentence in sentences:
            yield f"{word}: {sentence}"
    for chapter in results.chapters:
        for table in chapter.tables:
            yield f"table {table.name}: {table.title}"
            yield from _rows(table)
            for note in table.notes:
                yield f"note: {note}"


def _rows(table: ResultTable) -> Iterator[str]:
    if len(table) > ROWS:
        yield f"{len(table)} rows; {setting('out')} writes them"
        return
    for row in table.rows:
        said = (
            _said(column, value)
            for column, value in zip(table.columns, row, strict=True)
            if value is not None and value != "" and not (table.marks and value == 0)
        )
        yield "; ".join(said)


def _said(column: Column, value: Value) -> str:
    text = to_print(value, column.kind)
    if column.name == NOTE:
        return text
    if column.heading.endswith(" (%)"):
        return f"{column.heading.removesuffix(' (%)')} {text} %"
    return f"{column.heading} {text}"
