"""What is under the hand, and how far the hand has come through it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.engine.advance import EndOfLine
from vbraille.engine.record import Flag
from vbraille.layout.texts import cells_per_line
from vbraille.reading.speed import too_fast_note
from vbraille.reading.waiting import Waiting
from vbraille.simulation.steering import ReadLine

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vbraille.engine.engine import Engine
    from vbraille.reading.window import Window
    from vbraille.render import BrailleStyle, Model
    from vbraille.simulation.steering import Steering

MOST_CELLS = 512  # that can be shown at once, however close they stand
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PAUSED, _HELD = int(Flag.PAUSED), int(Flag.HELD)


class UnderHand:
    """A part of a line that is under the hand.

    Parameters
    ----------
    engine
        Engine that drives the device.
    model
        Display, and style in which lines are shown on it.
    steering
        Steering that tells a simulated hand what to read; None if a person reads.
    say
        Function that is called with each thing to be said.
    by_hand
        Whether the next line comes when the hand returns; otherwise a key brings it.
    key
        Key that brings the next line; empty if there is nobody at a keyboard.

    Attributes
    ----------
    window : Window or None
        The part of a line; None before the first.
    style : BrailleStyle
        How lines are shown.
    width : int
        Largest number of cells that are shown.
    shown : int
        Number of times that something else was put under the hand.
    patient : bool
        Whether the hand may do as it likes, since somebody moves it in the live view.
    """

    def __init__(
        self,
        engine: Engine,
        model: Model,
        steering: Steering | None,
        say: Callable[[str], None],
        *,
        by_hand: bool,
        key: str,
    ) -> None:
        self.window: Window | None = None
        self.style = model.style
        self.shown = 0
        self.patient = False
        self._engine = engine
        self._display = model.display
        self.width = self.width_in(model.style)
        self._steering = steering
        self._say = say
        self._by_hand = by_hand
        self._key = key
        self._end: EndOfLine
        self._end_mm = 0.0
        self._waiting: Waiting
        self._begun = False  # whether the hand was before the end since the window is there
        self._too_fast_said = False

    @property
    def hopeless(self) -> str | None:
        """Reason why the line will not come to its end unless somebody helps; None without one."""
        return None if self.window is None else self._waiting.hopeless

    @property
    def reached(self) -> bool:
        """Whether the hand has been at the end."""
        return self.window is not None and self._end.reached

    def width_in(self, style: BrailleStyle) -> int:
        """Largest number of cells that can be shown in a style.

        Raises
        ------
        InputError
            If there is no room for a cell.
        """
        return min(cells_per_line(style.geometry, self._display), MOST_CELLS)

    def put(self, window: Window, name: str) -> None:
        """Put a part of a line under the hand.

        Parameters
        ----------
        window
            The part of the line.
        name
            What the line is called, such as "line 12".
        """
        self.window = window
        self.shown += 1
        self._begun = False
        span_mm = self._display.span_mm
        self._end_mm = window.start_mm + self.style.geometry.extent_mm(len(window))
        self._end = EndOfLine(span_mm, self._end_mm)
        self._waiting = Waiting(span_mm, self._end_mm, name, by_hand=self._by_hand, key=self._key)
        self._render(window)
        self.steer()

    def show_in(self, style: BrailleStyle) -> None:
        """Show lines in another style from now on, this one too."""
        self.style = style
        self.width = self.width_in(style)
        self._too_fast_said = False
        if self.window is not None:
            self._render(self.window)

    def steer(self) -> None:
        """Have a simulated hand read the line under it; a person's hand does so by itself."""
        if self._steering is not None and self.window is not None:
            self._steering.give(ReadLine(self._end_mm))

    def steered_till(self, tick: np.void) -> bool:
        """Whether a simulated hand had read the line by the time of a tick; False without one."""
        return self._steering is not None and self._steering.done_at(int(tick["device_ns"]))

    def felt(self, ticks: NDArray[np.void]) -> NDArray[np.void]:
        """Take of some ticks those in which the line was to be felt."""
        if self.window is None:
            return ticks[:0]
        number = self.window.line.number
        ticks = ticks[(ticks["line"] == number) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            self._waiting.rest()
        return ticks

    def follow(self, ticks: NDArray[np.void]) -> bool:
        """Look where the hand was while it felt the line: whether it is done with it."""
        # Frames that the device did not take were not felt.
        felt_mm = ticks["x_mm"][ticks["flags"] & _HELD == 0]
        if not self._begun:  # a hand that was at the end when the line came has not read it
            before = np.flatnonzero(felt_mm < self._end_mm)
            self._begun = bool(before.size)
            felt_mm = felt_mm[before[0] :] if before.size else felt_mm[:0]
        return self._end.find(felt_mm) is not None

    def watch(self, ticks: NDArray[np.void], *, finished: bool) -> None:
        """Say what keeps the hand from the end of the line, and whether it is too fast."""
        if not finished:
            watched = self._waiting.watch(ticks, reached=self._end.reached, patient=self.patient)
            for sentence in watched:
                self._say(sentence)
        if self._too_fast_said or self._end.reached or self.patient:
            return
        note = too_fast_note(float(ticks["vx_mm_s"].max()), self.style)
        if note is not None:
            self._too_fast_said = True
            self._say(note)

    def _render(self, window: Window) -> None:
        program = self.style.render(window.masks, self._display)
        if window.start_mm:
            program = program.with_anchor(self._display.span_mm / 2 + window.start_mm)
        self._engine.show(program, window.line.number)
