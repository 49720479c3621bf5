"""Serial ports: which there are, how one is opened, and how it is found again.

PATH[?baud=N]          /dev/ttyACM0, or a link to it, such as one of /dev/serial/by-id/
socket://HOST:PORT     the serial line of another computer, over TCP
"""

from __future__ import annotations

import errno
import os
import socket
import stat
import termios
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

import serial
from serial.tools import list_ports

from vbraille.errors import DeviceError, InputError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from serial.tools.list_ports_common import ListPortInfo

    ListPorts = Callable[[], Iterable[ListPortInfo]]

BAUD: Final = 921_600
_LOWEST_BAUD, _HIGHEST_BAUD = 300, 12_000_000
# Group that owns a port where only a group may open it, in the usual case.
_GROUP = "dialout"
_SOCKET: Final = "socket://"
_EXAMPLE: Final = "socket://192.168.1.5:7000"


@dataclass(frozen=True, slots=True)
class Address:
    """Address of a port, and how the port is to be opened.

    Parameters
    ----------
    url
        A path, or the URL of a socket.
    baud
        Symbols a second; None if the rate was not given.
    """

    url: str
    baud: int | None = None

    @property
    def is_path(self) -> bool:
        """Whether the address is a path, and no URL."""
        return "://" not in self.url

    @property
    def limits(self) -> bool:
        """Whether the baud rate says how much the line carries.

        On a UART it does. With USB CDC, sockets and pseudo-terminals it has no meaning unless
        somebody gives one.
        """
        if self.baud is not None:
            return True
        name = os.path.realpath(self.url)
        return self.is_path and not name.startswith(("/dev/pts/", "/dev/ttyACM"))


@dataclass(frozen=True, slots=True)
class Identity:
    """What identifies a device on USB, wherever it is plugged in.

    Parameters
    ----------
    vendor, product
        Numbers of its make (VID and PID).
    serial_number
        Serial number of this very device.
    interface
        Which of the device's ports it is, if the device has several; otherwise empty.
    """

    vendor: int
    product: int
    serial_number: str
    interface: str


def parse_address(text: str) -> Address:
    """Address of a text, with our own options taken off it.

    Raises
    ------
    InputError
        If the text names no port, or an option is unknown or out of range.
    """
    url, _, query = text.partition("?")
    if not url:
        raise InputError(f"serial: needs a port, as in serial:/dev/ttyACM0; {_there_is()}")
    if "://" in url:
        _check_socket(url)
    baud = None
    for option in filter(None, query.split("&")):
        name, _, value = option.partition("=")
        if name == "baud":
            baud = _parse_baud(value)
        else:
            raise InputError(f"there is no option {name!r} of a serial port; there is baud")
    return Address(url, baud)


def _check_socket(url: str) -> None:
    """Raise InputError if a URL is not that of a socket."""
    if not url.lower().startswith(_SOCKET):
        raise InputError(
            f"{url} is no port; give a path, such as /dev/ttyACM0 or one of /dev/serial/by-id/, or "
            f"{_EXAMPLE}"
        )
    try:
        parts = urlsplit(url)
        whole = parts.hostname and parts.port and parts.path in ("", "/")
    except ValueError:
        whole = False
    if not whole:
        raise InputError(f"{url} needs a host and the number of a port, as in {_EXAMPLE}")


def _parse_baud(text: str) -> int:
    if text.isdecimal() and _LOWEST_BAUD <= int(text) <= _HIGHEST_BAUD:
        return int(text)
    raise InputError(
        f"baud rate is {text!r}; it must be a whole number from {_LOWEST_BAUD} to {_HIGHEST_BAUD}"
    )


