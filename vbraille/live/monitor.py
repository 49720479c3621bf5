"""The live view as the program that reads has it: a process of its own, which is never waited for.

Whatever becomes of that process, reading goes on: the worst is a sentence among `Monitor.notes`.
"""

from __future__ import annotations

import errno
import os
import socket
import subprocess
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Self

import msgspec

from vbraille.live.channel import Asks, Begin, Shares, Tells, encode, from_server, open_line
from vbraille.live.messages import ViewState
from vbraille.logs import kept, tracebacks_wanted

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.engine.mailbox import Extent
    from vbraille.live.messages import PagePress, Turn
    from vbraille.simulation.steering import Pointer


def has_desktop() -> bool:
    """Tell whether a person sits here who would see a browser that opens."""
    desktop = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    with suppress(OSError, ValueError, AttributeError):  # there may be no standard input
        return bool(desktop) and sys.stdin.isatty()
    return False


_END_S: Final = 2.0
_HEARD_BYTES: Final = 1 << 16  # the server's messages are short
_TOO_LARGE: Final = "the page is too large to be shown here"
_ENDED: Final = "live view: ended by a fault; reading goes on"


class Monitor:
    """The live view of what is read; it is a context manager, which launches it.

    Parameters
    ----------
    host
        Name or address at which pages reach it; this machine alone if it is None. Elsewhere a
        token is needed to watch, too.
    port
        Port at which pages reach it; a free one if it is None.
    pointer
        What holds the simulated hand, so that pages can be the hand; None if they cannot.
    blind
        Whether stimuli are hidden: then no deflections, no lines and no maps are sent, whatever
        states say.
    steers
        Whether pages may steer at all.
    """

    def __init__(
        self,
        *,
        host: str | None = None,
        port: int | None = None,
        pointer: Pointer | None = None,
        blind: bool = False,
        steers: bool = True,
    ) -> None:
        self._pointer = pointer  # whose memory the process has a share in
        held = None if pointer is None else pointer.descriptor
        self._begin = Begin(-1, host, port, held, blind, steers)
        self._line: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._asked: list[PagePress | Turn] = []
        self._notes: list[str] = []
        # What the line had no room for yet: the newest memory, and the newest state.
        self._unshared: tuple[int, Extent] | None = None
        self._untold: ViewState | None = None

    def launch(self) -> None:
        """Start the process without waiting for it; `notes` says its address, or why not."""
        if self._process is not None:
            return
        self._line, other = open_line()
        # What a browser writes is not for the reader.
        writes = tracebacks_wanted() or kept() == "-"
        begin = msgspec.structs.replace(
            self._begin, line=other.fileno(), opens=has_desktop(), log=kept()
        )
        with other:
            try:
                self._process = subprocess.Popen(
                    [sys.executable, "-m", "vbraille.live.serving", encode(begin).decode()],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    stderr=None if writes else subprocess.DEVNULL,
                    pass_fds=[end for end in (begin.line, begin.pointer) if end is not None],
                    start_new_session=True,
                )
            except OSError as error:
                self._notes.append(f"live view: cannot begin: {error.strerror}; reading goes on")
                self._hang_up()
        self._flush()

    def share(self, descriptor: int, extent: Extent) -> None:
        """Give it the memory of a host that was started; the descriptor may be closed then."""
        self._forget_memory()
        self._unshared = os.dup(descriptor), extent
        self._flush()

    def tell(self, state: ViewState) -> None:
        """Have pages be told another state; of those that must wait only the newest is kept."""
        self._untold = state
        self._flush()

    def take(self) -> list[PagePress | Turn]:
        """Take what pages have asked for since the last call, oldest first."""
        self._hear()
        self._flush()
        asked, self._asked = self._asked, []
        return asked

    def notes(self) -> list[str]:
        """Take the sentences for the reader since the last call, oldest first."""
        self._hear()
        notes, self._notes = self._notes, []
        return notes

    def close(self) -> None:
        """End the live view; further calls do nothing."""
        self._hang_up()
        process, self._process = self._process, None
        if process is None:
            return
        try:
            process.wait(_END_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

    def __enter__(self) -> Self:
        self.launch()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _hear(self) -> None:
        """Take all that the server has said; see whether it has ended."""
        while self._line is not None:
            try:
                said = self._line.recv(_HEARD_BYTES)
            except BlockingIOError:
                return
            except OSError:
                said = b""
            if not said:
                self._notes.append(_ENDED)
                self._hang_up()
                return
            message = from_server(said)
            if isinstance(message, Asks):
                self._asked.append(message.request)
                continue
            self._notes.append(message.sentence)
            if message.ends:
                self._hang_up()

    def _flush(self) -> None:
        """Send what waits, as far as there is room for it."""
        if self._line is None:
            return
        try:
            if self._unshared is not None:
                descriptor, extent = self._unshared
                message = encode(Shares(extent))
                socket.send_fds(self._line, [message], [descriptor], socket.MSG_NOSIGNAL)
                self._forget_memory()
            if self._untold is not None:
                _send_fitting(self._line, self._untold)
                self._untold = None
        except BlockingIOError:
            pass
        except OSError:  # it has ended, and `_hear` will say so
            self._forget_memory()
            self._untold = None

    def _forget_memory(self) -> None:
        if self._unshared is not None:
            os.close(self._unshared[0])
            self._unshared = None

    def _hang_up(self) -> None:
        self._forget_memory()
        self._untold = None
        if self._line is not None:
            self._line.close()
            self._line = None


def _send_fitting(line: socket.socket, state: ViewState) -> None:
    """Send as much of a state as one message of the line can hold."""
    for fewer in _fewer(state):
        try:
            line.send(encode(Tells(fewer)), socket.MSG_NOSIGNAL)
        except OSError as error:
            if error.errno != errno.EMSGSIZE:
                raise
        else:
            return


def _fewer(state: ViewState) -> Iterator[ViewState]:
    """Give a state, then ever less of it, down to what there is always room for."""
    yield state
    under = [line for line in state.lines if line.under]
    yield msgspec.structs.replace(state, lines=under)
    pale = [msgspec.structs.replace(one, image="") for one in state.figures]
    yield msgspec.structs.replace(state, lines=under, figures=pale, beside=None)
    if state.scene is not None:
        scene = msgspec.structs.replace(state.scene, image="", off_image="")
        yield msgspec.structs.replace(state, lines=under, figures=pale, beside=None, scene=scene)
    yield ViewState(state.number, place=state.place, device=_TOO_LARGE, blind=state.blind)
