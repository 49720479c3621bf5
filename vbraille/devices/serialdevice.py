"""A device on a serial line, by docs/wire-protocol.md.

The conversation is here: silence, loss and return, and what is said
of them. `openserial` begins it. Its parts are `serialport` (bytes), `wire`
(messages), `place` (counts to mm) and `drive` (deflections to levels).
"""

from __future__ import annotations

import time
from enum import Enum, auto
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.devices.base import Device
from vbraille.devices.changes import another, changes, differences, to_do
from vbraille.devices.delivery import Delivery
from vbraille.devices.drive import Drive
from vbraille.devices.greeting import HELLO, info_of, misfit, particulars_of
from vbraille.devices.messages import (
    HELLO_PERIOD_MS,
    LOST_MS,
    NOTICES,
    SILENCE_MS,
    Error,
    Info,
    Rest,
    State,
    Watchdog,
)
from vbraille.devices.notices import Notices
from vbraille.devices.place import DeviceTime, Place
from vbraille.devices.serialport import DRAIN_MS
from vbraille.devices.wire import DELIMITER, OtherVersion, encode, unwrap
from vbraille.errors import DeviceError
from vbraille.pose import Pose

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.devices.greeting import Greeted
    from vbraille.devices.serialport import SerialPort
    from vbraille.devices.wire import Event
    from vbraille.display import Display

# Frames without anything to feel for so long, and there is nothing to show: no gap between words.
IDLE_MS: Final = 5000
_NS_PER_MS = 1_000_000
# Reads that empty a line: what a stopped host has not read is some kB at most.
_MOST_READS = 64
_REST = encode(Rest())
_U16 = 0xFFFF


class _Link(Enum):
    GREETING = auto()  # HELLO was sent, or is due; INFO has not come
    LIVE = auto()
    SILENT = auto()  # STATE is missing, but not for long enough to begin again
    STRANGER = auto()  # what came back is another device: nothing is said to it
    GONE = auto()


