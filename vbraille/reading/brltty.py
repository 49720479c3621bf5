"""The talk with BRLTTY's Virtual driver (``-b vr``): lines of text, over a socket.

`Talk` knows the lines alone; `Port` the socket. Other commands than ROUTE take no number.
"""

from __future__ import annotations

import os
import re
import socket
import time
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.braille.cells import mask_of
from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MOST_BYTES: Final = 1 << 20  # taken at once, and of a line
_AGAIN_S: Final = 1.0  # from one attempt to connect to the next
_DOTS: Final = re.compile(r'"([1-8|\s]*)"')
_SHOWN: Final = 40  # characters of nonsense


class Talk:
    """What BRLTTY shows, by the lines that it sends.

    Parameters
    ----------
    rows, cells
        Size of the display.

    Attributes
    ----------
    masks : uint8[rows, cells]
        Dot masks.
    text : str
        Print, a character for each cell, row after row.
    status : dict[str, int]
        Numbers of BRLTTY's state, such as ``CSRROW``.
    """

    def __init__(self, rows: int, cells: int) -> None:
        self.masks = np.zeros((rows, cells), np.uint8)
        self.text = " " * self.masks.size
        self.status: dict[str, int] = {}
        self._rest = b""
        self._remarks: dict[str, bool] = {}  # and whether each is said

    @property
    def hello(self) -> bytes:
        """The first line, which tells BRLTTY the size of the display."""
        rows, cells = self.masks.shape
        return f"Cells {cells} {rows}\n".encode()

    def remarks(self) -> list[str]:
        """Take the sentences on what was not as expected, each once."""
        new = [sentence for sentence, said in self._remarks.items() if not said]
        self._remarks |= dict.fromkeys(new, True)
        return new

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
        if kind.upper() == "BRAILLE" and (found := _DOTS.fullmatch(content)):
            cells = found[1].split("|")
            self.masks = self._fitted(
                [mask_of(map(int, filter(str.isdigit, cell))) for cell in cells]
            )
        elif kind.upper() == "VISUAL" and content.startswith('"') and content.endswith('"'):
            text = re.sub(r"\\(.)", r"\1", content[1:-1])
            self.text = text[: self.masks.size].ljust(self.masks.size)
        elif content.isascii() and content.isdigit():
            self.status[kind.upper()] = int(content)
        elif kind.upper() != "STATUS":
            self.remark(f"BRLTTY: not understood: {printable(line[:_SHOWN])}")

    def _fitted(self, masks: list[int]) -> NDArray[np.uint8]:
        size = self.masks.size
        if len(masks) != size:
            self.remark(f"BRLTTY: it sent {len(masks)} cells for {size}")
        fitted = np.zeros(size, np.uint8)
        fitted[: len(masks)] = masks[:size]
        return fitted.reshape(self.masks.shape)

    def remark(self, sentence: str) -> None:
        """Keep a sentence, to be said once."""
        if len(self._remarks) < _SHOWN:
            self._remarks.setdefault(sentence, False)


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
        self._address, self._connects = address, connects
        host, colon, port = address.rpartition(":")
        self.local = "/" in address
        self._family = socket.AF_UNIX if self.local else socket.AF_INET
        if not self.local and not (colon and port.isdigit()):
            raise InputError(f"{address!r} is no address; give a path, or HOST:PORT")
        self._place = address if self.local else (host or "127.0.0.1", int(port))
        self._listening = None if connects else self._listen()
        self._peer: socket.socket | None = None
        self._due_s = 0.0

    def _listen(self) -> socket.socket:
        listening = socket.socket(self._family)
        try:
            if self.local:
                self._clear()
                before = os.umask(0o177)
                try:
                    listening.bind(self._place)
                finally:
                    os.umask(before)
            else:
                listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                listening.bind(self._place)
            listening.listen()
        except (OSError, OverflowError) as error:
            listening.close()
            why = getattr(error, "strerror", None) or error
            raise InputError(f"{self._address} cannot be listened at: {why}") from None
        listening.setblocking(False)
        return listening

    def _clear(self) -> None:
        """Remove a socket at which no program listens any more."""
        with socket.socket(self._family) as asked, suppress(FileNotFoundError):
            try:
                asked.connect(self._place)
            except ConnectionRefusedError:
                Path(self._address).unlink()

    @property
    def connected(self) -> bool:
        """Whether BRLTTY is there."""
        return self._peer is not None

    @property
    def descriptors(self) -> list[int]:
        """Descriptors that have something to read when there is something to take."""
        ends = (self._listening, self._peer)
        return [end.fileno() for end in ends if end is not None]

    def meet(self) -> bool:
        """Tell whether BRLTTY has come, or come again."""
        try:
            if self._listening is not None:
                found = self._listening.accept()[0]
            elif self._peer is None and time.monotonic() >= self._due_s:
                self._due_s = time.monotonic() + _AGAIN_S
                found = socket.socket(self._family)
                found.settimeout(0.1)
                found.connect(self._place)
            else:
                return False
        except OSError:
            return False
        found.setblocking(False)
        self._drop()
        self._peer = found
        return True

    def take(self) -> bytes:
        """Take what BRLTTY has sent; `connected` is False when it has ended."""
        data = b""
        while self._peer is not None and len(data) < _MOST_BYTES:
            try:
                more = self._peer.recv(_MOST_BYTES)
            except BlockingIOError:
                break
            except OSError:
                more = b""
            data += more
            if not more:
                self._drop()
        return data

    def send(self, line: bytes) -> None:
        """Send a line; one for which BRLTTY has no room is lost, like a key that is not heard."""
        with suppress(OSError):
            if self._peer is not None:
                self._peer.send(line)

    def _drop(self) -> None:
        if self._peer is not None:
            self._peer.close()
            self._peer = None

    def close(self) -> None:
        """End; the file of a Unix socket goes."""
        self._drop()
        if self._listening is not None:
            self._listening.close()
            self._listening = None
            if self.local:
                with suppress(FileNotFoundError):
                    Path(self._address).unlink()
