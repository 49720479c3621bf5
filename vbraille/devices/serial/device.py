"""A device on a serial line, by docs/wire-protocol.md: a port, a clock, and a `Conversation`.

``serial:PATH[?baud=N]`` opens the port, greets the device and sees that the line is fast enough.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import serial

from vbraille.devices.base import Device
from vbraille.devices.events import Fault, Stranger
from vbraille.devices.serial.conversation import Conversation, Stage
from vbraille.devices.serial.kernels import SteadyConversation
from vbraille.devices.serial.port import BAUD, DRAIN_MS, LOOK_S, SerialPort, parse_address
from vbraille.devices.serial.wire import (
    DELIMITER,
    STALL_MS,
    VERSION,
    Levels,
    line_bytes,
)
from vbraille.errors import DeviceError, InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.devices.calibration import Calibration
    from vbraille.devices.events import Event
    from vbraille.devices.serial.port import Address
    from vbraille.devices.serial.wire import Info
    from vbraille.display import Display, Pose


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
    """A device that has answered HELLO; `open_serial` begins the conversation.

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
        self.display = conversation.display
        self._now_ns = now_ns
        self._pause = pause
        self._losses = port.losses
        self._unsent = 0
        self._steady = SteadyConversation()
        self._left_over = b""  # bytes that came while the conversation was steady
        self._copy()

    @property
    def has_own_gains(self) -> bool:
        """Tell whether the device's INFO says that its actuators differ."""
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
            raise DeviceError(conversation.failure.say())
        return pose

    def begin_steady(self) -> SteadyConversation | None:
        """Numbers by which the engine does steady ticks itself; None if the line does not suit."""
        descriptor = self.port.bare_descriptor
        if descriptor is None or self._left_over or not self.conversation.drive.settled:
            return None
        if not self._steady.take_from(self.conversation):
            return None
        self._steady.descriptor = descriptor
        return self._steady

    def end_steady(self, received: int, unsent: int, torn: bytes) -> None:
        """Go on from the numbers that the engine left.

        Parameters
        ----------
        received
            Number of bytes that were not taken, with which `read` begins.
        unsent
            Number of FRAMEs that found no room.
        torn
            Rest of a FRAME of which a part went out.
        """
        self._steady.give_to(self.conversation)
        left_over = self._steady.received[:received].tobytes()
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


# Each byte has a start bit and a stop bit.
_BITS_PER_BYTE = 10
_FRAME_HEAD_BYTES = 3
_LISTEN_S = 0.005
# A frame may be late by half a period.
LOWEST_RATE_HZ: Final = 40


def open_serial(
    address: str,
    wanted: Display | None,
    *,
    now_ns: Callable[[], int] = time.monotonic_ns,
    pause: Callable[[float], None] = time.sleep,
    look_s: float = LOOK_S,
) -> SerialDevice:
    """Open ``serial:``: the device that answers at an address.

    Parameters
    ----------
    address
        ``PATH[?baud=N]``, or a URL that pyserial knows.
    wanted
        Display that the page was laid out for; None if any device will do.
    now_ns, pause
        Clock of the host, and function that waits for a number of seconds.
    look_s
        Time between attempts to find a port that is gone, in seconds.

    Raises
    ------
    InputError
        If there is no such port, or the baud rate is too slow.
    DeviceError
        If the port cannot be opened, or no device that speaks our protocol answers.
    """
    port = SerialPort(parse_address(address), look_s=look_s)
    device = begin(port, wanted, now_ns, pause)
    device.serial_number = port.serial_number
    return device


def begin(
    port: SerialPort,
    wanted: Display | None,
    now_ns: Callable[[], int],
    pause: Callable[[float], None],
) -> SerialDevice:
    """Begin to talk with the device at a port; if that fails, close the port.

    Raises
    ------
    InputError
        If the baud rate is too slow.
    DeviceError
        If no device that speaks our protocol answers.
    """
    rate_hz = None if wanted is None else wanted.rate_hz
    try:
        conversation = Conversation(now_ns(), rate_hz)
        info = greet(port, conversation, now_ns, pause)
        if rate_hz is not None:
            _check_often_enough(info, rate_hz)
            # It is sent no more than it takes, whether or not that is enough for who asks.
            _check_baud(port.address, info, min(rate_hz, info.rate_hz))
        return SerialDevice(port, conversation, now_ns, pause)
    except BaseException:  # a signal's exception, too
        port.close(pause)
        raise


def greet(
    port: SerialPort,
    conversation: Conversation,
    now_ns: Callable[[], int],
    pause: Callable[[float], None],
) -> Info:
    """Ask who is there until a device answers, for some seconds: it may restart when opened.

    Raises
    ------
    DeviceError
        If no device answers, or the device cannot be read on.
    """
    while conversation.info is None:
        send_due(port, conversation)
        chunk = port.read()
        if port.gone:
            raise DeviceError(f"{port.address.url} went away; plug the device in and try again")
        conversation.hear(chunk, now_ns())
        if isinstance(conversation.failure, Stranger):
            raise _turned_away(conversation.failure, port.address)
        if conversation.stage is Stage.FAILED:
            raise _no_answer(conversation, port.address)
        if conversation.info is None:
            pause(_LISTEN_S)
    return conversation.info


def _turned_away(stranger: Stranger, address: Address) -> DeviceError:
    if stranger.version is not None:
        return DeviceError(
            f"the device at {address.url} speaks version {stranger.version} of the "
            f"protocol and this vbraille version {VERSION}; update the older of the two"
        )
    return DeviceError(
        f"the device at {address.url} says in its INFO what cannot be: {stranger.fault}; "
        f"mend its firmware or its settings"
    )


def _no_answer(conversation: Conversation, address: Address) -> DeviceError:
    if conversation.speaks:
        return DeviceError(
            f"the device at {address.url} sends, but does not answer; "
            f"switch it off and on, or check its cable"
        )
    if conversation.heard:
        return DeviceError(
            f"what {address.url} sends makes no sense: it is no vbraille device, or not set to "
            f"{address.baud or BAUD} baud; choose another port, or ?baud="
        )
    return DeviceError(
        f"nothing answers at {address.url}; see that the device is on, or choose another port"
    )


def _check_often_enough(info: Info, rate_hz: float) -> None:
    """Check that frames come often enough for the device's watchdog.

    Raises
    ------
    InputError
        If they come too rarely.
    """
    if rate_hz < LOWEST_RATE_HZ:
        raise InputError(
            f"{info.name} goes to rest when frames are further apart than {STALL_MS} ms, and "
            f"{rate_hz:g} a second are asked for; choose {setting('rate')} {LOWEST_RATE_HZ} or more"
        )


def _check_baud(address: Address, info: Info, rate_hz: float) -> None:
    """Check that the line carries a rate of frames.

    Raises
    ------
    InputError
        If it does not; the message names the baud rate or the frame rate that would do.
    """
    if not address.limits:
        return
    packed = Levels(info.rows * info.columns, info.top_level).packed_bytes
    frame_bits = line_bytes(_FRAME_HEAD_BYTES + packed) * _BITS_PER_BYTE
    baud = address.baud or BAUD
    needed = frame_bits * rate_hz
    if needed <= baud:
        return
    enough = next((rate for rate in serial.SerialBase.BAUDRATES if rate >= needed), None)
    faster = f", or set the device and ?baud= to {enough}" if enough else ""
    raise InputError(
        f"{baud} baud carry {baud // frame_bits} frames a second of {info.name}, and "
        f"{rate_hz:g} are asked for; choose {setting('rate')} {baud // frame_bits} or less{faster}"
    )
