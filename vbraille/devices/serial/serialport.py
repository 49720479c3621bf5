"""A serial port that is found again after it was gone."""

from __future__ import annotations

import logging
import os
import termios
import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from serial.tools import list_ports

from vbraille.devices.serial.ports import find_again, identify
from vbraille.devices.serial.seriallines import open_line
from vbraille.errors import VbrailleError

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices.serial.ports import Address, ListPorts
    from vbraille.devices.serial.seriallines import SerialLine

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
        """Close the port once all is out, or time is up; nobody looks for it after that."""
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
