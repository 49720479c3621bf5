"""A line to a device: a serial port, a pseudo-terminal or a socket, that never waits.

Drivers of other serial or TCP boxes may import it, too.
"""

from __future__ import annotations

import array
import errno
import fcntl
import grp
import os
import re
import socket
import stat
import termios
import time
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import parse_qsl, urlsplit

from vbraille.errors import DeviceError, InputError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Mapping

BAUD: Final = 921_600
_BAUD_RANGE: Final = (300, 12_000_000)
_MOST_BYTES: Final = 65_536
_CONNECT_S: Final = 0.8  # a loop that looks for its device waits for so long
_DRAIN_S: Final = 0.05  # that the last bytes may take to go out


@dataclass(frozen=True, slots=True)
class Address:
    """Place of a device, and how its port is opened.

    Parameters
    ----------
    where
        A path, or ``socket://HOST:PORT``.
    baud
        Symbols a second.
    options
        Other options, by name: those of the driver.
    """

    where: str
    baud: int
    options: Mapping[str, float]

    @property
    def is_socket(self) -> bool:
        """Tell whether it is that of a socket."""
        return "://" in self.where


def parse_address(text: str, **usual: float) -> Address:
    """Read an address such as ``/dev/ttyACM0?baud=115200``.

    Parameters
    ----------
    text
        The address.
    usual
        Further options that there are, with their usual values.

    Raises
    ------
    InputError
        If it names no port, or an option is unknown or out of range.
    """
    where, _, query = text.partition("?")
    if not where:
        raise InputError(f"serial: needs a port, as in serial:/dev/ttyACM0; {ports_said()}")
    if "://" in where and not re.fullmatch(r"socket://[^/]+:[0-9]{1,5}", where):
        raise InputError(f"{where} is no port; give a path, or socket://HOST:PORT")
    options = {"baud": BAUD, **usual}
    for name, value in parse_qsl(query, keep_blank_values=True):
        if name not in options:
            raise InputError(f"unknown option {name!r} of a port; known: {', '.join(options)}")
        low, high = _BAUD_RANGE if name == "baud" else (0, 60)
        with suppress(ValueError):
            options[name] = float(value)
            if low <= options[name] <= high:
                continue
        raise InputError(f"{name} is {value!r}; it must be a number from {low} to {high}")
    return Address(where, int(options.pop("baud")), options)


def ports_said() -> str:
    """Name the serial ports of this computer in a sentence."""
    from serial.tools import list_ports

    names = sorted(port.device for port in list_ports.comports())
    return f"ports: {', '.join(names)}" if names else "no serial port is plugged in"


class Line:
    """An open port; whole messages go out, or nothing of them. OSError means that it is gone.

    Parameters
    ----------
    address
        Where it is.

    Raises
    ------
    InputError
        If there is no such port.
    DeviceError
        If it cannot be opened.
    """

    def __init__(self, address: Address) -> None:
        self._left = b""  # of a message that was cut short
        self._is_socket = address.is_socket
        try:
            if address.is_socket:
                parts = urlsplit(address.where)
                link = socket.create_connection((parts.hostname, parts.port), _CONNECT_S)
                link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                link.setblocking(False)
                self._port, self.descriptor = link, link.fileno()
                return
            self._port, self.descriptor = _open_serial(address)
        except (OSError, ValueError, termios.error) as fault:
            raise _explained(fault, address.where) from fault

    def read(self) -> bytes:
        """Give the bytes that have come."""
        try:
            chunk = os.read(self.descriptor, _MOST_BYTES)
        except BlockingIOError:
            return b""
        if not chunk:
            raise OSError(errno.EIO, "hung up")
        return chunk

    def write(self, message: bytes) -> bool:
        """Send a message; tell whether it was taken. One that was cut short is finished first."""
        left = len(self._left)
        chunk = self._left + message if left else message
        try:
            sent = os.write(self.descriptor, chunk) if chunk else 0
        except BlockingIOError:
            return False
        # Where not a byte of it went out, it would be late when it does.
        self._left = chunk[sent:] if sent > left or not message else self._left[sent:]
        return sent > left

    def drop_unsent(self) -> None:
        """Have the system drop what has not gone out; a socket cannot do so, and sends it."""
        if not self._is_socket:
            with suppress(OSError, termios.error):
                termios.tcflush(self.descriptor, termios.TCOFLUSH)
                self._left = b"\0"

    def close(self) -> None:
        """Close the port, once the last bytes are out or have had their time."""
        until_s = time.monotonic() + _DRAIN_S
        with suppress(OSError, termios.error):
            while self._unsent() and time.monotonic() < until_s:
                time.sleep(0.001)
            self.drop_unsent()  # closing a terminal waits for what it has not sent
        with suppress(OSError):
            self._port.close()

    def _unsent(self) -> bool:
        if self._left:
            self.write(b"")
        queued = array.array("i", [0])
        fcntl.ioctl(self.descriptor, termios.TIOCOUTQ, queued)
        return bool(self._left or queued[0])


def _open_serial(address: Address):
    import serial

    if not stat.S_ISCHR(Path(address.where).stat().st_mode):
        raise OSError(errno.ENOTTY, "no serial port")
    # With an inter-byte timeout a read tells a line that hung up from one with nothing to read.
    port = serial.Serial(
        address.where, address.baud, timeout=0, inter_byte_timeout=0.0, exclusive=True
    )
    with suppress(OSError, ValueError, NotImplementedError):  # a pseudo-terminal has none
        port.set_low_latency_mode(True)
    return port, port.fileno()


def _explained(fault: Exception, where: str) -> VbrailleError:
    """Sentence on why a port could not be opened, and on what to do."""
    number = getattr(fault, "errno", None)
    if "://" in where:
        host = urlsplit(where).hostname
        if isinstance(fault, socket.gaierror):
            return InputError(f"unknown host {host}; check its name")
        if number == errno.ECONNREFUSED:
            return DeviceError(f"{host} answers, but nothing listens at {where}; start the device")
        return DeviceError(f"{host} does not answer; see that it is on and in this network")
    if number in (errno.EACCES, errno.EPERM):
        group = _group_of(where)
        return DeviceError(
            f"you may not open {where}; add yourself to the group {group} "
            f"(sudo usermod -aG {group} $USER) and log in again"
        )
    if number in (errno.EBUSY, errno.EAGAIN):
        return DeviceError(f"{where} is busy; end the other program that uses it")
    return InputError(f"{where} is no serial port; {ports_said()}")


def _group_of(path: str) -> str:
    """Name the group that owns a port: distributions differ in it."""
    try:
        return grp.getgrgid(Path(path).stat().st_gid).gr_name
    except (OSError, KeyError):
        return "dialout"


def usb_identity(path: str) -> tuple[object, ...] | None:
    """Return what tells the USB device at a port from others, wherever it is plugged in, if any.

    Of a device with several ports it tells them apart.
    """
    real = os.path.realpath(path)
    return next((identity for identity, port in _plugged().items() if port == real), None)


def _plugged() -> dict[tuple[object, ...], str]:
    """Ports of this computer that have a serial number, by maker, product, it and interface."""
    from serial.tools import list_ports

    return {
        (port.vid, port.pid, port.serial_number, (port.location or "").partition(":")[2]): (
            port.device
        )
        for port in list_ports.comports()
        if port.serial_number
    }


def find_again(address: Address, identity: tuple[object, ...] | None) -> Address:
    """Address at which a device that went away is back: by its identity, else where it was.

    Raises
    ------
    KeyError
        If no device of that identity is plugged in: another one may be at its old path.
    """
    return address if identity is None else replace(address, where=_plugged()[identity])
