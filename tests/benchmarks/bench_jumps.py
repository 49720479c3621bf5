"""Nothing jumps: the law of `tests.wired`, with more seeds than the tests have time for."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from typing import TYPE_CHECKING

from tests.benchmarks.timing import Result
from tests.controllers import Alone, HastyController
from tests.wired import Wired, reading
from vbraille.simulation.firmware import Controller

if TYPE_CHECKING:
    from collections.abc import Iterator

SEEDS = 2000
CASES = (
    ("the host stopped, what the device says lost or late", "host", Controller),
    ("the same, with a controller that shows each FRAME at once", "host", HastyController),
    ("the line dead, held up and repeating too", "line", Controller),
    ("the same, with a controller written from the protocol's page", "line", Alone),
)


def run() -> Iterator[Result]:
    with ProcessPoolExecutor() as pool:
        for what, kind, controller in CASES:
            read = list(
                pool.map(_read, range(SEEDS), repeat(kind), repeat(controller), chunksize=20)
            )
            shown, rests = (sum(column) for column in list(zip(*read, strict=True))[:2])
            jumps = [f"seed {seed}: {said[0]}" for seed, (*_, said) in enumerate(read) if said]
            yield Result(
                f"{SEEDS} readings with troubles at random ({what}): actuators that moved within a "
                f"millisecond more than three times as far as hand and fade ask for",
                "0",
                f"{len(jumps)} in {shown} frames and {rests} rests{''.join(jumps[:1])}",
                not jumps,
            )


def _read(seed: int, kind: str, controller: type[Controller]) -> tuple[int, int, list[str]]:
    wired: Wired = reading(seed, kind, controller)
    return wired.shown, wired.rests, wired.breaches
