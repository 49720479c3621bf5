"""Times and ratios that hold on a noisy machine."""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


@dataclass(frozen=True, slots=True)
class Result:
    """A row of the table."""

    what: str
    bar: str
    got: str
    met: bool

    def row(self) -> str:
        return f"| {self.what} | {self.bar} | {self.got}{'' if self.met else ' (missed)'} |"


def seconds(call: Callable[[], object], times: int = 1) -> float:
    """Time of one call, as the mean of so many."""
    start = perf_counter()
    for _ in range(times):
        call()
    return (perf_counter() - start) / times


def ratio(
    ours: Callable[[], object],
    theirs: Callable[[], object],
    *,
    times: int = 1,
    pairs: int = 15,
) -> tuple[float, float]:
    """Median ratio of the pairs, and the least time of ours in seconds."""
    ours(), theirs()
    taken = [(seconds(ours, times), seconds(theirs, times)) for _ in range(pairs)]
    return statistics.median(a / b for a, b in taken), min(a for a, _ in taken)


def process_seconds(arguments: Sequence[str]) -> float:
    """Processor time of a command, start to end."""
    # With byte code forbidden the compiler would be measured.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(arguments, check=True, capture_output=True, env=environment)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def vbraille(*arguments: str) -> list[str]:
    """The command line of the installed program."""
    return [str(Path(sys.executable).with_name("vbraille")), *arguments]
