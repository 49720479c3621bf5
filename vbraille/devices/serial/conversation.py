"""The host's end of a serial conversation: no port, no clock, no thread.

It is given the time, bytes that came and what is wanted; it gives places, events, and the
messages that are due, one after the other. `transitions` says what leads where.

    conversation = Conversation(now_ns)
    while (message := conversation.due()) is not None:
        if port.write(message):
            conversation.sent()
        else:
            conversation.refused()
    pose = conversation.hear(port.read(), now_ns)
"""

from __future__ import annotations

from enum import Enum, auto
from typing import TYPE_CHECKING, Final

from vbraille.devices.events import Unplugged
from vbraille.devices.serial.listening import Listening
from vbraille.devices.serial.transitions import TALKING, UNTOLD, Cause, Stage
from vbraille.devices.wire.codec import DELIMITER, encode
from vbraille.devices.wire.messages import HELLO_PERIOD_MS, Hello, Rest

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.events import Event

# If frames have had nothing to feel for so long, nothing is shown: gaps between words are shorter.
IDLE_MS: Final = 5000
_NS_PER_MS: Final = 1_000_000
_HELLO: Final = DELIMITER + encode(Hello())  # the zero ends whatever was on the line before
_REST: Final = encode(Rest())
_U16: Final = 0xFFFF
_GREETING: Final = frozenset({Stage.GREETING, Stage.ASKED})


class _Wish(Enum):
    """The kinds of messages that may be due."""

    REST = auto()
    HELLO = auto()
    FRAME = auto()


class Conversation(Listening):
    """A conversation with whatever answers, from HELLO until the host takes leave.

    Parameters
    ----------
    now_ns
        Time by a clock that does not go back.
    rate_hz
        FRAMEs a second that will be wanted; None for as many as the device is made for.

    Its attributes, which may be looked at, are described in `Listening`.
    """

    def __init__(self, now_ns: int, rate_hz: float | None = None) -> None:
        super().__init__(now_ns, rate_hz)
        self._leaving = self._frame_due = False
        self._offer: _Wish | None = None  # the message that was given last

    @property
    def steady(self) -> bool:
        """Whether FRAMEs hold the actuators, nothing else is due, and all is well."""
        return self.stage is Stage.LIVE and not (self.delivery.rest_due or self.drop_unsent)

    def take_events(self, now_ns: int) -> list[Event]:
        """Events since the last call, each kind once a second at most."""
        return list(self._notices.take(now_ns))

    def lose(self, now_ns: int) -> None:
        """Note that the port is gone."""
        if self._go(Cause.UNPLUGGED):
            self._let_go(now_ns)
            self._tell_away(Unplugged(), now_ns)

    def find(self, now_ns: int) -> None:
        """Note that the port is back; nothing that was said before goes on."""
        if self._go(Cause.PLUGGED_IN):
            self.decoder.feed(DELIMITER)  # what was begun will not be ended
            self._hello_ns = now_ns

    def mind_stall(self, now_ns: int) -> bool:
        """Have the device rest if the host was stopped for so long that it may rest; tell whether.

        What waits to be read is old in that case, and must all be read at once.
        """
        if self.stage not in TALKING or not self.delivery.stalled(now_ns):
            return False
        if self.stage is Stage.LIVE:
            self._fall(Cause.STALLED, now_ns)
        elif self._go(Cause.STALLED):
            self._stop(tell=False)
        self.delivery.give_time(now_ns)
        return True

    def show(self, frame: NDArray[np.float64], now_ns: int) -> None:
        """Have deflections shown, as far as the device is ready for them.

        Parameters
        ----------
        frame : float64[rows, columns]
            Deflections that the actuators are to have, in [0, 1].
        now_ns
            Time of the call, by the same clock.
        """
        self._now_ns = now_ns
        self.frames.acknowledged_ns = self.frames.sent_ns = None
        if self.stage not in TALKING or self.stage is Stage.SILENT:
            return
        if not self.place.known:
            if self._go(Cause.PLACE_LOST):
                self._stop(tell=True)
            return
        self.mind_stall(now_ns)
        if self.stage is Stage.LIVE:
            if self.drive.fill(frame, now_ns):
                self.frames.felt_ns = now_ns
            elif now_ns - self.frames.felt_ns >= IDLE_MS * _NS_PER_MS:
                self._go(Cause.NOTHING_TO_FEEL)
                self.delivery.stop(tell=True)
                return
        else:
            if frame.any():
                self._go(Cause.FELT)
            if self.stage is not Stage.AT_REST:
                return
            self.drive.rested(now_ns)
            self.drive.fill(self._rest_frame, now_ns)
            self.frames.felt_ns = now_ns
        self._frame_due = True

    def rest(self, now_ns: int) -> None:
        """Have the device told to rest: it ramps there, where a FRAME of rest would be a jump."""
        self._now_ns = now_ns
        if self._go(Cause.REST_WANTED):
            self.delivery.stop(tell=True)

    def set_zero(self, now_ns: int) -> None:
        """Take the carriage's place for the left stop: the reader says that it is there."""
        self.place.set_zero()
        self._mind_placing(now_ns)

    def close(self, now_ns: int) -> None:
        """End the conversation: the device is told to rest, if it is there to be told."""
        self._now_ns = now_ns
        there = self.stage not in UNTOLD
        if self._go(Cause.CLOSED):
            self._leaving, self._frame_due = there, False

    # Messages that go out.

    def due(self) -> bytes | None:
        """Next message that is to go out, whole; None if none is due.

        Call `sent` or `refused` before the next call, to tell what became of the message.
        """
        if self._frame_due:
            self._offer = _Wish.FRAME
            return self.drive.frame((self.frames.sequence + 1) & _U16)
        if self._leaving or (self._rest_due and self.stage not in UNTOLD):
            self._offer = _Wish.REST
            return _REST
        if self.stage in _GREETING and self._now_ns >= self._hello_ns:
            self._offer = _Wish.HELLO
            return _HELLO
        return None

    @property
    def _rest_due(self) -> bool:
        return self.info is not None and self.delivery.rest_due

    def sent(self) -> None:
        """Note that the message given last goes out now."""
        now_ns, frames = self._now_ns, self.frames
        if self._offer is _Wish.FRAME:
            self._frame_due = self.no_room = False
            frames.sequence = (frames.sequence + 1) & _U16
            frames.sent_ns = now_ns
            self.drive.sent(now_ns)
            holding = self.stage is Stage.LIVE
            self.delivery.sent(frames.sequence, now_ns, holding=holding)
        elif self._offer is _Wish.REST:
            self._leaving = False
            if self.info is not None:
                self.delivery.told(now_ns)
        else:
            self._hello_ns = now_ns + HELLO_PERIOD_MS * _NS_PER_MS
            self._go(Cause.ASKED)

    def refused(self) -> bool:
        """Note that there was no room for the message given last; tell whether a FRAME was lost.

        Any other message is due again when something comes in the next time.
        """
        self._frame_due = False
        lost = self._offer is _Wish.FRAME
        self.no_room = self.no_room or lost
        if lost:  # its sequence counts: the device is to know how far the next one goes on
            self.frames.sequence = (self.frames.sequence + 1) & _U16
        return lost
