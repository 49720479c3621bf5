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
from typing import Final

import numpy as np

from vbraille.braille.cells import mask_of
from vbraille.errors import InputError
from vbraille.wording import printable

_MOST_BYTES: Final = 1 << 20  # taken at once, and of a line
_AGAIN_S: Final = 1.0  # from one attempt to connect to the next
_CONNECT_S: Final = 0.1
_PORTS: Final = 1 << 16
_DOTS: Final = re.compile(r'"([1-8| ]*)"')
_SHOWN: Final = 40  # characters of nonsense


class Talk:
    """Conversation with BRLTTY, which sends what it shows in lines.

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
    def hello(self) -> str:
        """The first line, which tells BRLTTY the size of the display."""
        rows, cells = self.masks.shape
        return f"Cells {cells} {rows}"

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
        size = self.masks.size
        if kind.upper() == "BRAILLE" and (found := _DOTS.fullmatch(content)):
            masks = [mask_of(map(int, "".join(cell.split()))) for cell in found[1].split("|")]
            if len(masks) != size:
                self.remark(f"BRLTTY: it sent {len(masks)} cells for {size}")
            fitted = (masks + [0] * size)[:size]
            self.masks = np.array(fitted, np.uint8).reshape(self.masks.shape)
        elif kind.upper() == "VISUAL" and content.startswith('"') and content.endswith('"'):
            self.text = re.sub(r"\\(.)", r"\1", content[1:-1])[:size].ljust(size)
        elif content.isascii() and content.isdigit():
            self.status[kind.upper()] = int(content)
        else:
            self.remark(f"BRLTTY: not understood: {printable(line[:_SHOWN])}")

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
        host, colon, port = address.rpartition(":")
        self.local = "/" in address
        if not self.local and not (colon and port.isdigit() and int(port) < _PORTS):
            raise InputError(f"{address!r} is no address; give a path, or HOST:PORT")
        self._family = socket.AF_UNIX if self.local else socket.AF_INET
        self._place = address if self.local else (host or "127.0.0.1", int(port))
        self._ends: dict[str, socket.socket] = {}
        self._due_s = 0.0
        if not connects:
            try:
                self._ends["listening"] = self._listen()
            except OSError as error:
                raise InputError(f"{address} cannot be listened at: {error}") from None

    def _listen(self) -> socket.socket:
        if self.local:
            # A socket at which no program listens any more is removed.
            with socket.socket(self._family) as asked, suppress(FileNotFoundError):
                if asked.connect_ex(self._place) == ECONNREFUSED:
                    Path(str(self._place)).unlink()
            listening = socket.socket(self._family)
            before = os.umask(0o177)
            try:
                listening.bind(self._place)
                listening.listen()
            except OSError:
                listening.close()
                raise
            finally:
                os.umask(before)
        else:
            listening = socket.create_server(self._place)  # type: ignore[arg-type]
        listening.setblocking(False)
        return listening

    @property
    def connected(self) -> bool:
        """Tell whether BRLTTY is there."""
        return "brltty" in self._ends

    @property
    def descriptors(self) -> list[int]:
        """Descriptors that have something to read when there is something to take."""
        return [end.fileno() for end in self._ends.values()]

    def meet(self) -> bool:
        """Tell whether BRLTTY has come, or come again."""
        try:
            if "listening" in self._ends:
                found = self._ends["listening"].accept()[0]
            elif not self.connected and time.monotonic() >= self._due_s:
                self._due_s = time.monotonic() + _AGAIN_S
                found = socket.socket(self._family)
                found.settimeout(_CONNECT_S)
                found.connect(self._place)
            else:
                return False
        except OSError:
            return False
        found.setblocking(False)
        self._end("brltty")
        self._ends["brltty"] = found
        return True

    def take(self) -> bytes:
        """Take what BRLTTY has sent; `connected` is False when it has ended."""
        data = b""
        while self.connected and len(data) < _MOST_BYTES:
            try:
                more = self._ends["brltty"].recv(_MOST_BYTES)
            except BlockingIOError:
                break
            except OSError:
                more = b""
            data += more
            if not more:
                self._end("brltty")
        return data

    def send(self, line: str) -> None:
        """Send a line; one for which BRLTTY has no room is lost, like a key that is not heard."""
        with suppress(OSError, KeyError):
            self._ends["brltty"].send(f"{line}\n".encode())

    def _end(self, name: str) -> None:
        if name in self._ends:
            self._ends.pop(name).close()

    def close(self) -> None:
        """End; the file of a Unix socket goes."""
        self._end("brltty")
        if self.local and "listening" in self._ends:
            Path(str(self._place)).unlink(missing_ok=True)
        self._end("listening")
