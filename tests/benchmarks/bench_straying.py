"""What a finger feels that strays from its line: bands and free pages, and arrays that are turned.

A hand reads pages line by line, at 40 mm/s, and drifts around the middle of each line. A dot is
felt where an actuator of its row swings half of its full swing or more as it passes the dot; a free
page has as the dot's row the actuators that are nearest to it just then. A cell is right if all six
dots are felt as they are on the line that the hand means.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result
from vbraille.devices.events import HandDone
from vbraille.engine.batch import BatchEngine
from vbraille.render import STRESS2, STRESS2_8X8, Straying, Tuning
from vbraille.simulation.hand import Hand, Sweep, drifting, read_lines
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.steering import ReadPage

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.render import Model
    from vbraille.simulation.motion import Motion
    from vbraille.simulation.steering import Area

LINES, CELLS, SEEDS = 8, 10, 6
STRAYS = (0.15, 0.3, 0.45, 0.6)  # line pitches
WAYS = [Straying("line", band) for band in (0.0, 0.25, 0.5, 0.75, 0.9)] + [Straying("free")]
TURNS_DEG = (0, 5, 10, 15, 20, 25, 30)
_STEP = 0.1  # ticks at which the hand is within this share of a dot's width count for the dot


class Drifting(Hand):
    """A hand at constant speed that strays so far from each line, without turning."""

    def __init__(self, stray: float, seed: int) -> None:
        self._stray, self._random = stray, np.random.default_rng(seed)

    def read_line(self, start_mm: float, end_mm: float) -> Motion:
        """Motion along a line, which strays only on a page."""
        return Sweep(40.0).read_line(start_mm, end_mm)

    def read_page(self, area: Area) -> Motion:
        """Motion over a page."""
        motion = read_lines(self.read_line, area)
        return drifting(motion, self._random, self._stray * area.pitch_mm, 0.0)


def plane(model: Model, straying: Straying) -> Model:
    """Model on a carriage on which nothing is in the way, with dots that are plain to feel."""
    pitch_mm = model.style.geometry.line_pitch_mm
    display = replace(model.display, height_mm=(LINES + 1) * pitch_mm, travel_mm=300.0, turns=True)
    tuning = Tuning(texture=0.0)
    return replace(
        model, display=display, style=model.style.replace(straying=straying, tuning=tuning)
    )


def read(model: Model, masks: NDArray[np.uint8], stray: float, seed: int) -> NDArray[np.void]:
    """Ticks of a hand that reads a page, on the model's display."""
    style = model.style
    hand = Drifting(stray, seed)
    pitch_mm = style.geometry.line_pitch_mm
    with SimulatedDevice(model.display, hand=hand) as device:
        engine = BatchEngine(device, poll_ticks=20_000)
        engine.show(style.render_page(list(masks), model.display), 1)
        engine.give(ReadPage(LINES, pitch_mm, style.geometry.extent_mm(CELLS)))
        parts = [engine.poll()]
        while not any(isinstance(event, HandDone) for event in engine.take_events()):
            parts.append(engine.poll())
    return np.concatenate(parts)


