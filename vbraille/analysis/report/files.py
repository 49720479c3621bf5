"""The report's directory: whole, or not at all."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.analysis.report.shown import KINDS, csv_name, figure_name
from vbraille.analysis.report.tohtml import to_html
from vbraille.analysis.report.tojson import to_json
from vbraille.analysis.report.tomarkdown import to_markdown
from vbraille.files import check_free, write_folder
from vbraille.sessions.record.export import encode

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.analysis.results import Results

PAGE, TEXT, NUMBERS = "report.html", "report.md", "results.json"
_DPI = 300  # of the PNGs: what a journal asks for


def write_report(
    results: Results, folder: Path, extra: Mapping[str, bytes] | None = None
) -> list[Path]:
    """Make a directory with the report, its numbers and its figures; the files, in their order.

    Parameters
    ----------
    folder
        Not there yet, or empty.
    extra
        Contents of other files, by their paths in the directory; the report links to them.

    Raises
    ------
    InputError
        If there is something already, or no directory can be made there.
    VbrailleError
        If the disk does not take it; nothing is left then.
    """
    folder = folder.absolute()
    check_free(folder)  # before the figures are drawn, which takes a while
    files = _files(results, extra or {})
    # Not forced onto the disk, as a session is: a report can be made again.
    write_folder(folder, files)
    return [folder / name for name in files]


def _files(results: Results, extra: Mapping[str, bytes]) -> dict[str, bytes]:
    """Contents of all files, by their paths in the directory."""
    # Here, as matplotlib takes longer to import than all else to be written.
    from vbraille.pictures.drawcharts import draw_chart
    from vbraille.pictures.figurefiles import to_bytes

    drawn: dict[str, bytes] = {}
    svgs: dict[str, bytes] = {}
    for figure in results.figures():
        drawing = draw_chart(figure.chart)
        for kind in KINDS:
            drawn[figure_name(figure, kind)] = to_bytes(drawing, kind, _DPI)
        svgs[figure.name] = drawn[figure_name(figure, "svg")]
    return {
        PAGE: encode(to_html(results, svgs, (TEXT, NUMBERS, *extra))),
        TEXT: encode(to_markdown(results, (PAGE, NUMBERS, *extra))),
        NUMBERS: encode("".join(to_json(results))),
        **extra,
        **{csv_name(table): encode(table.to_csv()) for table in results.tables()},
        **drawn,
    }
