"""The screen of the computer under the hand: a braille display of BRLTTY.

BRLTTY says what is shown, and does what keys ask for; here it comes under the hand.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from vbraille.braille.spelling import to_braille
from vbraille.engine.engine import EndOfLine
from vbraille.engine.record import Flag
from vbraille.knobs import KNOBS
from vbraille.layout import cells_per_line
from vbraille.reading.brltty import Talk
from vbraille.reading.commands import Where, command
from vbraille.reading.explored import Explored
from vbraille.reading.surface import rows_on
from vbraille.simulation.steering import ReadLine, ReadPage

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from vbraille.reading.brltty import Port
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.keys import Keyboard
    from vbraille.reading.outputs import Output
    from vbraille.render import BrailleStyle

_UNFELT: Final = int(Flag.PAUSED | Flag.SILENT | Flag.MARK | Flag.STOP | Flag.HELD | Flag.TURNED)
_CALM_S: Final = 0.02  # from one change of what is shown to the next
_ECHO_S: Final = 0.3  # what stands for so long is printed
_BELOW_S: Final = 0.5  # a hand that stays below the lines for so long asks for those below
_SIX: Final = 0x3F  # mask of dots 1 to 6
_EIGHTH: Final = 3  # dot row of dots 7 and 8


class Screen(Explored):
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
        super().__init__(device, outputs)
        self.style = style
        self.rows = rows_on(device.display, style)
        self.row = 0
        self._port, self._keyboard = port, keyboard
        cells = cells_per_line(style.geometry, device.display)
        self._new = lambda: Talk(max(self.rows, 1), cells)
        self.talk = self._new()
        self._x_mm = math.nan
        self._number = 0
        self._shown_s, self._changed_s = -math.inf, math.inf
        self._below_ns = 0
        self._echoed = self.talk.text
        self._masks: NDArray[np.uint8] = self.talk.masks
        self._tail = EndOfLine(0.0, 0.0), -1.0
        self.put()

    # What is under the hand

    @property
    def text(self) -> str:
        """Print of the line under the hand."""
        cells = self.talk.masks.shape[1]
        return self.talk.text[self.row * cells : (self.row + 1) * cells].rstrip()

    @property
    def line_masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line under the hand, uint8[cells]."""
        return self.talk.masks[self.row]

    @property
    def cell(self) -> int | None:
        """Cell of the line under the finger; None if there is none."""
        if math.isnan(self._x_mm):
            return None
        cell = math.floor(self._x_mm / self.style.geometry.cell_pitch_mm)
        return cell if 0 <= cell < self.line_masks.size else None

    def echoed(self, echo: str) -> Iterable[str]:
        """Lines that are printed of the line: its print, its cells, or both."""
        if echo in ("cells", "both"):
            yield f"cells: {to_braille(self.line_masks.tolist())}"
        if echo in ("text", "both"):
            yield f"text: {self.text}"

    def put(self) -> None:
        """Put what BRLTTY shows under the hand; cells that stay are felt as before."""
        style, display, masks = self.style, self.device.display, self.talk.masks
        if max(*style.mapping.left, *style.mapping.right) < _EIGHTH and (masks > _SIX).any():
            self.talk.remark("dots 7 and 8 are not shown: the mapping has three rows of dots")
        if self.rows:
            program = style.render_page(list(masks), display)
        else:
            program = style.render(masks[0], display)
        self._number += 1
        self._masks = masks
        self.device.put(program, self._number)
        end_mm = self.end_mm
        if end_mm != self._tail[1]:
            self._watch_end(end_mm)

    @property
    def end_mm(self) -> float:
        """Place where the last dot of the longest line ends."""
        felt = np.flatnonzero((self.talk.masks & _SIX).any(0))
        return self.style.geometry.extent_mm(int(felt[-1]) + 1 if felt.size else 1)

    def _watch_end(self, end_mm: float) -> None:
        self._tail = EndOfLine(self.device.display.span_mm, end_mm), end_mm
        self.steer()

    def steer(self) -> None:
        """Have a simulated hand read what is shown."""
        if self.rows:
            pitch_mm = self.style.geometry.line_pitch_mm
            self.device.give(ReadPage(self.rows, pitch_mm, self._tail[1], pitch_mm))
        else:
            self.device.give(ReadLine(self._tail[1]))

    # What BRLTTY says

    def idle(self, now_s: float) -> None:
        """Meet BRLTTY, and show what it says."""
        was = self._port.connected
        if self._port.meet():
            self.talk = self._new()
            self._port.send(self.talk.hello)
            self.say("BRLTTY: connected")
            was = True
        if now_s - self._shown_s >= _CALM_S:
            self.talk.feed(self._port.take())
            if was and not self._port.connected:
                self.talk = self._new()
                self.say("BRLTTY: gone; the array rests until it comes back")
            if not np.array_equal(self.talk.masks, self._masks):
                self._shown_s = now_s
                self.put()
        for sentence in self.talk.remarks():
            self.say(sentence)
        if self.talk.text != self._echoed:
            self._echoed, self._changed_s = self.talk.text, now_s
        if now_s - self._changed_s >= _ECHO_S:
            self._changed_s = math.inf
            for output in self.outputs:
                output.show(self)
        calm = now_s - self._shown_s >= _CALM_S
        self._keyboard.also = self._port.descriptors if calm else []

    def send(self, name: str) -> None:
        """Ask BRLTTY for something by the name of its command."""
        if self._port.connected:
            self._port.send(name)
        else:
            self.refuse("BRLTTY is not connected")

    # What the hand does

    def follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand went; a hand that comes back from the end goes on to the right."""
        felt = ticks[ticks["flags"] & _UNFELT == 0]
        if not felt.size or not self._port.connected:
            return
        self._x_mm = float(felt["x_mm"][-1])
        if self.rows:
            self._follow_rows(felt)
        elif self._tail[0].find(felt["x_mm"]) is not None:
            self.send("FWINRT")
            self._watch_end(self._tail[1])

    def _follow_rows(self, ticks: NDArray[np.void]) -> None:
        row = math.floor(float(ticks["y_mm"][-1]) / self.style.geometry.line_pitch_mm)
        now_ns = int(ticks["time_ns"][-1])
        if row < self.rows:
            self.row, self._below_ns = max(row, 0), 0
            return
        before, self._below_ns = self._below_ns, self._below_ns or now_ns
        if before > 0 and now_ns - before >= _BELOW_S * 1e9:
            self._below_ns = -1  # until the hand is back on the lines
            self.send("WINDN")
            self.steer()

    def route(self, cell: int) -> None:
        """Take the screen's cursor to a cell of the line."""
        # The driver counts from 0, takes no 0, and says otherwise (BRLTTY 6.5 to 6.8).
        number = self.row * self.line_masks.size + cell
        if number:
            self.send(f"ROUTE {number}")
        else:
            self.refuse("BRLTTY takes the cursor to every cell but the first")

    def turn(self, knob: str, value: float) -> str:
        """Give a knob of the style a value; a sentence on it, or empty if it had it before."""
        turned = KNOBS[knob]
        changes: dict[str, Any] = {turned.field: value}
        style = self.style.replace(**changes)
        if style == self.style:
            return ""
        self.style = style
        self.put()
        return turned.said(value)


