"""A page of 25 × 40 cells of braille with a figure in it, against the page alone.

The page alone is what a page of books is: once as a finger reads it by lines, once as each actuator
shows what lies under it, which is what a picture does. Frames are made one by one, from Python, at
the same places for all three; places are over the whole page, and over the figure alone.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tests.benchmarks.timing import Result, ratio
from tests.shown import part_of
from vbraille.render import STRESS2_8X8, Straying
from vbraille.render.compiling import compile_scene
from vbraille.render.figures import FigureAt, page_with_figures
from vbraille.render.labels import Assets
from vbraille.scene.patterns import (
    Circle,
    Fill,
    LinearGrating,
    Polygon,
    StraightLine,
    Stroke,
    UniformVibration,
)
from vbraille.scene.scene import Canvas, Scene

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from vbraille.render.program import Program

LINES, CELLS = 25, 40
FROM_LINE, TO_LINE = 9, 16  # of the figure, which takes the right half of these lines
PLACES = 400
BAR = 2.0


def figure(width_mm: float, height_mm: float) -> Scene:
    """A house with a sun, a path and a door: outlines, gratings, and a vibration."""
    stroke = Stroke(width_mm=3.0)
    w, h = width_mm, height_mm
    wall = LinearGrating(ridge_mm=5.0, wave_angle_deg=90.0)
    roof = LinearGrating(ridge_mm=3.0, gap_mm=2.0)
    return Scene(
        canvas=Canvas(width_mm=w, height_mm=h),
        elements=(
            Polygon(
                vertices_mm=(
                    (w / 4, h / 2),
                    (3 * w / 4, h / 2),
                    (3 * w / 4, h - 4),
                    (w / 4, h - 4),
                ),
                stroke=stroke,
                fill=Fill(texture=wall, gap_mm=1.0),
            ),
            Polygon(
                vertices_mm=((w / 5, h / 2), (w / 2, 5), (4 * w / 5, h / 2)),
                stroke=stroke,
                fill=Fill(texture=roof, gap_mm=1.0),
            ),
            Circle(
                center_mm=(w - 18, 18),
                radius_mm=12.0,
                stroke=stroke,
                fill=Fill(texture=UniformVibration(), gap_mm=1.0),
            ),
            StraightLine(start_mm=(4, h - 6), end_mm=(w / 4 - 6, h - 6), stroke=stroke),
        ),
    )


def programs() -> tuple[Program, Program, Program, NDArray[np.float64]]:
    """The page with the figure, the page alone in both ways, and the figure's rectangle."""
    rng = np.random.default_rng(1)
    model, geometry = STRESS2_8X8, STRESS2_8X8.style.geometry
    lines = [rng.integers(1, 64, CELLS).astype(np.uint8) for _ in range(LINES)]
    left_mm = CELLS // 2 * geometry.cell_pitch_mm
    top_mm, bottom_mm = FROM_LINE * geometry.line_pitch_mm, TO_LINE * geometry.line_pitch_mm
    right_mm = geometry.extent_mm(CELLS)
    beside = [
        masks[: CELLS // 2 - 1] if FROM_LINE <= number < TO_LINE else masks
        for number, masks in enumerate(lines)
    ]
    drawn = figure(right_mm - left_mm, bottom_mm - top_mm)
    scene, assets = page_with_figures(
        beside, model.style, (FigureAt(drawn, (left_mm, top_mm), Assets()),)
    )
    both = compile_scene(scene, model.display, assets)
    free = model.style.replace(straying=Straying("free")).render_page(lines, model.display)
    by_lines = model.style.render_page(lines, model.display)
    return both, free, by_lines, np.array([[left_mm, right_mm], [top_mm, bottom_mm]])


def over(program: Program, places: NDArray[np.float64]) -> Callable[[], None]:
    """Frames of a program at places, each by its own call."""
    out = np.zeros(program.shape)
    poses = [(x, y, part_of(program, y)) for x, y in places.T.tolist()]

    def frames() -> None:
        for x, y, part in poses:
            program.frame(x, out, y_mm=y, part=part)

    return frames


def run() -> Iterator[Result]:
    """Measure frames over the page and over the figure."""
    both, free, by_lines, inside = programs()
    rng = np.random.default_rng(2)
    geometry = STRESS2_8X8.style.geometry
    whole = np.array([[0, geometry.extent_mm(CELLS)], [0, LINES * geometry.line_pitch_mm]])
    for where, box in (("the whole page", whole), ("the figure", inside)):
        places = rng.uniform(*box.T[:, :, None], (2, PLACES))
        for how, alone in (("each actuator by itself", free), ("by lines", by_lines)):
            times, least_s = ratio(over(both, places), over(alone, places))
            yield Result(
                f"a frame of a page of {LINES} × {CELLS} cells with a figure, over {where}, "
                f"against the page alone, {how}",
                f"≤ {BAR:g} ×",
                f"{times:.2f} ×, {least_s / PLACES * 1e6:.2f} µs",
                times <= BAR,
            )
