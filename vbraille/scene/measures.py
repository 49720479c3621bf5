"""Numbers that a picture may have, and the checks of them that all its parts share."""

from __future__ import annotations

import math

from vbraille.errors import check_range

# A place on the canvas, x and y in mm: x grows to the right, y down towards the reader.
Point = tuple[float, float]

# No table is larger, and floating point is still good to a nanometre there.
MOST_MM = 10_000.0
# Ridges below this size are finer than any array can show, and would cost as much as coarse ones.
LEAST_MM = 0.05
# Two points of a path that are nearer are one: there is no direction between them.
LEAST_APART_MM = 1e-6
LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ = 0.1, 50.0
LEAST_ZOOM, MOST_ZOOM = 0.5, 16.0


def check_length(what: str, value_mm: float | None, least_mm: float = LEAST_MM) -> None:
    """Check a length, width or radius; None passes.

    Raises
    ------
    ValueError
        If it is below the least one or above 10 m, or no number.
    """
    check_range(what, value_mm, least_mm, MOST_MM, " mm")


def check_point(what: str, point_mm: Point) -> None:
    """Check that a place is on or near a canvas.

    Raises
    ------
    ValueError
        If a coordinate is no number, or farther than 10 m from the origin.
    """
    for axis, value in zip("xy", point_mm, strict=True):
        check_range(f"{what}, {axis}", value, -MOST_MM, MOST_MM, " mm")


def check_share(what: str, value: float | None) -> None:
    """Check an amplitude or another share; None passes.

    Raises
    ------
    ValueError
        If it is not from 0 to 1.
    """
    check_range(what, value, 0.0, 1.0)


def check_zooms(begins: float | None, ends: float | None) -> None:
    """Check the zooms from which on a pattern is there, and is not; None for no such limit.

    Raises
    ------
    ValueError
        If one is beyond what pictures are zoomed to, or it would never be there.
    """
    check_range("zoom_from", begins, LEAST_ZOOM, MOST_ZOOM)
    check_range("zoom_to", ends, LEAST_ZOOM, MOST_ZOOM)
    if begins is not None and ends is not None and begins >= ends:
        raise ValueError(
            f"zoom_to is {ends:g}, and zoom_from {begins:g}, so that it is never there; "
            "give zoom_to a larger number"
        )


def check_angle(what: str, value_deg: float | None) -> None:
    """Check an angle in degrees; None passes.

    Raises
    ------
    ValueError
        If it is beyond a turn in either direction, or no number.
    """
    check_range(what, value_deg, -360.0, 360.0, "°")


def travel_deg(wave_angle_deg: float | None, ridge_angle_deg: float | None) -> float:
    """Direction in which a grating's wave travels, in degrees from +x towards +y.

    A file says either that or the direction of the ridges, a quarter turn less (Lévesque 2009,
    6.3.3 and 8.4.1, which use the two differently). Without either the wave travels along x.
    """
    if ridge_angle_deg is not None:
        return math.fmod(ridge_angle_deg + 90.0, 360.0)
    return 0.0 if wave_angle_deg is None else wave_angle_deg


def check_velocity_by(name: str, moves: bool) -> None:
    """Refuse the name of a signal as the speed of what does not move.

    Raises
    ------
    ValueError
        If there is such a name, and no velocity.
    """
    if name and not moves:
        raise ValueError(f"velocity_by is {name!r} without a velocity; add one, or leave it out")


def check_file(name: str, what: str = "file") -> None:
    """Check the name of a file that is read with a scene, by a key.

    Raises
    ------
    ValueError
        If it is empty, or a place in the net, since nothing is fetched.
    """
    if not name.strip():
        raise ValueError(f"{what} is empty; give the name of a file")
    if "://" in name:
        raise ValueError(f"{what} is {name!r}; give the name of a file, since nothing is fetched")
