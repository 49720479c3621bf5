"""Procedures that go by the answers: how fast they choose, and how near they come."""

from __future__ import annotations

import statistics
from time import thread_time
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result
from tests.benchmarks.tuned_people import KINDS, PEOPLE, PROTOCOLS, SEED, tune
from vbraille.adaptive.questplus import (
    GridAxis,
    detection_quest,
    geometric,
    nearer_quest,
    ordered_pairs,
    steps,
)
from vbraille.sessions.planning.procedures import QuestProcedure
from vbraille.sessions.planning.protocolfiles import load_protocol

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.adaptive.questplus import GridQuest

TRIALS = 200
ONE_MS, PAIRS_MS = 5.0, 50.0


def run() -> Iterator[Result]:
    values = steps(0.0, 1.0, 0.01)
    fixed = [GridAxis("spread", (0.1,)), GridAxis("guess", (0.5,)), GridAxis("lapse", (0.02,))]
    one = detection_quest("normal", values, GridAxis("threshold", values), *fixed)
    yield _timed(one, "one parameter, 101 values × 101 thresholds", ONE_MS)
    grid = steps(0.5, 3.0, 0.05)
    two = nearer_quest(
        ordered_pairs(grid), GridAxis("centre", grid),
        GridAxis("spread", geometric(0.05, 1.0, 9)), GridAxis("lapse", (0.03,)), about="centre",
    )  # fmt: skip
    yield _timed(two, "pairs on two parameters, 1275 pairs × 51 × 9", PAIRS_MS)
    protocol = load_protocol("tuning-width-adaptive")
    assert isinstance(protocol.procedure, QuestProcedure)
    shipped = protocol.procedure.quest(protocol.design)
    yield _timed(shipped, f"tuning-width-adaptive, {len(shipped.stimuli)} pairs × 51 × 9", PAIRS_MS)
    for name in PROTOCOLS:
        for kind in KINDS:
            yield _tuned(name, kind)


def _timed(quest: GridQuest, what: str, bar_ms: float) -> Result:
    """Time each of so many choices, the history growing as in a session."""
    random = np.random.default_rng(SEED)
    history, taken_ms = [], []
    for _ in range(TRIALS):
        begun = thread_time()
        stimulus = quest.next(history)
        taken_ms.append((thread_time() - begun) * 1e3)
        history.append((stimulus, int(random.integers(2))))
    half, longest = statistics.median(taken_ms), max(taken_ms)
    return Result(
        f"QUEST+, the next question, {what}: processor time, half of {TRIALS} trials, the longest",
        f"≤ {bar_ms:g} ms",
        f"{half:.2f} ms, {longest:.2f} ms",
        longest <= bar_ms,
    )


def _tuned(name: str, kind: str) -> Result:
    tuned = tune(kind, PEOPLE, SEED, name)
    adaptive, six, fixed = tuned.rmse()
    ratio = f"{adaptive / fixed:.2f} × (s.e. {tuned.ratio_error():.2f})"
    return Result(
        f"{name}, {PEOPLE} simulated people, {kind}: RMSE of the preferred value with 30 adaptive "
        f"trials, beside 90 fixed ones",
        f"≤ {fixed:.3f} mm",
        f"{adaptive:.3f} mm, {ratio}; 30 adaptive on the six values {six:.3f} mm; the "
        f"95 % interval holds it in {tuned.inside:.1%}",
        adaptive <= fixed,
    )