def felt(model: Model, ticks: NDArray[np.void], *, knows_turn: bool = True) -> NDArray[np.uint8]:
    """Dot masks that are felt on the lines that the hand means, uint8[LINES, CELLS]."""
    style, display = model.style, model.display
    geometry, own = style.geometry, style.rows_on(display).start
    right = display.column_offsets_mm() - display.span_mm / 2
    down = display.row_offsets_mm() - display.depth_mm / 2
    # The line that is meant: each begins where the array is back at the left.
    home = ticks["x_mm"] < -display.span_mm / 2 + 0.01
    meant = np.cumsum(np.diff(home.astype(int), prepend=1) < 0) - 1
    reading = np.gradient(ticks["x_mm"]) > 0
    theta = ticks["theta_rad"] if knows_turn else np.zeros(ticks.size)
    masks = np.zeros((LINES, CELLS), np.uint8)
    free = style.straying.manner == "free"
    for line in range(LINES):
        on = ticks[(meant == line) & reading]
        turn = theta[(meant == line) & reading]
        for cell in range(CELLS):
            for dot in range(6):
                side, dot_row = divmod(dot, 3)
                dot_mm = cell * geometry.cell_pitch_mm + side * geometry.dot_spacing_mm
                dot_mm += geometry.dot_width_mm / 2
                table = style.mapping.right if side else style.mapping.left
                row = np.full(on.size, own + table.index(dot_row))
                if free:
                    below_mm = (line + 0.5) * geometry.line_pitch_mm - on["y_mm"]
                    below_mm = below_mm + (dot_row - 1) * geometry.row_spacing_mm
                    row = np.abs(below_mm[:, None] - down).argmin(axis=1)
                at_mm = on["x_mm"][:, None] + right * np.cos(turn)[:, None]
                at_mm += (down[row] * np.sin(turn))[:, None]
                over = np.abs(at_mm - dot_mm) < _STEP * geometry.dot_width_mm
                swings = on["frame"][np.arange(on.size), row][over]
                masks[line, cell] |= bool(swings.size and np.median(swings) >= 0.5) << dot
    return masks


def strayed(model: Model, straying: Straying, stray: float, seeds: int = SEEDS) -> float:
    """Share of cells that are right."""
    shown, right = plane(model, straying), []
    for seed in range(seeds):
        masks = np.random.default_rng((7, seed)).integers(1, 64, (LINES, CELLS)).astype(np.uint8)
        right.append(felt(shown, read(shown, masks, stray, seed)) == masks)
    return float(np.mean(right))


def turned(model: Model, theta_rad: float, *, knows_turn: bool) -> float:
    """Share of cells that are right on the lines of an array that is turned by an angle."""
    shown = plane(model, Straying())
    masks = np.random.default_rng(7).integers(1, 64, (LINES, CELLS)).astype(np.uint8)
    ticks = read(shown, masks, 0.0, 1)
    ticks["theta_rad"] = theta_rad
    page = shown.style.render_page(list(masks), shown.display)
    for tick in ticks:  # however far it is turned
        page.frame(float(tick["x_mm"]), tick["frame"], theta_rad=theta_rad, part=int(tick["part"]))
    return float(np.mean(felt(shown, ticks, knows_turn=knows_turn) == masks))


def over_own_dots(model: Model, theta_rad: float) -> float:
    """Share of the actuators of a row that are nearer to its own row of dots than to another."""
    right = model.display.column_offsets_mm() - model.display.span_mm / 2
    off_mm = np.abs(right * math.sin(theta_rad))
    return float(np.mean(off_mm <= model.style.geometry.row_spacing_mm / 2))


def run() -> Iterator[Result]:
    """Rows of the table."""
    for model in (STRESS2, STRESS2_8X8):
        for way in WAYS:
            name = f"band {way.band:g}" if way.manner == "line" else "free"
            shares = [strayed(model, way, stray) for stray in STRAYS]
            got = ", ".join(f"{100 * share:.1f} %" for share in shares)
            strays = ", ".join(f"{stray:g}" for stray in STRAYS)
            yield Result(
                f"{model.title}, {name}: cells right, strays of {strays} pitches", "", got, True
            )
    for degrees in TURNS_DEG:
        theta_rad = math.radians(degrees)
        for model in (STRESS2, STRESS2_8X8):
            knows, not_ = (turned(model, theta_rad, knows_turn=way) for way in (True, False))
            own = over_own_dots(model, theta_rad)
            yield Result(
                f"{model.title}, turned by {degrees}°: cells right by the dots' own places, and by "
                "the places of an array that is not turned; actuators over their own row of dots",
                "",
                f"{100 * knows:.0f} %, {100 * not_:.0f} %; {100 * own:.0f} %",
                True,
            )
