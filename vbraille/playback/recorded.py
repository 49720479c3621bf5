"""A recording as a source of the live view: each page asks for frames of the times it wants.

Frames are read by the piece, so that memory holds seconds of them and not hours.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from functools import lru_cache
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.live.frames import EMPTY, FrameHeader, frame_bytes
from vbraille.live.messages import to_json

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.live.messages import Next, PlayedEvent, Steering, ViewState

# What is known of each frame, by the names of `vbraille.live.frames.FrameHeader`.
PLAYED: Final = np.dtype(
    [
        ("flags", "u4"),
        ("line", "u4"),
        ("part", "u4"),
        ("late", "u4"),
        ("tick", "f8"),
        ("time_s", "f8"),  # seconds from the start of the recording
        ("x_mm", "f8"),
        ("y_mm", "f8"),
        ("theta_rad", "f8"),
        ("vx_mm_s", "f8"),
        ("share", "f8"),
        ("scene", "i8"),  # number of what a page shows beside the frames
    ]
)
_HEADER: Final = PLAYED.names[:-1] if PLAYED.names else ()
# A page asks for the next frame of the same piece soon.
_MOST_PIECES: Final = 12


class Piece(NamedTuple):
    """Frames that follow each other.

    Parameters
    ----------
    ticks : `PLAYED`[n]
        What is known of each beside its deflections; times never go back.
    frames : float32[n, rows, columns]
        Deflections, 0 … 1; NaN where they are not known.
    """

    ticks: NDArray[np.void]
    frames: NDArray[np.float32]

    def after(self, at_s: float) -> int:
        """Give the index of the first frame later than a time; their number if none is."""
        return int(np.searchsorted(self.ticks["time_s"], at_s, "right"))


class Playback(ABC):
    """Recorded frames, of which any can be asked for; a `vbraille.live.frames.Source`.

    Attributes
    ----------
    length_s : float
        Length in seconds.
    pieces : int
        Number of pieces.
    moments : list[PlayedEvent]
        What happened, by time.
    notes : list[str]
        Sentences for the user who plays it, such as on damage.
    """

    playback = True
    length_s: float
    pieces: int
    moments: list[PlayedEvent]

    def __init__(self) -> None:
        self.notes: list[str] = []
        self.piece = lru_cache(_MOST_PIECES)(self.read)
        self.state = lru_cache(256)(self._state)
        self._first_s = lru_cache(None)(self.first_s)

    @abstractmethod
    def first_s(self, number: int) -> float:
        """Give the time of the first frame of a piece; about, where it is damaged."""

    @abstractmethod
    def read(self, number: int) -> Piece:
        """Read a piece, which is empty where the recording is damaged."""

    @abstractmethod
    def describe(self, scene: int) -> ViewState:
        """Make what a page shows beside the frames of a scene; its number is given here."""

    def viewer(self) -> RecordingViewer:
        """Make the view of a page."""
        return RecordingViewer(self)

    def ask(self, request: Steering) -> None:  # noqa: ARG002
        """Refuse what a page wants changed.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError("a recording is played back: nothing in it can be changed")

    def locate(self, at_s: float) -> tuple[int, int]:
        """Find the frame of a time, as the number of its piece and its index in that.

        Pieces that are damaged are passed over: the last whole frame before is shown on, or the
        first one after if there is none.

        Raises
        ------
        InputError
            If no frame is whole.
        """
        number = max(bisect_right(range(self.pieces), at_s, key=self._first_s) - 1, 0)
        for at in (*range(number, -1, -1), *range(number + 1, self.pieces)):
            piece = self.piece(at)
            if piece.ticks.size:
                return at, max(piece.after(at_s) - 1, 0)
        raise InputError("no frame of the recording is whole; there is nothing to play")

    def _state(self, scene: int) -> bytes:
        return to_json(replace(self.describe(scene), number=scene + 1))


class RecordingViewer:
    """View of a recording by one page."""

    def __init__(self, recording: Playback) -> None:
        self._recording = recording
        self._at_s = 0.0

    def look(self, request: Next, told: int | None) -> tuple[int, bytes, bytes]:  # noqa: ARG002
        """Give the frame of a time."""
        recording = self._recording
        if request.at_s is not None and math.isfinite(request.at_s):
            self._at_s = min(max(request.at_s, 0.0), recording.length_s)
        number, index = recording.locate(self._at_s)
        piece = recording.piece(number)
        tick, frame = piece.ticks[index], piece.frames[index]
        scene = int(tick["scene"])
        header = FrameHeader(
            **{name: tick[name].item() for name in _HEADER},
            state=scene + 1,
            lateness_us=math.nan,
            work_us=math.nan,
        )
        felt = EMPTY if np.isnan(frame).any() else frame
        return scene + 1, recording.state(scene), frame_bytes(header, felt)
