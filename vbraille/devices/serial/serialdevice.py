"""A device on a serial line, by docs/wire-protocol.md: a port, a clock, and a `Conversation`."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

from vbraille.devices.base import Device
from vbraille.devices.events import Fault
from vbraille.devices.lent import Lent
from vbraille.devices.saying import say
from vbraille.devices.serial.lending import Lending
from vbraille.devices.serial.serialport import DRAIN_MS
from vbraille.devices.serial.transitions import Stage
from vbraille.devices.wire.codec import DELIMITER
from vbraille.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration
    from vbraille.devices.events import Event
    from vbraille.devices.serial.conversation import Conversation
    from vbraille.devices.serial.serialport import SerialPort
    from vbraille.display import Display
    from vbraille.pose import Pose

# Number of reads that empty a line: a stopped host has left some kB unread at most.
_MOST_READS: Final = 64


def send_due(port: SerialPort, conversation: Conversation) -> int:
    """Send messages that are due, as far as there is room; count the FRAMEs that had none."""
    if conversation.drop_unsent:
        port.drop_unsent()
        conversation.drop_unsent = False
    while (message := conversation.due()) is not None:
        if not port.write(message):
            return int(conversation.refused() and not port.gone)
        conversation.sent()
    return 0


class SerialDevice(Device):
    """A device that has answered HELLO; `openserial` begins the conversation.

    Parameters
    ----------
    port
        The line to the device.
    conversation
        The conversation with the device, which has answered.
    now_ns, pause
        Clock of the host, and function that waits for a number of seconds.
    """

    acknowledges = True

    def __init__(
        self,
        port: SerialPort,
        conversation: Conversation,
        now_ns: Callable[[], int] = time.monotonic_ns,
        pause: Callable[[float], None] = time.sleep,
    ) -> None:
        assert conversation.display is not None
        self.port = port
        self.conversation = conversation
        self._display = conversation.display
        self._now_ns = now_ns
        self._pause = pause
        self._losses = port.losses
        self._unsent = 0
        self._lending = Lending()
        self._left_over = b""  # bytes that came while the conversation was lent
        self._copy()

    @property
    def display(self) -> Display:
        """Display that the device described first."""
        return self._display

    @property
    def has_own_gains(self) -> bool:
        """Whether the device's INFO says that its actuators differ."""
        return self.conversation.drive.has_own_gains

    def correct(self, calibration: Calibration | None) -> None:
        """Make up for what was found of the actuators, where INFO says nothing of it."""
        self.conversation.correct(calibration)
        self.calibration = None if self.has_own_gains else calibration

    def uncorrect(self) -> bool:
        """Do nothing: told to rest, the device takes its actuators to its own rest by a ramp."""
        return False

    def rest(self) -> None:
        """Tell the device to rest: it ramps there, where a FRAME of rest would be a jump."""
        self.conversation.rest(self._now_ns())
        self._send_due()

    def set_zero(self) -> None:
        """Take the carriage's place for the left stop: the reader says that it is there."""
        self.conversation.set_zero(self._now_ns())
        self._copy()

    def take_events(self) -> Sequence[Event]:
        """Events since the last call, each kind once a second at most."""
        return self.conversation.take_events(self._now_ns())

    def counts(self) -> Mapping[str, int]:
        """Counts of what went wrong so far, by name."""
        conversation = self.conversation
        return {
            "frames not sent": self._unsent,
            "states missed": conversation.states.missed,
            "old states dropped": conversation.states.old,
            "watchdog trips": conversation.trips.count,
            "watchdog reports not believed": conversation.trips.disbelieved,
            "reconnections": conversation.reconnections,
            **{str(kind): number for kind, number in conversation.decoder.dropped.items()},
        }

    def read(self) -> Pose | None:
        """Newest sample since the last call, or None; this never waits.

        Raises
        ------
        DeviceError
            If the device says that it cannot go on.
        """
        now_ns = self._now_ns()
        port, conversation = self.port, self.conversation
        stalled = conversation.mind_stall(now_ns)
        chunk, self._left_over = self._left_over + port.read(), b""
        for _ in range(_MOST_READS * stalled):
            chunk += (more := port.read())
            if not more:
                break
        if port.losses != self._losses:
            self._losses = port.losses
            conversation.lose(now_ns)
        if port.gone:
            self._copy()
            return None
        if conversation.stage is Stage.GONE:
            conversation.find(now_ns)
        pose = conversation.hear(chunk, now_ns)
        self._send_due()
        if conversation.stage is Stage.FAILED and isinstance(conversation.failure, Fault):
            raise DeviceError(say(conversation.failure))
        return pose

    def lend(self) -> Lent | None:
        """What the engine needs to do steady ticks by itself; None if the line does not suit."""
        descriptor = self.port.bare_descriptor
        if descriptor is None or self._left_over or not self.conversation.drive.settled:
            return None
        begun = self._lending.lend(self.conversation)
        if begun is None:
            return None
        lending = self._lending
        return Lent(
            descriptor,
            begun,
            lending.received,
            lending.work,
            lending.out,
            lending.talk,
            lending.actuators,
        )

    def take_back(self, lent: Lent, received: int, unsent: int, torn: bytes) -> None:
        """Take back what was lent: `read` then begins with the bytes that were not taken."""
        self._lending.give_back(self.conversation)
        left_over = lent.received[:received].tobytes()
        if DELIMITER in left_over:
            self._left_over = left_over
        else:
            self.conversation.decoder.feed(left_over)
        self._unsent += unsent
        self.conversation.no_room = unsent > 0
        if torn:
            self.port.keep(torn)
        self._copy()

    def _send(self, frame: NDArray[np.float64]) -> None:
        self.conversation.show(frame, self._now_ns())
        self._send_due()

    def _send_due(self) -> None:
        self._unsent += send_due(self.port, self.conversation)
        self._copy()

    def _copy(self) -> None:
        """Copy the values that `Device` promises from the conversation."""
        conversation = self.conversation
        self.rested = conversation.rested
        self.taking = conversation.taking
        self.placing = conversation.place.placing
        self.particulars = conversation.particulars
        self.watchdog_trips = conversation.trips.count
        self.acknowledged_ns = conversation.frames.acknowledged_ns

    def _release(self) -> None:
        try:
            self.conversation.close(self._now_ns())
            for _ in range(DRAIN_MS):
                self._send_due()
                if self.conversation.due() is None or self.port.gone:
                    break
                self._pause(0.001)
        finally:
            self.port.close(self._pause)
