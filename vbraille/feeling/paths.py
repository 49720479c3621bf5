"""The path over a picture that frames and costs are taken on, by its name."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.simulation.exploring import Disturbance, ExploringPath, parse_place, spot, wide
from vbraille.simulation.motion import SLACK
from vbraille.simulation.recorded import load_recorded
from vbraille.wording import setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.scene.scene import Canvas


@dataclass(frozen=True, slots=True)
class PathOptions:
    """How a path over a picture is chosen; None stands for what is usual.

    Parameters
    ----------
    name
        "wide", "spot" or "recorded:FILE".
    at
        Place that a spot path swings about, as X,Y.
    radius, seconds
        How far it swings in mm, and for how long.
    spacing
        Distance between turns of a wide path in mm.
    speed
        Speed in mm/s.
    sway, unsteady, back
        Disturbances of a wide path; see `vbraille.simulation.exploring.Disturbance`.
    """

    name: str = "wide"
    at: str | None = None
    radius: float | None = None
    seconds: float | None = None
    spacing: float | None = None
    speed: float | None = None
    sway: float | None = None
    unsteady: float | None = None
    back: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class PosedPath:
    """Poses of an array on its way over a picture, at even times.

    Parameters
    ----------
    t_s, x_mm, y_mm, theta_rad : float64[n]
        Times from 0 on, and the pose at each; see `vbraille.pose`.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]
    theta_rad: NDArray[np.float64]

    def only(self, chosen: NDArray[np.bool_]) -> PosedPath:
        """Make the path of chosen poses, bool[n]."""
        arrays = (self.t_s, self.x_mm, self.y_mm, self.theta_rad)
        return PosedPath(*(array[chosen] for array in arrays))


_SPOT = ("at", "radius", "seconds")
_WIDE = ("spacing", "sway", "unsteady", "back")


def path_of(options: PathOptions, canvas: Canvas, span_mm: float, rate_hz: float) -> PosedPath:
    """Make the poses of a path.

    Parameters
    ----------
    options
        Which path.
    canvas
        Canvas that it goes over.
    span_mm
        Distance between the outer columns of the array.
    rate_hz
        Poses a second.

    Raises
    ------
    InputError
        If there is no such path, an option is for another one, or a number is out of range.
    """
    kind, _, rest = options.name.partition(":")
    if kind == "recorded" and rest:
        _refuse(options, "recorded", (*_SPOT, *_WIDE, "speed"))
        motion = load_recorded(rest).motion()
        t_s = _times(motion.duration_s, rate_hz)
        places = (motion.x_mm, motion.y_mm, motion.theta_rad)
        x_mm, y_mm, theta_rad = (
            np.zeros(t_s.size) if values is None else np.interp(t_s, motion.t_s, values)
            for values in places
        )
        if motion.y_mm is None:
            y_mm = np.full(t_s.size, canvas.height_mm / 2)
        return PosedPath(t_s, x_mm + span_mm / 2, y_mm, theta_rad)
    course = _course(options, canvas)
    t_s = _times(course.duration_s, rate_hz)
    x_mm = np.interp(t_s, course.t_s, course.x_mm)
    y_mm = np.interp(t_s, course.t_s, course.y_mm)
    return PosedPath(t_s, x_mm, y_mm, np.zeros(t_s.size))


def _times(duration_s: float, rate_hz: float) -> NDArray[np.float64]:
    return np.arange(1 + int(duration_s * rate_hz + SLACK)) / rate_hz


def _course(options: PathOptions, canvas: Canvas) -> ExploringPath:
    speed_mm_s = 60.0 if options.speed is None else options.speed
    try:
        if options.name == "spot":
            _refuse(options, "spot", _WIDE)
            middle = canvas.width_mm / 2, canvas.height_mm / 2
            return spot(
                *(middle if options.at is None else parse_place(options.at)),
                radius_mm=5.0 if options.radius is None else options.radius,
                speed_mm_s=speed_mm_s,
                duration_s=10.0 if options.seconds is None else options.seconds,
            )
        if options.name == "wide":
            _refuse(options, "wide", _SPOT)
            disturbance = Disturbance(
                sway_mm=options.sway or 0.0,
                speed_change=options.unsteady or 0.0,
                back_mm=options.back or 0.0,
            )
            return wide(
                canvas.width_mm,
                canvas.height_mm,
                spacing_mm=10.0 if options.spacing is None else options.spacing,
                speed_mm_s=speed_mm_s,
                disturbance=disturbance,
            )
    except ValueError as error:
        raise InputError(str(error)) from None
    raise InputError(f"there is no path {options.name!r}; give wide, spot or recorded:FILE.csv")


def _refuse(options: PathOptions, name: str, others: tuple[str, ...]) -> None:
    """Refuse options that a path does not have."""
    for other in others:
        if getattr(options, other) is not None:
            raise InputError(
                f"{setting(other)} is not for the path {name}; leave {setting(other)} out"
            )
