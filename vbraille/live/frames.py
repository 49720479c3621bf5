"""Frames as bytes, and where they come from; `docs/live-view.md` has the header as a table."""

from __future__ import annotations

import math
import struct
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.live.messages import Next, PlayedEvent, Steering

# Sizes of the frame, number of signals; then `FrameHeader`.
_HEADER: Final = struct.Struct("<3H2x5I4x2d8f")
_U32: Final = 0xFFFFFFFF
EMPTY: Final = np.zeros((0, 0), np.float32)


class FrameHeader(NamedTuple):
    """Numbers of a tick.

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
        Pose of the array's centre on the canvas, NaN where unknown, and velocity along x.
    lateness_us, work_us
        From the deadline to the waking, and from then until the frame was written.
    share
        How much of a change has faded in, 0 … 1.
    age_ms
        From the tick until the frame was sent.
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


def frame_bytes(
    header: FrameHeader,
    deflections: NDArray[np.float32] = EMPTY,
    signals: NDArray[np.floating] = EMPTY,
) -> bytes:
    """Pack a frame.

    Parameters
    ----------
    header
        Numbers of the tick.
    deflections
        float32[rows, columns], 0 … 1; 0 × 0 where they are hidden.
    signals
        Values of a picture's signals, float32[n].
    """
    whole = (number & _U32 for number in header[:5])
    packed = _HEADER.pack(*deflections.shape, signals.size, *whole, *header[5:])
    parts = (np.asarray(part, np.float32) for part in (deflections, signals))
    return packed + b"".join(part.tobytes() for part in parts)


class Viewer(Protocol):
    """View of a source by one page."""

    def look(self, request: Next, told: int | None) -> tuple[int, bytes, bytes] | None:
        """Give what a page asks for.

        Parameters
        ----------
        request
            What the page asked.
        told
            Number of the state that it was told last; None gives a frame in any case.

        Returns
        -------
        int, bytes, bytes or None
            Number of the state, the state as JSON, and a frame; None if neither is new.
        """
        ...


class Source(Protocol):
    """Source of what a server shows."""

    @property
    def playback(self) -> bool:
        """Tell whether it is a recording, so that pages name times."""
        ...

    @property
    def length_s(self) -> float:
        """Length of the recording in seconds; 0 without one."""
        ...

    @property
    def moments(self) -> Sequence[PlayedEvent]:
        """Events of the recording, by time."""
        ...

    def viewer(self) -> Viewer:
        """Make the view of a page."""
        ...

    def ask(self, request: Steering) -> None:
        """Take what a page with the right to steer asks for; `InputError` if it cannot be."""
        ...
