"""Conventional displays: how soon a line is there, and what that costs the loop.

BRLTTY is the real one, with its driver for Handy Tech; the display is at a pseudo-terminal.
"""

from __future__ import annotations

import statistics
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.bench_engine import INFO, ROOM, line
from tests.benchmarks.timing import Result
from tests.conventional.handytech import Brltty, missing, until
from vbraille.conventional.brlapi import BrlapiDisplay, DisplayGoneError
from vbraille.conventional.display import ConventionalDisplay
from vbraille.engine.host import Host
from vbraille.layout.pages import Layout
from vbraille.reading.conventionalview import ConventionalView
from vbraille.reading.reader import Reader
from vbraille.render import STRESS2
from vbraille.translate import Book, BrailleTable, Document

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

ROUNDS = 5
LINES = 30  # in each block of a round
APART_S = 0.1
BLOCK_S = 8.0
PAIRS = 5
_POLL_S = 0.02  # as a reading polls
_WORDS = ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def run() -> Iterator[Result]:
    if why := missing():
        raise SystemExit(f"conventional displays are measured with a BRLTTY: {why}")
    with tempfile.TemporaryDirectory() as folder, Brltty(Path(folder)) as brltty:
        yield from _latency(brltty)
        yield _lateness(brltty)


def _latency(brltty: Brltty) -> Iterator[Result]:
    """From a line's first tick to the display, beside BRLTTY's own way to it."""
    bare_ms: list[float] = []
    tick_ms: list[float] = []
    put_ms: list[float] = []
    for _ in range(ROUNDS):
        bare_ms += _bare(brltty)
        for tick, put in _ours(brltty):
            tick_ms.append(tick)
            put_ms.append(put)
    bare, tick, put = (statistics.median(each) for each in (bare_ms, tick_ms, put_ms))
    worst = float(np.percentile(tick_ms, 99))
    yield Result(
        f"line to conventional display, from the engine's first tick of it, against BRLTTY's own "
        f"latency, {ROUNDS * LINES} lines each in turn",
        "≤ 1.1 ×",
        f"{tick / bare:.2f} × ({tick:.2f} ms of {bare:.2f} ms; 99 %: {worst:.2f} ms of "
        f"{np.percentile(bare_ms, 99):.2f} ms)",
        tick <= 1.1 * bare,
    )
    yield Result(
        "the same, from when the reading gave the line to the display's process",
        "",
        f"{put / bare:.2f} × ({put:.2f} ms)",
        met=True,
    )


def _bare(brltty: Brltty) -> list[float]:
    """Times in ms from BRLTTY's library to the display."""

    def opened() -> BrlapiDisplay | None:
        try:
            return BrlapiDisplay(brltty.host)
        except DisplayGoneError:
            return None

    display = until(opened)
    taken = []
    try:
        for number in range(LINES):
            cells = bytes((number % 63 + 1, 0x2A))
            time.sleep(APART_S)
            asked_ns = time.monotonic_ns()
            display.write(cells)
            taken.append((brltty.display.wait(cells) - asked_ns) / 1e6)
    finally:
        display.close()
    return taken


class Timed:
    """A display that notes when it was last told to show something."""

    def __init__(self, display: ConventionalDisplay) -> None:
        self._display = display
        self.poll, self.rest = display.poll, display.rest
        self.told_ns = 0

    @property
    def standing(self):
        return self._display.standing

    def show(self, cells: bytes) -> int:
        self.told_ns = time.monotonic_ns()
        return self._display.show(cells)


def _ours(brltty: Brltty) -> list[tuple[float, float]]:
    """Times in ms from the first tick of each line, and from its putting, to the display."""
    text = "\n\n".join(
        f"{_WORDS[n % 10]} {_WORDS[n // 10]} {_WORDS[n % 7]}" for n in range(LINES + 1)
    )
    layout = Layout(Book(Document.from_text(text), BrailleTable("en-ueb-g2.ctb")), 26)
    taken = []
    with (
        Host("sim:?hand=sweep:60", INFO, ROOM) as host,
        ConventionalDisplay(f"brlapi:{brltty.host}") as display,
    ):
        reader = Reader(layout, host, model=STRESS2, say=lambda _: None, advance=False)
        timed = Timed(display)
        alongside = ConventionalView(timed, lambda _: None)  # type: ignore[arg-type]
        reader.start()
        until(lambda: alongside.attend(reader) or display.standing)
        for _ in range(LINES):
            _go_on(host, reader, alongside, APART_S)
            reader.press("n")
            alongside.attend(reader)
            assert reader.line is not None
            came_ns = brltty.display.wait(reader.line.masks.tobytes()[: display.standing.columns])
            first_ns = until(lambda: _first_ns(host.poll(), reader.line.number))
            taken.append(((came_ns - first_ns) / 1e6, (came_ns - timed.told_ns) / 1e6))
    return taken


def _go_on(host: Host, reader: Reader, alongside: ConventionalView, seconds: float) -> None:
    """Read on for a while, as a reading does."""
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s:
        time.sleep(_POLL_S)
        reader.step(host.poll())
        alongside.attend(reader)


def _first_ns(ticks: NDArray[np.void], number: int) -> int | None:
    found = np.flatnonzero(ticks["line"] == number)
    return int(ticks["time_ns"][found[0]]) if found.size else None


def _lateness(brltty: Brltty) -> Result:
    """Lateness of the loop with a display beside that is told something all the time."""
    ratios, late_us = [], []
    for _ in range(PAIRS):
        alone = _block(None)
        with ConventionalDisplay(f"brlapi:{brltty.host}") as display:
            until(lambda display=display: display.poll() and display.standing)
            beside = _block(display)
        ratios.append(float(np.percentile(beside, 99) / np.percentile(alone, 99)))
        late_us.append(float(np.percentile(beside, 99)))
    return Result(
        "lateness of the loop with a conventional display that shows something new 50 times a "
        f"second, against none, 99 %, {PAIRS} pairs",
        "≤ 1.1 ×",
        f"{statistics.median(ratios):.2f} × ({min(ratios):.2f} to {max(ratios):.2f}; "
        f"{statistics.median(late_us):.0f} µs)",
        statistics.median(ratios) <= 1.1,
    )


def _block(display: ConventionalDisplay | None) -> NDArray[np.float64]:
    """Lateness of the ticks of a block in µs, float64[n]."""
    late_us = []
    with Host("sim:?hand=sweep:60", INFO, ROOM) as host:
        host.show(line(), 1)
        time.sleep(0.5)
        host.poll()
        end_s, number = time.monotonic() + BLOCK_S, 0
        while time.monotonic() < end_s:
            time.sleep(_POLL_S)
            number += 1
            if display is not None:
                display.show(bytes((number % 255 + 1,)) * 40)
                display.poll()
            late_us.append(host.poll()["lateness_ns"] / 1e3)
    return np.concatenate(late_us)