# BRLTTY's commands with their keys; those are of `read`, where they mean the same. Help names the
# first, and pages of the live view offer them.
_ASKED: Final = {
    "LNDN": ("next line", "n down"),
    "LNUP": ("previous line", "p up"),
    "FWINRT": ("on along the line, then the next line", "right"),
    "TOP": ("first line of the screen", "< ctrl-home"),
    "HOME": ("to the cursor", "."),
    "CSRTRK": ("follow the cursor, or stay", "C"),
    "FWINLT": ("back along the line, then the line before", "left"),
    "LNBEG": ("start of the line", "home"),
    "LNEND": ("end of the line", "end"),
    "BOT": ("last line of the screen", "> ctrl-end"),
    "WINDN": ("lines below", "] ctrl-pagedown"),
    "WINUP": ("lines above", "[ ctrl-pageup"),
    "NXDIFLN": ("next line that differs", "pagedown"),
    "PRDIFLN": ("previous line that differs", "pageup"),
    "RETURN": ("to the cursor, or back from it", ","),
    "CSRVIS": ("show the cursor, or hide it", "c"),
    "FREEZE": ("hold the screen still, or go on", "f"),
    "SIXDOTS": ("computer braille of six dots or eight", "6"),
}
_FIRST: Final = 6
_BUTTONS: Final = {"LNDN": "button:1", "LNUP": "button:2"}


def _add_asked() -> None:
    for place, (name, (words, keys)) in enumerate(_ASKED.items()):
        also = f"pins:{name} {_BUTTONS.get(name, '')}"
        told = {"first": place < _FIRST, "steers": place < _FIRST, "name": name.lower()}

        @command(words, keys, also=also, where=Where.SCREEN, **told)
        def ask(screen: Screen, name: str = name) -> None:
            screen.send(name)


_add_asked()


@command("take the cursor to the finger", "enter", also="button:4", where=Where.SCREEN, first=True,
         steers=True)  # fmt: skip
def route(screen: Screen) -> None:
    """Take the cursor to the finger."""
    if screen.cell is None:
        screen.refuse("the finger is on no cell")
    else:
        screen.route(screen.cell)


@command("where the line and the cursor are on the screen", "i", where=Where.SCREEN, first=True)
def where(screen: Screen) -> None:
    """Say where the line and the cursor are."""
    status = screen.talk.status
    said = (
        f"{words}: row {status.get(f'{name}ROW', 0)}, column {status.get(f'{name}COL', 0)}"
        for name, words in (("BRL", "line"), ("CSR", "cursor"))
    )
    screen.say("; ".join(said))