class SerialDevice(Device):
    """A device that has answered the handshake.

    Parameters
    ----------
    port
        Its line.
    greeted
        What it answered.
    now_ns, pause
        The host's clock, and how to wait for so many seconds.
    rate_hz
        FRAMEs a second that it is going to be sent; None is as many as it is made for.
    """

    acknowledges = True

    def __init__(
        self,
        port: SerialPort,
        greeted: Greeted,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
        rate_hz: float | None = None,
    ) -> None:
        self._rate_hz = rate_hz or float(greeted.info.rate_hz)
        self._port = port
        self._now_ns = now_ns
        self._pause = pause
        self._decoder = greeted.decoder
        self._info = info_of(greeted.info)
        self._notes = Notices()
        self._time = DeviceTime()
        self._away = False  # since a note said so, until another says that it is back
        self._sequence = 0  # of the last FRAME
        self._sent_ns: int | None = None  # when the one was that is not acknowledged
        self._unsent = self._missed = self._reconnections = 0
        self._trips_before = self._disbelieved_before = 0
        self._losses = port.losses
        self.watchdog_trips = 0
        self._delivery = Delivery(greeted.info.rate_hz)
        self._begin(greeted.info, now_ns())
        self._take(greeted.events, now_ns())
        self._tell_taking()

    @property
    def display(self) -> Display:
        """What the device said of itself first."""
        return self._info

    def rest(self) -> None:
        """Tell the device to rest; it ramps there, where a FRAME of rest would be a jump."""
        self._delivery.stop()
        self._tell()

    def set_zero(self) -> None:
        """Take it that the carriage is at the left stop now: the reader says so."""
        self._place.set_zero()
        self.placing = self._place.placing

    def take_notes(self) -> Sequence[str]:
        """What there is to say to the reader since the last call."""
        return self._notes.take(self._now_ns())

    def counts(self) -> Mapping[str, int]:
        """What went wrong so far."""
        return {
            "frames not sent": self._unsent + self._port.lost,
            "states missed": self._missed,
            "watchdog trips": self._trips_before + self._delivery.trips,
            "watchdog reports not believed": self._disbelieved_before + self._delivery.disbelieved,
            "reconnections": self._reconnections,
            **{str(kind): number for kind, number in self._decoder.dropped.items()},
        }

    def read(self) -> Pose | None:
        """Newest sample since the last call, or None; never waits.

        Raises
        ------
        DeviceError
            If the device says that it cannot go on.
        """
        now_ns = self._now_ns()
        stalled = self._mind_stall(now_ns)
        chunk = self._port.read()
        for _ in range(_MOST_READS * stalled):
            chunk += (more := self._port.read())
            if not more:
                break
        if self._port.losses != self._losses:
            self._losses = self._port.losses
            self._link = _Link.GONE
            self._note_away("device: unplugged; plug it in again and reading goes on", now_ns)
        if self._port.gone:
            self._tell_taking()
            return None
        if self._link is _Link.GONE:
            self._decoder.feed(DELIMITER)  # what was begun will not be ended
            self._greet(now_ns)
        sample = self._take(self._decoder.feed(chunk), now_ns) if chunk else None
        self._mind_silence(now_ns)
        self._tell_taking()
        return sample

    def _take(self, events: Sequence[Event], now_ns: int) -> Pose | None:
        sample = None
        for event in events:
            if isinstance(event, State):
                if self._link is _Link.LIVE or self._link is _Link.SILENT:
                    sample = self._take_state(event, now_ns)
            elif isinstance(event, Info | OtherVersion):
                if self._link is _Link.GREETING and self._asked:
                    self._take_info(event, now_ns)
            elif self._link not in (_Link.LIVE, _Link.SILENT):
                pass  # of an earlier conversation
            elif isinstance(event, Watchdog):
                if self._delivery.take_watchdog(event, now_ns):
                    self._fell(now_ns)
            elif isinstance(event, Error):
                if event.code < NOTICES:
                    raise DeviceError(f"{self._info.name}: {event.text or f'error {event.code}'}")
                said = event.text or f"notice {event.code}"
                self._notes.add(f"notice {event.code}", f"device: {said}", now_ns)
        if self._decoder.bad_info:
            self._take_bad_info(self._decoder.bad_info, now_ns)
            self._decoder.bad_info = ""
        return sample

    def _take_state(self, state: State, now_ns: int) -> Pose | None:
        self._heard_ns = now_ns
        if self._link is _Link.SILENT:
            self._link = _Link.LIVE
            self.rested += 1
        if self._away:
            self._away = False
            self._notes.add("back", "device: back", now_ns)
        if state.faulty:  # its ERROR, which says why, was lost
            raise DeviceError(f"{self._info.name} has a fault; switch it off and on, and try again")
        if self._state_sequence is not None:
            gap = unwrap(state.sequence, self._state_sequence, 16) - self._state_sequence - 1
            self._missed += max(gap, 0)
        self._state_sequence = state.sequence
        if self._delivery.take_state(state, now_ns):
            self._fell(now_ns)
        if self._delivery.stuck:
            raise DeviceError(
                f"{self._info.name} does not go to rest, neither when it is told to nor without "
                f"frames; switch it off, and do not read on it until that is mended"
            )
        if self._sent_ns is not None and state.frame_sequence == self._sequence:
            self.acknowledged_ns = now_ns - self._sent_ns
            self._sent_ns = None
        x_mm = self._place.x_mm(state)
        self.placing = self._place.placing
        time_ns = self._time.ns(state.time_us, now_ns)
        return None if x_mm is None else Pose(time_ns, x_mm)

    def _take_info(self, info: Info | OtherVersion, now_ns: int) -> None:
        if isinstance(info, OtherVersion):
            self._turn_away(
                f"a device of version {info.version} of the protocol came back; plug in "
                f"{self._info.name} again and reading goes on",
                now_ns,
            )
        elif others := differences(self._info, info_of(info)):
            self._turn_away(another(self._info, info_of(info), others), now_ns)
        elif misfit(info):
            self._take_bad_info(misfit(info), now_ns)
        else:
            changed = changes(self._greeted, info)
            if changed:
                self._notes.add(
                    "changed", f"device: changed, for {', '.join(changed)}{to_do(info)}", now_ns
                )
            self._reconnections += 1
            self.rested += 1
            self._begin(info, now_ns)

    def _take_bad_info(self, fault: str, now_ns: int) -> None:
        if self._link is _Link.GREETING and self._asked:
            self._turn_away(f"what came back says in its INFO what cannot be: {fault}", now_ns)

    def _turn_away(self, why: str, now_ns: int) -> None:
        """Say nothing more to what is there now, which is not what reading began on."""
        self._link = _Link.STRANGER
        self._away = True
        self._notes.add("stranger", f"device: {why}", now_ns)

    def _begin(self, info: Info, now_ns: int) -> None:
        """Begin a conversation; the device is at rest."""
        self._link = _Link.LIVE
        self._greeted = info
        self.particulars = particulars_of(info)
        self._asked = False
        self._heard_ns = now_ns
        self._state_sequence: int | None = None
        self._place = Place(info)
        self.placing = self._place.placing
        self._time.restart()
        self._drive = Drive(info, now_ns, self._rate_hz)
        self._trips_before += self._delivery.trips
        self._disbelieved_before += self._delivery.disbelieved
        self._delivery = Delivery(info.rate_hz)
        self._rest_frame = np.zeros((info.rows, info.columns))
        self._felt_ns = now_ns  # when a frame last had anything to feel
        self._idle = False  # at rest for want of anything to feel

    def _greet(self, now_ns: int) -> None:
        """Begin to ask who is there."""
        self._link = _Link.GREETING
        self._asked = False
        self._hello_ns = now_ns

    def _mind_silence(self, now_ns: int) -> None:
        silent_ns = now_ns - self._heard_ns
        if self._link is _Link.LIVE and silent_ns >= SILENCE_MS * _NS_PER_MS:
            self._link = _Link.SILENT
            self._stop()
            note = "device: silent, and sent to rest; reading goes on once it speaks"
            self._note_away(note, now_ns)
        if self._link in (_Link.LIVE, _Link.SILENT):
            self._tell()
        if self._link is _Link.SILENT and silent_ns >= LOST_MS * _NS_PER_MS:
            self._greet(now_ns)
        if self._link is _Link.GREETING and now_ns >= self._hello_ns and self._port.write(HELLO):
            self._asked = True
            self._hello_ns = now_ns + HELLO_PERIOD_MS * _NS_PER_MS

    def _stop(self, *, tell: bool = True) -> None:
        """Send no FRAME until the device is at rest, and nothing that lies about unsent."""
        self._delivery.stop(tell=tell)
        self._idle = False
        self._port.drop_unsent()
        self._tell()

    def _tell(self) -> None:
        if self._delivery.rest_due and self._port.write(_REST):
            self._delivery.told(self._now_ns())

    def _mind_stall(self, now_ns: int) -> bool:
        """Whether this process was stopped for so long that the device may rest; it does then."""
        if self._link is not _Link.LIVE or not self._delivery.stalled(now_ns):
            return False
        if self._delivery.taking:
            self._fell(now_ns)
        else:
            self._stop(tell=False)
        self._delivery.stall(now_ns)
        return True

    def _fell(self, now_ns: int) -> None:
        """The device went to rest, or may have."""
        self._stop(tell=False)
        self._felt_ns = now_ns
        self.rested += 1
        note = "device: no frame reached it in time, so it went to rest; reading goes on"
        self._notes.add("watchdog", note, now_ns)

    def _tell_taking(self) -> None:
        """Say whether FRAMEs hold the actuators, or would if there were anything to feel.

        A device that is away is silent, which says enough.
        """
        self.taking = self._link is not _Link.LIVE or self._delivery.taking or self._idle
        self.watchdog_trips = self._trips_before + self._delivery.trips

    def _note_away(self, note: str, now_ns: int) -> None:
        if not self._away:
            self._notes.add(note, note, now_ns)
        self._away = True

    def _send(self, frame: NDArray[np.float64]) -> None:
        self.acknowledged_ns = self._sent_ns = None
        if self._link is _Link.LIVE:
            self._send_live(frame, self._now_ns())
        self._tell_taking()

    def _send_live(self, frame: NDArray[np.float64], now_ns: int) -> None:
        if not self._place.known:
            if self._delivery.taking:
                self._stop()
            return
        self._mind_stall(now_ns)
        delivery = self._delivery
        if delivery.taking:
            felt = self._drive.fill(frame, now_ns)
            if felt:
                self._felt_ns = now_ns
            elif now_ns - self._felt_ns >= IDLE_MS * _NS_PER_MS:
                delivery.stop()
                self._tell()
                self._idle = True
                return
        else:
            if self._idle and not frame.any():
                return
            self._idle = False
            if not delivery.at_rest:
                return
            self._drive.rested(now_ns)
            self._drive.fill(self._rest_frame, now_ns)
            self._felt_ns = now_ns
        sequence = (self._sequence + 1) & _U16
        if not self._port.write(self._drive.frame(sequence)):
            self._unsent += not self._port.gone
            return
        self._sequence, self._sent_ns = sequence, now_ns
        self._drive.sent(now_ns)
        delivery.sent(sequence, now_ns)

    def _release(self) -> None:
        try:
            if self._link is not _Link.STRANGER:
                for _ in range(DRAIN_MS):
                    if self._port.write(_REST) or self._port.gone:
                        break
                    self._pause(0.001)
        finally:
            self._port.close(self._pause)
