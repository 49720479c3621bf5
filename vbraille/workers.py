"""Processes of the program's own beside it: started, told, heard, ended, and never waited for.

What may take its time, such as a speech server, a display's library or a search in a whole book,
has a process, so that no hand waits for it. Program and process tell each other messages of
msgspec through two pipes, each after its length in bytes. The host of the engine is no such worker:
it shares memory (`vbraille.engine.host`).
"""

from __future__ import annotations

import ctypes
import os
import select
import signal
import struct
import subprocess
import sys
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Any, Final, Generic, Self, TypeVar

import msgspec

if TYPE_CHECKING:
    from collections.abc import Sequence

Message = TypeVar("Message")
_LENGTH: Final = struct.Struct("<I")
_READ_BYTES: Final = 1 << 16
_END_S: Final = 2.0
_PR_SET_PDEATHSIG: Final = 1


class Incoming(Generic[Message]):
    """Messages that come through a pipe, which is read without waiting.

    Parameters
    ----------
    descriptor
        Number of the pipe's open file.
    kind
        Type of the messages; a message of another one ends them.

    Attributes
    ----------
    ended : bool
        Whether nothing more can come.
    """

    def __init__(self, descriptor: int, kind: Any) -> None:
        os.set_blocking(descriptor, False)
        self.descriptor = descriptor
        self.ended = False
        self._decoder: msgspec.msgpack.Decoder[Message] = msgspec.msgpack.Decoder(kind)
        self._held = bytearray()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for something to come, or for the end; False if neither came in so many seconds."""
        return bool(select.select([self.descriptor], [], [], seconds)[0])

    def take(self) -> list[Message]:
        """Take the messages that are whole by now."""
        while not self.ended:
            try:
                read = os.read(self.descriptor, _READ_BYTES)
            except BlockingIOError:
                break
            except OSError:
                read = b""
            self.ended = not read
            self._held += read
        messages: list[Message] = []
        begun = 0
        while len(self._held) - begun >= _LENGTH.size:
            start = begun + _LENGTH.size
            end = start + _LENGTH.unpack_from(self._held, begun)[0]
            if len(self._held) < end:
                break
            messages.append(self._decoder.decode(self._held[start:end]))
            begun = end
        del self._held[:begun]
        return messages


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
        self._waiting: deque[bytes] = deque()
        self._begun = memoryview(b"")  # the rest of a message of which a part is in the pipe

    def put(self, message: object, *, alone: bool = False) -> None:
        """Take a message, and write as much as there is room for.

        Parameters
        ----------
        message
            Message, of builtins and msgspec structs.
        alone
            Whether messages that still wait here are dropped in its favour.

        Raises
        ------
        OSError
            If the other side is gone.
        """
        packed = msgspec.msgpack.encode(message)
        if alone:
            self._waiting.clear()
        self._waiting.append(_LENGTH.pack(len(packed)) + packed)
        self.flush()

    def flush(self) -> bool:
        """Write as much of what is left as there is room for; whether nothing is left.

        Raises
        ------
        OSError
            If the other side is gone.
        """
        while self._begun or self._waiting:
            if not self._begun:
                self._begun = memoryview(self._waiting.popleft())
            try:
                written = os.write(self._descriptor, self._begun)
            except BlockingIOError:
                return False
            self._begun = self._begun[written:]
        return True


class Worker(Generic[Message]):
    """A process of our own that runs a module; see `begin` for its end. A context manager.

    It has a session of its own, so that keys of the terminal neither stop nor end it, and it ends
    with its parent.

    Parameters
    ----------
    module
        Name of the module.
    arguments
        Arguments that the module is given, after the number of this process.
    tells
        Type of the messages that it sends; None if it sends none.
    pass_fds
        Descriptors that it inherits.
    quiet
        Whether what it prints goes nowhere; otherwise it goes to standard error.

    Raises
    ------
    OSError
        If no process can be started.
    """

    def __init__(
        self,
        module: str,
        *arguments: str,
        tells: Any = None,
        pass_fds: Sequence[int] = (),
        quiet: bool = False,
    ) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", module, str(os.getpid()), *arguments],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if quiet else None,
            pass_fds=pass_fds,
            bufsize=0,
            start_new_session=True,
        )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self._orders = Outgoing(self.process.stdin.fileno())
        self._told: Incoming[Message] = Incoming(self.process.stdout.fileno(), tells)
        self._closed = False

    @property
    def descriptor(self) -> int:
        """Number of the open file that can be read when a message comes."""
        return self._told.descriptor

    @property
    def ended(self) -> bool:
        """Tell whether the process is gone, as `receive` or `send` has found."""
        return self._closed or self._told.ended

    def send(self, message: object, *, alone: bool = False) -> bool:
        """Send a message as soon as there is room for it; this never waits.

        Parameters
        ----------
        message
            The message.
        alone
            Whether messages that still wait here are dropped in its favour.

        Returns
        -------
        bool
            Whether the process is still there to be told; later messages may show that it is not.
        """
        if self._closed:
            return False
        try:
            self._orders.put(message, alone=alone)
        except OSError:
            return False
        return True

    def receive(self) -> list[Message]:
        """Take the messages that have come; this never waits."""
        if self._closed:
            return []
        with suppress(OSError):
            self._orders.flush()
        return self._told.take()

    def close(self, wait_s: float = _END_S) -> None:
        """End the process, once it has done what it was told; further calls do nothing.

        Parameters
        ----------
        wait_s
            Time that it has for that, in s.
        """
        if self._closed:
            return
        self._closed = True
        for pipe in (self.process.stdin, self.process.stdout):
            assert pipe is not None
            with suppress(OSError):
                pipe.close()
        try:
            self.process.wait(wait_s)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def begin(orders: Any, nice: int = 0) -> tuple[Incoming[Any], Outgoing]:
    """Begin to work, in the process of a `Worker`, which the system ends with its parent.

    What anything prints from now on goes to standard error.

    Parameters
    ----------
    orders
        Type of the messages that come.
    nice
        Number that is added to the niceness of the process.

    Returns
    -------
    tuple[Incoming, Outgoing]
        Messages from the parent, and to it.
    """
    ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL))
    if os.getppid() != int(sys.argv[1]):  # the parent was gone before that
        sys.exit()
    with suppress(OSError):
        os.nice(nice)
    told = os.dup(1)  # which no process of its own inherits
    os.dup2(2, 1)
    return Incoming(0, orders), Outgoing(told)
