"""A conventional display beside the device: the line under the hand, or what was said, on its pins.

BRLTTY drives it, through the system's python3-brlapi, in a thread of its own that never holds the
loop.
"""

from __future__ import annotations

import queue
import re
import threading
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.layout import lay_out_text
from vbraille.reading.outputs import Cue, system_module
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.explored import Explored
    from vbraille.translate import BrailleTable

_SPEC = re.compile(r"brlapi(?::(|[^\s:]*:[0-9]{1,5}|/\S+))?")
_SLACK = 1  # cells that the finger may be beyond what is shown before the display follows
_WAIT_S, _RETRY_S = 0.02, 1.0
_ROUTE = "pins:ROUTE"
_PAN = {"FWINRT": 1, "FWINLT": -1}
# Keys of X11's keysymdef.h that are no characters.
_NAMED = {
    0xFF08: "backspace", 0xFF09: "tab", 0xFF0D: "enter", 0xFF1B: "escape", 0xFF50: "home",
    0xFF51: "left", 0xFF52: "up", 0xFF53: "right", 0xFF54: "down", 0xFF55: "pageup",
    0xFF56: "pagedown", 0xFF57: "end", 0xFF63: "insert", 0xFFFF: "delete",
    **{0xFFBE + number: f"f{number + 1}" for number in range(12)},
}  # fmt: skip
_UNICODE = 0x0100_0000  # keysyms of all other characters begin here


class Pins:
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
        self._table, self._said_of = table, say
        self._pane = _Pane()
        self._sentences: list[str] = []
        self._at = 0  # part of the sentences that stands there
        self._finger: int | None = None  # its cell when they came
        self._link = _Link(spec)

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Show a sentence, after those that came together with it."""
        if sentence:
            self._sentences.append(sentence)

    def show(self, what: Explored) -> None:  # noqa: ARG002 - `pressed` looks at it all the time
        """Show a line in place of sentences that were said before."""
        self._sentences.clear()
        self._at = 0

    def pressed(self, what: Explored) -> list[str]:
        """Show what is to be shown now, and name the keys that were pressed.

        Those of BRLTTY's commands are such as "pins:LNDN", a routing key "route:12".
        """
        said, keys = self._link.take()
        for sentence in said:
            self._said_of(sentence)
        if what.line_masks is not None and what.cell != self._finger and self._link.width:
            self._finger = what.cell
            self._sentences.clear()
        asked = [key for key in keys if not self._obey(what, key)]
        self._link.show(self._masks(what))
        if asked:
            self._sentences.clear()
            self._at = 0
        return [self._routed(key) for key in asked]

    def close(self) -> None:
        """Give the display back to BRLTTY."""
        self._link.close()

    def rest(self) -> None:
        """Give the display back until something else is shown."""
        self._link.show(None)

    def _obey(self, what: Explored, key: str) -> bool:
        """Pan over what is shown; False if that is not asked for, or there is no more."""
        step = _PAN.get(key.removeprefix("pins:"), 0)
        if not step:
            return False
        if self._sentences:
            at = self._at + step
            if 0 <= at < len(self._parts()):
                self._at = at
                return True
            return what.line_masks is None
        return what.line_masks is not None and self._pane.pan(step, what.cell)

    def _routed(self, key: str) -> str:
        if not key.startswith(f"{_ROUTE}:"):
            return key
        return f"route:{self._pane.first + int(key.rpartition(':')[2])}"

    def _parts(self) -> list[bytes]:
        """Dot masks of the sentences, cut into parts of the display's width."""
        parts = []
        for sentence in self._sentences:
            layout = lay_out_text(sentence, max(self._link.width, 1), self._table)
            parts += [line.masks.tobytes() for line in layout.lines()]
        return parts

    def _masks(self, what: Explored) -> bytes:
        if self._sentences:
            parts = self._parts()
            return parts[min(self._at, len(parts) - 1)]
        if what.line_masks is None:
            return b""
        return self._pane.follow(what.line_masks.tobytes(), self._link.width, what.cell)


class _Pane:
    """Part of a line on a display, which follows the finger."""

    def __init__(self) -> None:
        self.first = 0
        self._masks, self._width = b"", 0
        self._panned_at: int | None = None  # the finger's cell when a key last moved it

    def follow(self, masks: bytes, width: int, cell: int | None) -> bytes:
        """Dot masks of the part with the finger in it; it may stray by a cell beyond."""
        if masks != self._masks or width != self._width:
            self._masks, self._width, self._panned_at = masks, width, None
            self.first = (cell or 0) // max(width, 1) * width
        elif cell is not None and (self._panned_at is None or abs(cell - self._panned_at) > _SLACK):
            self._panned_at = None
            if not self.first - _SLACK <= cell < self.first + width + _SLACK:
                self.first = cell // max(width, 1) * width
        return self._masks[self.first : self.first + width]

    def pan(self, step: int, cell: int | None) -> bool:
        """Show the next part of the line, or the one before; False if there is none."""
        first = self.first + step * self._width
        if not 0 <= first < len(self._masks):
            return False
        self.first, self._panned_at = first, cell if cell is not None else -1
        return True


