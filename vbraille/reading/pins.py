"""A conventional display beside the device: the line under the hand, or what was said, on its pins.

BRLTTY drives it, through the system's python3-brlapi, in a thread of its own that never holds the
loop.
"""

from __future__ import annotations

import re
import threading
from collections import deque
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.layout import Layout
from vbraille.reading.outputs import Cue, Output, system_module
from vbraille.translate import Book, text_source
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.explored import Explored
    from vbraille.translate import BrailleTable

_SPEC = re.compile(r"brlapi(?::(|[^\s:]*:[0-9]{1,5}|/\S+))?")
_SLACK = 1  # cells that the finger may go before what stands there gives way
_WAIT_S, _RETRY_S = 0.02, 1.0
_PAN = {"pins:FWINRT": 1, "pins:FWINLT": -1}
# Keys of X11's keysymdef.h that are no characters.
_NAMED = {
    0xFF08: "backspace", 0xFF09: "tab", 0xFF0D: "enter", 0xFF1B: "escape", 0xFF50: "home",
    0xFF51: "left", 0xFF52: "up", 0xFF53: "right", 0xFF54: "down", 0xFF55: "pageup",
    0xFF56: "pagedown", 0xFF57: "end", 0xFF63: "insert", 0xFFFF: "delete",
    **{0xFFBE + number: f"f{number + 1}" for number in range(12)},
}  # fmt: skip
_UNICODE = 0x0100_0000  # keysyms of all other characters begin here


