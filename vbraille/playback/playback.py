"""A reel as a source of the live view: each page asks for frames of the times that it wants."""

from __future__ import annotations

import math
from collections import OrderedDict
from threading import RLock
from typing import TYPE_CHECKING, Final, TypeVar

import msgspec
import numpy as np

from vbraille.errors import InputError
from vbraille.live.framing import NO_DEFLECTIONS, FrameHeader, frame_bytes, thinned
from vbraille.live.maps import picture
from vbraille.playback.reels import PLAYED

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from vbraille.live.messages import Map, Next, PlayedEvent
    from vbraille.live.sources import Steering
    from vbraille.playback.reels import Piece, Reel

Kept = TypeVar("Kept")

# Pieces and states that are kept, since a page asks for the next frame of the same piece soon.
_MOST_PIECES: Final = 12
_MOST_STATES: Final = 256
# A page that asks for a time far from the one before gets ticks of so long a stretch, no more.
_LONGEST_S: Final = 4.0
_HEADER: Final = tuple(name for name in PLAYED.names or () if name != "scene")
_NOT_SO: Final = "a recording is played back: nothing in it can be changed"


class Playback:
    """A source of recorded frames.

    Parameters
    ----------
    reel
        What is played back.

    Raises
    ------
    InputError
        If no frame of it is whole.
    """

    def __init__(self, reel: Reel) -> None:
        self._reel = reel
        self._pieces: OrderedDict[int, Piece] = OrderedDict()
        self._states: OrderedDict[int, bytes] = OrderedDict()
        self._lock = RLock()  # maps are drawn in a thread of their own
        self.locate(0.0)  # there is a whole frame, which later calls find at the worst

    @property
    def playback(self) -> bool:
        """Whether pages name times; always."""
        return True

    @property
    def length_s(self) -> float:
        """Length of the recording in seconds."""
        return self._reel.length_s

    @property
    def moments(self) -> Sequence[PlayedEvent]:
        """What happened in the recording, by time."""
        return self._reel.moments

    @property
    def notes(self) -> Sequence[str]:
        """Sentences for whoever plays it."""
        return self._reel.notes

    def viewer(self) -> PlaybackViewer:
        """Make the viewer of a page."""
        return PlaybackViewer(self)

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
        found = self._reel.program(int(self.piece(number).ticks["scene"][index]))
        if found is None:
            raise InputError("there is no map: nothing is known to be under the hand at this time")
        program, title = found
        note = "Made anew from what the recording says was shown, not from its frames."
        try:
            return picture(program, request.form, title, note)
        except ValueError as error:
            raise InputError(str(error)) from None

    def ask(self, request: Steering) -> None:  # noqa: ARG002
        """Refuse what a page wants changed.

        Raises
        ------
        InputError
            Always.
        """
        raise InputError(_NOT_SO)

    def piece(self, number: int) -> Piece:
        """Read a piece, or take it from those that are kept."""
        with self._lock:
            return _kept(self._pieces, number, self._reel.piece, _MOST_PIECES)

    def state(self, scene: int) -> bytes:
        """Make the state of a scene as JSON, whose number is that of the scene and 1."""
        with self._lock:
            return _kept(self._states, scene, self._make_state, _MOST_STATES)

    def locate(self, at_s: float) -> tuple[int, int]:
        """Find the frame of a time, as the number of its piece and its index in that.

        Pieces that are damaged are passed over: the last whole frame before is shown on, or the
        first one after if there is none.

        Raises
        ------
        InputError
            If no frame is whole.
        """
        number = self._reel.find(at_s)
        for at in range(number, -1, -1):
            if len(self.piece(at)):
                return at, self.piece(at).index(at_s)
        for at in range(number + 1, self._reel.find(math.inf) + 1):
            if len(self.piece(at)):
                return at, 0
        raise InputError("no frame of the recording is whole; there is nothing to play")

    def _make_state(self, scene: int) -> bytes:
        state = msgspec.structs.replace(self._reel.state(scene), number=scene + 1)
        return msgspec.json.encode(state)


class PlaybackViewer:
    """What one page sees of a recording.

    Parameters
    ----------
    playback
        The recording.
    """

    def __init__(self, playback: Playback) -> None:
        self._playback = playback
        self._at_s = 0.0

    def state(self, request: Next) -> tuple[int, bytes]:
        """Number of the state that belongs to a time, and the state as JSON."""
        number, index = self._playback.locate(self._time(request))
        scene = int(self._playback.piece(number).ticks["scene"][index])
        return scene + 1, self._playback.state(scene)

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:  # noqa: ARG002
        """Give the frame of a time, with the ticks since the frame before it.

        A page that only draws on gets ticks between the two times that it names. If it went back,
        or begins, it gets this tick alone.
        """
        at_s = self._at_s = self._time(request)
        number, index = self._playback.locate(at_s)
        piece = self._playback.piece(number)
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
        return min(max(at_s, 0.0), self._playback.length_s)

    def _samples(self, request: Next, now_s: float, number: int, index: int) -> NDArray[np.float32]:
        """Ticks after the frame before, up to this one."""
        since_s = now_s if request.since_s is None else max(request.since_s, now_s - _LONGEST_S)
        pieces: list[tuple[Piece, slice]] = []
        stop = index + 1
        while True:
            piece = self._playback.piece(number)
            first = int(np.searchsorted(piece.ticks["time_s"][:stop], since_s, "right"))
            pieces.insert(0, (piece, slice(first, stop)))
            if first or not number or since_s >= now_s:
                break
            number -= 1
            stop = len(self._playback.piece(number))
        row = min(max(request.row, 0), pieces[0][0].frames.shape[1] - 1)
        column = min(max(request.column, 0), pieces[0][0].frames.shape[2] - 1)
        ticks = np.concatenate([piece.ticks[chosen] for piece, chosen in pieces])
        followed = np.concatenate([piece.frames[chosen, row, column] for piece, chosen in pieces])
        if not ticks.size:  # the page stands still, or went back
            piece = pieces[-1][0]
            ticks, followed = piece.ticks[[index]], piece.frames[[index], row, column]
        chosen = thinned(ticks.size)
        samples = np.empty((chosen.size, 3), np.float32)
        samples[:, 0] = now_s - ticks["time_s"][chosen]
        samples[:, 1] = ticks["x_mm"][chosen]
        samples[:, 2] = followed[chosen]
        return samples


def _kept(
    kept: OrderedDict[int, Kept], number: int, make: Callable[[int], Kept], most: int
) -> Kept:
    """Take what is kept by a number, or make it; of what is kept, the least used goes."""
    if number in kept:
        kept.move_to_end(number)
        return kept[number]
    made = kept[number] = make(number)
    if len(kept) > most:
        kept.popitem(last=False)
    return made
