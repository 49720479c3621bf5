"""``vbraille analyse``."""

from __future__ import annotations

import os
from pathlib import Path

import click

from vbraille.cli import options
from vbraille.cli.printing import show


@options.command(
    "analyse P01-letters.session P02-letters.session --out report",
    click.argument("paths", nargs=-1, type=click.Path(), metavar="[SESSION|TABLE]..."),
    options.out(metavar="DIR", help="New directory for the report, the tables and the figures."),
    options.option("--scores", type=click.Path(), metavar="TABLE",
                   help="Table of scores: participant, what was varied, score."),
    options.option("--measure", metavar="NAME", help="Measure to compare, such as duration."),
    options.option("--factors", metavar="NAME,NAME", help="Columns to compare by."),
    options.option("--protocol", metavar="NAME", help="Take only trials of this protocol."),
    options.option("--exclude", type=options.pair, metavar="P07=REASON", multiple=True,
                   help="Leave a participant out; may be given again."),
    options.json,
)  # fmt: skip
def command(
    paths: tuple[str, ...],
    out: str | None,
    scores: str | None,
    measure: str | None,
    factors: str | None,
    protocol: str | None,
    exclude: tuple[tuple[str, str], ...],
    json: bool,
) -> None:
    """Print the planned comparison, or write a report.

    Tables of trials are CSV files with the columns participant, condition, presented and answered.
    """
    if bool(paths) == bool(scores):
        raise click.UsageError("give sessions or tables of trials, or --scores with a table")
    chosen = {"--measure": measure, "--factors": factors, "--protocol": protocol}
    for name, value in (chosen | {"--exclude": exclude}).items():
        if scores and value:
            raise click.UsageError(f"{name} is for trials, and not for --scores")
    if out is not None:
        from vbraille.files import check_free

        check_free(Path(out))
    # Threads of BLAS wait for each other on matrices as small as ours: 8 ms a threshold against 60.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    from vbraille.analysis import analyse, analyse_scores

    if scores:
        analysis = analyse_scores(scores)
    else:
        analysis = analyse(
            paths,
            protocol=protocol,
            measure=measure,
            factors=None if factors is None else [name.strip() for name in factors.split(",")],
            exclude=dict(exclude),
        )
    if out is not None:
        analysis.write(out)
    lines = analysis.lines() if out is None else [f"report: {Path(out) / 'report.html'}"]
    show(lines, analysis.to_json() if json else None, as_json=json)
