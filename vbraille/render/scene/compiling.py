"""Scenes, compiled for a display; `vbraille.render.machine.words` has what their programs say."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.render import work
from vbraille.render.machine import words
from vbraille.render.program import Program, head
from vbraille.render.scene.assets import Assets
from vbraille.render.scene.flat import flatten
from vbraille.render.scene.grid import TileGrid, assemble
from vbraille.render.scene.nodes import NodeKind, joined
from vbraille.render.scene.trees import deflection, layer
from vbraille.render.work import ProgramKind
from vbraille.scene.patterns import Shape
from vbraille.scene.textures import AxialGrating, LinearGrating, RadialGrating
from vbraille.scene.traversal import drawn_vibrations, each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.display import Display
    from vbraille.render.scene.flat import Flat
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Scene


_KINDS = {
    "multiply": NodeKind.MULTIPLY,
    "add": NodeKind.ADD,
    "maximum": NodeKind.MAXIMUM,
    "overwrite": NodeKind.OVER,
}


def compile_scene(
    scene: Scene,
    display: Display,
    assets: Assets | None = None,
    *,
    rate_hz: float = 1000.0,
    pruned: bool = True,
) -> Program:
    """Compile a scene for a display.

    Parameters
    ----------
    scene
        A resolved scene: without `Use` and `ImageDots`.
    display
        Display that shows it.
    assets
        Bitmaps of its images and cells of its labels.
    rate_hz
        Frames a second, of which a vibration may take half.
    pruned
        Whether what an actuator cannot touch is left out; only tests and benchmarks do without.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, or patterns stand too deep in each other.
    """
    moves_hz = [
        highest_hz(element, number, rate_hz) for number, element in enumerate(scene.elements, 1)
    ]
    flat = flatten_scene(scene, assets or Assets())
    radius_mm = 0.5 * math.hypot(display.span_mm, display.depth_mm)
    grid = TileGrid.over(scene.canvas, radius_mm, pruned)
    numbers = head(display, ProgramKind.SCENE, words.GRID)
    numbers[words.COLUMN_MM] = display.column_pitch_mm
    numbers[words.ROW_MM] = display.row_pitch_mm
    numbers[work.FREQUENCY] = max(moves_hz, default=0.0)
    numbers[work.AMPLITUDE] = numbers[work.FREQUENCY] > 0.0
    return Program(*assemble(numbers, scene.canvas, grid, flat))


def flatten_scene(scene: Scene, assets: Assets) -> Flat | None:
    """Make plain arrays of a scene; None if there is nothing in it.

    Raises
    ------
    ValueError
        If patterns stand too deep in each other, or elements cannot be put together by the scene's
        operation.
    """
    if scene.operation not in _KINDS:
        raise ValueError(
            f'operation = "{scene.operation}" is for groups; put the elements into one'
        )
    if not scene.elements:
        return None
    node = layer if scene.operation == "overwrite" else deflection
    elements = tuple(node(element, assets) for element in scene.elements)
    return flatten(joined(_KINDS[scene.operation], elements))


def highest_hz(pattern: AnyPattern, number: int, rate_hz: float) -> float:
    """Find the highest frequency of what moves in an element by itself; 0 if nothing does.

    Parameters
    ----------
    pattern, number
        The element, and its number in the scene, from 1.
    rate_hz
        Frames a second that show it.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, so that it would be shown as another.
    """
    highest = 0.0
    for part in each(pattern):
        for hz in _frequencies(part):
            if hz > rate_hz / 2:
                name = part.id or pattern.id
                named = f'"{name}"' if name else f"number {number}"
                raise ValueError(
                    f"element {named} moves at {hz:g} Hz; it can be at most half of the rate, "
                    f"{rate_hz / 2:g} Hz"
                )
            highest = max(highest, hz)
    return highest


def _frequencies(pattern: AnyPattern) -> Iterator[float]:
    """Frequencies of a pattern itself, without those that stand in it."""
    for vibration in (pattern.vibration, *drawn_vibrations(pattern)):
        if vibration is not None and vibration.amplitude > 0.0:
            yield vibration.frequency_hz
    if isinstance(pattern, Shape):
        along = None if pattern.stroke is None else pattern.stroke.along
        if along is not None and along.velocity_mm_s:
            yield abs(along.velocity_mm_s) / (along.ridge_mm + along.gap_mm)
    elif isinstance(pattern, LinearGrating | RadialGrating):
        if pattern.velocity_mm_s:
            yield abs(pattern.velocity_mm_s) / (pattern.ridge_mm + pattern.gap_mm)
    elif isinstance(pattern, AxialGrating) and pattern.velocity_deg_s:
        yield abs(pattern.velocity_deg_s) / (pattern.ridge_deg + pattern.gap_deg)
