"""Rights to see the live view and to steer, and the addresses by which the server is called.

A page of another site must not reach a server on this machine through a user's browser: neither
by its own name that leads here (the Host header is checked), nor from its own page (the Origin
header is checked). `docs/live-view.md` tells the rules.
"""

from __future__ import annotations

import ipaddress
import os
import secrets
import socket
import sys
from contextlib import suppress
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, Final

LOOPBACK: Final = "127.0.0.1"
_HTTP_PORT: Final = 80


class Right(Enum):
    """Rights of a page."""

    NONE = "none"
    WATCH = "watch"
    STEER = "steer"


def new_token() -> str:
    """Make a token that cannot be guessed."""
    return secrets.token_urlsafe(16)


@dataclass(frozen=True, slots=True)
class Admission:
    """The rules of one server.

    Parameters
    ----------
    host
        Name or address that the server listens at.
    port
        Port that it listens at.
    steers
        Whether anybody may steer at all.
    watch_token, steer_token
        Tokens of the two rights; who may steer may watch, too.
    """

    host: str
    port: int
    steers: bool = True
    watch_token: str = field(default_factory=new_token, repr=False)
    steer_token: str = field(default_factory=new_token, repr=False)

    @property
    def on_loopback(self) -> bool:
        """Tell whether only this machine reaches the server, so that watching needs no token."""
        return is_loopback(self.host)

    @property
    def steering_address(self) -> str:
        """Address of the page, with the right to steer where there is one."""
        token = self.steer_token if self.steers else "" if self.on_loopback else self.watch_token
        return self._address(token)

    @property
    def watching_address(self) -> str:
        """Address of the page with the right to watch."""
        return self._address("" if self.on_loopback else self.watch_token)

    def _address(self, token: str) -> str:
        host = self.host if self.on_loopback else reachable(self.host)
        port = "" if self.port == _HTTP_PORT else f":{self.port}"
        return f"http://{_spelled(host)}{port}/" + (f"#{token}" if token else "")

    def is_for(self, owner: int | None) -> bool:
        """Tell if a user of this machine may connect, on loopback the server's own or root.

        Parameters
        ----------
        owner
            Number of the user who owns the other end of a connection; None if that is not known.
        """
        return not self.on_loopback or owner in (None, 0, os.getuid())

    def right(self, token: str, *, from_page: bool) -> Right:
        """Right of a page that sends this token.

        Parameters
        ----------
        token
            What was sent; "" without one.
        from_page
            Whether it came from a page of this server, as a browser's Origin header says, of a user
            who is known. Whatever else connects needs a token even to watch on loopback.
        """
        if _same(token, self.steer_token):
            return Right.STEER if self.steers else Right.WATCH
        if _same(token, self.watch_token):
            return Right.WATCH
        if not token and self.on_loopback and from_page:
            return Right.WATCH
        return Right.NONE

    def is_ours(self, host: str, local: str) -> bool:
        """Tell whether a Host header names this server.

        Parameters
        ----------
        host
            The header.
        local
            The address of this machine at which the request came in.
        """
        names = [self.host, LOOPBACK, "localhost", "::1"] if self.on_loopback else []
        if not self.on_loopback:
            name = socket.gethostname()
            names = [self.host, local, name, f"{name}.local"]
            if is_loopback(local):
                names += [LOOPBACK, "localhost"]
        allowed = {f"{_spelled(name)}:{self.port}".lower() for name in names}
        if self.port == _HTTP_PORT:
            allowed |= {_spelled(name).lower() for name in names}
        return host.lower() in allowed


def owner_of(peer: tuple[Any, ...], local: tuple[Any, ...]) -> int | None:
    """User of this machine who owns the other end of a connection, by the kernel's table.

    Parameters
    ----------
    peer, local
        Address and port, first of all, of the other end and of this one.

    Returns
    -------
    int or None
        Number of the user; None if the other end is on another machine, or unknown.
    """
    table = "tcp6" if ":" in peer[0] else "tcp"
    with suppress(OSError, ValueError):
        ends = [_in_table(peer), _in_table(local)]
        for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]:
            columns = line.split()
            if columns[1:3] == ends:
                return int(columns[7])
    return None


def _in_table(end: tuple[Any, ...]) -> str:
    """Address and port as the kernel's table has them: words in the machine's own order."""
    family = socket.AF_INET6 if ":" in end[0] else socket.AF_INET
    address = socket.inet_pton(family, end[0])
    words = [address[at : at + 4] for at in range(0, len(address), 4)]
    host = "".join(f"{int.from_bytes(word, sys.byteorder):08X}" for word in words)
    return f"{host}:{end[1]:04X}"


def is_loopback(host: str) -> bool:
    """Tell whether a name or an address is reached from this machine only."""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def reachable(host: str) -> str:
    """Address by which others reach a server that listens at a host: itself, if it is only one."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return host
    if not address.is_unspecified:
        return host
    six = address.version == 6
    # Connecting by datagrams sends nothing: the system only chooses the way, and its own address.
    with socket.socket(socket.AF_INET6 if six else socket.AF_INET, socket.SOCK_DGRAM) as asked:
        try:
            asked.connect(("2001:db8::1" if six else "192.0.2.1", 9))
            return str(asked.getsockname()[0])
        except OSError:  # no network is there
            return socket.gethostname()


def _spelled(host: str) -> str:
    return f"[{host}]" if ":" in host else host


def _same(one: str, other: str) -> bool:
    return secrets.compare_digest(one.encode(errors="replace"), other.encode())
