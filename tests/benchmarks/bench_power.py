"""Power by simulation: how fast, the same on any workers, and as its closed form says."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
from dataclasses import replace
from typing import TYPE_CHECKING

from tests.benchmarks.bare_power import question
from tests.benchmarks.timing import Result, seconds
from vbraille.forecast.power import PowerQuestion, PowerTable, power
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.protocolfiles import load_protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

STUDIES, MANY, ROUNDS = 1000, 40_000, 3
SIZES = (4, 6, 8, 12, 16, 20, 30, 40)
EFFECTS = ("0.55", "0.6")
NORMAL = 20_000  # studies that the closed form is held against


def run() -> Iterator[Result]:
    found: list[PowerTable] = []
    taken = seconds(lambda: found.append(power(question(STUDIES), Workers(2))))
    alone = power(question(STUDIES), Workers())
    yield Result(
        f"{STUDIES} studies of 12 participants × 78 trials, two workers",
        "≤ 60 s, and what one worker finds",
        f"{taken:.1f} s, {'the same' if found[0] == alone else 'other'} numbers",
        taken <= 60 and found[0] == alone,
    )
    yield _speed_up()
    yield _closed_form()


def _speed_up() -> Result:
    """Gain of two workers by that of two bare processes, both over one bare process."""
    gains = []
    for _ in range(ROUNDS):
        bare, shared = _bare(1), _bare(2)
        two = seconds(lambda: power(question(MANY), Workers(2)))
        gains.append((bare / two, bare / shared, shared / two))
    ours, theirs, ratio = (statistics.median(column) for column in zip(*gains, strict=True))
    return Result(
        f"gain of two workers, {MANY} such studies, median of {ROUNDS}",
        "≥ 0.9 of that of two bare processes",
        f"{ours:.2f} and {theirs:.2f}: {ratio:.2f}",
        ratio >= 0.9,
    )


def _bare(number: int) -> float:
    """Seconds that so many bare processes take together."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

    def work() -> None:
        begun = [
            subprocess.Popen(
                [sys.executable, "-m", "tests.benchmarks.bare_power", *map(str, (n, number, MANY))],
                env=environment,
            )
            for n in range(number)
        ]
        assert not any(process.wait() for process in begun)

    return seconds(work)


def _closed_form() -> Result:
    asked = PowerQuestion(load_protocol("legibility"), {}, SIZES, test="paired", studies=NORMAL)
    tables = [
        power(replace(asked, effect={"nominal": "0.5", "textured": share}), Workers(2))
        for share in EFFECTS
    ]
    off = [
        (abs(row.power - (row.closed_form or 0.0)), row) for table in tables for row in table.rows
    ]
    worst, row = max(off, key=lambda one: one[0])
    return Result(
        f"power of a paired design against noncentral t, {min(SIZES)} to {max(SIZES)} participants "
        f"× 160 trials, shares 50 % and {', '.join(EFFECTS)}, {NORMAL} studies each",
        "within 1.5 points",
        f"at most {100 * worst:.2f} points (at {row.participants} participants, "
        f"power {row.power:.1%})",
        worst <= 0.015,
    )
