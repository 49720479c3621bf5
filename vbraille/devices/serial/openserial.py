"""``serial:PATH[?baud=N]``: open the port, greet the device, see that the line is fast enough."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import serial

from vbraille.devices.events import Stranger
from vbraille.devices.serial.conversation import Conversation
from vbraille.devices.serial.ports import BAUD, parse_address
from vbraille.devices.serial.serialdevice import SerialDevice, send_due
from vbraille.devices.serial.serialport import LOOK_S, SerialPort
from vbraille.devices.serial.transitions import Stage
from vbraille.devices.wire.codec import Levels, line_bytes
from vbraille.devices.wire.messages import STALL_MS, VERSION
from vbraille.errors import DeviceError, InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices.serial.ports import Address
    from vbraille.devices.wire.messages import Info
    from vbraille.display import Display

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
