"""The screen of the computer under the hand: a braille display of BRLTTY.

BRLTTY says what is shown, and does what keys ask for; here it comes under the hand.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.reading.brltty import Talk
from vbraille.reading.commands import Where, command
from vbraille.reading.surface import Part, Surface

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.reading.brltty import Port
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.keys import Keyboard
    from vbraille.reading.outputs import Output
    from vbraille.render import BrailleStyle

_CALM_S: Final = 0.02  # from one change of what is shown to the next
_ECHO_S: Final = 0.3  # what stands for so long is printed
_SIX: Final = 0x3F  # mask of dots 1 to 6
_EIGHTH: Final = 3  # dot row of dots 7 and 8


class Screen(Surface):
    """Screen as BRLTTY shows it, under a hand.

    Parameters
    ----------
    port
        Where BRLTTY is met.
    device, outputs
        As for an `Explored`.
    style
        How braille is shown.
    keyboard
        Keyboard whose wait ends when BRLTTY says something.

    Attributes
    ----------
    talk : Talk
        What BRLTTY has said.
    """

    where = Where.SCREEN
    doing = "the screen is under the hand"

    def __init__(
        self,
        port: Port,
        device: ReadingDevice,
        outputs: Sequence[Output],
        style: BrailleStyle,
        keyboard: Keyboard,
    ) -> None:
        super().__init__(device, outputs, "usual", style)
        self._port, self._keyboard = port, keyboard
        self._shown_s, self._changed_s = -math.inf, math.inf
        self._begin()
        self._echoed, self._masks = self.talk.text, self.talk.masks
        self.show_parts(self._parts(), 0)

    def _begin(self) -> None:
        self.talk = Talk(max(self.rows, 1), self.width, self.say)

    @property
    def text(self) -> str:
        """Print of the line under the hand."""
        begin = self.row * self.line_masks.size
        return self.talk.text[begin : begin + self.line_masks.size].rstrip()

    @property
    def line_masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line under the hand, uint8[cells]."""
        return self.talk.masks[self.row]

    @property
    def cell(self) -> int | None:
        """Cell of the line under the finger; None if there is none."""
        x_mm = self.device.x_mm
        cell = -1 if x_mm is None else math.floor(x_mm / self.style.geometry.cell_pitch_mm)
        return cell if 0 <= cell < self.line_masks.size else None

    def _parts(self) -> list[Part]:
        """Rows as the surface shows them; a blank one ends where its first cell does."""
        mapping = self.style.mapping
        if max(*mapping.left, *mapping.right) < _EIGHTH and (self.talk.masks > _SIX).any():
            self.talk.remark("dots 7 and 8 are not shown: the mapping has three rows of dots")
        rows = (masks[: max(np.flatnonzero(masks), default=0) + 1] for masks in self.talk.masks)
        return [Part(Cells.bare(masks), self.width) for masks in rows]

    def tune(self, **changes: Any) -> None:
        """Show the screen in another style."""
        self.show_in(self.style.replace(**changes))

    def idle(self, now_s: float) -> None:
        """Meet BRLTTY, and show what it says; cells that stay are felt as before."""
        port = self._port
        if port.meet():
            self._begin()
            port.send(self.talk.hello)
            self.say("BRLTTY: connected")
        calm = now_s - self._shown_s >= _CALM_S
        if calm and port.connected:
            self.talk.feed(port.take())
            if not port.connected:
                self._begin()
                self.say("BRLTTY: gone; the array rests until it comes back")
            if not np.array_equal(self.talk.masks, self._masks):
                self._shown_s, calm, self._masks = now_s, False, self.talk.masks
                self.change(self._parts())
        if self.talk.text != self._echoed:
            self._echoed, self._changed_s = self.talk.text, now_s
        if now_s - self._changed_s >= _ECHO_S:
            self._changed_s = math.inf
            for output in self.outputs:
                output.show(self)
        self._keyboard.also = port.descriptors if calm else []

    def send(self, name: str) -> None:
        """Ask BRLTTY for something by the name of its command."""
        if self._port.connected:
            self._port.send(name)
        else:
            self.refuse("BRLTTY is not connected")

    def follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand went; one that has read all asks for what follows."""
        followed = self.track(ticks)
        if followed is not None and followed.done and self._port.connected:
            self.send("WINDN" if self.rows else "FWINRT")
            self.begin_row(self.row)
            self.steer()

    def route(self, cell: int) -> None:
        """Take the screen's cursor to a cell of the line."""
        # The driver counts from 0, takes no 0, and says otherwise (BRLTTY 6.5 to 6.8).
        number = self.row * self.line_masks.size + cell
        if number:
            self.send(f"ROUTE {number}")
        else:
            self.refuse("BRLTTY takes the cursor to every cell but the first")

    @command("take the cursor to the finger", "enter", also="button:4", where=Where.SCREEN,
             first=True, steers=True, name="route")  # fmt: skip
    def route_here(self) -> None:
        """Take the cursor to the finger."""
        if self.cell is None:
            self.refuse("the finger is on no cell")
        else:
            self.route(self.cell)


# BRLTTY's commands with their keys; those are of `read`, where they mean the same. Help names the
# first, and pages of the live view offer them.
_ASKED: Final = {
    "LNDN": ("next line", "n down"),
    "LNUP": ("previous line", "p up"),
    "FWINRT": ("pan right, then to the next line", "right"),
    "TOP": ("first line of the screen", "< ctrl-home"),
    "HOME": ("to the cursor", "."),
    "CSRTRK": ("follow the cursor, or stay", "V"),
    "INFO": ("where the line and the cursor are, in braille; again: back", "i"),
    "FWINLT": ("pan left, then to the previous line", "left"),
    "LNBEG": ("start of the line", "home"),
    "LNEND": ("end of the line", "end"),
    "BOT": ("last line of the screen", "> ctrl-end"),
    "WINDN": ("lines below", "] ctrl-pagedown"),
    "WINUP": ("lines above", "[ ctrl-pageup"),
    "NXDIFLN": ("next line that differs", "pagedown"),
    "PRDIFLN": ("previous line that differs", "pageup"),
    "RETURN": ("to the cursor, or back from it", ","),
    "CSRVIS": ("show the cursor, or hide it", "v"),
    "FREEZE": ("hold the screen still, or go on", "f"),
    "SIXDOTS": ("computer braille of six dots or eight", "6"),
}
_FIRST: Final = 7
_BUTTONS: Final = {"LNDN": "button:1", "LNUP": "button:2"}

for place, (name, (words, keys)) in enumerate(_ASKED.items()):
    told = place < _FIRST
    also = f"pins:{name} {_BUTTONS.get(name, '')}"
    command(words, keys, also=also, where=Where.SCREEN, first=told, steers=told, name=name.lower())(
        partial(Screen.send, name=name)
    )
