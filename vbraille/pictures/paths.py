"""The path of a simulated hand over a picture, on which frames are rendered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.constants import DIFFERENCE, MEAN
from vbraille.errors import InputError
from vbraille.simulation.exploring import Explorer
from vbraille.simulation.recorded import Recorded
from vbraille.simulation.steering import Area
from vbraille.wording import setting

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.scene.scene import Canvas
    from vbraille.simulation.hand import Hand


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


def path_of(hand: Hand, canvas: Canvas, span_mm: float, rate_hz: float) -> PosedPath:
    """Return the poses of a hand on its way over a picture.

    Parameters
    ----------
    hand
        Hand that goes over pictures by itself, or was recorded.
    canvas
        Canvas that it goes over.
    span_mm
        Distance between the outer columns of the array.
    rate_hz
        Poses a second.

    Raises
    ------
    InputError
        If the hand does not go over pictures by itself.
    """
    if not isinstance(hand, Explorer | Recorded):
        raise InputError(
            f"this hand does not go over a picture; give {setting('hand')} wide, wide:SPACING, "
            f"spot, spot:X,Y or recorded:FILE.csv"
        )
    course = hand.read_page(Area(1, canvas.height_mm, canvas.width_mm, start_mm=-span_mm))
    t_s, x_mm, y_mm, theta_rad = course.sample(rate_hz, canvas.height_mm / 2)
    x_mm += span_mm / 2
    return PosedPath(t_s, x_mm, y_mm, theta_rad, _velocities(x_mm, y_mm, rate_hz))


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
