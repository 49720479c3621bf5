"""The path over a picture that frames and costs are taken on, by its name."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.engine.constants import DIFFERENCE, MEAN
from vbraille.errors import InputError
from vbraille.simulation.exploring import parse_explorer, parse_place, spot, wide
from vbraille.simulation.motion import SLACK, Motion
from vbraille.simulation.recorded import load_recorded
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from vbraille.scene.scene import Canvas


@dataclass(frozen=True, slots=True)
class PathOptions:
    """Choice of a path over a picture; None stands for the usual value.

    Parameters
    ----------
    hand
        "wide" or "wide:SPACING" with the distance between turns in mm, "spot" for one that swings
        about the middle or "spot:X,Y", or "recorded:FILE".
    radius, seconds
        How far a spot path swings in mm, and for how long.
    speed
        Speed in mm/s.
    """

    hand: str = "wide"
    radius: float | None = None
    seconds: float | None = None
    speed: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class PosedPath:
    """Poses of an array on its way over a picture, at even times.

    Parameters
    ----------
    t_s, x_mm, y_mm, theta_rad : float64[n]
        Times from 0 on, and the pose at each; see `vbraille.display`.
    velocity_mm_s : float64[n, 2]
        Velocity of the hand along x and y, as ticks measure it.
    """

    t_s: NDArray[np.float64]
    x_mm: NDArray[np.float64]
    y_mm: NDArray[np.float64]
    theta_rad: NDArray[np.float64]
    velocity_mm_s: NDArray[np.float64]

    def only(self, chosen: NDArray[np.bool_]) -> PosedPath:
        """Make the path of chosen poses, bool[n]."""
        arrays = (self.t_s, self.x_mm, self.y_mm, self.theta_rad, self.velocity_mm_s)
        return PosedPath(*(array[chosen] for array in arrays))


# Options of each path, by the names that `vbraille.simulation.exploring` has for them.
_SPOT: Final = {"radius": "radius_mm", "seconds": "duration_s", "speed": "speed_mm_s"}
_WIDE: Final = {"speed": "speed_mm_s"}
_OPTIONS: Final = {"spot": _SPOT, "wide": _WIDE, "recorded": ()}


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
    kind, _, rest = options.hand.partition(":")
    if kind in _OPTIONS:
        _refuse(options, kind)
    if kind == "recorded" and rest:
        course = load_recorded(rest).motion()
        theta_rad, left_mm = course.theta_rad, span_mm / 2
    else:
        course = _course(options, kind, canvas)
        theta_rad, left_mm = None, 0.0
    t_s = np.arange(1 + int(course.duration_s * rate_hz + SLACK)) / rate_hz
    x_mm, y_mm, theta_rad = (
        np.full(t_s.size, usual) if values is None else np.interp(t_s, course.t_s, values)
        for values, usual in (
            (course.x_mm, 0.0),
            (course.y_mm, canvas.height_mm / 2),
            (theta_rad, 0.0),
        )
    )
    velocity_mm_s = _velocities(x_mm, y_mm, rate_hz)
    return PosedPath(t_s, x_mm + left_mm, y_mm, theta_rad, velocity_mm_s)


def _course(options: PathOptions, kind: str, canvas: Canvas) -> Motion:
    size = canvas.width_mm, canvas.height_mm
    try:
        if options.hand == "spot":
            return spot(size[0] / 2, size[1] / 2, **_given(options, _SPOT))
        if kind == "spot":
            at_mm = parse_place(options.hand.partition(":")[2])
            return spot(*at_mm, **_given(options, _SPOT))
        if kind == "wide":
            given = _given(options, _WIDE)
            return wide(*size, spacing_mm=parse_explorer(options.hand).spacing_mm, **given)
    except ValueError as error:
        raise InputError(str(error)) from None
    raise InputError(
        f"the hand {options.hand!r} does not go over a picture alone; give wide, wide:SPACING, "
        f"spot:X,Y or recorded:FILE.csv"
    )


def _given(options: PathOptions, names: Mapping[str, str]) -> dict[str, float]:
    """Options that were given, by other names."""
    values = {theirs: getattr(options, ours) for ours, theirs in names.items()}
    return {name: value for name, value in values.items() if value is not None}


def _refuse(options: PathOptions, name: str) -> None:
    """Refuse options that a path does not have."""
    for field in fields(options)[1:]:
        if field.name not in _OPTIONS[name] and getattr(options, field.name) is not None:
            other = setting(field.name)
            raise InputError(f"{other} is not for the hand {name}; leave {other} out")


def _velocities(
    x_mm: NDArray[np.float64], y_mm: NDArray[np.float64], rate_hz: float
) -> NDArray[np.float64]:
    """Compute the velocity of a hand on its way, as ticks do: Lévesque 2009, eqs. 9.4 and 9.5.

    Parameters
    ----------
    x_mm, y_mm : float64[n]
        Places of the hand at even times; before the first it stood still.
    rate_hz
        Places a second.

    Returns
    -------
    float64[n, 2]
        Velocity along x and y, in mm/s.
    """
    places = np.stack((x_mm, y_mm), axis=1)
    steps = np.zeros_like(places)
    steps[DIFFERENCE:] = (places[DIFFERENCE:] - places[:-DIFFERENCE]) * (rate_hz / DIFFERENCE)
    sums = np.concatenate([np.zeros((MEAN, 2)), np.cumsum(steps, axis=0)])
    return (sums[MEAN:] - sums[:-MEAN]) / MEAN
