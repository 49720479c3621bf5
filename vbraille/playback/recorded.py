"""A recording as a source of the live view: each page asks for frames of the times it wants.

Frames are read by the piece, so that memory holds seconds of them and not hours.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from bisect import bisect_right
from dataclasses import dataclass
from functools import cache, lru_cache
from threading import RLock
from typing import TYPE_CHECKING, Final

import msgspec
import numpy as np

from vbraille.errors import InputError
from vbraille.live.framing import NO_DEFLECTIONS, FrameHeader, frame_bytes, thinned
from vbraille.live.maps import picture

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.live.messages import Map, Next, PlayedEvent, ViewState
    from vbraille.live.sources import Steering
    from vbraille.render.program import Program

# What is known of each frame, by the names of `vbraille.live.framing.FrameHeader`.
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
_HEADER: Final = tuple(name for name in PLAYED.names or () if name != "scene")
# Pieces and states that are kept, since a page asks for the next frame of the same piece soon.
_MOST_PIECES: Final = 12
_MOST_STATES: Final = 256
# A page that asks for a time far from the one before gets ticks of so long a stretch, no more.
_LONGEST_S: Final = 4.0


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Some frames that follow each other.

    Parameters
    ----------
    ticks : `PLAYED`[n]
        What is known of each frame beside its deflections; times never go back.
    frames : float32[n, rows, columns]
        Deflections, 0 … 1; NaN where they are not known.
    """

    ticks: NDArray[np.void]
    frames: NDArray[np.float32]

    @classmethod
    def damaged(cls, display: Display) -> Piece:
        """Make a piece without frames, for what cannot be read."""
        return cls(np.zeros(0, PLAYED), np.zeros((0, *display.shape), np.float32))

    def after(self, at_s: float, stop: int | None = None) -> int:
        """Index of the first of some frames that is later than a time; their number if none is."""
        return int(np.searchsorted(self.ticks["time_s"][:stop], at_s, "right"))


class Playback(ABC):
    """Recorded frames, of which any can be asked for at any time; a `LiveSource`.

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
        self._lock = RLock()  # maps are drawn in a thread of their own
        self._piece = lru_cache(_MOST_PIECES)(self.read)
        self._state = lru_cache(_MOST_STATES)(self._encode)
        self._first_s = cache(self.first_s)

    @abstractmethod
    def first_s(self, number: int) -> float:
        """Time of the first frame of a piece; about, where the recording is damaged."""

    @abstractmethod
    def read(self, number: int) -> Piece:
        """Read a piece, which may be empty where the recording is damaged."""

    @abstractmethod
    def describe(self, scene: int) -> ViewState:
        """Make what a page shows beside the frames of a scene; its number is left 0."""

    @abstractmethod
    def program(self, scene: int) -> tuple[Program, str] | None:
        """Compile what is under the hand in a scene, and its title; None if that is not known."""

    def viewer(self) -> RecordingViewer:
        """Make the viewer of a page."""
        return RecordingViewer(self)

    def map(self, request: Map) -> bytes:
        """Draw the map of what was under the hand at a time.

        It is made anew from the page or the stimulus that the recording has, and so it shows
        places, too, where the hand never was.

        Raises
        ------
        InputError
            If nothing was under the hand then, or the recording does not say what it was.
        """
        number, index = self.locate(request.at_s or 0.0)
        found = self.program(int(self.piece(number).ticks["scene"][index]))
        if found is None:
            raise InputError("there is no map: nothing is known to be under the hand at this time")
        note = "Made anew from what the recording says was shown, not from its frames."
        try:
            return picture(found[0], request.form, found[1], note)
        except ValueError as error:
            raise InputError(str(error)) from None

    def ask(self, request: Steering) -> None:  # noqa: ARG002
        """Refuse what a page wants changed.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError("a recording is played back: nothing in it can be changed")

    def piece(self, number: int) -> Piece:
        """Read a piece, or take it from those that are kept."""
        with self._lock:
            return self._piece(number)

    def state(self, scene: int) -> bytes:
        """Make the state of a scene as JSON, whose number is that of the scene and 1."""
        with self._lock:
            return self._state(scene)

    def find(self, at_s: float) -> int:
        """Number of the piece that has the frame of a time: the last one that is not later."""
        return max(bisect_right(range(self.pieces), at_s, key=self._first_s) - 1, 0)

    def locate(self, at_s: float) -> tuple[int, int]:
        """Find the frame of a time, as the number of its piece and its index in that.

        Pieces that are damaged are passed over: the last whole frame before is shown on, or the
        first one after if there is none.

        Raises
        ------
        InputError
            If no frame is whole.
        """
        number = self.find(at_s)
        for at in (*range(number, -1, -1), *range(number + 1, self.pieces)):
            piece = self.piece(at)
            if piece.ticks.size:
                return at, max(piece.after(at_s) - 1, 0)
        raise InputError("no frame of the recording is whole; there is nothing to play")

    def _encode(self, scene: int) -> bytes:
        state = msgspec.structs.replace(self.describe(scene), number=scene + 1)
        return msgspec.json.encode(state)


