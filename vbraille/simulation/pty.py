"""The device's end of a pseudo-terminal, which a host opens as a serial port."""

from __future__ import annotations

import os
import select
import tty
from contextlib import suppress
from pathlib import Path

from vbraille.errors import InputError
from vbraille.wording import setting

_CHUNK = 65_536


class Link:
    """A symbolic link to a port, so that the port has the same name each time.

    Parameters
    ----------
    path
        Path of the link; whatever is there already is left alone.
    """

    def __init__(self, path: str) -> None:
        self.path = Path(path)
        self._target: str | None = None

    def point(self, target: str) -> None:
        """Have the link point at a port.

        Raises
        ------
        InputError
            If something else is at the path, or no link can be made there.
        """
        self.remove()
        try:
            self.path.symlink_to(target)
        except FileExistsError:
            raise InputError(
                f"{self.path} is there already; remove it, or choose another name for "
                f"{setting('link')}"
            ) from None
        except OSError as error:
            raise InputError(
                f"no link can be made at {self.path}: {error.strerror}; "
                f"choose another place for {setting('link')}"
            ) from None
        self._target = target

    def remove(self) -> None:
        """Remove the link, unless something else has taken its place."""
        with suppress(OSError):
            if self._target is not None and self.path.readlink() == Path(self._target):
                self.path.unlink()


class Port:
    """A pseudo-terminal, plugged in until `unplug`. Its methods never wait.

    Parameters
    ----------
    link
        Link that points at the port while it is plugged in.

    Raises
    ------
    InputError
        If the link cannot be made.
    """

    def __init__(self, link: Link | None = None) -> None:
        self._link = link
        self._master: int | None = None
        self._poll = select.poll()
        self._left = b""  # rest of a message that was written in part
        self.path = ""
        self.plug()

    @property
    def descriptor(self) -> int | None:
        """Descriptor to wait for with select; None while the port is unplugged."""
        return self._master

    @property
    def is_open(self) -> bool:
        """Tell whether a host has the port open."""
        if self._master is None:
            return False
        return not any(event & select.POLLHUP for _, event in self._poll.poll(0))

    def plug(self) -> None:
        """Make the port, perhaps at another path than before."""
        self._master, slave = os.openpty()
        self.path = os.ttyname(slave)
        tty.setraw(slave)
        os.close(slave)
        os.set_blocking(self._master, False)
        self._poll.register(self._master, select.POLLHUP)
        self._left = b""
        if self._link is not None:
            try:
                self._link.point(self.path)
            except InputError:
                self.unplug()
                raise

    def unplug(self) -> None:
        """Hang up, and let the port go."""
        if self._link is not None:
            self._link.remove()
        if self._master is not None:
            self._poll.unregister(self._master)
            os.close(self._master)
        self._master = None

    def read(self) -> bytes:
        """Give the bytes that have come."""
        if self._master is None:
            return b""
        try:
            return os.read(self._master, _CHUNK)
        except OSError:  # there is nothing, or no host has the port open
            return b""

    def send(self, message: bytes) -> bool:
        """Send a message whole, or not at all; tell whether it was sent."""
        if self._left:
            self._left = self._left[self._write(self._left) :]
        if self._left:
            return False
        written = self._write(message)
        if not written:
            return False
        self._left = message[written:]
        return True

    def _write(self, message: bytes) -> int:
        if self._master is None:
            return 0
        try:
            return os.write(self._master, message)
        except OSError:
            return 0
