"""``vbraille analyse``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.analysis.analyse import Options, analyse, analyse_scores
from vbraille.cli.printable import printable
from vbraille.errors import InputError, VbrailleError

if TYPE_CHECKING:
    import argparse

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
        from vbraille.sessions.record.folder import check_free

        check_free(folder)
    results, trials, faults = _analysed(arguments, options)
    if folder is not None:
        from vbraille.analysis.report.files import write_report

        write_report(results, folder, trials)
    if arguments.json:
        from vbraille.analysis.report.tojson import to_json

        print(to_json(results), end="")
    elif folder is not None:
        print(printable(f"written: {folder / 'report.html'}"))
    else:
        from vbraille.analysis.report.tolines import to_lines

        for line in to_lines(results):
            print(printable(line))
    if faults:
        raise VbrailleError(f"analysed is what is whole; {'; '.join(faults)}")
    return 0


def _analysed(
    arguments: argparse.Namespace, options: Options
) -> tuple[Results, dict[str, bytes], tuple[str, ...]]:
    """Results, the trials they come from as a file, and what is damaged."""
    if arguments.scores is not None:
        for name in ("factors", "protocol", "exclude", "marks"):
            if getattr(arguments, name):
                raise InputError(f"--{name} is of trials, not of scores; leave it out")
        from vbraille.analysis.study import load_scores

        scores, about = load_scores(Path(arguments.scores))
        return analyse_scores(scores, about, options), {}, ()
    from vbraille.analysis.study import load_study, trials_file

    study = load_study(
        [Path(path) for path in arguments.paths],
        exclude=arguments.exclude,
        protocol=arguments.protocol,
    )
    return analyse(study, options), trials_file(study), study.faults
