"""Open serial ports: bytes in and out, without waiting, by one system call each.

`Serial.write` is no way to do it: it spins once the peer stops reading (pyserial#280).
"""

from __future__ import annotations

import array
import errno
import fcntl
import os
import termios
from contextlib import suppress
from typing import TYPE_CHECKING

from vbraille.devices.serial.ports import open_serial_port
from vbraille.devices.wire.codec import DELIMITER

if TYPE_CHECKING:
    import serial

    from vbraille.devices.serial.ports import Address

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
        """Whether the driver has nothing more to send."""
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
