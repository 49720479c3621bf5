"""How often the intervals of the trials' model, d′ and psychometric functions hold the truth.

`OMP_NUM_THREADS=1 python -m tests.benchmarks.bench_trials_coverage` writes its tables into
docs/validation.md: every number comes from seeds of its own cell, so that a rerun writes the same.
Names of tables after it make these alone, and print them instead.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from tests.benchmarks import coverage_model as model
from tests.benchmarks import coverage_readers as readers
from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

DOCUMENT = Path("docs/validation.md")
BEGIN, END = "<!-- coverage of trials: begin -->", "<!-- coverage of trials: end -->"
STUDIES, FEWER, SLOW = 10_000, 2_000, 1_000
LOW, HIGH, MOST_MISLED, MOST_BIASED = 93.0, 98.0, 6.0, 0.02
PROCESSES = 2
WITHIN, BETWEEN = (3, 5, 10, 20), (6, 10, 20)
POPULATIONS = tuple(product((0.5, 0.8, 0.95), (0.5, 1.0, 1.5)))


class Made(NamedTuple):
    """A table, and what its cells came to."""

    title: str
    heads: list[str]
    lines: list[list[str]]
    cells: list


class Wanted(NamedTuple):
    """A table to be made: rows and columns are arguments of a function of its module."""

    title: str
    make: Callable
    rows: list[tuple[str, tuple]]
    columns: list[tuple[str, tuple]]
    more: tuple
    part: str = ""  # of what the function finds, where it finds several at once


def wanted() -> dict[str, Wanted]:
    """Every table by its name."""
    columns = [(f"{share}, SD {sd}", (share, sd)) for share, sd in POPULATIONS]
    people = {
        kind: [(f"{n} people", (n,)) for n in numbers]
        for kind, numbers in (
            ("within", WITHIN),
            ("missing", WITHIN),
            ("between", BETWEEN),
            ("covariate", WITHIN),
            ("three within", (4, *WITHIN[1:])),
            ("three between", (9, 12, 20)),
        )
    }
    told = {
        "within": "two conditions",
        "missing": "two conditions, some missing",
        "between": "two groups",
    }
    found = {
        f"{what}, {kind}": Wanted(
            f"{what.capitalize()}, {words}, by mean share and SD of log odds ({FEWER:,} studies)",
            model.intervals,
            people[kind],
            columns,
            (kind, what, FEWER),
        )
        for what in model.WHAT
        for kind, words in told.items()
    }
    for kind, words in (
        ("within", "two conditions"),
        ("between", "two groups"),
        ("covariate", "a slope over the session"),
        ("three within", "three conditions together"),
        ("three between", "three groups together"),
    ):
        found[f"false positives, {kind}"] = Wanted(
            f"False positives of {words} (%), by mean share and SD ({STUDIES:,} studies)",
            model.misled,
            people[kind],
            columns,
            (kind, STUDIES),
        )
    found["d′"] = Wanted(
        f"d′ of yes and no, by d′ and criterion ({STUDIES:,} readers)",
        readers.sensitivity,
        [(f"{n} trials of each kind", (n,)) for n in (10, 20, 39, 78)],
        [(f"{d:g}, c {c:g}", (d, c)) for d in (0, 1, 2, 3) for c in (0, 0.5)],
        (STUDIES,),
    )
    shapes = [(shape, (shape, None)) for shape in ("logistic", "normal", "weibull")]
    for what in ("threshold", "spread"):
        found[f"psychometric {what}"] = Wanted(
            f"{what.capitalize()} of which of two, lapses 2 % ({SLOW:,} readers)",
            readers.curve,
            [(f"7 levels of {n} trials", (n,)) for n in (10, 20, 40)],
            shapes,
            (SLOW,),
            what,
        )
    alarms = [(f"{share:.0%}", ("logistic", share)) for share in (0.02, 0.05, 0.1, 0.2, 0.3)]
    for what, name in (
        ("threshold", "Threshold"),
        ("spread", "Spread"),
        ("bias", "Mean error of a threshold of 1"),
    ):
        found[f"{what}, yes and no"] = Wanted(
            f"{name}, yes and no, by false alarms ({SLOW:,} readers)",
            readers.curve,
            [(f"7 levels of {n} trials, {n} blanks", (n,)) for n in (12, 24)],
            alarms,
            (SLOW,),
            what,
        )
    return found


def run() -> Iterator[Result]:
    for name, table in tables():
        yield result(name, table)


def tables(only: list[str] | None = None) -> Iterator[tuple[str, Made]]:
    """Make the tables, or those that are named."""
    with ProcessPoolExecutor(PROCESSES) as pool:
        asked = {name: want for name, want in wanted().items() if not only or name in only}
        calls = {
            name: [
                [(want.make, *row, *column, *want.more) for _, column in want.columns]
                for _, row in want.rows
            ]
            for name, want in asked.items()
        }
        # What two tables have in common is made once.
        waiting = {
            call: pool.submit(*call) for of in calls.values() for line in of for call in line
        }
        for name, want in asked.items():
            found = [[waiting[call].result() for call in line] for line in calls[name]]
            cells = [[cell[want.part] for cell in line] if want.part else line for line in found]
            lines = [
                [row, *(cell.text() for cell in line)]
                for (row, _), line in zip(want.rows, cells, strict=True)
            ]
            heads = ["", *(column for column, _ in want.columns)]
            yield name, Made(want.title, heads, lines, [cell for line in cells for cell in line])


def result(name: str, table: Made) -> Result:
    """Row for the table of benchmarks."""
    if name.startswith("false positives"):
        most = max(cell.share for cell in table.cells if cell.given)
        return Result(name, f"≤ {MOST_MISLED:g} %", f"{most:.1f} % at most", most <= MOST_MISLED)
    if name.startswith("bias"):
        most = max(abs(cell.error) for cell in table.cells)
        return Result(name, f"≤ {MOST_BIASED:g}", f"{most:.3f} at most", most <= MOST_BIASED)
    given = [cell.coverage for cell in table.cells if cell.given]
    held = sum(LOW <= coverage <= HIGH for coverage in given)
    return Result(
        f"95 % intervals of {name}: cells in which {LOW:g} to {HIGH:g} % hold the truth",
        "all",
        f"{held} of {len(given)}; {min(given):.1f} to {max(given):.1f} %",
        held == len(given),
    )


def markdown(table: Made) -> str:
    """Text of a table."""
    rows = [table.heads, ["---"] * len(table.heads), *table.lines]
    return f"**{table.title}**\n\n" + "".join(f"| {' | '.join(row)} |\n" for row in rows)


def write(made: list[str]) -> None:
    """Put the tables into the document, in place of those that are there."""
    text = DOCUMENT.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    if not after:
        sys.exit(f"{DOCUMENT} has no place for the tables, between {BEGIN} and {END}")
    DOCUMENT.write_text(f"{before}{BEGIN}\n{chr(10).join(made)}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    every = []
    for name, table in tables(sys.argv[1:]):
        print(result(name, table).row(), flush=True)
        every.append(markdown(table))
    if sys.argv[1:]:
        print("\n".join(every))
    else:
        write(every)
