"""A reader: the lines of a book under the hand, one after the other."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from vbraille.engine.advance import EndOfLine
from vbraille.engine.record import Flag
from vbraille.layout.pages import Layout, locate
from vbraille.layout.texts import cells_per_line
from vbraille.reading.context import Context
from vbraille.reading.echo import Echo
from vbraille.reading.holding import hold
from vbraille.reading.speed import too_fast_note
from vbraille.reading.waiting import Waiting
from vbraille.simulation.steering import ReadLine

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.engine.engine import Engine
    from vbraille.layout.pages import Line
    from vbraille.reading.cues import Cue
    from vbraille.render import Model
    from vbraille.render.braille.style import BrailleStyle
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
    styles : list of BrailleStyle
        Styles before each turn that can be undone, the last one last.
    keep : callable or None
        Function that saves a style in the profile in use, and gives a sentence on that; None if
        there is nothing to save to.
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
        self.styles: list[BrailleStyle] = []
        self.keep: Callable[[BrailleStyle], str] | None = None
        self.lines = 0
        self.done = False
        self._model = model
        self._first, self._last = first, last
        self._advance = advance
        self._stay = stay
        self._steering = steering
        self._steered_mm = 0.0  # how far a simulated hand was told to go
        self._start_mm = 0.0  # where the line's first cell begins
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
        return locate(self.line, self.style.geometry, x_mm - self._start_mm)

    @property
    def model(self) -> Model:
        """Display, and style in which lines are shown on it now."""
        return replace(self._model, style=self.style)

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
            self._steered_mm = self._end_mm(self.line)
            self._steering.give(ReadLine(self._steered_mm))

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

        Parameters
        ----------
        turned
            New values, by the names that `BrailleStyle.replace` takes.

        Raises
        ------
        InputError
            If a value is out of range, or leaves no room for a cell.
        """
        self.restyle(self.style.replace(**turned))

    def restyle(self, style: BrailleStyle) -> None:
        """Show this line and those after it in another style.

        Where distances change, the page is laid out anew around the character under the hand,
        which stays where it is.

        Raises
        ------
        InputError
            If the distances leave no room for a cell.
        """
        width = cells_per_line(style.geometry, self._model.display)
        before, self.style = self.style, style
        self._too_fast_said = False
        if style.geometry != before.geometry:
            self._lay_out_around(before.geometry, width)
        elif self.line is not None:
            self._render(self.line)

    def _lay_out_around(self, before: Geometry, width: int) -> None:
        """Lay out the page for the distances of the style, around what is under the hand."""
        held = None
        if self.line is not None:
            following = self.layout.line(self.line.number + 1)
            held = hold(
                self.line,
                None if following is None else _beginning(following),
                before,
                self.style.geometry,
                x_mm=self.engine.x_mm,
                start_mm=self._start_mm,
                span_mm=self._model.display.span_mm,
            )
        old, line = self.layout, self.line
        self.layout = Layout(old.book, width, () if held is None else held.forced)
        self._first = self._renumbered(old, self._first) or 1
        self._last = None if self._last is None else self._renumbered(old, self._last)
        if line is None:
            return
        character = _beginning(line) if held is None else held.character
        place = self.layout.place(character)
        assert place is not None, "a line of the book has a place in it"
        self._start_mm = 0.0 if held is None else held.start_mm
        reached = self._end.reached
        self._put(place[0])
        self._end.reached = reached
        if self._end_mm(place[0]) > self._steered_mm:
            self.steer()

    def _renumbered(self, old: Layout, number: int) -> int | None:
        """Line of the layout on which a line of the old one begins; None past the end."""
        if number == 1:
            return 1
        line = old.line(number)
        place = None if line is None else self.layout.place(_beginning(line))
        return None if place is None else place[0].number

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
        self.lines += 1
        self._finished = False
        self._prefetched = False
        self._start_mm = 0.0
        self._put(line)
        self.steer()
        for sentence in self.echo.sentences(line):
            self.say(sentence)

    def _put(self, line: Line) -> None:
        """Put a line under the hand, with its first cell where it is to begin."""
        self.line = line
        span_mm, end_mm = self._model.display.span_mm, self._end_mm(line)
        self._end = EndOfLine(span_mm, end_mm)
        self._waiting = Waiting(
            span_mm, end_mm, line.number, by_hand=self._advance, keys=self._stay
        )
        self._render(line)

    def _end_mm(self, line: Line) -> float:
        """Place where the last dot of a line ends."""
        return self._start_mm + self.style.geometry.extent_mm(len(line))

    def _render(self, line: Line) -> None:
        display = self._model.display
        program = self.style.render(line.masks, display)
        if self._start_mm:
            program = program.with_anchor(display.span_mm / 2 + self._start_mm)
        self.engine.show(program, line.number)

    def _watch_speed(self, speed_mm_s: float) -> None:
        if self._too_fast_said or self._end.reached:
            return
        note = too_fast_note(speed_mm_s, self.style)
        if note is not None:
            self._too_fast_said = True
            self.say(note)


def _beginning(line: Line) -> int:
    """Source character that a line begins with."""
    return int(line.cells.starts[0]) if len(line.cells) else line.cells.end
