"""``serial:PATH[?baud=N]``: open the port, greet the device, see that the line is fast enough."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Final

import serial

from vbraille.devices.greeting import greet
from vbraille.devices.messages import STALL_MS
from vbraille.devices.ports import BAUD, parse_address
from vbraille.devices.serialdevice import SerialDevice
from vbraille.devices.serialport import LOOK_S, SerialPort
from vbraille.devices.wire import Levels, line_bytes
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices.messages import Info
    from vbraille.devices.ports import Address
    from vbraille.display import Display

# A start bit and a stop bit with each byte.
_BITS_PER_BYTE = 10
_FRAME_HEAD_BYTES = 3
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
        ``PATH[?baud=N]``, or a URL of pyserial's.
    wanted
        What the page was laid out for; None if any device will do.
    now_ns, pause
        The host's clock, and how to wait for so many seconds.
    look_s
        How often a port that is gone is looked for.

    Raises
    ------
    InputError
        If there is no such port, or the baud rate is too slow.
    DeviceError
        If it cannot be opened, or no device of our protocol answers.
    """
    port = SerialPort(parse_address(address), look_s=look_s)
    try:
        greeted = greet(port, now_ns, pause)
        if wanted is None:
            return SerialDevice(port, greeted, now_ns, pause)
        _check_rate(greeted.info, wanted.rate_hz)
        _check_baud(port.address, greeted.info, wanted.rate_hz)
        return SerialDevice(port, greeted, now_ns, pause, wanted.rate_hz)
    except BaseException:  # a signal's, too
        port.close(pause)
        raise


def _check_rate(info: Info, rate_hz: float) -> None:
    """See that frames come often enough for the device's watchdog.

    Raises
    ------
    InputError
        If they do not.
    """
    if rate_hz < LOWEST_RATE_HZ:
        raise InputError(
            f"{info.name} goes to rest when frames are further apart than {STALL_MS} ms, and "
            f"{rate_hz:g} a second are asked for; choose --rate {LOWEST_RATE_HZ} or more"
        )


def _check_baud(address: Address, info: Info, rate_hz: float) -> None:
    """See that the line carries so many frames a second.

    Raises
    ------
    InputError
        If it does not, with the baud rate or the frame rate that would do.
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
        f"{rate_hz:g} are asked for; choose --rate {baud // frame_bits} or less{faster}"
    )
