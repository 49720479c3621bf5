"""From a turn of a knob to the first frame that differs, on a host, while the hand moves."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result
from tests.conftest import TEXTS
from vbraille.layout.pages import Layout
from vbraille.layout.texts import cells_per_line
from vbraille.reading.commands.table import calling
from vbraille.reading.commands.turning import turn
from vbraille.reading.device import OpenDevice
from vbraille.render import STRESS2
from vbraille.translate import Book, BrailleTable, Document

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.render.program import Program

BAR_MS = 50.0
TURNS = 40
KNOBS = ("contrast", "texture", "dot_width_mm", "dot_spacing_mm", "cell_gap_mm")
_NS_PER_MS = 1_000_000
_SETTLED_S = 0.25  # fades take 0.1 s
_FELT = 0.002  # of the full swing
_DIFFERENT = 0.05  # between two styles that can be told apart where the hand is


def run() -> Iterator[Result]:
    book = Book(Document.open(str(TEXTS / "english.txt")), BrailleTable("en-ueb-g2.ctb"))
    layout = Layout(book, cells_per_line(STRESS2.style.geometry, STRESS2.display))
    with OpenDevice("sim", STRESS2.display, hand="sweep:20", attended=True) as device:
        device.find()
        device.start(STRESS2)
        device.show(layout)
        for name in KNOBS:
            latencies = _turns(device, name)
            turns = len(latencies)
            p99 = float(np.percentile(latencies, 99))
            yield Result(
                f"from a turn of {name} to the first frame that differs, {turns} turns, p99",
                f"≤ {BAR_MS:g} ms",
                f"{p99:.1f} ms (median {np.median(latencies):.1f})",
                met=p99 <= BAR_MS,
            )


def _turns(device: OpenDevice, name: str) -> list[float]:
    """Milliseconds from each turn to the first frame of the other style."""
    latencies = []
    handlers = calling(turn, name, -1), calling(turn, name, 1)
    for number in range(TURNS):
        _record(device, _SETTLED_S)
        reader = device.reader
        before = _program(device)
        pressed_ns = time.monotonic_ns()
        handlers[number % 2](reader)
        ticks = _record(device, _SETTLED_S)
        frames, others = (made.path(ticks["x_mm"]) for made in (before, _program(device)))
        after = ticks["time_ns"] >= pressed_ns
        if not np.abs(others - frames)[after][:10].max(initial=0.0) > _DIFFERENT:
            continue  # over a blank, both are alike
        first = _first_of_the_other(ticks, frames, pressed_ns)
        if first is not None:
            latencies.append((int(ticks["time_ns"][first]) - pressed_ns) / _NS_PER_MS)
    return latencies


def _program(device: OpenDevice) -> Program:
    """Program of what is under the hand."""
    window, display = device.reader.window, device.display
    program = device.reader.style.render(window.masks, display)
    return program.with_anchor(display.span_mm / 2 + window.start_mm)


def _record(device: OpenDevice, seconds: float) -> np.ndarray:
    """Records of the ticks of some time, which the reader sees too."""
    end, records = time.monotonic() + seconds, []
    while time.monotonic() < end:
        time.sleep(0.005)
        ticks = device.engine.poll()
        device.reader.step(ticks)
        records.append(ticks)
    return np.concatenate(records)


def _first_of_the_other(ticks: np.ndarray, before: np.ndarray, pressed_ns: int) -> int | None:
    """Index of the first tick after a turn whose frame is not that of the style before."""
    differs = np.abs(ticks["frame"] - before).max(axis=(1, 2)) > _FELT
    found = np.flatnonzero(differs & (ticks["time_ns"] >= pressed_ns))
    return int(found[0]) if found.size else None
