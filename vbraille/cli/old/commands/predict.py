"""``vbraille predict``."""

from __future__ import annotations

import csv
import io
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import WorkProgress, print_json, say_line
from vbraille.files import check_free, write_folder
from vbraille.forecast.grids import predict, to_json
from vbraille.forecast.workers import Workers

if TYPE_CHECKING:
    import argparse

    from vbraille.forecast.grids import Prediction


def run(arguments: argparse.Namespace) -> int:
    """Ask the simulated reader about each point of a grid."""
    out = None if arguments.out is None else Path(arguments.out)
    if out is not None:
        check_free(out)
    workers = Workers(arguments.workers)
    keep = None if arguments.keep is None else Path(arguments.keep)
    progress = WorkProgress(verbose=arguments.verbose)
    grid, found, ended = predict(arguments.grid, workers, keep=keep, report=progress.of)
    if out is not None:
        write_folder(out, {"predictions.csv": _csv(found).encode()})
    if arguments.json:
        print_json(to_json(grid, found), indent=1)
    elif arguments.csv:
        sys.stdout.write(_csv(found))
    else:
        say_line("predicted: by the simulated reader, no data about people")
        for one in found:
            where = ", ".join(f"{name} {value}" for name, value in one.point.items())
            say_line(f"{where}: {100 * one.legibility:.1f} % of the characters right")
        if out is not None:
            say_line(f"written: {out / 'predictions.csv'}")
    if ended is not None:
        sys.stdout.flush()
        raise ended
    return 0


def _csv(found: list[Prediction]) -> str:
    out = io.StringIO()
    rows = csv.DictWriter(out, list(found[0].row()), lineterminator="\n")
    rows.writeheader()
    rows.writerows(one.row() for one in found)
    return out.getvalue()
