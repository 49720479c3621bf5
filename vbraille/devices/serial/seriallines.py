"""Open serial ports: bytes in and out, without waiting.

A port with a descriptor is read and written by one system call each.
`Serial.write` is no way to do it: it spins once the peer stops reading
(pyserial#280). The handlers of other URLs get threads that may wait.
"""

from __future__ import annotations

import array
import errno
import fcntl
import os
import termios
import threading
from collections import deque
from contextlib import suppress
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING, Protocol

import serial

from vbraille.devices.serial.ports import open_serial_port
from vbraille.devices.wire.codec import DELIMITER

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.devices.serial.ports import Address

_MOST_BYTES = 65_536
# Longest time that the threads of a handler wait before they look whether they are to end.
_PATIENCE_S = 0.1
_JOIN_S = 1.0


class SerialLine(Protocol):
    """An open port; its methods raise OSError if the port is gone."""

    lost: int
    """Frames that were taken, and then did not go out."""

    def read(self) -> bytes:
        """Give the bytes that have come; this never waits."""
        ...

    def write(self, frame: bytes) -> bool:
        """Send a frame whole, or not at all; tell whether it was taken. This never waits."""
        ...

    @property
    def bare_descriptor(self) -> int | None:
        """Descriptor to read and write by, with nothing left of an earlier frame; else None."""
        ...

    def keep(self, rest: bytes) -> None:
        """Keep the rest of a frame, of which a part went out by the descriptor, to send it next."""
        ...

    def drop_unsent(self) -> None:
        """Drop what has not gone out yet; the next frame ends one of which a part has gone out."""
        ...

    def drained(self) -> bool:
        """Whether all frames that were taken have gone out."""
        ...

    def close(self) -> None:
        """Close the port; this may wait."""
        ...


class DescriptorLine:
    """A port with a non-blocking descriptor."""

    lost = 0

    def __init__(self, port: serial.SerialBase, descriptor: int) -> None:
        self._port = port
        self._descriptor = descriptor
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


class ThreadedLine:
    """A handler without a descriptor, whose reads and writes may wait: each has a thread."""

    def __init__(self, port: serial.SerialBase) -> None:
        port.timeout = port.write_timeout = _PATIENCE_S
        self.lost = 0
        self._port = port
        self._ending = self._busy = self._torn = False
        self._fault: Exception | None = None
        self._come: deque[bytes] = deque()
        # Box for one frame, and a bell that rings when there is one. Neither makes anybody wait.
        self._box: deque[bytes] = deque()
        self._bell: SimpleQueue[None] = SimpleQueue()
        self._threads = [
            threading.Thread(target=self._run, args=(work,), daemon=True, name="vbraille port")
            for work in (self._receive, self._send)
        ]
        for thread in self._threads:
            thread.start()

    def read(self) -> bytes:
        """Give the bytes that the thread has read."""
        if self._come:
            return b"".join(self._come.popleft() for _ in range(len(self._come)))
        self._check()
        return b""

    def write(self, frame: bytes) -> bool:
        """Leave a frame for the thread, in place of a frame that still lies there."""
        self._check()
        with suppress(IndexError):
            self._box.popleft()
            self.lost += 1
        self._box.append(frame)
        if self._bell.empty():
            self._bell.put(None)
        return True

    bare_descriptor = None

    def keep(self, rest: bytes) -> None:
        """Do nothing: no part of a frame goes out but by the thread."""

    def drop_unsent(self) -> None:
        """Drop the frame that waits for the thread."""
        with suppress(IndexError):
            self._box.popleft()
            self.lost += 1

    def drained(self) -> bool:
        """Whether the thread has written all frames."""
        return not self._box and not self._busy

    def close(self) -> None:
        """End the threads, then close the handler."""
        self._ending = True
        for thread in self._threads:
            thread.join(_JOIN_S)
        with suppress(OSError):
            self._port.close()

    def _check(self) -> None:
        if self._fault is not None:
            raise OSError(errno.EIO, str(self._fault))

    def _run(self, work: Callable[[], None]) -> None:
        try:
            while not self._ending and self._fault is None:
                work()
        except Exception as fault:  # a handler may raise anything once its line is gone
            self._fault = fault

    def _receive(self) -> None:
        chunk = self._port.read(max(1, getattr(self._port, "in_waiting", 1)))
        if chunk:
            self._come.append(chunk)

    def _send(self) -> None:
        try:
            self._bell.get(timeout=_PATIENCE_S)
            self._busy = True
            frame = self._box.popleft()
            self._port.write(DELIMITER + frame if self._torn else frame)
            self._torn = False
        except (Empty, IndexError):
            pass
        except serial.SerialTimeoutException:
            # Nobody knows how much of it went out: the next frame must end it to be whole itself.
            self._torn = True
            self.lost += 1
        finally:
            self._busy = False


def open_line(address: Address, url: str | None = None) -> SerialLine:
    """Open a port as the line that suits it; this raises what `open_serial_port` raises."""
    port = open_serial_port(address, url)
    try:
        descriptor = _descriptor(port)
        return ThreadedLine(port) if descriptor is None else DescriptorLine(port, descriptor)
    except BaseException:
        port.close()
        raise


def _descriptor(port: serial.SerialBase) -> int | None:
    """Descriptor to read and write by; None if there is none, or the handler must see all bytes."""
    if isinstance(port, serial.Serial) and type(port).write is not serial.Serial.write:
        return None  # as the handler of spy:// must
    try:
        descriptor = port.fileno()
        return None if os.get_blocking(descriptor) else descriptor
    except (OSError, AttributeError):
        return None
