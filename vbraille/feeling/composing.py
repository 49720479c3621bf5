"""Programs of scenes, and the frames that they give."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.feeling.loading import with_assets
from vbraille.render import work
from vbraille.render.braille.models import STRESS2_8X8, Model, model_of
from vbraille.render.program import Program
from vbraille.render.scene.compiling import compile_scene, highest_hz
from vbraille.scene.locations import OpenedScene
from vbraille.scene.patterns import Group
from vbraille.scene.reading import open_scene

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from vbraille.display import Display
    from vbraille.feeling.loading import LoadedScene

_COMPILED: Final = ("multiply", "add", "maximum", "overwrite")  # others are a group's


def compose(
    loaded: LoadedScene,
    display: Display,
    *,
    rate_hz: float = 1000.0,
    contrast: float = 1.0,
    own_y_mm: float | None = None,
) -> Program:
    """Compile a scene for a display.

    Parameters
    ----------
    loaded
        The scene.
    display
        Display that it is felt on.
    rate_hz
        Frames a second.
    contrast
        Factor of all its deflections, from 0 to 1.
    own_y_mm
        Height of the canvas that an array is at whose carriage measures no y; None for the middle.

    Raises
    ------
    InputError
        If the scene cannot be shown at this rate, or stands too deep in itself.
    """
    scene = loaded.scene
    whole = contrast == 1.0 and scene.operation in _COMPILED
    if not whole and scene.elements:
        group = Group(operation=scene.operation, parts=scene.elements, amplitude=contrast)
        scene = replace(scene, operation="maximum", elements=(group,))
    try:
        program = compile_scene(scene, display, loaded.assets, rate_hz=rate_hz)
    except ValueError as error:
        _refuse_too_fast(loaded, rate_hz)
        raise InputError(f"{loaded.opened.path}: {error}") from None
    height_mm = scene.canvas.height_mm / 2 if own_y_mm is None else own_y_mm
    program.numbers[work.OWN_Y] = height_mm
    return program


def _refuse_too_fast(loaded: LoadedScene, rate_hz: float) -> None:
    """Say which element moves too fast for the rate, and where it is written."""
    for number, element in enumerate(loaded.scene.elements):
        try:
            highest_hz(element, number + 1, rate_hz)
        except ValueError as error:
            raise InputError(f"{loaded.opened.place(number)}: {error}") from None


def at_height(program: Program, y_mm: float) -> Program:
    """Make the same program for an array that is at another height where it measures none."""
    numbers = program.numbers.copy()
    numbers[work.OWN_Y] = y_mm
    return Program(numbers, program.table)


@dataclass(frozen=True, slots=True)
class FramedScene(OpenedScene):
    """A scene from a file that gives frames; `open_framed` opens one."""

    _programs: dict[Display, Program] = field(default_factory=dict, repr=False, compare=False)

    def frames(
        self,
        poses: ArrayLike,
        time_s: ArrayLike = 0.0,
        velocity_mm_s: ArrayLike = 0.0,
        *,
        display: Model | Display = STRESS2_8X8,
    ) -> NDArray[np.float32]:
        """Compute the frames that an array shows at poses on the canvas.

        It is compiled for a display when frames for that are first asked for.

        Parameters
        ----------
        poses : float64[n, 2] or float64[n, 3]
            Places x, y of the array's centre in mm from the top left corner, and its angles in
            radians, 0 where they are left out.
        time_s : float or float64[n]
            Time since the scene was first shown, in seconds.
        velocity_mm_s : float or float64[n, 2]
            Velocity of the array along x and y. Nothing of today's scenes depends on it.
        display
            Display that the frames are for.

        Returns
        -------
        float32[n, rows, columns]
            Deflections, 0 (rest) to 1 (full swing); 0 beyond the canvas.

        Raises
        ------
        InputError
            If the numbers do not fit each other, or the scene cannot be shown on the display.
        """
        model = display if isinstance(display, Model) else model_of(display)
        at = np.array(poses, np.float64)
        if at.ndim != 2 or at.shape[1] not in (2, 3) or not np.isfinite(at).all():
            raise InputError("poses must be finite numbers, [n, 2] or [n, 3]: x, y in mm, angle")
        try:
            time = np.broadcast_to(np.asarray(time_s, np.float64), len(at))
            velocity = np.broadcast_to(np.asarray(velocity_mm_s, np.float64), (len(at), 2))
        except ValueError:
            raise InputError("time_s must be a number or one for each pose, velocity two") from None
        program = self._programs.get(model.display)
        if program is None:
            loaded = with_assets(self, model.style)
            program = compose(loaded, model.display, rate_hz=model.display.rate_hz)
            self._programs[model.display] = program
        theta = at[:, 2] if at.shape[1] == 3 else 0.0
        return program.poses(at[:, 0], at[:, 1], theta, time, velocity)[1]


def open_framed(path: str | Path) -> FramedScene:
    """Open a scene file, a drawing in SVG, or a file of OpenLatero's, which then gives frames.

    Raises
    ------
    InputError
        If it cannot be read, or is not right; one sentence says where.
    """
    opened = open_scene(path)
    return FramedScene(**{one.name: getattr(opened, one.name) for one in fields(opened)})
