"""A source of canned frames, by which the page and the server are tried without an engine.

`python -m tests.live.canned [PORT]` serves it on this machine; an environment variable
``CANNED=playback`` makes a recording of it. It prints the address, and then what pages ask for.
"""

from __future__ import annotations

import asyncio
import math
import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from vbraille.errors import InputError
from vbraille.live.framing import FrameHeader, frame_bytes
from vbraille.live.messages import (
    ArrayShown,
    CommandShown,
    KnobShown,
    LineShown,
    Map,
    Next,
    PlayedEvent,
    ViewState,
)
from vbraille.live.server import LiveServer

if TYPE_CHECKING:
    from vbraille.live.sources import Steering

ROWS, COLUMNS = 6, 10
SIGNALS = (0.25, 1.0, 0.0)  # values of the first signals that a state has
COUNT = 240  # frames, after which they begin anew
LENGTH_S = COUNT / 60
ARRAY = ArrayShown(
    "STReSS²", ROWS, COLUMNS, column_pitch_mm=1.2, row_pitch_mm=1.612, swing_mm=0.2,
    rest_right=True, travel_mm=213.0, height_mm=0.0, turns=False, rate_hz=1000.0,
)  # fmt: skip
GEOMETRY = {
    "dot_width_mm": 2.0, "dot_spacing_mm": 2.5, "cell_gap_mm": 4.0, "row_spacing_mm": 2.5,
    "line_pitch_mm": 10.0,
}  # fmt: skip
TEXT = "the quick brown fox"
LETTERS = (
    1, 3, 9, 25, 17, 11, 27, 19, 10, 26, 5, 7, 13,
    29, 21, 15, 31, 23, 14, 30, 37, 39, 58, 45, 61, 53,
)  # fmt: skip
MASKS = dict(zip("abcdefghijklmnopqrstuvwxyz", LETTERS, strict=True))
LINES = [
    LineShown(
        number=number,
        text=TEXT,
        start_mm=0.0,
        top_mm=10.0 * (number - 1),
        cells=[MASKS.get(letter, 0) for letter in TEXT],
        sources=[(n, n + 1) for n in range(len(TEXT))],
        under=number == 2,
    )
    for number in (1, 2, 3)
]
KNOBS = [
    KnobShown("dot_width_mm", "dot width", "mm", 2.0, 0.1, 0.5, 4.0),
    KnobShown("contrast", "contrast", "", 1.0, 0.05, 0.0, 1.0),
    KnobShown("texture", "texture", "", 0.1, 0.05, 0.0, 1.0, fixed="the protocol says so"),
]
COMMANDS = [
    CommandShown(name, words)
    for name, words in (
        ("LNUP", "previous line"),
        ("LNDN", "next line"),
        ("PAUSE", "rest the array at once, or go on"),
    )
]
MOMENTS = [
    PlayedEvent(0.5, "line", "line 1"),
    PlayedEvent(1.0, "trial", "trial 1"),
    PlayedEvent(2.0, "cue", "cue: line end"),
    PlayedEvent(2.5, "answer", "answer: e"),
    PlayedEvent(3.0, "fault", "fault: the device was silent for 0.2 s"),
]


def canned_state(number: int = 1, **changes) -> ViewState:
    """A state as a reader has it."""
    state = ViewState(
        number,
        title="a canned text",
        array=ARRAY,
        geometry=GEOMETRY,
        rows_shown=[(row // 2, row // 2) for row in range(ROWS)],
        lines=LINES,
        place="line 2, page 1",
        knobs=KNOBS,
        mapping="mapping: 3 dot rows, 2 rows of actuators each",
        simulated=True,
        device="reading",
        said=["line 2", "dot width: 2 mm"],
        facts=[("rate", "1000 Hz"), ("late ticks", "0")],
        commands=COMMANDS,
    )
    return msgspec.structs.replace(state, **changes)


def canned_frame(
    n: int,
    state: int = 1,
    age_ms: float = 0.0,
    time_s: float | None = None,
    signals: tuple[float, ...] = (),
) -> bytes:
    """Frame n, from 0: the hand goes along the line and comes back."""
    at = n % COUNT
    x_mm = 100.0 - 90.0 * math.cos(2 * math.pi * at / COUNT)
    place = x_mm + np.arange(COLUMNS) * 1.2
    swing = 0.5 + 0.5 * np.sin(place[None, :] + np.arange(ROWS)[:, None])
    before = np.arange(15, -1, -1, dtype=np.float32) / 1000
    trace = x_mm - before * 10
    samples = np.stack([before, trace, 0.5 + 0.5 * np.sin(trace)], axis=1)
    header = FrameHeader(
        state=state,
        line=2,
        tick=16.0 * n,
        time_s=n / 60 if time_s is None else time_s,
        x_mm=x_mm,
        y_mm=15.0,
        theta_rad=0.0,
        vx_mm_s=90 * 2 * math.pi / LENGTH_S * math.sin(2 * math.pi * at / COUNT),
        lateness_us=40.0,
        work_us=55.0,
        age_ms=age_ms,
    )
    values = np.array(signals, np.float32)
    return frame_bytes(header, swing.astype(np.float32), samples.astype(np.float32), values)


class CannedViewer:
    """A page's view of canned frames; each has the next at every request."""

    def __init__(self, source: CannedSource) -> None:
        self._source = source
        self._next = 0

    def state(self, request: Next) -> tuple[int, bytes]:  # noqa: ARG002
        return self._source.told

    def frame(self, request: Next, *, again: bool = False) -> bytes | None:
        if self._source.silent and not again:
            return None
        if self._source.playback:
            n = round((request.at_s or 0.0) * 60)
        else:
            n = self._next
            self._next += 1
        return self._source.frames[n % COUNT]


class CannedSource:
    """Frames that were made before; it takes whatever is asked, and remembers it.

    Attributes
    ----------
    asked : list
        What pages asked for.
    silent : bool
        Whether there is no new frame for the time being.
    """

    def __init__(self, *, playback: bool = False, state: ViewState | None = None) -> None:
        self.playback = playback
        self.length_s = LENGTH_S if playback else 0.0
        self.moments = MOMENTS if playback else []
        self.asked: list[Steering] = []
        self.silent = False
        self.show(state or canned_state())

    def show(self, state: ViewState) -> None:
        """Have pages be told another state."""
        self.now = state
        self.told = state.number, msgspec.json.encode(state)
        self.frames = [
            canned_frame(n, state.number, signals=SIGNALS[: len(state.signals)])
            for n in range(COUNT)
        ]

    def viewer(self) -> CannedViewer:
        return CannedViewer(self)

    def map(self, request: Map) -> bytes:
        if self.now.blind:
            raise InputError("a blind session shows no map")
        if request.form == "svg":
            return b'<svg xmlns="http://www.w3.org/2000/svg" width="2" height="1"/>'
        return (Path(__file__).parents[2] / "docs/wave.png").read_bytes()

    def ask(self, request: Steering) -> None:
        self.asked.append(request)


async def _serve(port: int | None) -> None:
    source = CannedSource(playback=os.environ.get("CANNED") == "playback")
    async with LiveServer(source, port=port) as server:
        print(server.admission.steering_address, flush=True)
        shown = 0
        while True:
            await asyncio.sleep(0.1)
            for request in source.asked[shown:]:
                print(f"{time.monotonic():.3f} {request}", flush=True)
            shown = len(source.asked)


if __name__ == "__main__":
    asyncio.run(_serve(int(sys.argv[1]) if len(sys.argv) > 1 else None))
