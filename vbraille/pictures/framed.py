"""Scenes for programs: frames of any poses, recordings of a path, scene files."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.files import check_unused, whole_file
from vbraille.pictures.composing import compose
from vbraille.pictures.loading import with_assets
from vbraille.pictures.scenes import small_png
from vbraille.recording import Recording, SceneRecorded
from vbraille.render.braille.models import STRESS2_8X8, Model, check_shown, model_of
from vbraille.scene.converting import write_scene
from vbraille.scene.locations import Locations, OpenedScene
from vbraille.scene.reading import open_scene, resolve
from vbraille.scene.scene import Scene

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.display import Display
    from vbraille.render.program import Program


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
            Velocity of the array along x and y, which signals of the scene may follow; poses are
            then those of one hand in order.
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
        check_shown(display)
        model = display if isinstance(display, Model) else model_of(display)
        at = _poses(poses)
        x_mm, y_mm, theta_rad = at.T
        try:
            time = np.broadcast_to(np.asarray(time_s, np.float64), len(at))
            velocity = np.broadcast_to(np.asarray(velocity_mm_s, np.float64), (len(at), 2))
        except (TypeError, ValueError):
            raise InputError("time_s must be a number or one for each pose, velocity two") from None
        program = self._programs.get(model.display)
        if program is None:
            loaded = with_assets(self, model.style)
            program = compose(loaded, model.display, rate_hz=model.display.rate_hz)
            self._programs[model.display] = program
        return program.poses(x_mm, y_mm, theta_rad, time, velocity)[1]

    def recording(
        self,
        poses: ArrayLike,
        *,
        rate_hz: float = 1000.0,
        display: Model | Display = STRESS2_8X8,
    ) -> Recording:
        """Make what a hand feels on a path over the canvas, whose poses are 1 / rate_hz apart.

        Parameters
        ----------
        poses, display
            As of `frames`.
        rate_hz
            Number of poses a second.

        Raises
        ------
        InputError
            If the numbers do not fit each other, or the scene cannot be shown on the display.
        """
        check_shown(display)
        model = display if isinstance(display, Model) else model_of(display)
        model = replace(model, display=replace(model.display, rate_hz=check_rate(rate_hz)))
        at = _poses(poses)
        x_mm, y_mm, theta_rad = at.T
        nowhere = np.zeros(len(at), np.int64)  # no line, no part
        time_s = np.arange(len(at)) / rate_hz
        step_mm_s = np.gradient(at[:, :2], axis=0) * rate_hz if len(at) > 1 else 0.0
        loaded, canvas = with_assets(self, model.style), self.resolved.canvas
        drawn = small_png(loaded.scene, loaded.assets)
        text = write_scene(self.written).encode()
        return Recording(
            time_s,
            x_mm,
            y_mm,
            theta_rad,
            self.frames(at, time_s, step_mm_s, display=model),
            model,
            [np.zeros(0, np.uint8)],
            nowhere,
            nowhere,
            source=loaded.title,
            scene=SceneRecorded(
                text, loaded.title, self.resolved.description,
                canvas.width_mm, canvas.height_mm, drawn,
            ),
        )  # fmt: skip

    def write(self, path: str | Path, *, replace: bool = False) -> None:
        """Write the scene, as it is `written`, to a scene file.

        Raises
        ------
        InputError
            If no file can be made there, or one is there that may not be replaced.
        """
        check_unused(Path(path), replace=replace)
        with whole_file(Path(path), replace=replace) as partial:
            partial.write_text(write_scene(self.written), encoding="utf-8")

    def _repr_png_(self) -> bytes:
        """Deflection map for a notebook: rest is white, full swing is black."""
        loaded = with_assets(self, STRESS2_8X8.style)
        return small_png(loaded.scene, loaded.assets)


def _poses(poses: ArrayLike) -> NDArray[np.float64]:
    """Places and angles of an array, checked; float64[n, 3]."""
    try:
        at = np.array(poses, np.float64)
    except (TypeError, ValueError):  # no numbers
        at = np.zeros((0, 0))
    if at.ndim != 2 or at.shape[1] not in (2, 3) or not np.isfinite(at).all():
        raise InputError("poses must be finite numbers, [n, 2] or [n, 3]: x, y in mm, angle")
    return np.column_stack([at, np.zeros(len(at))])[:, :3]


def open_framed(scene: str | Path | Scene) -> FramedScene:
    """Open a scene, which then gives frames.

    Parameters
    ----------
    scene
        A scene file, a drawing in SVG, a file of OpenLatero's, or a scene made in Python, whose
        images are seen from the present folder.

    Raises
    ------
    InputError
        If it cannot be read, or is not right; one sentence says where.
    """
    if isinstance(scene, Scene):
        resolved = resolve(scene)
        return FramedScene(Path(scene.title or "scene"), Path(), scene, resolved, Locations())
    opened = open_scene(scene)
    return FramedScene(**{one.name: getattr(opened, one.name) for one in fields(opened)})
