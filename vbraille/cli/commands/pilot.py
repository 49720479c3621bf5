"""``vbraille pilot``."""

from __future__ import annotations

from pathlib import Path

import click

from vbraille.cli import options
from vbraille.cli.printing import Progress, say
from vbraille.errors import needing_extras


@options.command(
    "pilot letters --participants 20 --workers 2",
    click.argument("protocol"),
    options.option("--participants", type=options.whole(1, 500), required=True, metavar="N",
                   help="Number of simulated people."),
    options.out(metavar="DIR", help="Directory for the sessions and the report."),
    options.option("--answers", default="simulated:0.4", show_default=True, metavar="SPEC",
                   help="Simulated reader, such as simulated:0.4,lapses=0.05."),
    options.seed(group=options.FIRST),
    options.workers,
)  # fmt: skip
def command(
    protocol: str, participants: int, out: str | None, answers: str, seed: int, workers: int
) -> None:
    """Run the sessions of a study with the simulated reader, and write their report.

    Given again, a pilot that was interrupted goes on. No person answers: the report says so.
    """
    with needing_extras():
        from vbraille.analysis.pilot import pilot

    folder = Path(out or f"pilot-{Path(protocol).stem}")
    written = pilot(
        protocol,
        participants,
        folder,
        answers=answers,
        seed=seed,
        workers=workers,
        report=Progress().of,
    )
    say(f"report: {written / 'report.html'}")
