"""Rights of pages, and the addresses by which the server is called.

A page of another site must not reach a server on this machine through a user's browser: neither
by a name of its own that leads here (the Host header is checked), nor from its own page (Origin).
"""

from __future__ import annotations

import ipaddress
import os
import secrets
import socket
import sys
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

LOOPBACK: Final = "127.0.0.1"


@dataclass(frozen=True, slots=True)
class Admission:
    """The rules of one server.

    Parameters
    ----------
    host, port
        Where it listens.
    steers
        Whether pages may steer at all.
    watch_token, steer_token
        Tokens of the two rights.
    """

    host: str
    port: int
    steers: bool = True
    watch_token: str = field(default_factory=secrets.token_urlsafe, repr=False)
    steer_token: str = field(default_factory=secrets.token_urlsafe, repr=False)

    @property
    def on_loopback(self) -> bool:
        """Tell whether only this machine reaches the server, so that its user may watch."""
        return _is_loopback(self.host)

    @property
    def addresses(self) -> list[str]:
        """Addresses of the page: the one with the most rights, and one to watch only."""
        watching = self._address("" if self.on_loopback else self.watch_token)
        return [self._address(self.steer_token), watching] if self.steers else [watching]

    def _address(self, token: str) -> str:
        host = self.host if self.on_loopback else _reachable(self.host)
        return f"http://{_spelled(host)}:{self.port}/" + (f"#{token}" if token else "")

    def may_steer(self, token: str, *, known: bool) -> bool | None:
        """Tell whether a page may steer; None if it may not even watch.

        Parameters
        ----------
        token
            Token that it sent; empty without one.
        known
            Whether it is a page of this server, as a browser's Origin says, of a known user.
        """
        sent = token.encode(errors="replace")
        if secrets.compare_digest(sent, self.steer_token.encode()):
            return self.steers
        watches = secrets.compare_digest(sent, self.watch_token.encode())
        return False if watches or (not token and known and self.on_loopback) else None

    def is_called(self, host: str, local: str) -> bool:
        """Tell whether a Host header names this server, which was reached at a local address."""
        names = {self.host, local}
        if not self.on_loopback:
            names |= {socket.gethostname(), f"{socket.gethostname()}.local"}
        if _is_loopback(local):
            names |= {LOOPBACK, "localhost", "::1"}
        return host.lower() in {f"{_spelled(name)}:{self.port}".lower() for name in names}


def owner_of(peer: tuple[Any, ...], local: tuple[Any, ...]) -> int | None:
    """Find the user of this machine who owns the other end of a connection.

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
    """Spell an address and a port as the kernel does: words in the machine's own order."""
    address = ipaddress.ip_address(end[0]).packed
    words = [address[at : at + 4] for at in range(0, len(address), 4)]
    host = "".join(f"{int.from_bytes(word, sys.byteorder):08X}" for word in words)
    return f"{host}:{end[1]:04X}"


def is_stranger(owner: int | None) -> bool:
    """Tell whether a connection on loopback is that of another user of this machine."""
    return owner not in (None, 0, os.getuid())


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def _reachable(host: str) -> str:
    """Give an address by which others reach a server that listens everywhere."""
    if host not in ("0.0.0.0", "::"):
        return host
    six = ":" in host
    # Connecting by datagrams sends nothing: the system chooses its own address for the way.
    with socket.socket(socket.AF_INET6 if six else socket.AF_INET, socket.SOCK_DGRAM) as asked:
        try:
            asked.connect(("2001:db8::1" if six else "192.0.2.1", 9))
            return str(asked.getsockname()[0])
        except OSError:  # no network is there
            return socket.gethostname()


def _spelled(host: str) -> str:
    return f"[{host}]" if ":" in host else host
