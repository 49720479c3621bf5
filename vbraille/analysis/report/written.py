"""The report's directory: whole, or not at all; with a codebook of its tables' columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.report.tohtml import KINDS, csv_name, figure_name, to_html
from vbraille.analysis.report.totext import to_json
from vbraille.analysis.results import Kind, to_csv
from vbraille.analysis.sharing import shared
from vbraille.files import check_free, write_folder
from vbraille.sessions.record.codebook import CodebookEntry, entry_of, to_codebook, unit_of
from vbraille.sessions.record.export import encode

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from vbraille.analysis.results import Column, ReportFigure, Results, ResultTable

PAGE, NUMBERS = "report.html", "results.json"
TRIALS = "trials.csv"
CODEBOOK = "codebook.csv"
_UNITS = {Kind.PERCENT: "share, 1 = 100 %", Kind.COUNT: "count"}
_FEW = 12  # values of a column of text that are listed
_DPI = 300  # dots per inch of the PNGs, as journals ask for


def write_report(
    results: Results, folder: Path, *, mark: Callable[[str], str] | None = None
) -> list[Path]:
    """Make a directory of the report, its numbers and its figures; give the files in their order.

    Parameters
    ----------
    folder
        Directory that does not exist yet, or is empty.
    mark
        Function that the text of each table goes through before it is written; None to write
        tables as they are.

    Raises
    ------
    InputError
        If there is something at this path already, or no directory can be made there.
    VbrailleError
        If the disk cannot take the report; then nothing is left of it.
    """
    folder = folder.absolute()
    check_free(folder)  # checked before the figures are drawn, which takes a while
    files = _files(results)
    if mark is not None:
        tables = {name: text for name, text in files.items() if name.endswith(".csv")}
        files |= {name: encode(mark(text.decode("utf-8"))) for name, text in tables.items()}
    # Not flushed to the disk as a session is: a report can be made again.
    write_folder(folder, files)
    return [folder / name for name in files]


def _files(results: Results) -> dict[str, bytes]:
    """Contents of all files, by their paths in the directory."""
    # Imported before processes share it: matplotlib takes longer to load than a figure to draw.
    import vbraille.pictures.drawcharts
    import vbraille.pictures.figurefiles  # noqa: F401

    trials = {} if results.trials is None else {TRIALS: encode(to_csv(results.trials))}
    drawn: dict[str, bytes] = {}
    svgs: dict[str, bytes] = {}
    # That of the result is for a paper; the others are to be looked at.
    figures = [(figure, figure.name == results.main) for figure in results.figures()]
    for (figure, main), files in zip(figures, shared(_drawn, figures), strict=True):
        drawn |= files
        if main:
            svgs[figure.name] = drawn[figure_name(figure, "svg")]
    return {
        PAGE: encode(to_html(results, svgs, (NUMBERS, *trials, CODEBOOK))),
        NUMBERS: b"".join(encode(part) for part in to_json(results)),
        **trials,
        CODEBOOK: encode(codebook(results, TRIALS)),
        **{csv_name(table): encode(to_csv(table.frame)) for table in results.result_tables()},
        **drawn,
    }


def _drawn(drawing: tuple[ReportFigure, bool]) -> dict[str, bytes]:
    """Files of a figure, by their paths; of a main one in all kinds."""
    from vbraille.pictures.drawcharts import draw_chart
    from vbraille.pictures.figurefiles import to_bytes

    figure, main = drawing
    drawn = draw_chart(figure.chart)
    return {
        figure_name(figure, kind): to_bytes(drawn, kind, _DPI)
        for kind in (KINDS if main else KINDS[:1])
    }


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
