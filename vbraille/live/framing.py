"""Frames and maps as bytes; `docs/live-view.md` has their headers as tables.

A frame is its header, the deflections, samples of the ticks since the frame before, and the values
of a picture's signals.
"""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from vbraille.live.messages import (
    FRAME_KIND,
    MAP_KIND,
    MOST_SAMPLES,
    VERSION,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Kind, version, number of samples, `FrameHeader`, rows, columns, number of signals; and kind, form,
# size of the file.
# Packing so takes a tenth of the time that numpy needs.
_FRAME: Final = struct.Struct("<BBHIIIIIdd8fHHI")
_MAP: Final = struct.Struct("<BBHI")
_U32: Final = 0xFFFFFFFF
_SAMPLE_BYTES, _FLOAT_BYTES = 12, 4


class FrameHeader(NamedTuple):
    """Facts in the header of a frame, beside the sizes of its parts.

    Parameters
    ----------
    flags
        Bits of `vbraille.engine.record.Flag`.
    state
        Number of the state that the frame belongs to.
    line, part
        Number of what is under the hand, 0 before the first, and which part of it is shown.
    late
        Deadlines missed so far.
    tick, time_s
        Number of the tick, from 0, and when it woke; in a recording, seconds from its start.
    x_mm, y_mm, theta_rad, vx_mm_s
        Place of the array's centre on the canvas, NaN where it is not known, how far it is turned,
        and the hand's velocity along x.
    lateness_us, work_us
        From the deadline to the waking, and from then until the frame was written.
    share
        How much of a change has faded in: 1 is all.
    age_ms
        From the tick until the frame was sent; 0 in a recording.
    """

    flags: int = 0
    state: int = 0
    line: int = 0
    part: int = 0
    late: int = 0
    tick: float = 0.0
    time_s: float = 0.0
    x_mm: float = math.nan
    y_mm: float = math.nan
    theta_rad: float = math.nan
    vx_mm_s: float = math.nan
    lateness_us: float = 0.0
    work_us: float = 0.0
    share: float = 1.0
    age_ms: float = 0.0


NO_DEFLECTIONS: Final = np.zeros((0, 0), np.float32)


def frame_bytes(
    header: FrameHeader,
    deflections: NDArray[np.float32] = NO_DEFLECTIONS,
    samples: NDArray[np.float32] = NO_DEFLECTIONS,
    signals: NDArray[np.float32] = NO_DEFLECTIONS,
) -> bytes:
    """Bytes of a frame.

    Parameters
    ----------
    header
        All numbers of the header but the sizes.
    deflections
        Deflections, float32[rows, columns], 0 … 1; 0 × 0 where they are not shown.
    samples
        Samples, float32[samples, 3], oldest first: seconds before this tick, place of the array's
        centre in mm, deflection of the actuator that the page follows.
    signals
        Values of the signals of the state, float32[signals].
    """
    parts = deflections.tobytes(), samples.tobytes(), signals.tobytes()
    return joined(header, deflections.shape, *parts)


def joined(
    header: FrameHeader,
    shape: tuple[int, ...],
    deflections: bytes,
    samples: bytes,
    signals: bytes = b"",
) -> bytes:
    """Bytes of a frame of which all but the header is bytes already, as `frame_bytes` takes it."""
    flags, state, line, part, late, *numbers = header
    count = len(samples) // _SAMPLE_BYTES
    sizes = FRAME_KIND, VERSION, count, flags, state & _U32, line & _U32, part & _U32, late & _U32
    packed = _FRAME.pack(*sizes, *numbers, *shape, len(signals) // _FLOAT_BYTES)
    return b"".join((packed, deflections, samples, signals))


def map_bytes(file: bytes, form: str) -> bytes:
    """Bytes of a map: its header, and the bytes of a file of the form, "png" or "svg"."""
    return _MAP.pack(MAP_KIND, form == "svg", 0, len(file)) + file


def thinned(count: int) -> NDArray[np.intp]:
    """Choose which of so many ticks are sent as samples: at most `MOST_SAMPLES`, evenly.

    The newest is always among them.

    Returns
    -------
    int64[n]
        Indices, from the oldest to the newest.
    """
    if count <= MOST_SAMPLES:
        return np.arange(count)
    return count - 1 - np.arange(MOST_SAMPLES)[::-1] * count // MOST_SAMPLES
