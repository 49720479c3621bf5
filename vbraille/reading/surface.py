"""Surface under the hand: part of one line, or a page of lines where the carriage has two axes.

It knows from the ticks of the engine which line the finger is on, and whether it is done.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vbraille.engine.engine import EndOfLine
from vbraille.engine.record import Flag
from vbraille.reading.explored import Explored
from vbraille.simulation.steering import ReadLine, ReadPage

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.outputs import Output
    from vbraille.render import BrailleStyle

MOST_LINES, MOST_CELLS = 64, 512  # that are shown at once
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PAUSED = int(Flag.PAUSED)
_UNFELT = int(Flag.SILENT | Flag.STOP | Flag.HELD | Flag.TURNED)
# A finger that goes across lines is on none of them: nothing of one has faded in before.
_ON_NS = 120_000_000
# Longer than a finger that strays off the last line takes to come back.
_BELOW_NS = 500_000_000
_FOOT_PITCHES = 0.1  # below the last line and its band, for a finger that asks for the next page


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """Cells of a line that the hand can cross at once.

    Parameters
    ----------
    line
        The line, which has masks and a length.
    width : int
        Largest number of cells that are shown.
    first : int
        Cell of the line that stands first; below 0, that many blank cells stand before the line.
    """

    line: Any
    width: int
    first: int = 0

    def __len__(self) -> int:
        return max(0, min(self.width, len(self.line) - self.first))

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of what is shown, uint8[cells]."""
        before = np.zeros(max(-self.first, 0), np.uint8)
        return np.concatenate((before, self.line.masks[max(self.first, 0) :]))[: len(self)]


class Followed(NamedTuple):
    """Progress of the hand: it is on another line, came to a line's end, or is done with all."""

    line: bool = False
    reached: bool = False
    done: bool = False


