"""Messages between a program and the server of its live view, and the line between them.

It is a pair of sockets that keep messages apart, in JSON. Neither side ever waits for the other.
Memory goes along as a descriptor.
"""

from __future__ import annotations

import socket
from typing import Final

import msgspec

from vbraille.engine.mailbox import Extent
from vbraille.live.messages import PagePress, Turn, ViewState

# Room that is asked for on the line; the system gives less if its bounds are lower.
_ROOM_BYTES: Final = 1 << 20
# Largest message that is read; none is larger, for the line would not take it.
MOST_MESSAGE_BYTES: Final = 1 << 22


class Begin(msgspec.Struct, frozen=True):
    """Settings with which the server begins, as its command line tells them.

    Parameters
    ----------
    line
        Descriptor of the server's end of the line.
    host, port
        Where to listen; None for loopback, and for any port that is free.
    pointer
        Descriptor of the memory that holds a simulated hand; None if pages cannot be the hand.
    blind
        Whether stimuli are hidden.
    steers
        Whether pages may steer.
    opens
        Whether to open a browser.
    log
        File of the log; None without one.
    """

    line: int
    host: str | None = None
    port: int | None = None
    pointer: int | None = None
    blind: bool = False
    steers: bool = True
    opens: bool = False
    log: str | None = None


class Shares(msgspec.Struct, frozen=True, tag=True):
    """The memory of a host that was started; its descriptor goes along."""

    extent: Extent


class Tells(msgspec.Struct, frozen=True, tag=True):
    """The newest state."""

    state: ViewState


class Asks(msgspec.Struct, frozen=True, tag=True):
    """Request of a page with the right to steer."""

    request: PagePress | Turn


class Says(msgspec.Struct, frozen=True, tag=True):
    """A sentence of the server for the reader.

    Parameters
    ----------
    sentence
        The sentence.
    ends
        Whether the server ends after it.
    """

    sentence: str
    ends: bool = False


to_server = msgspec.json.Decoder(Shares | Tells).decode
from_server = msgspec.json.Decoder(Asks | Says).decode
encode = msgspec.json.Encoder().encode


def open_line() -> tuple[socket.socket, socket.socket]:
    """Open a line: the program's end, and the server's."""
    ends = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    for end in ends:
        prepare(end)
    return ends


def prepare(end: socket.socket) -> None:
    """Have an end of the line take large messages, and never wait."""
    end.setblocking(False)
    end.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _ROOM_BYTES)
