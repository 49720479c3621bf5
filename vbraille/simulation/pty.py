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


class Port:
    """A pseudo-terminal, plugged in until `unplug`. Its methods never wait.

    Parameters
    ----------
    link
        Path of a symbolic link that points at the port while it is plugged in, so that it has the
        same name each time.

    Attributes
    ----------
    descriptor : int or None
        Descriptor to wait for with select; None while the port is unplugged.
    path : str
        Path of the port itself.

    Raises
    ------
    InputError
        If the link cannot be made, or something else is at its path.
    """

    def __init__(self, link: str | None = None) -> None:
        self._link = None if link is None else Path(link)
        self.descriptor: int | None = None
        self.path = ""
        self.plug()

    @property
    def is_open(self) -> bool:
        """Tell whether a host has the port open."""
        if self.descriptor is None:
            return False
        poll = select.poll()
        poll.register(self.descriptor, select.POLLHUP)
        return not any(event & select.POLLHUP for _, event in poll.poll(0))

    def plug(self) -> None:
        """Make the port, perhaps at another path than before."""
        self.descriptor, slave = os.openpty()
        self.path = os.ttyname(slave)
        tty.setraw(slave)
        os.close(slave)
        os.set_blocking(self.descriptor, False)
        self._left = b""  # rest of a message that was written in part
        if self._link is None:
            return
        try:
            self._link.symlink_to(self.path)
        except OSError as error:
            self.unplug()
            what = f"no link can be made at {self._link}: {error.strerror}"
            if isinstance(error, FileExistsError):
                what = f"{self._link} is there already; remove it"
            raise InputError(f"{what}, or choose another place for {setting('link')}") from None

    def unplug(self) -> None:
        """Hang up, and let the port go; the link goes unless something else has its place."""
        with suppress(OSError):
            if self._link is not None and self._link.readlink() == Path(self.path):
                self._link.unlink()
        if self.descriptor is not None:
            os.close(self.descriptor)
        self.descriptor = None

    def read(self) -> bytes:
        """Give the bytes that have come."""
        if self.descriptor is None:
            return b""
        try:
            return os.read(self.descriptor, _CHUNK)
        except OSError:  # there is nothing, or no host has the port open
            return b""

    def send(self, message: bytes) -> None:
        """Send a message; it is lost if the one before has not gone out."""
        self._left = self._left or message
        with suppress(OSError):
            if self.descriptor is not None:
                self._left = self._left[os.write(self.descriptor, self._left) :]
