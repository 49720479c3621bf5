"""Power by simulation: how fast, the same on any workers, and as its closed form says."""

from __future__ import annotations

import json
import os
import statistics
import subprocess
import sys
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING

from msgspec import structs

from tests.benchmarks.bare_power import question
from tests.benchmarks.timing import Result, seconds
from tests.forecast.closedform import of_row
from tests.forecast.independent import off_by
from vbraille.forecast.power import PowerQuestion, PowerTable, power
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.protocolfiles import load_protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

STUDIES, MANY, ROUNDS = 1000, 40_000, 3
SIZES = (4, 6, 8, 12, 16, 20, 30, 40)
EFFECTS = ("0.55", "0.6")
NORMAL = 2_000  # studies that the closed form is held against
CROSSED = 10_000  # studies of 2 × 3 within × 2 groups


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
    yield from _speed_up()
    yield _closed_form()
    yield crossed(CROSSED)


def _speed_up() -> Iterator[Result]:
    """Gain of two workers by that of two bare processes, both over one bare process.

    All three begin with a new process, whose start and imports count. On a machine that does
    other work as well, only the second row tells what two processors could do: processor time of
    the longest way from the beginning to the end, which is this process until its workers are
    there, and from then on the worker that has most to do.
    """
    clock, used = [], []
    for _ in range(ROUNDS):
        runs = [_run(_bare(1)), _run(_bare(2)), _run([["shared_power", "2", f"{MANY}"]])]
        for gains, part in ((clock, 0), (used, 1)):
            one, bare, shared = (run[part] for run in runs)
            gains.append((one / shared, one / bare, bare / shared))
    for gains, what in ((clock, "by the clock"), (used, "by processor time of the longest way")):
        ours, theirs, ratio = (statistics.median(column) for column in zip(*gains, strict=True))
        yield Result(
            f"gain of two workers, {MANY} such studies, {what}, median of {ROUNDS}",
            "≥ 0.9 of that of two bare processes",
            f"{ours:.2f} and {theirs:.2f}: {ratio:.2f}",
            ratio >= 0.9,
        )


def _bare(number: int) -> list[list[str]]:
    return [["bare_power", f"{n}", f"{number}", f"{MANY}"] for n in range(number)]


def _run(commands: list[list[str]]) -> tuple[float, float]:
    """Seconds until all of some processes have ended, and processor time of the longest way."""
    environment = os.environ | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    begun_s = perf_counter()
    processes = [
        subprocess.Popen(
            [sys.executable, "-m", f"tests.benchmarks.{name}", *rest],
            env=environment, stdout=subprocess.PIPE, text=True,
        )
        for name, *rest in commands
    ]  # fmt: skip
    told = [json.loads(process.communicate()[0]) for process in processes]
    taken_s = perf_counter() - begun_s
    return taken_s, max(one["own"] + max(one["workers"], default=0.0) for one in told)


def crossed(studies: int) -> Result:
    """Power of a design of 2 × 3 within people and 2 groups, against studies drawn otherwise."""
    off, compared = off_by(studies)
    return Result(
        f"power of every effect and difference of 2 × 3 within × 2 groups, 12 people, against an "
        f"independent simulation, {studies} studies each",
        "within 1.5 points",
        f"at most {100 * off:.2f} points ({compared})",
        off <= 0.015,
    )


def _closed_form() -> Result:
    protocol = load_protocol("legibility")
    protocol = structs.replace(protocol, analysis=structs.replace(protocol.analysis, model="means"))
    asked = PowerQuestion(protocol, {}, SIZES, studies=NORMAL)
    questions = [replace(asked, effect={"nominal": "0.5", "textured": share}) for share in EFFECTS]
    off = [
        (abs(row.power - of_row(question, row)), row)
        for question in questions
        for row in power(question, Workers(2)).rows
        if row.power is not None
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
