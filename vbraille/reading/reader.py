"""A reader: the lines of a book under the hand, one after the other."""

from __future__ import annotations

from enum import StrEnum
from typing import TYPE_CHECKING

from vbraille.engine.advance import EndOfLine
from vbraille.engine.record import Flag
from vbraille.layout.pages import locate
from vbraille.reading.commands import BY_KEY, COMMANDS
from vbraille.reading.keys import PASTE
from vbraille.reading.waiting import Waiting
from vbraille.simulation.steering import ReadLine

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.engine.engine import Engine
    from vbraille.layout.pages import Layout, Line
    from vbraille.render import BrailleStyle, Model
    from vbraille.simulation.steering import Steering

STEP = 0.1
# Above this the devices' reconstruction filters take texture away (Lévesque 2009, 6.2).
FILTER_HZ = 200.0
# Plain numbers: numpy asks an enumeration for attributes, and loses a signal that comes meanwhile.
_PAUSED, _HELD = int(Flag.PAUSED), int(Flag.HELD)


class Echo(StrEnum):
    """What is said of each line."""

    NONE = "none"
    TEXT = "text"
    CELLS = "cells"
    BOTH = "both"


class Reader:
    """Read a range of lines.

    Parameters
    ----------
    layout
        The book.
    engine
        Drives the device.
    model
        The display, and how lines are shown on it.
    first, last
        Lines to read, from 1, both included; None for the end.
    advance
        Whether the next line comes when the hand returns; else a key brings it.
    stay
        Whether to wait for keys at the end of the text, instead of being done.
    echo
        What to say of each line.
    steering
        What tells the simulated hand what to read; None if a person's hand reads.
    say
        Where to say it, one thing a call.

    Attributes
    ----------
    lines : int
        Lines read so far: those that were under the hand.
    done : bool
        Whether there is no more to read, or the reader stopped.
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
    ) -> None:
        self.layout = layout
        self.engine = engine
        self.style = model.style
        self.lines = 0
        self.done = False
        self._model = model
        self._say = say
        self._first, self._last = first, last
        self._advance = advance
        self._stay = stay
        self._echo = echo
        self._steering = steering
        self._line: Line | None = None
        self._end: EndOfLine
        self._waiting: Waiting
        self._finished = False  # said that there is no more, until a key brings another line
        self._prefetched = False
        self._too_fast_said = False

    @property
    def hopeless(self) -> str | None:
        """Why the line will not come to its end unless somebody sees to it; else None."""
        return None if self._line is None else self._waiting.hopeless

    @property
    def line(self) -> Line | None:
        """The line under the hand; None before the first."""
        return self._line

    @property
    def line_number(self) -> int:
        """Of the line under the hand; 0 before the first."""
        return 0 if self._line is None else self._line.number

    def start(self) -> None:
        """Put the first line under the hand."""
        line = self.layout.line(self._first)
        if line is None:
            self.done = True
        else:
            self._show(line)

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in these ticks, all since the last call."""
        if self._line is None:
            return
        ticks = ticks[(ticks["line"] == self._line.number) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            self._waiting.rest()
            return
        # What the device did not take was not felt.
        felt_mm = ticks["x_mm"][ticks["flags"] & _HELD == 0]
        if self._end.find(felt_mm) is not None and self._advance and not self._finished:
            self.go_on()
        else:
            if self._end.reached and not self._prefetched:
                # On the way back to the start there is time for it.
                self._prefetched = True
                self.layout.line(self._line.number + 1)
            if not self._finished:
                for sentence in self._waiting.watch(ticks, reached=self._end.reached):
                    self._say(sentence)
        self._watch_speed(float(ticks["vx_mm_s"].max()))

    def steer(self) -> None:
        """Have a simulated hand read the line under it; a person's hand does by itself."""
        if self._steering is not None and self._line is not None:
            self._steering.give(ReadLine(self.style.geometry.extent_mm(len(self._line))))

    def steered_till(self, tick: np.void) -> bool:
        """Whether a simulated hand had read the line, by the time of a tick; no other ever has."""
        return self._steering is not None and self._steering.done_at(int(tick["device_ns"]))

    def go_on(self) -> None:
        """Put the next line under the hand; there is none: the reading is finished."""
        if self._line is not None and not self._go(self._line.number + 1):
            self._finish()

    def press(self, key: str) -> None:
        """Do what a key stands for."""
        command = BY_KEY.get(key)
        if key == PASTE:
            self._say("paste: text that is pasted is passed over; type the keys")
        elif command is None:
            self._say(f"no command: {key!r}; h says the keys")
        else:
            getattr(self, command.name.lower())()

    def tune(self, **turned: float) -> None:
        """Show the line, and those after it, with another texture or contrast, 0 to 1.

        Raises
        ------
        ValueError
            If a value is out of range.
        """
        self.style = self.style.replace(**turned)
        self._too_fast_said = False
        if self._line is not None:
            self._picture(self._line)

    def lndn(self) -> None:
        """Next line."""
        self._step_by_key(1, "last line")

    def lnup(self) -> None:
        """Previous line."""
        self._step_by_key(-1, "first line")

    def word(self) -> None:
        """Say the word under the middle of the array."""
        line, x_mm = self._line, self.engine.x_mm
        cell = None
        if line is not None and x_mm is not None:
            cell = locate(line, self.style.geometry, x_mm)
        word = line.word(cell) if line is not None and cell is not None else ""
        self._say(f"word: {word}" if word else "word: none here")

    def pause(self) -> None:
        """Rest the array at once, or go on."""
        self.engine.paused = not self.engine.paused
        self._say("paused" if self.engine.paused else "reading")

    def texture_up(self) -> None:
        """More texture."""
        self._turn("texture", STEP)

    def texture_down(self) -> None:
        """Less texture."""
        self._turn("texture", -STEP)

    def contrast_up(self) -> None:
        """More contrast."""
        self._turn("contrast", STEP)

    def contrast_down(self) -> None:
        """Less contrast."""
        self._turn("contrast", -STEP)

    def help(self) -> None:
        """Say the keys."""
        for command in COMMANDS:
            self._say(f"{command.spoken_keys}: {command.help}")

    def quit(self) -> None:
        """Stop reading."""
        self.done = True

    def _step_by_key(self, step: int, none: str) -> None:
        """Go to another line and say its number, or that there is none."""
        if self._line is None or not self._go(self._line.number + step):
            self._say(none)
        elif self._echo is Echo.NONE:
            self._say(f"line: {self._line.number}")

    def _finish(self) -> None:
        if self._stay:
            self._finished = True
            self._say("end of text; p goes back, q stops")
        else:
            self.done = True

    def _go(self, number: int) -> bool:
        """Put another line under the hand; whether there is one."""
        if number < self._first or (self._last is not None and number > self._last):
            return False
        line = self.layout.line(number)
        if line is None:
            return False
        self._show(line)
        return True

    def _show(self, line: Line) -> None:
        self._line = line
        self.lines += 1
        self._finished = False
        self._prefetched = False
        end_mm = self.style.geometry.extent_mm(len(line))
        self._end = EndOfLine(self._model.display.span_mm, end_mm)
        self._waiting = Waiting(
            self._model.display.span_mm, end_mm, line.number, by_hand=self._advance, keys=self._stay
        )
        self._picture(line)
        self.steer()
        self._say_line(line)

    def _picture(self, line: Line) -> None:
        self.engine.show(
            self.style.render(line.masks, self._model.display),
            line.number,
        )

    def _say_line(self, line: Line) -> None:
        if self._echo is Echo.NONE:
            return
        self._say(f"line: {line.number}")
        if self._echo in (Echo.CELLS, Echo.BOTH):
            self._say(f"cells: {line.printed.to_unicode()}")
        if self._echo in (Echo.TEXT, Echo.BOTH):
            self._say(f"text: {line.text.strip()}")

    def _turn(self, name: str, step: float) -> None:
        tuning = self.style.tuning
        value = round(min(max(getattr(tuning, name) + step, 0.0), 1.0), 6)
        if value == getattr(tuning, name):
            self._say(f"{name}: {value:g}, the {'most' if step > 0 else 'least'}")
            return
        self._say(f"{name}: {value:g}")
        self.tune(**{name: value})

    def _watch_speed(self, speed_mm_s: float) -> None:
        if self._too_fast_said or self._end.reached:
            return
        note = too_fast_note(speed_mm_s, self.style)
        if note is not None:
            self._too_fast_said = True
            self._say(note)


def too_fast_note(speed_mm_s: float, style: BrailleStyle) -> str | None:
    """What to say of a hand so fast that texture passes the filters; None if it is not."""
    if not style.tuning.texture:
        return None
    period_mm = style.profile.texture_period_mm(style.geometry.dot_width_mm, style.tuning.cycles)
    if speed_mm_s / period_mm <= FILTER_HZ:
        return None
    return (
        f"speed: {speed_mm_s:.0f} mm/s, at which texture passes {FILTER_HZ:g} Hz and fades; "
        f"below {FILTER_HZ * period_mm:.0f} mm/s it is felt"
    )
