"""``vbraille analyse``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.analysis.chapters import Options, analyse, analyse_scores
from vbraille.analysis.input.study import load_scores, load_study, trials_file
from vbraille.errors import InputError, VbrailleError
from vbraille.wording import printable, spelled

if TYPE_CHECKING:
    import argparse

    from vbraille.analysis.input.study import Study
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
    given = {name: getattr(arguments, name) for name in ("factors", "marks", "seed")}
    options = Options(
        correction=arguments.correction,
        **{name: value for name, value in given.items() if value is not None},
    )
    folder = None if arguments.out is None else Path(arguments.out)
    if folder is not None:
        from vbraille.files import check_free

        check_free(folder)
    results, study = _analysed(arguments, options)
    if folder is not None:
        from vbraille.analysis.report.files import write_report

        write_report(results, folder, {} if study is None else trials_file(study))
    if arguments.json:
        from vbraille.analysis.report.tojson import to_json

        sys.stdout.writelines(to_json(results))
    elif folder is not None:
        print(printable(f"written: {folder / 'report.html'}"))
    else:
        from vbraille.analysis.report.tolines import to_lines

        for line in to_lines(results):
            print(printable(spelled(line)))
    if study is not None and study.faults:
        raise VbrailleError(f"analysed is what is whole; {'; '.join(study.faults)}")
    return 0


def _analysed(arguments: argparse.Namespace, options: Options) -> tuple[Results, Study | None]:
    """Results, and the study that they are of; None of a table of scores."""
    if arguments.scores is not None:
        for name in ("factors", "protocol", "exclude", "marks", "sites"):
            if getattr(arguments, name):
                raise InputError(f"--{name} is of trials, not of scores; leave it out")
        scores, about = load_scores(Path(arguments.scores))
        return analyse_scores(scores, about, options), None
    study = load_study(
        [Path(path) for path in arguments.paths],
        exclude=arguments.exclude,
        protocol=arguments.protocol,
        sites=arguments.sites,
    )
    return analyse(study, options), study
