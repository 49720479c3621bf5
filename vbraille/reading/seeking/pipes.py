"""Messages between a reader and the process that looks through its book: lengths and msgpack."""

from __future__ import annotations

import os
import struct
from typing import TYPE_CHECKING, Any

import msgspec

if TYPE_CHECKING:
    from collections.abc import Iterator

_LENGTH = struct.Struct("<I")
_READ_BYTES = 65_536


class Incoming:
    """Messages that come through a pipe.

    Parameters
    ----------
    descriptor
        Number of the pipe's open file, which is read without waiting.

    Attributes
    ----------
    ended : bool
        Whether nothing more can come.
    """

    def __init__(self, descriptor: int) -> None:
        os.set_blocking(descriptor, False)
        self.descriptor = descriptor
        self._held = bytearray()
        self.ended = False

    def messages(self) -> Iterator[Any]:
        """Give the messages that are whole by now; `ended` tells whether more can come."""
        while not self.ended:
            try:
                read = os.read(self.descriptor, _READ_BYTES)
            except BlockingIOError:
                break
            except OSError:
                read = b""
            self.ended = not read
            self._held += read
        while len(self._held) >= _LENGTH.size:
            end = _LENGTH.size + _LENGTH.unpack_from(self._held)[0]
            if len(self._held) < end:
                return
            message = msgspec.msgpack.decode(bytes(self._held[_LENGTH.size : end]))
            del self._held[:end]
            yield message


class Outgoing:
    """Messages that go into a pipe, as fast as the other side takes them.

    Parameters
    ----------
    descriptor
        Number of the pipe's open file, which is written without waiting.
    """

    def __init__(self, descriptor: int) -> None:
        os.set_blocking(descriptor, False)
        self._descriptor = descriptor
        self._held = bytearray()

    def put(self, message: Any) -> None:
        """Take a message, and write as much as there is room for.

        Raises
        ------
        BrokenPipeError
            If nobody reads.
        """
        packed = msgspec.msgpack.encode(message)
        self._held += _LENGTH.pack(len(packed)) + packed
        self.flush()

    def flush(self) -> bool:
        """Write as much of what is left as there is room for; whether nothing is left.

        Raises
        ------
        BrokenPipeError
            If nobody reads.
        """
        while self._held:
            try:
                written = os.write(self._descriptor, self._held)
            except BlockingIOError:
                return False
            del self._held[:written]
        return True
