"""Values between a process and one that it has begun, through pipes."""

from __future__ import annotations

import os
import pickle
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from typing import IO

_LENGTH = 8  # bytes


def send(stream: IO[bytes], value: object) -> None:
    """Send a value.

    Raises
    ------
    BrokenPipeError
        If nobody reads it.
    """
    content = pickle.dumps(value, pickle.HIGHEST_PROTOCOL)
    stream.write(len(content).to_bytes(_LENGTH, "little") + content)
    stream.flush()


def receive(stream: IO[bytes]) -> object:
    """Receive a value, and nothing beyond it: what `select` sees in the pipe is the next value.

    Raises
    ------
    EOFError
        If the other process has ended.
    """
    length = int.from_bytes(_exactly(stream, _LENGTH), "little")
    return pickle.loads(_exactly(stream, length))


def _exactly(stream: IO[bytes], size: int) -> bytearray:
    content = bytearray()
    while len(content) < size:
        piece = os.read(stream.fileno(), size - len(content))
        if not piece:
            raise EOFError
        content += piece
    return content
