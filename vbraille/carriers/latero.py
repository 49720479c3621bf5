"""The Latero's carrier: three arms whose encoders tell where its array is.

Lengths, offsets and signs are those of the author's own client of the Latero; Lévesque 2009 does
not know the device. The first joint is behind the tray, near its right edge. In the frame of the
arms x grows to the reader's left and y towards the reader. On the tray x grows to the right, and
the origin is where the array's centre is when the disc under it touches the left and the far edge.
Angles grow against the clock as the reader sees it, in both; the arms bend to one side only.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final

from vbraille.carriers.carrier import LATERO, LATERO_DISC_MM, LATERO_TRAY_MM
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

ARMS_MM: Final = (222.3, 245.6, 62.7)  # from the root
# How far the array's centre goes.
WIDTH_MM: Final = LATERO.travel_mm
HEIGHT_MM: Final = LATERO.height_mm
# Place of the first joint in the tray's frame: 11.1 mm left of its right edge, 61.2 mm behind it.
ROOT_X_MM: Final = LATERO_TRAY_MM[0] - 11.1 - LATERO_DISC_MM / 2
ROOT_Y_MM: Final = -61.2 - LATERO_DISC_MM / 2
# Where the array is put when the encoders are reset: the lower left corner, not turned. The third
# arm stands straight up there: from the array it goes straight away from the reader.
RESET: Final = (0.0, HEIGHT_MM, 0.0)
_RAD_A_COUNT: Final = 2 * math.pi / 65_536
_HALF, _WHOLE = 1 << 31, 1 << 32  # the encoders count modulo 2³²


def pose_at(*joints_rad: float) -> tuple[float, float, float]:
    """Pose of the array at three joint angles, counted from the root, in radians.

    Returns
    -------
    x_mm, y_mm, theta_rad
        Centre of the array on the tray, from 0 to `WIDTH_MM` and 0 to `HEIGHT_MM` if it lies flat
        on it, and how far it is turned against the clock.
    """
    x_mm, y_mm, angle_rad = ROOT_X_MM, ROOT_Y_MM, 0.0
    for arm_mm, joint_rad in zip(ARMS_MM, joints_rad, strict=True):
        angle_rad += joint_rad
        x_mm -= arm_mm * math.cos(angle_rad)
        y_mm += arm_mm * math.sin(angle_rad)
    return x_mm, y_mm, angle_rad - math.pi / 2


def joints_at(x_mm: float, y_mm: float, theta_rad: float = 0.0) -> tuple[float, float, float]:
    """Three joint angles, from the root, in radians, at which the array is there: undo `pose_at`.

    These are Lévesque's equations for two arms (A.15, 7.2), with arctangents in place of
    arccosines, which are inexact where the arms are nearly stretched or folded.

    Raises
    ------
    InputError
        If the arms do not reach there, turned as asked; unturned they reach every place.
    """
    a_mm, b_mm, third_mm = ARMS_MM
    angle_rad = theta_rad + math.pi / 2
    x_mm = ROOT_X_MM - x_mm - third_mm * math.cos(angle_rad)
    y_mm = y_mm - ROOT_Y_MM - third_mm * math.sin(angle_rad)
    r_mm = math.hypot(x_mm, y_mm)
    # (2ab)² sin²β, by Heron's formula; 2ab cos β by the law of cosines (eq. A.11).
    square = ((a_mm + b_mm) ** 2 - r_mm**2) * (r_mm**2 - (a_mm - b_mm) ** 2)
    if not square >= 0:
        raise InputError(
            f"arms of {a_mm:g} and {b_mm:g} mm do not reach a place {r_mm:.1f} mm away; they reach "
            f"{abs(a_mm - b_mm):.1f} to {a_mm + b_mm:.1f} mm"
        )
    second = math.atan2(math.sqrt(square), r_mm * r_mm - a_mm * a_mm - b_mm * b_mm)
    bent_rad = math.atan2(b_mm * math.sin(second), a_mm + b_mm * math.cos(second))
    first = math.atan2(y_mm, x_mm) - bent_rad
    return first, second, angle_rad - first - second


RESET_JOINTS: Final = joints_at(*RESET)


def offsets_at(encoders: Sequence[int]) -> tuple[int, ...]:
    """Counts of the encoders at angle 0 of their joints, if the array now stands at `RESET`.

    Parameters
    ----------
    encoders
        Counts of the first three encoders in the device's order, which is from the array to the
        root: encoder 2 is on joint 0. Further ones are not looked at.

    Returns
    -------
    tuple of three int
        In the same order, cut to whole counts as the author's client does.
    """
    pairs = zip(encoders, reversed(RESET_JOINTS), strict=False)
    return tuple(int(count + joint / _RAD_A_COUNT) for count, joint in pairs)


def joints_of(encoders: Sequence[int], offsets: Sequence[int]) -> list[float]:
    """Three joint angles, from the root, in radians, from the first three encoders' counts.

    They count against the angle. A count that has passed 2³² since the reset is no turn.
    """
    counts = (encoders[n] - offsets[n] for n in (2, 1, 0))
    return [-((count + _HALF) % _WHOLE - _HALF) * _RAD_A_COUNT for count in counts]


def encoders_of(joints: Sequence[float], offsets: Sequence[int]) -> tuple[int, int, int]:
    """Counts of the three encoders, 0 … 2³² - 1, in the device's order, at three joint angles."""
    third, second, first = (
        (offset - round(joint / _RAD_A_COUNT)) % _WHOLE
        for offset, joint in zip(offsets, reversed(joints), strict=True)
    )
    return third, second, first
