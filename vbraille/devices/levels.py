"""Compiled steps of each frame on its way to actuators: a check, and levels packed for the wire."""

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
def pack(frame, top, out):
    """Fill in the levels of a FRAME: round(deflection · top), row by row.

    Parameters
    ----------
    frame : float64[rows, columns]
        Deflections in [0, 1].
    top : int
        Level of a full swing; levels have a byte each, or 10 bits where it is above 255.
    out : uint8[bytes]
        Packed levels, least significant bit first.
    """
    bits = 8 if top <= 255 else 10
    held, count, at = 0, 0, 0  # bits that do not fill a byte yet, their number, and the next byte
    for n in range(frame.size):
        held |= int(np.rint(frame.flat[n] * top)) << count
        count += bits
        while count >= 8:
            out[at] = held & 0xFF
            held >>= 8
            count -= 8
            at += 1
    if count > 0:
        out[at] = held & 0xFF
