"""The Tactograph of Lévesque 2009, ch. 7 and appendix A: two arms and a turning array.

The first joint is behind the middle of the tray. In the frame of the arms, which is that of the
source, x grows along the tray and y away from the joint over it. Where the reader sits is lost in
the scan: here y grows towards the reader and x to the reader's right, as on our canvas, so that
the angles of the arms grow with the clock as the reader sees it. Where the canvas lies on the tray
is silent as well, and what the third encoder calls 0: both are our choice, made here.
"""

from __future__ import annotations

import math
from typing import Final

from vbraille.carriers.carrier import TACTOGRAPH
from vbraille.carriers.planar import Arms, ThreeArms

# A.72 ff.: the lengths that were chosen, k = 0.81; the array turns about the arms' end.
ARMS: Final = Arms(210.0, 170.0)
COUNTS_A_TURN: Final = 65_536
# The rectangle that the arms were made for, as wide and as high as a letter page: it begins 120 mm
# from the first joint, and the joint is behind its middle.
PAGE_MM: Final = (279.4, 215.9)
NEAR_MM: Final = 120.0
# What was left of it. Our choice is its place, in the middle: there the resolution is from 23.6 to
# 45.2 µm, as the source says of it.
WIDTH_MM: Final = TACTOGRAPH.travel_mm
HEIGHT_MM: Final = TACTOGRAPH.height_mm
# The array's own encoder: 0.072°, which is 4.32 minutes of arc.
TURN_COUNTS: Final = 5000

_LEFT_MM: Final = -WIDTH_MM / 2
_FAR_MM: Final = NEAR_MM + (PAGE_MM[1] - HEIGHT_MM) / 2
_LINKAGE: Final = ThreeArms(ARMS, 0.0)
_RAD_A_COUNT: Final = 2 * math.pi / COUNTS_A_TURN
_RAD_A_TURN_COUNT: Final = 2 * math.pi / TURN_COUNTS


def canvas_at(x_mm: float, y_mm: float) -> tuple[float, float]:
    """Place on the canvas, from its upper left corner, of a place in the frame of the arms."""
    return x_mm - _LEFT_MM, y_mm - _FAR_MM


def arms_at(x_mm: float, y_mm: float) -> tuple[float, float]:
    """Place in the frame of the arms of a place on the canvas: undo `canvas_at`."""
    return x_mm + _LEFT_MM, y_mm + _FAR_MM


def pose_at(alpha: float, beta: float, gamma: float) -> tuple[float, float, float]:
    """Pose of the array at the angles of its joints, in radians (eq. 7.1).

    Parameters
    ----------
    alpha, beta
        Angles of the two arms.
    gamma
        Angle of the array on the second arm; 0 when the array's right side points along it.

    Returns
    -------
    x_mm, y_mm, theta_rad
        The array's centre on the canvas, and how far it is turned against the clock.
    """
    x_mm, y_mm, whole_rad = _LINKAGE.forward(alpha, beta, gamma)
    return *canvas_at(x_mm, y_mm), -whole_rad


def joints_at(x_mm: float, y_mm: float, theta_rad: float = 0.0) -> tuple[float, float, float]:
    """Angles of the three joints, in radians, at which the array is there: undo `pose_at` (7.2).

    Raises
    ------
    InputError
        If the arms do not reach there; they reach the whole canvas.
    """
    return _LINKAGE.inverse(*arms_at(x_mm, y_mm), -theta_rad)


def measured(x_mm: float, y_mm: float, theta_rad: float = 0.0) -> tuple[float, float, float]:
    """Pose that the encoders tell, to their nearest counts, when the array is at this one."""
    alpha, beta, gamma = joints_at(x_mm, y_mm, theta_rad)
    return pose_at(
        round(alpha / _RAD_A_COUNT) * _RAD_A_COUNT,
        round(beta / _RAD_A_COUNT) * _RAD_A_COUNT,
        round(gamma / _RAD_A_TURN_COUNT) * _RAD_A_TURN_COUNT,
    )
