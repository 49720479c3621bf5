"""``vbraille analyse``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.analysis import analyse, analyse_scores
from vbraille.cli.old.terminal import WorkProgress
from vbraille.errors import InputError, VbrailleError
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from vbraille.analysis.results import Results


def run(arguments: argparse.Namespace) -> int:
    """Analyse sessions or tables; print the results, or write a report."""
    if bool(arguments.paths) == (arguments.scores is not None):
        raise InputError(
            "give directories of sessions, or a table of trials, or --scores with a table of scores"
        )
    for who, reason in arguments.exclude.items():
        if not reason.strip():
            raise InputError(f"--exclude {who} has no reason; give one: --exclude {who}=REASON")
    folder = None if arguments.out is None else Path(arguments.out)
    if folder is not None:
        from vbraille.files import check_free

        check_free(folder)
    writing = folder is not None
    progress = WorkProgress(verbose=arguments.verbose)
    results = _analysed(arguments, lambda done, parts: progress.of(done, parts + writing))
    if folder is not None:
        from vbraille.analysis.report.written import write_report

        write_report(results, folder)
        progress.at(1.0)
    if arguments.json:
        from vbraille.analysis.report.totext import to_json

        sys.stdout.writelines(to_json(results))
    elif folder is not None:
        print(printable(f"written: {folder / 'report.html'}"))
    else:
        from vbraille.analysis.report.totext import to_lines

        for line in to_lines(results):
            print(printable(spelled(line)))
    if results.faults:
        raise VbrailleError(f"analysed is what is whole; {'; '.join(results.faults)}")
    return 0


def _analysed(arguments: argparse.Namespace, report: Callable[[int, int], None]) -> Results:
    correction, seed = arguments.correction, arguments.seed
    if arguments.scores is None:
        return analyse(
            arguments.paths,
            exclude=arguments.exclude,
            protocol=arguments.protocol,
            factors=arguments.factors,
            correction=correction,
            marks=arguments.marks,
            seed=seed,
            report=report,
        )
    for name in ("factors", "protocol", "exclude", "marks"):
        if getattr(arguments, name):
            raise InputError(f"--{name} is of trials, not of scores; leave it out")
    return analyse_scores(arguments.scores, correction=correction, seed=seed)