def open_serial_port(address: Address, url: str | None = None) -> serial.SerialBase:
    """Open a port, for one process alone where the system can see to that.

    Parameters
    ----------
    address
        Address of the port, with its options.
    url
        URL of the port if it has moved from its address.

    Raises
    ------
    InputError
        If there is no port.
    DeviceError
        If the port cannot be opened.
    """
    url = url or address.url
    try:
        if address.is_path and not stat.S_ISCHR(Path(url).stat().st_mode):
            raise _no_port(url)
        # An inter-byte timeout of 0 makes pyserial set VMIN to 1: without it a read gives nothing
        # when there is nothing as well as when the line was hung up.
        port = serial.serial_for_url(
            url, address.baud or BAUD, timeout=0, inter_byte_timeout=0.0, exclusive=True
        )
    except (OSError, termios.error, ValueError, KeyError) as fault:
        raise explain(fault, url) from fault
    try:
        if isinstance(port, serial.Serial):
            port.set_low_latency_mode(True)
    except (OSError, ValueError, NotImplementedError):
        pass  # the driver has no lock, or the port is a pseudo-terminal
    except BaseException:
        port.close()
        raise
    return port


def explain(fault: Exception, url: str) -> VbrailleError:
    """Sentence on why a port could not be opened, and on what to do."""
    number = getattr(fault, "errno", None)
    if number in (errno.ENOENT, errno.ENXIO, errno.ENODEV, errno.ENOTDIR):
        return InputError(f"there is no port {url}; {_there_is()}")
    if number in (errno.EACCES, errno.EPERM):
        return DeviceError(
            f"you may not open {url}; add yourself to the group {_GROUP} "
            f"(sudo usermod -aG {_GROUP} $USER) and log in again"
        )
    if number in (errno.EBUSY, errno.EAGAIN):
        return DeviceError(f"{url} is busy; end the other program that uses it")
    return _explain_socket(fault, url) if "://" in url else _no_port(url)


def _explain_socket(fault: BaseException, url: str) -> VbrailleError:
    parts = urlsplit(url)
    host, port = parts.hostname, parts.port
    for cause in _causes(fault):
        number = cause.errno if isinstance(cause, OSError) else None
        if isinstance(cause, socket.gaierror):
            return InputError(f"there is no computer {host}; see that its name is right")
        if isinstance(cause, TimeoutError) or number == errno.ETIMEDOUT:
            return DeviceError(f"{host} does not answer; see that it is on and in this network")
        if number in (errno.ENETUNREACH, errno.EHOSTUNREACH):
            return DeviceError(f"there is no way to {host}; see that it is on and in this network")
        if number == errno.ECONNREFUSED:
            return DeviceError(
                f"{host} is there, but nothing answers at its port {port}; start what is to "
                f"answer, or give another number"
            )
    return DeviceError(f"{url} cannot be opened; see that host and port are right")


def _causes(fault: BaseException | None) -> Iterator[BaseException]:
    """Go through an exception and its causes: pyserial puts its own around the system's."""
    while fault is not None:
        yield fault
        fault = fault.__cause__ or fault.__context__


def _no_port(url: str) -> InputError:
    return InputError(f"{url} is no serial port; {_there_is()}")


def _there_is() -> str:
    names = sorted(port.device for port in list_ports.comports())
    if not names:
        return "plug the device in, for this computer has no serial port now"
    return f"there is {', '.join(names)}"


def identify(address: Address, list_ports: ListPorts = list_ports.comports) -> Identity | None:
    """Identity of the device at an address; None unless a path to a USB device with a number."""
    if not address.is_path:
        return None
    path = os.path.realpath(address.url)
    return next((_identity(port) for port in list_ports() if port.device == path), None)


def find_again(
    address: Address, identity: Identity | None, list_ports: ListPorts = list_ports.comports
) -> str | None:
    """URL at which to open a device that went away; None while it is away.

    A device with an identity is looked for by that alone, since another device may be at its
    old path. A device without one is expected where it was, or where the link points now.
    """
    if identity is None:
        return address.url
    return next((port.device for port in list_ports() if _identity(port) == identity), None)


def _identity(port: ListPortInfo) -> Identity | None:
    if port.vid is None or port.pid is None or not port.serial_number:
        return None
    # A device with several ports has one number; "1-4.2:1.3" is its port 1.3, wherever plugged in.
    interface = (port.location or "").partition(":")[2]
    return Identity(port.vid, port.pid, port.serial_number, interface)
