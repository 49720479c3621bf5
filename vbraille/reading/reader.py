"""A reader: the lines of a book under the hand, one after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.engine.advance import EndOfLine
from vbraille.engine.record import Flag
from vbraille.layout.pages import Layout, locate
from vbraille.layout.texts import cells_per_line
from vbraille.reading.context import Context
from vbraille.reading.echo import Echo
from vbraille.reading.speed import too_fast_note
from vbraille.reading.waiting import Waiting
from vbraille.simulation.steering import ReadLine

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.engine.engine import Engine
    from vbraille.layout.pages import Line
    from vbraille.reading.cues import Cue
    from vbraille.render import Model
    from vbraille.simulation.steering import Steering

# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PAUSED, _HELD = int(Flag.PAUSED), int(Flag.HELD)


class Reader:
    """Somebody who reads a range of lines: what is under the hand, and how far it has come.

    It speaks in sentences; `vbraille.reading.commands` calls its methods.

    Parameters
    ----------
    layout
        Lines of the book.
    engine
        Engine that drives the device.
    model
        Display, and style in which lines are shown on it.
    first, last
        Numbers of the first and last line to read, from 1; None for the end.
    advance
        Whether the next line comes when the hand returns; otherwise a key brings it.
    stay
        Whether to wait for keys at the end of the text, instead of being done.
    echo
        How much is said of each line.
    steering
        Steering that tells a simulated hand what to read; None if a person reads.
    say
        Function that is called with each thing to be said.
    cue
        Function that is called with each signal to be given.

    Attributes
    ----------
    line : Line or None
        Line under the hand; None before the first.
    style : BrailleStyle
        How lines are shown.
    context : Context
        Meaning of the keys at the moment.
    lines : int
        Number of lines read so far: those that were under the hand.
    done : bool
        Whether there is no more to read, or reading was stopped.
    """

    def __init__(
        self,
        layout: Layout,
        engine: Engine,
        *,
        model: Model,
        say: Callable[[str], None],
        first: int = 1,
        last: int | None = None,
        advance: bool = True,
        stay: bool = False,
        echo: Echo = Echo.NONE,
        steering: Steering | None = None,
        cue: Callable[[Cue], None] = lambda _: None,
    ) -> None:
        self.layout = layout
        self.engine = engine
        self.style = model.style
        self.say = say
        self.cue = cue
        self.echo = echo
        self.context = Context.READING
        self.line: Line | None = None
        self.lines = 0
        self.done = False
        self._model = model
        self._first, self._last = first, last
        self._advance = advance
        self._stay = stay
        self._steering = steering
        self._end: EndOfLine
        self._waiting: Waiting
        self._finished = False  # whether the end was said, until a key brings another line
        self._prefetched = False
        self._too_fast_said = False

    @property
    def hopeless(self) -> str | None:
        """Reason why the line will not come to its end unless somebody helps; None without one."""
        return None if self.line is None else self._waiting.hopeless

    @property
    def line_number(self) -> int:
        """Number of the line under the hand; 0 before the first."""
        return 0 if self.line is None else self.line.number

    @property
    def cell(self) -> int | None:
        """Number of the line's cell under the middle of the array; None if there is none."""
        x_mm = self.engine.x_mm
        if self.line is None or x_mm is None:
            return None
        return locate(self.line, self.style.geometry, x_mm)

    def start(self) -> None:
        """Put the first line under the hand."""
        line = self.layout.line(self._first)
        if line is None:
            self.done = True
        else:
            self._show(line)

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in ticks, which are all since the last call."""
        if self.line is None:
            return
        ticks = ticks[(ticks["line"] == self.line.number) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            self._waiting.rest()
            return
        # Frames that the device did not take were not felt.
        felt_mm = ticks["x_mm"][ticks["flags"] & _HELD == 0]
        if self._end.find(felt_mm) is not None and self._advance and not self._finished:
            self.go_on()
        else:
            if self._end.reached and not self._prefetched:
                # On the way back to the start there is time for this.
                self._prefetched = True
                self.layout.line(self.line.number + 1)
            if not self._finished:
                for sentence in self._waiting.watch(ticks, reached=self._end.reached):
                    self.say(sentence)
        self._watch_speed(float(ticks["vx_mm_s"].max()))

    def steer(self) -> None:
        """Have a simulated hand read the line under it; a person's hand does so by itself."""
        if self._steering is not None and self.line is not None:
            self._steering.give(ReadLine(self.style.geometry.extent_mm(len(self.line))))

    def steered_till(self, tick: np.void) -> bool:
        """Whether a simulated hand had read the line by the time of a tick; False without one."""
        return self._steering is not None and self._steering.done_at(int(tick["device_ns"]))

    def go_on(self) -> None:
        """Put the next line under the hand; if there is none, reading is finished."""
        if self.line is not None and not self.go(self.line.number + 1):
            self._finish()

    def go(self, number: int) -> bool:
        """Put the line of a number under the hand; False if it is none of those to read."""
        if number < self._first or (self._last is not None and number > self._last):
            return False
        line = self.layout.line(number)
        if line is None:
            return False
        self._show(line)
        return True

    def tune(self, **turned: Any) -> None:
        """Show this line and those after it in a style of which some values differ.

        Raises
        ------
        InputError
            If a value is out of range, or leaves no room for a cell.
        """
        style = self.style.replace(**turned)
        width = cells_per_line(style.geometry, self._model.display)
        cell = self.cell
        self.style = style
        self._too_fast_said = False
        if self.line is None:
            return
        if width == self.layout.width:
            self._render(self.line)
            return
        span = None if cell is None else self.line.source(cell)
        self.layout = Layout(self.layout.book, width)
        place = self.layout.place(int(self.line.cells.starts[0]) if span is None else span[0])
        if place is not None:
            self._show(place[0])

    def quit(self) -> None:
        """Stop reading."""
        self.done = True

    def _finish(self) -> None:
        if self._stay:
            self._finished = True
            self.say("end of text; p goes back, q stops")
        else:
            self.done = True

    def _show(self, line: Line) -> None:
        self.line = line
        self.lines += 1
        self._finished = False
        self._prefetched = False
        end_mm = self.style.geometry.extent_mm(len(line))
        self._end = EndOfLine(self._model.display.span_mm, end_mm)
        self._waiting = Waiting(
            self._model.display.span_mm, end_mm, line.number, by_hand=self._advance, keys=self._stay
        )
        self._render(line)
        self.steer()
        for sentence in self.echo.sentences(line):
            self.say(sentence)

    def _render(self, line: Line) -> None:
        self.engine.show(self.style.render(line.masks, self._model.display), line.number)

    def _watch_speed(self, speed_mm_s: float) -> None:
        if self._too_fast_said or self._end.reached:
            return
        note = too_fast_note(speed_mm_s, self.style)
        if note is not None:
            self._too_fast_said = True
            self.say(note)
