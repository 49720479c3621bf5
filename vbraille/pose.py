"""Where the array is, and where its actuators are then; nothing else in the program says so.

The canvas is the surface that a picture stands on, in mm: its origin is the top left, x grows to
the reader's right, and y grows down, towards the reader, as in images. On a canvas of braille
x = 0 is the left edge of a line's first cell, and line n (from 0) takes y from n to n + 1 line
pitches, with its dots around the middle.

The array's *centre* is the middle of its actuators, and θ turns the array about it. With q the
place of an actuator right of and below the centre of an array that is not turned, the actuator is
at (Lévesque 2009, 8.3.1, with the direction of θ as in its author's later code)::

    x + q_x cos θ + q_y sin θ,    y + q_y cos θ - q_x sin θ

so that a positive θ turns the array against the clock, as the reader sees it.
"""

from __future__ import annotations

from typing import NamedTuple


class Pose(NamedTuple):
    """Where the array is, and when.

    Parameters
    ----------
    time_ns
        Time of the pose, in ns of the device's clock.
    x_mm, y_mm
        The array's centre on the canvas. At the left stop of a slider the whole array stands
        before the line: x = -(columns - 1) / 2 · pitch. A slider measures no y: it says 0, and
        the picture is shown where it has its dots.
    theta_rad
        Angle by which the array is turned, in radians; 0 where that is not measured.
    """

    time_ns: int
    x_mm: float
    y_mm: float = 0.0
    theta_rad: float = 0.0
