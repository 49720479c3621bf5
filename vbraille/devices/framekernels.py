"""Compiled steps of each frame on its way to actuators.

These functions fill what they are given and allocate nothing. `vbraille.devices.serial.wire.Levels`
packs the same as `fill` in numpy.
"""

import numpy as np
from numba import njit

from vbraille.caching import keep_compiled

_compiled = njit(cache=keep_compiled(), error_model="numpy", nogil=True)


@_compiled
def in_range(frame):
    """Tell whether all deflections of a frame, float64[rows, columns], are numbers in [0, 1]."""
    for row in range(frame.shape[0]):
        for column in range(frame.shape[1]):
            if not 0.0 <= frame[row, column] <= 1.0:  # NaN fails, too
                return False
    return True


@_compiled
def step_levels(deflections, top_level, share, stands, levels):
    """Go some of the way to deflections whose rest is the highest level.

    Parameters
    ----------
    deflections : float64[rows, columns]
        Deflections that the actuators are to have, in [0, 1].
    top_level : float64
        Level at rest; 0 is full swing.
    share : float64
        Part of the way from where the actuators stand, up to 1.
    stands : float64[rows, columns]
        Levels where they stand, before they are rounded; they are changed.
    levels : uint8[rows, columns]
        Levels to send, which are filled in.
    """
    for row in range(deflections.shape[0]):
        for column in range(deflections.shape[1]):
            stand = deflections[row, column] * -top_level + top_level
            if share < 1.0:
                stand = stands[row, column] + (stand - stands[row, column]) * share
            stands[row, column] = stand
            levels[row, column] = min(max(np.rint(stand), 0.0), top_level)


@_compiled
def fill(deflections, last, wanted, step, swing, rest, bits, out):
    """Fill in the packed levels of a FRAME; tell whether there is anything to feel in it.

    Parameters
    ----------
    deflections, last, wanted : float64[rows, columns]
        Deflections that the actuators are to have, those of the FRAME before, and those of this
        FRAME, which are filled in.
    step : float64
        Largest difference that an actuator may move by from ``last``; infinite for no limit.
    swing : float64[rows, columns]
        Number of levels in a full swing, before it is inverted.
    rest : int64[rows, columns]
        Level at rest: 0, or above it where the actuator is inverted, whose levels count down from
        there; no less than its swing.
    bits : int64
        Number of bits in a level.
    out : uint8[bytes]
        Packed levels, most significant bit first.
    """
    rows, columns = deflections.shape
    held = 0  # bits that do not fill a byte yet
    count = 0
    at = 0
    felt = False
    for row in range(rows):
        for column in range(columns):
            place = deflections[row, column]
            place = min(max(place, last[row, column] - step), last[row, column] + step)
            wanted[row, column] = place
            felt = felt or place > 0.0
            level = int(np.rint(place * swing[row, column]))
            if rest[row, column] > 0:
                level = rest[row, column] - level
            held = (held << bits) | level
            count += bits
            while count >= 8:
                count -= 8
                out[at] = (held >> count) & 0xFF
                at += 1
            held &= (1 << count) - 1
    if count > 0:
        out[at] = (held << (8 - count)) & 0xFF
    return felt
