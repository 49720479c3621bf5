"""Serial ports: which there are, how one is opened, and how it is found again.

PATH[?baud=N]          /dev/ttyACM0, or a link to it, such as one of /dev/serial/by-id/
socket://HOST:PORT     the serial line of another computer, over TCP
"""

from __future__ import annotations

import array
import errno
import fcntl
import logging
import os
import socket
import stat
import termios
import threading
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

import serial
from serial.tools import list_ports

from vbraille.devices.serial.wire import DELIMITER
from vbraille.errors import DeviceError, InputError, VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from serial.tools.list_ports_common import ListPortInfo

    ListPorts = Callable[[], Iterable[ListPortInfo]]
    from collections.abc import Callable


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
        """Tell whether the address is a path, and no URL."""
        return "://" not in self.url

    @property
    def limits(self) -> bool:
        """Tell whether the baud rate says how much the line carries.

        On a UART it does. With USB CDC, sockets and pseudo-terminals it has no meaning unless the
        user gives one.
        """
        if self.baud is not None:
            return True
        name = os.path.realpath(self.url)
        return self.is_path and not name.startswith(("/dev/pts/", "/dev/ttyACM"))


@dataclass(frozen=True, slots=True)
class Identity:
    """Identity of a device on USB, wherever it is plugged in.

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


_MOST_BYTES = 65_536


class SerialLine:
    """An open port; a method raises OSError if the port is gone.

    Parameters
    ----------
    port
        The port, which has a descriptor that never waits.
    """

    def __init__(self, port: serial.SerialBase) -> None:
        self._port = port
        self._descriptor: int = port.fileno()  # pyright: ignore[reportAttributeAccessIssue]
        self._left = b""  # rest of a frame that was sent in part

    def read(self) -> bytes:
        """Give the bytes that have come, by one read."""
        try:
            chunk = os.read(self._descriptor, _MOST_BYTES)
        except BlockingIOError:
            return b""
        if not chunk:
            raise OSError(errno.EIO, "hung up")
        return chunk

    def write(self, frame: bytes) -> bool:
        """Send, by one write, what is left of the frame before and then this frame."""
        left = len(self._left)
        chunk = self._left + frame if left else frame
        try:
            written = os.write(self._descriptor, chunk)
        except BlockingIOError:
            return False
        if written > left:
            self._left = chunk[written:]
            return True
        # Not a byte of this frame went out; later it would be late.
        self._left = self._left[written:]
        return False

    @property
    def bare_descriptor(self) -> int | None:
        """Descriptor to read and write by, with nothing left of an earlier frame; else None."""
        return None if self._left else self._descriptor

    def keep(self, rest: bytes) -> None:
        """Keep the rest of a frame, to send it before the next."""
        self._left = rest

    def drop_unsent(self) -> None:
        """Have the driver drop what it has not sent; a socket cannot do so, and sends it all."""
        with suppress(OSError, termios.error):
            termios.tcflush(self._descriptor, termios.TCOFLUSH)
            self._left = DELIMITER

    def drained(self) -> bool:
        """Tell whether the driver has nothing more to send."""
        if self._left:
            with suppress(BlockingIOError):
                self._left = self._left[os.write(self._descriptor, self._left) :]
        queued = array.array("i", [0])
        fcntl.ioctl(self._descriptor, termios.TIOCOUTQ, queued)
        return not self._left and not queued[0]

    def close(self) -> None:
        """Close the port and drop what it could not send: closing a terminal waits for that."""
        # pyserial forgets to close a socket that the peer has shut down.
        socket = getattr(self._port, "_socket", None)
        with suppress(OSError, termios.error):
            if socket is None and not self.drained():
                termios.tcflush(self._descriptor, termios.TCOFLUSH)
        with suppress(OSError):
            self._port.close()
        if socket is not None:
            socket.close()


def open_line(address: Address, url: str | None = None) -> SerialLine:
    """Open a port as a line; this raises what `open_serial_port` raises."""
    return SerialLine(open_serial_port(address, url))


# Time between attempts to find a port that is gone.
LOOK_S: Final = 0.1
# Longest time that the last bytes may take to go out before the port is closed.
DRAIN_MS: Final = 50
_JOIN_S = 1.0
_NICENESS = 10
_log = logging.getLogger(__name__)


class SerialPort:
    """A port that is looked for when it is gone, and goes on when it is back.

    Parameters
    ----------
    address
        Address of the port.
    list_ports
        Function that lists the ports that are plugged in.
    look_s
        Time between attempts to find a port that is gone, in seconds.

    Attributes
    ----------
    gone : bool
        Whether the port is gone; `read` and `write` notice it, `read` ends it.
    losses : int
        How often the port was lost.
    """

    def __init__(
        self,
        address: Address,
        list_ports: ListPorts = list_ports.comports,
        look_s: float = LOOK_S,
    ) -> None:
        self.address = address
        self.gone = False
        self.losses = 0
        self._list_ports = list_ports
        self._look_s = look_s
        self._finder: _Finder | None = None
        self._identity = identify(address, list_ports)
        self._line = open_line(address)

    @property
    def serial_number(self) -> str:
        """Serial number of the device on USB; empty if none is known."""
        return "" if self._identity is None else self._identity.serial_number

    def read(self) -> bytes:
        """Bytes that have come; none while the port is gone. This never waits."""
        if self._finder is not None:
            line = self._finder.found
            if line is None:
                return b""
            _log.info("%s is back", self.address.url)
            self._line = line
            self._finder = None
            self.gone = False
        try:
            return self._line.read()
        except OSError:
            self._lose()
            return b""

    def write(self, frame: bytes) -> bool:
        """Send a frame whole, or not at all; tell whether it was taken. This never waits."""
        if self.gone:
            return False
        try:
            return self._line.write(frame)
        except OSError:
            self._lose()
            return False

    @property
    def bare_descriptor(self) -> int | None:
        """Descriptor to read and write by, with nothing left of an earlier frame; else None."""
        return None if self._finder is not None else self._line.bare_descriptor

    def keep(self, rest: bytes) -> None:
        """Keep the rest of a frame, of which a part went out by the descriptor, to send it next."""
        if not self.gone:
            self._line.keep(rest)

    def drop_unsent(self) -> None:
        """Drop what has not gone out yet, as far as the system lets us."""
        if not self.gone:
            self._line.drop_unsent()

    def close(self, pause: Callable[[float], None] = time.sleep) -> None:
        """Close the port once all is out, or time is up; the search for it ends, too."""
        if self._finder is not None:
            self._finder.stop()
            return
        try:
            for _ in range(DRAIN_MS):
                if self._line.drained():
                    break
                pause(0.001)
        except (OSError, termios.error):
            pass  # the port is gone
        finally:
            self._line.close()

    def _lose(self) -> None:
        self.gone = True
        self.losses += 1
        _log.info("%s is gone, and looked for", self.address.url)
        self._finder = _Finder(self._line, self._find, self._look_s)
        self._finder.start()

    def _find(self) -> SerialLine | None:
        url = find_again(self.address, self._identity, self._list_ports)
        return None if url is None else open_line(self.address, url)


class _Finder(threading.Thread):
    """Thread that closes a line that is gone and looks for it till it is back: both may be slow."""

    def __init__(
        self, gone: SerialLine, find: Callable[[], SerialLine | None], look_s: float
    ) -> None:
        super().__init__(name="vbraille port finder", daemon=True)
        self.found: SerialLine | None = None
        self._gone = gone
        self._find = find
        self._look_s = look_s
        self._stopped = threading.Event()
        self._handing = threading.Lock()

    def run(self) -> None:
        """Look for the port until it is found or not wanted any more."""
        _step_back()
        self._gone.close()
        while not self._stopped.wait(self._look_s):
            with suppress(VbrailleError, OSError):
                line = self._find()
                if line is not None:
                    self._hand_over(line)
                    return

    def stop(self) -> None:
        """Stop looking for the port, and close a port that was found."""
        with self._handing:
            self._stopped.set()
            if self.found is not None:
                self.found.close()
        # The thread may be connecting, for seconds; it then closes the port that it gets.
        self.join(_JOIN_S)

    def _hand_over(self, line: SerialLine) -> None:
        with self._handing:
            if self._stopped.is_set():
                line.close()
            else:
                self.found = line


def _step_back() -> None:
    """Let this thread run only when no other wants to; it begins with its parent's priority."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))
    with suppress(OSError, AttributeError):
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _NICENESS)
