"""The live view of a device, as a reading or a session has it; nothing in it is waited for."""

from __future__ import annotations

import time
from collections import deque
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.live.frames import FrameHeader, frame_bytes
from vbraille.live.messages import LetGo, Point, ViewState, to_json
from vbraille.live.server import Server, open_browser

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import Self

    from numpy.typing import NDArray

    from vbraille.engine.record import RingReader
    from vbraille.live.messages import Next, PlayedEvent, Steering


_SAME: Final = ("flags", "line", "part", "late", "tick", "x_mm", "y_mm", "theta_rad", "vx_mm_s",
                "share")  # fmt: skip
_MOST_ASKED: Final = 100  # requests that wait to be taken; of more the oldest go
_BLIND: Final[dict] = {
    "lines": [], "rows_shown": [], "scene": None, "signals": [],
    "blind": True,
}  # fmt: skip


class LiveView:
    """Shows a device to pages, and takes what they ask; a context manager, which serves them.

    Whatever goes wrong with it once it is open, reading goes on: the worst is a note.

    Parameters
    ----------
    host, port
        Where pages reach it; loopback and a free port if they are None.
    blind
        Whether stimuli are hidden. A state that says so has the same effect, for good.
    steers
        Whether pages may steer.

    Raises
    ------
    InputError
        If it cannot listen there; when it is entered.
    """

    playback = False
    length_s = 0.0
    moments: Sequence[PlayedEvent] = ()

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        blind: bool = False,
        steers: bool = True,
    ) -> None:
        self.ticks: RingReader | None = None
        self.blind = blind
        self._asked: deque[Steering] = deque(maxlen=_MOST_ASKED)
        self._server = Server(self, host=host, port=port, steers=steers)
        self._state = ViewState(-1)
        self.told = 0, b""
        self.tell(ViewState(device="device: not open yet"))

    def __enter__(self) -> Self:
        self._server.__enter__()
        open_browser(self._server.admission.addresses[0])
        return self

    def __exit__(self, *_: object) -> None:
        self._server.__exit__()

    @property
    def addresses(self) -> list[str]:
        """Sentences on how it is opened, the one with the most rights first."""
        admission = self._server.admission
        said = [f"live view: {admission.addresses[0]}"]
        if not admission.on_loopback and admission.steers:
            said.append(f"live view, to watch only: {admission.addresses[1]}")
        return said

    def watch(self, ticks: RingReader) -> None:
        """Show the ticks of an engine; call it after each start, with a reader of its ring."""
        self.ticks = ticks

    def tell(self, state: ViewState) -> None:
        """Have pages be told a state, if it is another; its number is given here."""
        self.blind = self.blind or state.blind
        number = self._state.number
        state = replace(state, number=number, **(_BLIND if self.blind else {}))
        if state != self._state:
            self._state = replace(state, number=number + 1)
            self.told = number + 1, to_json(self._state)

    def take(self) -> list[Steering]:
        """Take what pages have asked for since the last call, oldest first.

        Of places of the hand that follow each other only the last is given.
        """
        asked = [self._asked.popleft() for _ in range(len(self._asked))]
        return [
            one
            for one, then in zip_longest(asked, asked[1:])
            if not (isinstance(one, Point) and isinstance(then, Point))
        ]

    def notes(self) -> list[str]:
        """Take the sentences for the reader since the last call: that it has ended by a fault."""
        fault, self._server.fault = self._server.fault, ""
        return [f"live view: ended by a fault; reading goes on: {fault}"] if fault else []

    @property
    def signals(self) -> int:
        """Number of the signals that frames have."""
        return len(self._state.signals)

    def viewer(self) -> DeviceViewer:
        """Make the view of a page."""
        return DeviceViewer(self)

    def ask(self, request: Steering) -> None:
        """Take what a page with the right to steer asks for.

        Raises
        ------
        InputError
            If a real hand moves the device.
        """
        if isinstance(request, Point | LetGo) and not self._state.simulated:
            raise InputError("a real hand moves this device; a page cannot move it")
        self._asked.append(request)


class DeviceViewer:
    """View of a device by one page, with a cursor of its own in the ticks."""

    def __init__(self, view: LiveView) -> None:
        self._view = view
        self._of: RingReader | None = None
        self._last: NDArray[np.void] | None = None  # the newest tick

    def look(self, request: Next, told: int | None) -> tuple[int, bytes, bytes] | None:  # noqa: ARG002
        """Give the state, and the newest tick."""
        view = self._view
        number, state = view.told
        if view.ticks is not None and view.ticks is not self._of:
            self._of, self._reader, self._last = view.ticks, view.ticks.another(), None
        ticks = None if self._of is None else self._reader.drain()
        if ticks is not None and ticks.size:
            self._last = ticks[-1:]
        elif number == told:
            return None
        if self._last is None or ticks is None:
            return number, state, frame_bytes(FrameHeader(state=number))
        tick = self._last[0]
        header = FrameHeader(
            **{name: tick[name].item() for name in _SAME},
            state=number,
            time_s=tick["time_ns"] / 1e9,
            lateness_us=tick["lateness_ns"] / 1e3,
            work_us=tick["work_ns"] / 1e3,
            age_ms=(time.monotonic_ns() - int(tick["time_ns"])) / 1e6,
        )
        if view.blind:
            return number, state, frame_bytes(header)
        signals = [tick[f"signal_{n + 1}"] for n in range(view.signals)]
        return number, state, frame_bytes(header, tick["frame"], np.array(signals))
