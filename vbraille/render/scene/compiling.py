"""Scenes, compiled for a display; `vbraille.render.machine.words` has what their programs say."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from vbraille.render import work
from vbraille.render.machine import words
from vbraille.render.program import Program, head
from vbraille.render.scene.assets import Assets
from vbraille.render.scene.elements import FlatElements
from vbraille.render.scene.grid import TileGrid, assemble
from vbraille.render.work import ProgramKind

if TYPE_CHECKING:
    from vbraille.display import Display
    from vbraille.scene.scene import Scene

_RATE_HZ = 1000.0
_NO_ASSETS = Assets()


def compile_scene(
    scene: Scene,
    display: Display,
    assets: Assets | None = None,
    *,
    rate_hz: float = _RATE_HZ,
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
    return SceneCompiler(display, rate_hz=rate_hz, pruned=pruned).compile(scene, assets)


class SceneCompiler:
    """Compiles scenes that follow each other, of which most of the elements stay as they are.

    What has not changed is known by being the same object, so that a change of one element among
    thousands takes no longer than putting them together.

    Parameters
    ----------
    display
        Display that shows the scenes.
    rate_hz
        Frames a second, of which a vibration may take half.
    pruned
        Whether what an actuator cannot touch is left out.
    """

    def __init__(self, display: Display, *, rate_hz: float = _RATE_HZ, pruned: bool = True) -> None:
        self._display, self._rate_hz, self._pruned = display, rate_hz, pruned
        self._elements = FlatElements()

    def compile(self, scene: Scene, assets: Assets | None = None) -> Program:
        """Compile a scene; see `compile_scene`."""
        flat = self._elements.put_together(scene, assets or _NO_ASSETS, self._rate_hz)
        display = self._display
        radius_mm = 0.5 * math.hypot(display.span_mm, display.depth_mm)
        grid = TileGrid.over(scene.canvas, radius_mm, self._pruned)
        numbers = head(display, ProgramKind.SCENE, words.GRID)
        numbers[words.COLUMN_MM] = display.column_pitch_mm
        numbers[words.ROW_MM] = display.row_pitch_mm
        numbers[work.FREQUENCY] = 0.0 if flat is None else flat.frequency_hz
        numbers[work.AMPLITUDE] = numbers[work.FREQUENCY] > 0.0
        return Program(*assemble(numbers, scene.canvas, grid, flat))
