"""The codebook of a report: what each column of each of its CSV files holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.report.shown import csv_name
from vbraille.analysis.schemas import Kind
from vbraille.sessions.record.codebook import CodebookEntry, entry_of, to_codebook, unit_of

if TYPE_CHECKING:
    from vbraille.analysis.results import Results
    from vbraille.analysis.schemas import Column, ResultTable

_UNITS = {Kind.PERCENT: "share, 1 = 100 %", Kind.SECONDS: "s", Kind.COUNT: "count"}
_FEW = 12  # values of a column of text that are listed


def codebook(results: Results, trials: str) -> str:
    """Text of the codebook, as CSV.

    Parameters
    ----------
    trials
        Name of the file that has the trials.
    """
    files = {} if results.trials is None else {trials: [entry_of(str(n)) for n in results.trials]}
    for table in results.result_tables():
        files[csv_name(table)] = [_entry(table, column) for column in table.columns]
    return to_codebook(files)


def _entry(table: ResultTable, column: Column) -> CodebookEntry:
    values: dict[str, str] = {}
    if column.kind is Kind.TEXT:
        there = [str(value) for value in table.frame[column.name].dropna().unique() if value]
        values = dict.fromkeys(there if len(there) <= _FEW else (), "")
    unit = unit_of(column.name) or _UNITS.get(column.kind, "")
    return CodebookEntry(column.name, column.meaning, unit, values)
