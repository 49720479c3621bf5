"""The talk with BRLTTY's Virtual driver (``-b vr``): lines of text, over a socket.

`Talk` knows the lines alone; `Port` the socket. Other commands than ROUTE take no number.
"""

from __future__ import annotations

import os
import re
import socket
import time
from contextlib import suppress
from errno import ECONNREFUSED
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from vbraille.braille.cells import mask_of
from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Callable

_MOST_BYTES: Final = 1 << 20  # taken at once, and of a line
_AGAIN_S: Final = 1.0  # from one attempt to connect to the next
_CONNECT_S: Final = 0.1
_PORTS: Final = 1 << 16
_DOTS: Final = re.compile(r'"([1-8| ]*)"')
_SHOWN: Final = 40  # characters of nonsense, and sentences


class Talk:
    """Conversation with BRLTTY, which sends what it shows in lines.

    Parameters
    ----------
    rows, cells
        Size of the display.
    say
        Function that is called with a sentence on what is not as expected, once for each.

    Attributes
    ----------
    masks : uint8[rows, cells]
        Dot masks.
    text : str
        Print, a character for each cell, row after row.
    hello : str
        The first line, which tells BRLTTY the size of the display.
    """

    def __init__(self, rows: int, cells: int, say: Callable[[str], None]) -> None:
        self.masks = np.zeros((rows, cells), np.uint8)
        self.text = " " * self.masks.size
        self.hello = f"Cells {cells} {rows}"
        self._say, self._said = say, set[str]()
        self._rest = b""

    def remark(self, sentence: str) -> None:
        """Say a sentence once."""
        if sentence not in self._said and len(self._said) < _SHOWN:
            self._said.add(sentence)
            self._say(sentence)

    def feed(self, data: bytes) -> None:
        """Take bytes from BRLTTY; of several lines of a kind, the last one counts."""
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > _MOST_BYTES:
            self._rest = b""
            self.remark("BRLTTY: a line without an end is left out")
        newest = {line.partition(b" ")[0].upper(): line for line in lines if line.strip()}
        for line in newest.values():
            self._take(line.decode("utf-8", "replace").strip())

    def _take(self, line: str) -> None:
        kind, _, content = line.partition(" ")
        kind, size = kind.upper(), self.masks.size
        if kind == "BRAILLE" and (found := _DOTS.fullmatch(content)):
            masks = [mask_of(map(int, "".join(cell.split()))) for cell in found[1].split("|")]
            if len(masks) != size:
                self.remark(f"BRLTTY: it sent {len(masks)} cells for {size}")
            fitted = (masks + [0] * size)[:size]
            self.masks = np.array(fitted, np.uint8).reshape(self.masks.shape)
        elif kind == "VISUAL" and content.startswith('"') and content.endswith('"'):
            self.text = re.sub(r"\\(.)", r"\1", content[1:-1])[:size].ljust(size)
        elif not (content.isascii() and content.isdigit()):  # those are numbers of its state
            self.remark(f"BRLTTY: not understood: {printable(line[:_SHOWN])}")


class Port:
    """Socket at which BRLTTY is met; nothing here is waited for. A context manager.

    Parameters
    ----------
    address
        Path of a Unix socket, which only its user may open, or HOST:PORT.
    connects
        Whether BRLTTY listens there; otherwise it is listened for.

    Raises
    ------
    InputError
        If it is no address, or cannot be listened at.
    """

    def __init__(self, address: str, *, connects: bool = False) -> None:
        host, _, port = address.rpartition(":")
        self.local = "/" in address
        if not self.local and not (port.isdigit() and int(port) < _PORTS and ":" in address):
            raise InputError(f"{address!r} is no address; give a path, or HOST:PORT")
        self._family = socket.AF_UNIX if self.local else socket.AF_INET
        self._place: Any = address if self.local else (host or "127.0.0.1", int(port))
        self._listening = self._brltty = None
        self._due_s = 0.0
        if not connects:
            try:
                self._listening = self._listen()
            except OSError as error:
                raise InputError(f"{address} cannot be listened at: {error}") from None

    def _listen(self) -> socket.socket:
        if not self.local:
            return socket.create_server(self._place)
        # A socket at which no program listens any more is removed.
        with socket.socket(self._family) as asked, suppress(FileNotFoundError):
            if asked.connect_ex(self._place) == ECONNREFUSED:
                Path(self._place).unlink()
        before = os.umask(0o177)
        try:
            return socket.create_server(self._place, family=self._family)
        finally:
            os.umask(before)

    @property
    def connected(self) -> bool:
        """Tell whether BRLTTY is there."""
        return self._brltty is not None

    @property
    def descriptors(self) -> list[int]:
        """Descriptors that have something to read when there is something to take."""
        return [end.fileno() for end in (self._listening, self._brltty) if end is not None]

    def meet(self) -> bool:
        """Tell whether BRLTTY has come, or come again."""
        now_s = time.monotonic()
        try:
            if self._listening is not None:
                self._listening.setblocking(False)
                found = self._listening.accept()[0]
            elif self._brltty is None and now_s >= self._due_s:
                self._due_s = now_s + _AGAIN_S
                found = socket.socket(self._family)
                found.settimeout(_CONNECT_S)
                found.connect(self._place)
            else:
                return False
        except OSError:
            return False
        found.setblocking(False)
        self._part()
        self._brltty = found
        return True

    def take(self) -> bytes:
        """Take what BRLTTY has sent; `connected` is False when it has ended."""
        data = b""
        with suppress(BlockingIOError):
            with suppress(ConnectionError):
                data = self._brltty.recv(_MOST_BYTES) if self._brltty is not None else b""
            if not data:
                self._part()
        return data

    def send(self, line: str) -> None:
        """Send a line; one for which BRLTTY has no room is lost, like a key that is not heard."""
        if self._brltty is not None:
            with suppress(OSError):
                self._brltty.send(f"{line}\n".encode())

    def _part(self) -> None:
        if self._brltty is not None:
            self._brltty.close()
        self._brltty = None

    def close(self) -> None:
        """End; the file of a Unix socket goes."""
        self._part()
        if self._listening is not None:
            self._listening.close()
            if self.local:
                Path(self._place).unlink(missing_ok=True)