class Pins(Output):
    """An output on a conventional display, whose keys are obeyed.

    A line falls into parts of the display's width, and the part with the finger in it is shown. A
    sentence stands there until the finger goes on or a key is pressed.

    Parameters
    ----------
    spec
        "brlapi", or "brlapi:HOST:N" for BRLTTY at another address.
    table
        Table that sentences are translated by.
    say
        Function that is called with sentences on the display itself.

    Raises
    ------
    InputError
        If the text is no spec, or python3-brlapi is not installed.
    """

    def __init__(self, spec: str, table: BrailleTable, say: Callable[[str], None]) -> None:
        found = _SPEC.fullmatch(spec)
        if found is None:
            raise InputError(
                f"{setting('also')} is {spec!r}; give brlapi for the display of BRLTTY on this "
                f"machine, or brlapi:HOST:N, as in brlapi:127.0.0.1:0, for one elsewhere"
            )
        try:
            self._brlapi = system_module("brlapi")
        except OSError as error:
            raise InputError(f"{setting('also')} brlapi: {error}") from None
        self._host, self._table, self._say = found[1] or "", table, say
        self._line = b"", 0  # the line, and the display's width
        self._first = 0  # cell of the line that stands first
        self._sentences: list[str] = []
        self._at = 0  # part of the sentences that stands there
        self._finger = -1  # its cell when what stands there was chosen
        # For the thread:
        self._width = 0
        self._wanted: bytes | None = b""
        self._keys: deque[str] = deque()
        self._wakes, self._ended, self._told = threading.Event(), False, ""
        self._thread = threading.Thread(target=self._run, name="brlapi", daemon=True)
        self._thread.start()

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Show a sentence, after those that came together with it."""
        if sentence:
            self._sentences.append(sentence)

    def show(self, what: Explored) -> None:  # noqa: ARG002 - `pressed` looks at it all the time
        """Show a line in place of sentences that were said before."""
        self._sentences, self._at = [], 0

    def pressed(self, what: Explored) -> list[str]:
        """Show what is to be shown now, and name the keys that were pressed.

        Those of BRLTTY's commands are such as "pins:LNDN", a routing key "route:12".
        """
        masks, cell, width = what.line_masks, what.cell, max(self._width, 1)
        line = b"" if masks is None else masks.tobytes()
        another, self._line = (line, width) != self._line, (line, width)
        if another or (cell is not None and abs(cell - self._finger) > _SLACK):
            self._finger = 0 if cell is None else cell
            if another or not self._first <= self._finger < self._first + width:
                self._first = self._finger // width * width
            if not another:
                self.show(what)
        parts = self._parts(width)
        keys = [self._keys.popleft() for _ in range(len(self._keys))]
        asked = [key for key in keys if key and not self._pan(_PAN.get(key, 0), len(parts))]
        self._put(parts[min(self._at, len(parts) - 1)] if parts else line[self._first :])
        if asked:
            self.show(what)
        return [
            f"route:{self._first + int(key.rpartition(':')[2])}" if ":ROUTE:" in key else key
            for key in asked
        ]

    def _parts(self, width: int) -> list[bytes]:
        """Dot masks of the sentences, cut into parts of the display's width."""
        books = (Book(text_source(sentence), self._table) for sentence in self._sentences)
        layouts = (Layout(book, width) for book in books)
        return [line.masks.tobytes() for layout in layouts for line in layout.lines()]

    def _pan(self, step: int, parts: int) -> bool:
        """Show the next part of what stands there, or the one before; False without one."""
        line, width = self._line
        if step and 0 <= self._at + step < parts:
            self._at += step
        elif step and not parts and 0 <= self._first + step * width < len(line):
            self._first += step * width
        else:
            return False
        return True

    def rest(self) -> None:
        """Give the display back until something else is shown."""
        self._put(None)

    def close(self) -> None:
        """Give the display back to BRLTTY; this waits a second at most."""
        self._ended = True
        self._wakes.set()
        self._thread.join(1.0)

    def _put(self, masks: bytes | None) -> None:
        if masks != self._wanted:
            self._wanted = masks
            self._wakes.set()

    # In the thread

    def _tell(self, sentence: str) -> None:
        if sentence != self._told:
            self._told = sentence
            self._say(sentence)

    def _run(self) -> None:
        """Connect again and again until there is a display."""
        while not self._ended:
            try:
                self._drive(self._brlapi.Connection(self._host.encode() or None))
            except self._brlapi.OperationError as error:
                self._tell(f"display: {self._words(error)}")
            self._width = 0
            if not self._ended:
                self._wakes.wait(_RETRY_S)
                self._wakes.clear()

    def _words(self, error: Any) -> str:
        where = f"at {self._host}" if self._host else "on this machine"
        if getattr(error, "brlerrno", None) == self._brlapi.ERROR_AUTHENTICATION:
            return (
                f"BRLTTY {where} does not let you in; join the group that may read /etc/brlapi.key"
            )
        if isinstance(error, self._brlapi.ConnectionError):
            return f"no BRLTTY answers {where}; start it, or give its address"
        return f"BRLTTY {where} does not give the display: {' '.join(str(error).split())}"

    def _drive(self, connection: Any) -> None:
        """Show what is wanted, and take keys, as long as there is a display."""
        columns, rows = connection.displaySize
        name = _text(connection.driverName)
        # Without a display BRLTTY says that it has one of one cell, or of none.
        if name == "NoBraille" or columns * rows <= 1:
            self._tell("display: BRLTTY drives no display; plug one in")
            connection.closeConnection()
            return
        shown: bytes | None = None
        try:
            while not self._ended:
                wanted = self._wanted
                if wanted is None and shown is not None:
                    connection.leaveTtyMode()
                elif wanted is not None and shown is None:
                    try:
                        connection.enterTtyMode()
                    except Exception:  # of brlapi; the terminal is unknown, so everywhere
                        connection.enterTtyModeWithPath([])
                    self._width = columns
                    title = f"{name} {_text(connection.modelIdentifier)}".rstrip()
                    self._tell(f"display: {title}, {columns} cells")
                if wanted is not None and wanted != shown:
                    connection.writeDots(wanted[:columns].ljust(columns * rows, b"\0"))
                shown = wanted
                while shown is not None and (code := connection.readKey(0)):
                    self._keys.append(self._key(code))
                self._wakes.wait(_WAIT_S)
                self._wakes.clear()
        finally:
            with suppress(Exception):
                connection.leaveTtyMode()
                connection.closeConnection()

    def _key(self, code: int) -> str:
        """Name of a key; empty if it is not known."""
        key = self._brlapi.expandKeyCode(code)
        if key["type"] != self._brlapi.KEY_TYPE_CMD:
            return typed(key["command"])
        name = _text(self._brlapi.describeKeyCode(code)["command"])
        return f"pins:{name}:{key['argument']}" if name == "ROUTE" else f"pins:{name}"


def typed(symbol: int) -> str:
    """Name of a key of the display's keyboard by its X11 keysym; empty if it is not known."""
    if symbol in _NAMED:
        return _NAMED[symbol]
    if _UNICODE < symbol <= _UNICODE + 0x10FFFF:
        return chr(symbol - _UNICODE)
    return chr(symbol) if 0x20 <= symbol <= 0x7E or 0xA0 <= symbol <= 0xFF else ""


def _text(name: Any) -> str:
    return name.decode("utf-8", "replace") if isinstance(name, bytes) else str(name)
