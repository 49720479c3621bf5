"""Large books: lines deep in them, and memory while they are read."""

from __future__ import annotations

import random
import statistics
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING

import msgspec

from tests.benchmarks.big_texts import big_text
from tests.benchmarks.timing import Result, ratio, seconds
from tests.conftest import SEED

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Index

TABLE = "en-ueb-g2.ctb"
WIDTH = 26
JUMPS, LINES = 100, 40  # places that are gone to, and lines that are read there in each direction

_READ_ON = """
import json, resource, sys, msgspec
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.source import Index
path, index, character, lines = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
document = Document.open(path)
document.adopt(msgspec.json.decode(open(index, "rb").read(), type=Index))
start = document.block_at(character)
layout = Layout(Book(document, BrailleTable("en-ueb-g2.ctb")), 26, start=start, lines_before=None)
peaks = []
for n in range(lines):
    assert layout.line(layout.first_line + n) is not None
    if n in (lines // 10, lines - 1):
        peaks.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
print(json.dumps(peaks))
"""


def run() -> Iterator[Result]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        yield from _deep(folder, size=50_000_000)


def _deep(folder: Path, size: int) -> Iterator[Result]:
    from vbraille.layout.pages import Layout
    from vbraille.translate import Book, BrailleTable, Document

    path, small = big_text(folder / "large", size), big_text(folder / "50kb", 50_000)
    index, characters = _index(path)
    small_index, small_characters = _index(small)
    table = BrailleTable(TABLE)
    document = Document.open(path)
    taken = seconds(lambda: document.adopt(index))
    kept = len(msgspec.json.encode(index))
    yield Result(
        f"index of a text of {size // 1_000_000} MB, and taking it over",
        "reported", f"{kept / 1_000:.0f} kB, {1_000 * taken:.1f} ms", True,
    )  # fmt: skip

    layout = Layout(Book(document, table), WIDTH)
    draw = random.Random(SEED)
    walls, works = [], []
    for _ in range(JUMPS):
        found = layout.place(draw.randrange(characters))
        assert found is not None
        for step in (1, -1):
            number = found[0].number
            for _ in range(LINES):
                number += step
                wall, work = perf_counter(), process_time()
                layout.line(number)
                walls.append(1_000 * (perf_counter() - wall))
                works.append(1_000 * (process_time() - work))
    wall, work = (statistics.quantiles(times, n=100)[-1] for times in (walls, works))
    yield Result(
        f"next and previous line anywhere in it, translated and laid out, p99 of {len(walls):,}",
        "≤ 20 ms", f"{wall:.1f} ms ({work:.1f} ms of processor time)", wall <= 20,
    )  # fmt: skip

    def first_line(of: Path, known: Index, character: int) -> None:
        document = Document.open(of)
        document.adopt(known)
        start = document.block_at(character)
        assert start is not None
        layout = Layout(Book(document, table), WIDTH, start=start, lines_before=None)
        assert layout.line(layout.first_line) is not None

    deep = partial(first_line, path, index, characters * 7 // 10)
    share, least = ratio(deep, partial(first_line, small, small_index, small_characters * 7 // 10))
    yield Result(
        "opening it at 70 % by its index, to the first line, in the running program; against 50 kB",
        "reported", f"{1_000 * least:.0f} ms, {share:.2f} ×", True,
    )  # fmt: skip

    (folder / "index").write_bytes(msgspec.json.encode(index))
    lines = 300_000
    command = [sys.executable, "-c", _READ_ON, str(path), str(folder / "index")]
    command += [str(characters // 2), str(lines)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    early, late = msgspec.json.decode(done.stdout)
    yield Result(
        f"memory after reading {lines // 10:,} and {lines:,} lines from its middle",
        "≤ 250 MB, flat", f"{early} and {late} MB", late <= 250 and late - early <= 20,
    )  # fmt: skip


def _index(path: Path) -> tuple[Index, int]:
    """Index of a text, and the number of its characters."""
    from vbraille.translate import Document

    document = Document.open(path)
    number, end = 0, 0
    while (block := document.block(number)) is not None:
        number, end = number + 1, block.text.end
    return document.index(), end
