"""A conventional display beside the device: the line under the hand, or what was said, on its pins.

Keys of the display are obeyed. BRLTTY drives it, in a thread of its own that never holds the loop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.conventional.display import ConventionalDisplay, DisplayAway, DisplayStands
from vbraille.layout import Layout
from vbraille.reading.outputs import Cue, Output
from vbraille.translate import Book, text_source

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.explored import Explored
    from vbraille.translate import BrailleTable

_SLACK = 1  # cells that the finger may go before what stands there gives way
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
    """An output on a conventional display.

    A line falls into parts of the display's width, and the part with the finger in it is shown. A
    sentence stands there until the finger goes on or a key is pressed.

    Parameters
    ----------
    spec
        Which display, as for a `ConventionalDisplay`.
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
        self._display = ConventionalDisplay(spec)
        self._table, self._say = table, say
        self._line = b"", 0  # the line, and the display's width
        self._first = 0  # cell of the line that stands first
        self._sentences: list[str] = []
        self._at = 0  # part of the sentences that stands there
        self._finger = -1  # its cell when what stands there was chosen
        self._shown: bytes | None = None
        self.close = self._display.close

    def say(self, sentence: str, cue: Cue = Cue.NONE) -> None:  # noqa: ARG002 - cues are heard
        """Show a sentence, after those that came together with it."""
        if sentence:
            self._sentences.append(sentence)

    def show(self, what: Explored) -> None:  # noqa: ARG002 - `pressed` looks at it all the time
        """Show a line in place of sentences that were said before."""
        self._sentences, self._at = [], 0

    def rest(self) -> None:
        """Give the display back until something is shown again."""
        self._shown = None
        self._display.rest()

    def pressed(self, what: Explored) -> list[str]:
        """Show what is to be shown now, and name the keys that were pressed.

        Those of BRLTTY's commands are such as "pins:LNDN", a routing key "route:12".
        """
        for told in self._display.poll():
            if isinstance(told, DisplayStands):
                self._say(f"display: {told.title}, {told.columns} cells")
            elif isinstance(told, DisplayAway):
                self._say(f"display: {told.why}")
        standing, masks, cell = self._display.standing, what.line_masks, what.cell
        width = 1 if standing is None else standing.columns
        line = b"" if masks is None else masks.tobytes()
        another, self._line = (line, width) != self._line, (line, width)
        if another or (cell is not None and abs(cell - self._finger) > _SLACK):
            self._finger = 0 if cell is None else cell
            if another or not self._first <= self._finger < self._first + width:
                self._first = self._finger // width * width
            if not another:
                self.show(what)
        books = (Book(text_source(sentence), self._table) for sentence in self._sentences)
        layouts = (Layout(book, width) for book in books)
        parts = [part.masks.tobytes() for layout in layouts for part in layout.lines()]
        keys = [self._named(self._display.keys.popleft()) for _ in range(len(self._display.keys))]
        asked = [key for key in keys if key and not self._pan(_PAN.get(key, 0), len(parts))]
        stands = parts[min(self._at, len(parts) - 1)] if parts else line[self._first :][:width]
        if stands != self._shown:
            self._shown = stands
            self._display.show(stands)
        if asked:
            self.show(what)
        return asked

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

    def _named(self, code: int) -> str:
        """Name of a key; empty if it is not known."""
        brlapi = self._display.brlapi
        key = brlapi.expandKeyCode(code)
        if key["type"] != brlapi.KEY_TYPE_CMD:
            return typed(key["command"])
        name = brlapi.describeKeyCode(code)["command"]
        name = name.decode() if isinstance(name, bytes) else name
        return f"route:{self._first + key['argument']}" if name == "ROUTE" else f"pins:{name}"


def typed(symbol: int) -> str:
    """Name of a key of the display's keyboard by its X11 keysym; empty if it is not known."""
    if symbol in _NAMED:
        return _NAMED[symbol]
    if _UNICODE < symbol <= _UNICODE + 0x10FFFF:
        return chr(symbol - _UNICODE)
    return chr(symbol) if 0x20 <= symbol <= 0x7E or 0xA0 <= symbol <= 0xFF else ""