class Surface(Explored):
    """Lines that lie under the hand; a book, or a screen.

    Parameters
    ----------
    device, outputs, key_set
        As of `Explored`.
    style
        How braille is shown.
    by_hand
        Whether a hand that stays below a page asks for the next one.

    Attributes
    ----------
    parts : list[Part or None]
        What is shown, from the top; None where the text has not begun yet.
    row : int
        Row that is read; the finger is on it, or was on it last.
    rows : int
        Number of rows of a page; 0 where one line is shown, wherever along y the array is.
    width : int
        Number of cells that a line has room for.
    number : int
        Number by which ticks name what is shown, which grows.
    reached : bool
        Whether the hand has been at the end of the line.
    finger_row : int
        Row in which the finger is now; -1 if it is above the page.
    """

    def __init__(
        self,
        device: ReadingDevice,
        outputs: Sequence[Output],
        key_set: str,
        style: BrailleStyle,
        *,
        by_hand: bool = True,
    ) -> None:
        super().__init__(device, outputs, key_set)
        self.by_hand = by_hand
        self.parts: Sequence[Part | None] = []
        self.row = self.number = 0
        self.finger_row = -1
        self.fit(style)

    def fit(self, style: BrailleStyle) -> None:
        """Show what comes in a style.

        Raises
        ------
        InputError
            If there is no room for a cell.
        """
        self.width = min(style.geometry.cells_per_line(self.display.span_mm), MOST_CELLS)
        pitches = self.display.height_mm / style.geometry.line_pitch_mm - _below_pitches(style)
        self.rows = min(max(0, math.floor(pitches + 1e-9)), MOST_LINES)
        self.style = style

    @property
    def sizes(self) -> tuple[float, ...]:
        """Numbers and distances of cells and rows: if they stay, so does what is shown where."""
        geometry = self.style.geometry
        return geometry.cell_pitch_mm, self.width, self.rows and geometry.line_pitch_mm, self.rows

    @property
    def part(self) -> Part:
        """Part of a line that is read."""
        part = self.parts[self.row]
        assert part is not None, "a row with a line"
        return part

    @property
    def end_mm(self) -> float:
        """Place where the last dot of the line ends."""
        return self.style.geometry.extent_mm(len(self.part))

    # What is shown

    def show_in(self, style: BrailleStyle) -> None:
        """Show the same in another style; it fades in under the finger."""
        before = self.sizes
        self.fit(style)
        if self.sizes == before:
            self.render()
        else:
            self.show_parts(self.parts, self.row)

    def show_parts(self, parts: Sequence[Part | None], row: int) -> None:
        """Show parts of lines, one below the other, of which one is read."""
        self.parts = parts
        self.number += 1
        self.begin_row(row)
        self.render()
        self.steer()

    def change(self, parts: Sequence[Part]) -> None:
        """Show other cells in the same rows; the hand goes on where it is."""
        before_mm = self.end_mm
        self.parts = parts
        self.render()
        if self.end_mm != before_mm:
            self.enter(self.row)
            self.steer()

    def steer(self) -> None:
        """Have a simulated hand read what is shown."""
        if not self.rows:
            self.device.give(ReadLine(self.end_mm))
            return
        geometry, lines = self.style.geometry, len(self.parts)
        end_mm = geometry.extent_mm(max(len(part) for part in self.parts if part is not None))
        below_mm = self.display.height_mm - lines * geometry.line_pitch_mm
        foot_mm = min(below_mm, (_below_pitches(self.style) + 0.5) * geometry.line_pitch_mm)
        self.device.give(ReadPage(lines, geometry.line_pitch_mm, end_mm, foot_mm * self.by_hand))

    def render(self) -> None:
        """Show the parts as they are in the style now."""
        if self.rows:
            blank = np.zeros(0, np.uint8)
            masks = [blank if part is None else part.masks for part in self.parts]
            program = self.style.render_page(masks, self.display)
        else:
            program = self.style.render(self.part.masks, self.display)
        self.device.put(program, self.number)

    # What the hand does

    def begin_row(self, row: int) -> None:
        """Begin to follow a hand that has read nothing of what is shown."""
        self._near, self._near_ns, self._below_ns = row, 0, 0
        self._begun = False  # whether the finger was on the page since it came
        self.enter(row)

    def enter(self, row: int) -> None:
        """Begin to follow the finger along the line of a row."""
        self.row = row
        self.reached = self._left = False
        self._end = EndOfLine(self.display.span_mm, self.end_mm)

    def track(self, ticks: NDArray[np.void]) -> Followed | None:
        """Look where the hand went; None if nothing of what is shown was to be felt."""
        shown = ticks[ticks["line"] == self.number]
        if self.rows and shown.size and not math.isnan(shown["y_mm"][-1]):
            self.finger_row = int(shown["part"][-1])
        felt = shown[shown["flags"] & _PAUSED == 0]
        on = felt[felt["flags"] & _UNFELT == 0]
        if not on.size:  # it is paused, or the device was away or at rest by itself
            self._below_ns = 0
            return Followed() if felt.size else None
        x_mm, was_reached = on["x_mm"], self.reached
        if not self._left:  # a hand that was at the end when the line came has not read it
            before = np.flatnonzero(x_mm < self.end_mm)
            self._left = bool(before.size)
            x_mm = x_mm[before[0] :] if before.size else x_mm[:0]
        done = self._end.find(x_mm) is not None
        self.reached = self._end.reached
        followed = Followed(reached=self.reached and not was_reached, done=done)
        return self._follow_page(int(on["time_ns"][-1]), followed) if self.rows else followed

    def _follow_page(self, now_ns: int, along: Followed) -> Followed:
        """Look which row of a page the finger is in, or whether it stays below the last."""
        row, on_line = self.finger_row, along._replace(done=False)
        if row < len(self.parts):
            self._begun, self._below_ns = self._begun or row >= 0, 0
        elif self._begun:
            self._below_ns = self._below_ns or now_ns
            return along._replace(done=now_ns - self._below_ns >= _BELOW_NS)
        if row != self._near:
            self._near, self._near_ns = row, now_ns
        there = 0 <= row < len(self.parts) and self.parts[row] is not None
        if row == self.row or not there or now_ns - self._near_ns < _ON_NS:
            return on_line
        self.enter(row)
        return Followed(line=True)


def _below_pitches(style: BrailleStyle) -> float:
    """Way below the last line's edge that takes a finger off the page, in line pitches."""
    return style.straying.band / 2 + _FOOT_PITCHES