class _Link:
    """The connection to BRLTTY, in a thread that opens it again and again until it is there."""

    def __init__(self, spec: str) -> None:
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
        self.width = 0
        self._host = found[1] or ""
        self._keys: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._said: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._wanted: bytes | None = b""
        self._wakes = threading.Event()
        self._ended = False
        self._last = ""  # sentence
        self._thread = threading.Thread(target=self._run, name="brlapi", daemon=True)
        self._thread.start()

    def show(self, masks: bytes | None) -> None:
        """Have cells on the display; None gives it back."""
        if masks != self._wanted:
            self._wanted = masks
            self._wakes.set()

    def take(self) -> tuple[list[str], list[str]]:
        """Sentences and keys since the last call."""
        return _drained(self._said), _drained(self._keys)

    def close(self) -> None:
        """Give the display back; this waits a second at most."""
        self._ended = True
        self._wakes.set()
        self._thread.join(1.0)

    def _tell(self, sentence: str) -> None:
        if sentence != self._last:
            self._last = sentence
            self._said.put(sentence)

    def _run(self) -> None:
        while not self._ended:
            try:
                self._drive(self._brlapi.Connection(self._host.encode() or None))
            except self._brlapi.OperationError as error:
                self._tell(f"display: {self._words(error)}")
            self.width = 0
            if not self._ended:
                self._wakes.wait(_RETRY_S)
                self._wakes.clear()

    def _words(self, error: Any) -> str:
        where = f"at {self._host}" if self._host else "on this machine"
        number = getattr(error, "brlerrno", None)
        if number == self._brlapi.ERROR_AUTHENTICATION:
            return (
                f"BRLTTY {where} does not let you in; join the group that may read /etc/brlapi.key"
            )
        if isinstance(error, self._brlapi.ConnectionError):
            return f"no BRLTTY answers {where}; start it, or give its address"
        said = " ".join(str(error).split())
        return f"BRLTTY {where} does not give the display: {said}"

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
                if self._wanted is None and shown is not None:
                    connection.leaveTtyMode()
                    shown = None
                elif self._wanted is not None and self._wanted != shown:
                    if shown is None:
                        self._enter(connection)
                        self.width = columns
                        title = f"{name} {_text(connection.modelIdentifier)}".rstrip()
                        self._tell(f"display: {title}, {columns} cells")
                    shown = self._wanted
                    connection.writeDots(shown[:columns].ljust(columns * rows, b"\0"))
                if shown is not None:
                    self._read(connection)
                self._wakes.wait(_WAIT_S)
                self._wakes.clear()
        finally:
            with suppress(Exception):
                connection.leaveTtyMode()
                connection.closeConnection()

    def _enter(self, connection: Any) -> None:
        """Ask for the display at this program's terminal, or everywhere if that is unknown."""
        try:
            connection.enterTtyMode()
        except Exception:  # of brlapi
            connection.enterTtyModeWithPath([])

    def _read(self, connection: Any) -> None:
        while (code := connection.readKey(0)) is not None and code:
            key = self._brlapi.expandKeyCode(code)
            if key["type"] == self._brlapi.KEY_TYPE_CMD:
                told = self._brlapi.describeKeyCode(code)
                name = f"pins:{_text(told['command'])}"
                self._keys.put(f"{name}:{key['argument']}" if name == _ROUTE else name)
            elif name := typed(key["command"]):
                self._keys.put(name)


def typed(symbol: int) -> str:
    """Name of a key of the display's keyboard by its X11 keysym; empty if it is not known."""
    if symbol in _NAMED:
        return _NAMED[symbol]
    if _UNICODE < symbol <= _UNICODE + 0x10FFFF:
        return chr(symbol - _UNICODE)
    return chr(symbol) if 0x20 <= symbol <= 0x7E or 0xA0 <= symbol <= 0xFF else ""


def _drained(waiting: queue.SimpleQueue[str]) -> list[str]:
    found = []
    with suppress(queue.Empty):
        while True:
            found.append(waiting.get_nowait())
    return found


def _text(name: Any) -> str:
    return name.decode("utf-8", "replace") if isinstance(name, bytes) else str(name)
