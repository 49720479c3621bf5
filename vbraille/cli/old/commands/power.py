"""``vbraille power``."""

from __future__ import annotations

import csv
import sys
from dataclasses import asdict, fields
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import WorkProgress, print_json, say_line
from vbraille.forecast.power import ENOUGH, PowerQuestion, PowerRow, power
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.protocolfiles import load_protocol
from vbraille.wording import count

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from vbraille.forecast.power import PowerTable


def run(arguments: argparse.Namespace) -> int:
    """Simulate studies of a protocol, and say how many found the effect."""
    question = PowerQuestion(
        protocol=load_protocol(arguments.protocol),
        effect=arguments.effect,
        sizes=arguments.participants,
        between=arguments.between,
        differing=arguments.differing,
        correction=arguments.correction,
        studies=arguments.studies,
        seed=arguments.seed,
        lapses=arguments.lapses,
        false_alarms=arguments.false_alarms,
    )
    workers = Workers(arguments.workers)
    keep = None if arguments.keep is None else Path(arguments.keep)
    progress = WorkProgress(verbose=arguments.verbose)
    table = power(question, workers, keep=keep, report=progress.of)
    if arguments.json:
        print_json(table.to_json(), indent=1)
    elif arguments.csv:
        rows = csv.DictWriter(sys.stdout, [field.name for field in fields(PowerRow)])
        rows.writeheader()
        rows.writerows([asdict(row) for row in table.rows])
    else:
        for line in _lines(table):
            say_line(line)
    if table.unfinished is not None:
        sys.stdout.flush()
        raise table.unfinished
    return 0


def _lines(table: PowerTable) -> Iterator[str]:
    for word, sentence in table.about:
        yield f"{word}: {sentence}"
    for row in table.rows:
        people = count(row.participants, "participant")
        if row.power is None:
            width = "no interval" if row.half_width is None else f"± {row.half_width:.3g}"
            yield f"{people}: {row.kind} {row.compared}; 95 % interval {width} on average"
            continue
        untested = f"; without a p {row.untested}" if row.untested else ""
        line = (
            f"{people}: {row.kind} {row.compared}; "
            f"power {row.power:.1%}, {row.low:.1%} to {row.high:.1%}{untested}"
        )
        yield line.replace("%", " %")
    largest = max(row.participants for row in table.rows)
    for compared, least in table.enough().items():
        who = f"more than {largest}" if least is None else f"{least}"
        yield f"for a power of {100 * ENOUGH:.0f} %: {compared}; {who} participants"
