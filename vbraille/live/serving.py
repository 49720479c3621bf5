"""The process of the live view's server; `vbraille.live.monitor` starts it.

It ends when the line to the program ends, however the program ends. Keys of the terminal are the
program's to hear. It is less urgent than all else, so that it never competes with a loop.
"""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import signal
import socket
import sys
import webbrowser
from contextlib import suppress
from typing import TYPE_CHECKING, Final

import msgspec

try:
    # Each frame is a message to and one from, and uvloop takes a quarter less time for them.
    from uvloop import run
except ModuleNotFoundError:  # it is not made for all systems
    from asyncio import run

from vbraille.errors import InputError, VbrailleError
from vbraille.live.channel import (
    MOST_MESSAGE_BYTES,
    Asks,
    Begin,
    Says,
    Shares,
    encode,
    prepare,
    to_server,
)
from vbraille.live.devicesource import DeviceSource, TickViews
from vbraille.live.server import LiveServer
from vbraille.logs import keep
from vbraille.simulation.steering import Pointer
from vbraille.wording import spelled

if TYPE_CHECKING:
    from vbraille.live.admission import Admission
    from vbraille.live.messages import PagePress, Turn

_NICE: Final = 5
# Pages are told that it is over; one that does not answer is not waited for.
_END_S: Final = 0.5
_KEYS: Final = (signal.SIGINT, signal.SIGHUP, signal.SIGTSTP, signal.SIGTTIN, signal.SIGTTOU)
_log = logging.getLogger("vbraille.live.serving")  # it runs as __main__


class ServerLine:
    """The server's end of the line to the program.

    Parameters
    ----------
    descriptor
        Descriptor of the socket.
    """

    def __init__(self, descriptor: int) -> None:
        os.set_inheritable(descriptor, False)  # a browser that is opened must not keep it
        self._socket = socket.socket(fileno=descriptor)
        prepare(self._socket)
        self.ended = asyncio.Event()

    def forward(self, request: PagePress | Turn) -> None:
        """Tell the program what a page asks for.

        Raises
        ------
        InputError
            If the program has not taken what was asked before.
        """
        if not self._send(Asks(request)):
            raise InputError("the program is busy; ask again in a moment")

    def say(self, sentence: str, *, ends: bool = False) -> None:
        """Say a sentence to the reader."""
        self._send(Says(sentence, ends))

    def _send(self, message: Asks | Says) -> bool:
        try:
            self._socket.send(encode(message), socket.MSG_NOSIGNAL)
        except OSError:  # it is full, or the program is gone
            return False
        return True

    def follow(self, source: DeviceSource) -> None:
        """Take all that the program says, from now on, to a source."""
        asyncio.get_running_loop().add_reader(self._socket, self._hear, source)

    def _hear(self, source: DeviceSource) -> None:
        try:
            while True:
                said, descriptors, _, _ = socket.recv_fds(self._socket, MOST_MESSAGE_BYTES, 1)
                if not said:
                    break
                try:
                    _take(said, descriptors, source)
                finally:
                    for descriptor in descriptors:
                        os.close(descriptor)
        except BlockingIOError:
            return
        except OSError:
            pass
        asyncio.get_running_loop().remove_reader(self._socket)
        self.ended.set()


def _take(said: bytes, descriptors: list[int], source: DeviceSource) -> None:
    message = to_server(said)
    if not isinstance(message, Shares):
        source.show(message.state)
    elif descriptors:
        try:
            source.watch(TickViews(descriptors[0], message.extent))
        except (OSError, ValueError) as error:
            _log.warning("the host's memory cannot be watched: %s", error)


def addresses(admission: Admission) -> list[str]:
    """Sentences on how the live view is opened, the one with the most rights first."""
    said = [f"live view: {admission.steering_address}"]
    if admission.steers and not admission.on_loopback:
        said.append(f"live view, to watch only: {admission.watching_address}")
    return said


async def serve(begin: Begin, line: ServerLine) -> None:
    """Serve until the program is gone.

    Raises
    ------
    InputError
        If no server can listen there.
    """
    hand = None if begin.pointer is None else Pointer(begin.pointer)
    source = DeviceSource(line.forward, hand, blind=begin.blind)
    server = LiveServer(source, host=begin.host, port=begin.port, steers=begin.steers)
    line.follow(source)
    async with server:
        for sentence in addresses(server.admission):
            line.say(sentence)
        if begin.opens:
            asyncio.get_running_loop().run_in_executor(
                None, webbrowser.open, server.admission.steering_address
            )
        gc.freeze()
        await line.ended.wait()
        asyncio.get_running_loop().call_later(_END_S, os._exit, 0)


def main() -> int:
    """Run as the child of the program that holds the other end of the line."""
    for number in _KEYS:
        signal.signal(number, signal.SIG_IGN)
    with suppress(OSError):
        os.nice(_NICE)
    begin = msgspec.json.decode(sys.argv[1], type=Begin)
    if begin.log is not None:
        keep(begin.log)
    return run(_main(begin))


async def _main(begin: Begin) -> int:
    line = ServerLine(begin.line)
    try:
        await serve(begin, line)
    except VbrailleError as error:
        line.say(spelled(f"live view: {error}"), ends=True)
        return error.exit_code
    except Exception as error:
        _log.exception("the live view has ended")
        line.say(f"live view: ended by a fault; reading goes on: {error!r}", ends=True)
        return 1
    return 0


if __name__ == "__main__":
    code = main()
    # A map that is being drawn, or a browser that is slow to open, is not waited for.
    os._exit(code)