class RecordingViewer:
    """View of a recording by one page.

    Parameters
    ----------
    recording
        The recording.
    """

    def __init__(self, recording: Playback) -> None:
        self._recording = recording
        self._at_s = 0.0

    def state(self, request: Next) -> tuple[int, bytes]:
        """Number of the state that belongs to a time, and the state as JSON."""
        number, index = self._recording.locate(self._time(request))
        scene = int(self._recording.piece(number).ticks["scene"][index])
        return scene + 1, self._recording.state(scene)

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:  # noqa: ARG002
        """Give the frame of a time, with the ticks since the frame before it.

        A page that only draws on gets ticks between the two times that it names. If it went back,
        or begins, it gets this tick alone.
        """
        at_s = self._at_s = self._time(request)
        number, index = self._recording.locate(at_s)
        piece = self._recording.piece(number)
        tick, frame = piece.ticks[index], piece.frames[index]
        header = FrameHeader(
            **{name: tick[name].item() for name in _HEADER},
            state=int(tick["scene"]) + 1,
            lateness_us=math.nan,
            work_us=math.nan,
        )
        known = not np.isnan(frame).any()
        samples = self._samples(request, float(tick["time_s"]), number, index)
        return frame_bytes(header, frame if known else NO_DEFLECTIONS, samples)

    def _time(self, request: Next) -> float:
        """Time that is asked for, or the one before if none is."""
        at_s = self._at_s if request.at_s is None else request.at_s
        return min(max(at_s, 0.0), self._recording.length_s)

    def _samples(self, request: Next, now_s: float, number: int, index: int) -> NDArray[np.float32]:
        """Ticks after the frame before, up to this one."""
        since_s = now_s if request.since_s is None else max(request.since_s, now_s - _LONGEST_S)
        piece = self._recording.piece(number)
        # A page that stands still, or went back, gets this tick alone.
        first = min(piece.after(since_s, index + 1), index)
        pieces = [Piece(piece.ticks[first : index + 1], piece.frames[first : index + 1])]
        while not first and number and since_s < now_s:
            number -= 1
            piece = self._recording.piece(number)
            first = piece.after(since_s)
            pieces.insert(0, Piece(piece.ticks[first:], piece.frames[first:]))
        rows, columns = piece.frames.shape[1:]
        row = min(max(request.row, 0), rows - 1)
        column = min(max(request.column, 0), columns - 1)
        ticks = np.concatenate([piece.ticks for piece in pieces])
        followed = np.concatenate([piece.frames[:, row, column] for piece in pieces])
        chosen = thinned(ticks.size)
        samples = now_s - ticks["time_s"][chosen], ticks["x_mm"][chosen], followed[chosen]
        return np.stack(samples, axis=1).astype(np.float32)
