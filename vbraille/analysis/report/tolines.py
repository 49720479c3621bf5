"""Results one line a thing, for a terminal that speaks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.report.shown import ROWS
from vbraille.analysis.schemas import NOTE, to_print
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.analysis.results import Results
    from vbraille.analysis.schemas import Column, ResultTable, Value

_UNIT = " (%)"


def to_lines(results: Results) -> Iterator[str]:
    """Lines of text, each of them a heading or a row.

    A row says its first columns as they are, the others with their headings. Of tables with over
    `ROWS` rows only the number of rows is told. What each number means is left to the report.
    """
    yield results.title
    for warning in results.warnings:
        yield f"warning: {warning}"
    for finding in results.findings:
        yield f"found: {finding}"
    for word, sentence in results.about:
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
    if column.heading.endswith(_UNIT):
        return f"{column.heading.removesuffix(_UNIT)} {text} %"
    return f"{column.heading} {text}"
