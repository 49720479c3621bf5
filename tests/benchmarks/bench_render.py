"""Rendering, against filling the same memory."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result, ratio
from tests.conftest import SEED, TEXTS
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import Loop
from vbraille.engine.record import Ring
from vbraille.engine.ticks import POSE_X, POSE_Y, POSED
from vbraille.layout import Layout
from vbraille.render import STRESS2
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.translate import Book, BrailleTable, text_source

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.layout import Line
    from vbraille.render.program import Program

LINES, CELLS = 25, 40
LONG_BOOK = 10_000  # lines
PATH = 20_000
TICKS = 50_000


def renderer(masks: np.ndarray):
    return STRESS2.style.render(masks, STRESS2.display)


def run() -> Iterator[Result]:
    random = np.random.default_rng(SEED)
    page = [renderer(random.integers(1, 64, CELLS).astype(np.uint8)) for _ in range(LINES)]
    places = random.uniform(0, STRESS2.style.geometry.extent_mm(CELLS), 1000).tolist()
    out = np.zeros(STRESS2.display.shape)

    def frames() -> None:
        for line in page:
            frame = line.frame
            for x_mm in places:
                frame(x_mm, out)

    def fills() -> None:
        for _ in page:
            fill = out.fill
            for _ in places:
                fill(0)

    share, least = ratio(frames, fills)
    least /= LINES * len(places)
    yield Result(
        "one frame from Python, STReSS², page of 25 × 40 cells, against `out.fill(0)`",
        "≤ 5 ×, ≤ 1 µs",
        f"{share:.1f} ×, {least * 1e6:.2f} µs",
        share <= 5 and least <= 1e-6,
    )

    half_mm, end_mm = STRESS2.display.span_mm / 2, STRESS2.style.geometry.extent_mm(CELLS)
    path_mm = np.linspace(-half_mm, end_mm + half_mm, PATH)
    result = np.zeros((PATH, *STRESS2.display.shape), np.float32)
    share, least = ratio(lambda: page[0].path(path_mm), lambda: result.fill(0), times=5, pairs=31)
    yield Result(
        "a path of 20,000 positions, against filling its float32 result",
        "≤ 20 ×, ≤ 0.15 µs a frame",
        f"{share:.1f} ×, {least / PATH * 1e6:.2f} µs",
        share <= 20 and least / PATH <= 0.15e-6,
    )

    share, least = page_against_line(random)
    yield Result(
        "a tick with a page of 25 × 40 cells under a hand that goes over all of it, against one "
        "with a line, STReSS² with a second axis",
        "≤ 1.2 ×",
        f"{share:.2f} ×, {least * 1e6:.2f} µs",
        share <= 1.2,
    )

    book, single = lines_of(LONG_BOOK), lines_of(1)
    assert book.count() > LONG_BOOK
    spread = [book.line(1 + n * LONG_BOOK // LINES) for n in range(LINES)]
    share, _ = ratio(
        lambda: read(spread, places, out), lambda: read([single.line(1)] * LINES, places, out)
    )
    yield Result(
        "lines all over a book of 10,000, against the one line of another, a frame",
        "≤ 1.1 ×",
        f"{share:.2f} ×",
        share <= 1.1,
    )


def page_against_line(random: np.random.Generator) -> tuple[float, float]:
    """How much longer a tick takes with a page than with a line, and how long, in seconds."""
    style = STRESS2.style
    display = replace(STRESS2.display, height_mm=LINES * style.geometry.line_pitch_mm)
    masks = random.integers(1, 64, (LINES, CELLS)).astype(np.uint8)
    end_mm, height_mm = style.geometry.extent_mm(CELLS), display.height_mm
    # There and back over each line on a slant: all of the page in a block, at a hand's speed.
    n = np.arange(TICKS)
    poses = np.zeros((TICKS, 4))
    poses[:, POSED] = 1.0
    poses[:, POSE_X] = end_mm * np.abs((n * 2 * LINES / TICKS) % 2 - 1)
    poses[:, POSE_Y] = height_mm * n / TICKS

    def ticks_of(program: Program) -> Callable[[], object]:
        ring = Ring.alone(display.shape, TICKS)
        loop = Loop(SimulatedDevice(display), ManualClock(), ring=ring)
        loop.show(program, 1)
        times_ns = np.repeat(n[:, None] * 1_000_000, 2, axis=1)

        def block() -> None:
            times_ns[:] += TICKS * 1_000_000
            assert loop.advance(times_ns, poses) == TICKS

        return block

    page, line = (ticks_of(style.render_page(list(masks), display)),
                  ticks_of(style.render(masks[0], display)))  # fmt: skip
    share, least = ratio(page, line, pairs=31)
    return share, least / TICKS


def lines_of(count: int) -> Layout:
    """A book of so many lines, or a few more."""
    text = (TEXTS / "english.txt").read_text().strip().split("\n\n")
    paragraphs = text[1:] * (count // 200 + 1) if count > 1 else text[:1]
    return Layout(Book(text_source("\n\n".join(paragraphs)), BrailleTable("en-ueb-g2.ctb")), 26)


def read(lines: list[Line], places: list[float], out: np.ndarray) -> None:
    """Have each line under the hand at all those places."""
    for line in lines:
        frame = renderer(line.masks).frame
        for x_mm in places:
            frame(x_mm, out)
