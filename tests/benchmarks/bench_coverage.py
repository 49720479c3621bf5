"""Coverage of the analysis's 95 % intervals; its tables stand in docs/validation.md.

`OMP_NUM_THREADS=1 python -m tests.benchmarks.bench_coverage` writes them there: every number
comes from seeds of its own cell, so that a rerun writes the same.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from tests.benchmarks import coverage_people as people
from tests.benchmarks import coverage_trials as trials
from tests.benchmarks.timing import Result

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from tests.benchmarks.coverage_people import Found

DOCUMENT = Path("docs/validation.md")
BEGIN, END = "<!-- coverage: begin -->", "<!-- coverage: end -->"
STUDIES, FEWER, SLOW, FEWEST = 10_000, 1_000, 500, 100
LOW, HIGH = 93.0, 98.0
TRIALS = (40, 78)
ANSWERS = (130, 260, 520, 1040, 2080)
PROCESSES = 2

Table = tuple[str, list[str], list[list[str]], list["Found"]]


def run() -> Iterator[Result]:
    for name, table in tables():
        yield _result(name, table[3])


def tables() -> Iterator[tuple[str, Table]]:
    """Each table by its name: what it says, its heads, its rows, and what its cells found."""
    with ProcessPoolExecutor(PROCESSES) as pool:
        every = list(product(people.SHARES, people.SPREAD))
        # With the middle at a half the mean is a half as well.
        inner = [cell for cell in every if cell[0] != people.SHARES[0]]
        for centred, what, columns in (
            ("mean", "mean share", every),
            ("middle", "share of the middle of the log odds", inner),
        ):
            yield (
                f"shares, {centred}",
                _grid(
                    f"Mean share over people ({STUDIES:,} studies a cell), by {what} and SD of log "
                    f"odds",
                    [(n, t) for n in people.PEOPLE for t in TRIALS],
                    "{} people, {} trials",
                    columns,
                    "{}, SD {}",
                    lambda row, column, c=centred: pool.submit(
                        people.shares, *row, *column, c, STUDIES
                    ),
                ),
            )
        yield (
            "shares of few answers",
            _grid(
                f"The same of a character: few answers of each person ({STUDIES:,} studies)",
                [(n, t) for n in people.PEOPLE for t in (3, 15)],
                "{} people, {} answers",
                every,
                "{}, SD {}",
                lambda row, column: pool.submit(people.shares, *row, *column, "mean", STUDIES),
            ),
        )
        yield (
            "mean durations",
            _grid(
                f"Mean duration, by SD of its logarithm over people ({FEWER:,} studies)",
                [(n,) for n in people.PEOPLE],
                "{} people",
                [(0.3,), (0.5,)],
                "SD {}",
                lambda row, column: pool.submit(people.durations, *row, *column, FEWER),
            ),
        )
        yield (
            "differences",
            _grid(
                f"Difference of two conditions' shares of 40 trials, by mean share and SD "
                f"({FEWER:,} studies)",
                [(n,) for n in people.PEOPLE],
                "{} people",
                every,
                "{}, SD {}",
                lambda row, column: pool.submit(people.differences, *row, *column, FEWER),
            ),
        )
        yield (
            "preferred values",
            _grid(
                f"Preferred value of 0.5 to 3 mm, by mean and SD over people ({SLOW:,} studies)",
                [(n,) for n in (1, *people.PEOPLE[:4])],
                "people: {}",
                list(product((1.75, 2.0, 2.6), (0.2, 0.4, 0.8))),
                "{} mm, SD {}",
                lambda row, column: pool.submit(people.preference, *row, *column, SLOW),
            ),
        )
        yield (
            "slopes",
            _grid(
                f"Slope of one participant's right answers, by share and its change "
                f"({FEWER:,} studies)",
                [(t,) for t in TRIALS],
                "{} trials",
                [(0.5, 0.0), (0.5, 0.3), (0.8, 0.0), (0.8, 0.3), (0.95, 0.0), (0.95, 0.08)],
                "{}, change {}",
                lambda row, column: pool.submit(trials.slopes, *row, *column, FEWER),
            ),
        )
        of_people = [("people", n) for n in people.PEOPLE[1:]]
        yield (
            "correlations",
            _grid(
                f"Correlation of duration and legibility, by share ({FEWER:,} studies)",
                [("trials", t) for t in TRIALS] + of_people,
                "{1} {0}",
                [(share,) for share in people.SHARES],
                "{}",
                lambda row, column: pool.submit(
                    trials.correlations if row[0] == "trials" else trials.correlations_of_people,
                    row[1],
                    *column,
                    FEWER,
                ),
            ),
        )
        yield "transmitted bits", _bits(pool)


def _grid(
    title: str,
    rows: Sequence[tuple],
    row_name: str,
    columns: Sequence[tuple],
    column_name: str,
    submit: Callable,
) -> Table:
    found = [[submit(row, column) for column in columns] for row in rows]
    cells = [[future.result() for future in line] for line in found]
    heads = ["", *(column_name.format(*column) for column in columns)]
    lines = [
        [row_name.format(*row), *(cell.text() for cell in line)]
        for row, line in zip(rows, cells, strict=True)
    ]
    return title, heads, lines, [cell for line in cells for cell in line]


def _bits(pool: ProcessPoolExecutor) -> Table:
    """Errors and coverage of transmitted bits, where a number is given."""
    heads = [
        "reader", "bits", "answers", "plug-in, mean error", "corrected, mean error",
        "typical error", "coverage", "number given (%)",
    ]  # fmt: skip
    waiting = [
        (name, answers, pool.submit(trials.bits, shares, answers, FEWEST))
        for name, shares in trials.readers().items()
        for answers in ANSWERS
    ]
    lines, cells = [], []
    for name, answers, future in waiting:
        bits = future.result()
        found = bits.found
        ours = [f"{bits.error:+.2f}", f"{bits.typical_error:.2f}", f"{found.coverage:.1f}"]
        lines.append(
            [name, f"{bits.truth:.2f}", str(answers), f"{bits.plain_error:+.2f}"]
            + (ours if found.given else ["none"] * 3)
            + [f"{100 * found.given / found.studies:.0f}"]
        )
        cells.append(found)
    return f"Transmitted bits ({FEWEST} tables a row)", heads, lines, cells


def _result(name: str, cells: Sequence[Found]) -> Result:
    given = [cell.coverage for cell in cells if cell.given]
    held = sum(LOW <= coverage <= HIGH for coverage in given)
    return Result(
        f"95 % intervals of {name}: cells in which {LOW:g} to {HIGH:g} % hold the truth",
        "all",
        f"{held} of {len(given)}; {min(given):.1f} to {max(given):.1f} %",
        held == len(given),
    )


def _markdown(table: Table) -> str:
    title, heads, lines, _ = table
    rows = [heads, ["---"] * len(heads), *lines]
    return f"**{title}**\n\n" + "".join(f"| {' | '.join(row)} |\n" for row in rows)


def _write(made: Sequence[str]) -> None:
    """Put the tables into the document, in place of those that are there."""
    text = DOCUMENT.read_text(encoding="utf-8")
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    if not after:
        sys.exit(f"{DOCUMENT} has no place for the tables, between {BEGIN} and {END}")
    DOCUMENT.write_text(f"{before}{BEGIN}\n{chr(10).join(made)}{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    every = []
    for name, table in tables():
        print(_result(name, table[3]).row(), flush=True)
        every.append(_markdown(table))
    _write(every)
