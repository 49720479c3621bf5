"""Lines under the hand, one after the other, as the hand goes along them."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.engine.upright import Upright
from vbraille.reading.beside import Beside
from vbraille.reading.bindings import spoken
from vbraille.reading.cues import Cue
from vbraille.reading.echo import Echo
from vbraille.reading.ranged import LineRange
from vbraille.reading.surface import Surface, around, turned
from vbraille.reading.underhand import UnderHand
from vbraille.reading.whereabouts import (
    LINES_PER_PAGE,
    first_character,
    is_counted,
    line_name,
    place_sentence,
)
from vbraille.reading.window import Window
from vbraille.translate.source import BlockKind

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.engine.engine import Engine
    from vbraille.layout.pages import Layout, Line
    from vbraille.render import BrailleStyle, Model
    from vbraille.simulation.steering import Steering

_NS_PER_S = 1_000_000_000


class LineReader:
    """Somebody who reads one line after the other, each alone or on a page of several.

    The line under the hand is the one that the finger is on: on a page it changes as the finger
    goes up or down. What is put under the hand there comes into the row that the finger is in.

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
    beside
        What works beside the reader: keys of somebody's own, search, bookmarks, signals.

    Attributes
    ----------
    range : LineRange
        Lines that are read.
    under : UnderHand
        What is under the hand.
    skip_blank : bool
        Whether lines without a dot are passed over.
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
        beside: Beside | None = None,
    ) -> None:
        beside = Beside() if beside is None else beside
        self.range = LineRange(layout, first, last)
        self.engine = engine
        self.say = say
        self.echo = echo
        self.bound, self.cue, self.scroll = beside.bound, beside.cue, beside.scroll
        key = self.key("LNDN", "n") if stay else ""
        figures = beside.figures
        self.under = UnderHand(
            engine, model, steering, say, by_hand=advance, key=key, figures=figures
        )
        self.skip_blank = False
        self.lines = 0
        self.done = False
        self._upright = Upright()
        self._advance = advance
        self._stay = stay
        self._finished = False  # whether the end was said, until a key brings another line
        self._prefetched = False
        self._scrolled = 0  # how many times something was shown when scrolling began last
        self._echoed = False  # whether the line was said when it was put under the hand last

    @property
    def layout(self) -> Layout:
        """Lines of the book."""
        return self.range.layout

    @property
    def style(self) -> BrailleStyle:
        """How lines are shown."""
        return self.under.style

    @property
    def window(self) -> Window | None:
        """Part of a line that is under the hand; None before the first."""
        return self.under.window

    @property
    def line(self) -> Line | None:
        """Line under the hand; None before the first."""
        return None if self.window is None else self.window.line

    @property
    def line_number(self) -> int:
        """Number of the line under the hand; 0 before the first."""
        return 0 if self.window is None else self.window.line.number

    @property
    def cell(self) -> int | None:
        """Number of the line's cell under the middle of the array; None if there is none."""
        x_mm = self.engine.x_mm
        if self.window is None or x_mm is None or self.under.figure is not None:
            return None
        return self.window.cell_at(x_mm, self.style.geometry)

    @property
    def character(self) -> int:
        """Place of the source under the finger; where the line begins if there is none."""
        return self.character_of(self.cell)

    def character_of(self, cell: int | None) -> int:
        """Place of the source that a cell of the line stands for; where the line begins if none."""
        window = self.window
        if window is None:
            return 0
        for known in (cell, max(window.offset, 0)):
            source = None if known is None else window.line.source(known)
            if source is not None:
                return source[0]
        return first_character(window.line)

    def start(self) -> None:
        """Put the first line under the hand."""
        line = self.range.line(self.range.first)
        if line is None:
            self.done = True
        else:
            self.put(Window(line, self.under.width))

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in ticks, which are all since the last call."""
        if not ticks.size:
            return
        now_s = float(ticks["time_ns"][-1]) / _NS_PER_S
        if self.under.alone is not None:
            self.under.alone.attend(now_s)
            self.leave_figure()
            return
        for sentence in self._upright.watch(ticks[-1]):
            self.say(sentence)
        felt = self.under.felt(ticks)
        if felt.size:
            self._follow(felt)
        self.attend(now_s, resting=not felt.size)

    def _follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was while it felt the line."""
        if self.under.come_to(ticks, lambda line: line_name(self.layout, line)):
            self._came(another=True)
        was_reached = self.under.reached
        home = self.under.follow(ticks)
        if self.under.reached and not was_reached:
            self.cue(self._end_cue())
        by_hand = self._advance and not (self.scroll is not None and self.scroll.on)
        if home and by_hand and not self._finished:
            self.go_on()
            return
        if self.under.reached and not self._prefetched:
            # On the way back to the start there is time for this.
            self._prefetched = True
            self._prefetch()
        self.under.watch(ticks, finished=self._finished)

    def attend(self, now_s: float, *, resting: bool) -> None:
        """Do what is done by time: scroll, where the reader asked for that."""
        self.under.complete()
        scroll, window = self.scroll, self.window
        if scroll is not None and self._scrolled != self.under.shown:
            self._scrolled = self.under.shown
            scroll.begin(now_s)
        if scroll is None or not scroll.on or resting or self._finished or window is None:
            return
        if scroll.due(self.under.cells, now_s):
            self.go_on()

    def _end_cue(self) -> Cue:
        """Signal for the end of the line: whether it is also that of a page."""
        following = self.layout.line(self.line_number + 1)
        if following is None or (self.window is not None and self.window.right is not None):
            return Cue.LINE_END
        if following.block.kind is BlockKind.PAGE:
            return Cue.PAGE_END
        surface = self.under.surface
        if surface is not None and surface.paged:
            return Cue.PAGE_END if self.window is surface.there[-1] else Cue.LINE_END
        number = 0 if self.line is None else self.layout.number_of(self.line)
        return Cue.PAGE_END if number % LINES_PER_PAGE == 0 else Cue.LINE_END

    def leave_figure(self) -> None:
        """Go back to the text, if the reader has enough of the figure that is felt alone."""
        if self.under.alone is not None and self.under.alone.done:
            self.under.come_back()
            self._echoed = False
            self.announce()

    def go_on(self) -> None:
        """Put what follows under the hand; if there is nothing, reading is finished."""
        if self.window is None:
            return
        if self.pan(1):
            if self._paged:
                self.cue(Cue.PAGE_END)
        elif not self.turn_page(1):
            self.finish()

    def pan(self, step: int) -> bool:
        """Put the next part of the line under the hand, or the one before; False without one.

        On a page the parts of all lines are put there.
        """
        here = self._here
        surface = None if here is None else here.panned(step)
        if surface is not None:
            self._put(surface)
        return surface is not None

    def turn_page(self, step: int) -> bool:
        """Put the next page under the hand, or the one before; False if there is none.

        It is said which lines a page has. Where one line is shown, that is the page.
        """
        here = self.under.surface
        if here is None:
            return False
        if not here.paged:
            return self.go_by(step)
        page = self._turned(here, step)
        if page is None:
            return False
        self.cue(Cue.PAGE_END)
        self.say(self._page_sentence(page))
        row = self.under.row
        self._put(replace(page, row=row) if page.has(row) else page)
        return True

    def _turned(self, here: Surface, step: int) -> Surface | None:
        """The page after one, or before it; None if there are no lines."""
        under = self.under
        skip, rows = self.skip_blank, under.rows
        return turned(self.range, here, step, rows, skip_blank=skip, keep=under.keep)

    def _page_sentence(self, page: Surface) -> str:
        """Which lines a page has, or where it begins while lines are not counted."""
        first, last = page.there[0].line, page.there[-1].line
        if not is_counted(self.layout):
            return place_sentence(self.layout, first)
        numbers = [self.layout.number_of(line) for line in (first, last)]
        return (
            f"page: line {numbers[0]}" if first is last else "page: lines {} to {}".format(*numbers)
        )

    @property
    def _paged(self) -> bool:
        return self.under.surface is not None and self.under.surface.paged

    @property
    def _here(self) -> Surface | None:
        """What is under the hand, with the row that the finger is in as the one that is meant."""
        surface, window = self.under.surface, self.window
        return None if surface is None else replace(surface, row=surface.windows.index(window))

    def _prefetch(self) -> None:
        """Lay out what comes next."""
        here = self.under.surface
        if here is None:
            return
        if here.paged:
            self._turned(here, 1)
        else:
            self.layout.line(self.line_number + 1)

    def go_by(self, step: int, *, at_end: bool = False) -> bool:
        """Put the next line under the hand, or the one before; False if that is not to be read.

        Parameters
        ----------
        step
            1 for the next line, -1 for the one before; lines without dots may be passed over.
        at_end
            Whether to show the last part of the line.
        """
        line = self.range.following(self.line_number, step, skip_blank=self.skip_blank)
        if line is None:
            return False
        window = Window(line, self.under.width)
        self.put(window.last if at_end else window)
        return True

    def go(self, number: int) -> bool:
        """Put the line of a number under the hand; False if it is none of those to read."""
        line = self.range.line(number)
        if line is None:
            return False
        self.put(Window(line, self.under.width))
        return True

    def announce(self, what: str = "") -> None:
        """Say which line is under the hand, and what it is, unless its echo has just done so."""
        if not self._echoed and self.line is not None:
            self.say(place_sentence(self.layout, self.line, what))

    def key(self, name: str, usual: str) -> str:
        """Name of a key that calls a command, for a sentence."""
        keys = () if self.bound is None else self.bound.keys_of(name)
        return keys[0] if keys else spoken(usual)

    def quit(self) -> None:
        """Stop reading."""
        self.done = True

    def finish(self) -> None:
        """Come to the end of the text."""
        self.cue(Cue.LIMIT)
        if self.scroll is not None:
            self.scroll.on = False
        if self._stay:
            self._finished = True
            self.say(
                f"end of text; {self.key('LNUP', 'p')} goes back, {self.key('QUIT', 'q')} stops"
            )
        else:
            self.done = True

    def put(self, window: Window) -> None:
        """Put a part of a line under the hand; on a page, with the lines before and after it."""
        rows = self.under.rows
        if rows:
            row = self.under.row
            skip, keep = self.skip_blank, self.under.keep
            self._put(around(self.range, window, row, rows, skip_blank=skip, keep=keep))
        else:
            self._put(Surface((window,)))

    def _put(self, surface: Surface) -> None:
        another = self.line is None or self.line.number != surface.window.line.number
        self.under.put(surface, line_name(self.layout, surface.window.line))
        self._finished = False
        self._came(another=another)

    def _came(self, *, another: bool) -> None:
        """Take note that a line is under the hand, which may be the same as before."""
        line = self.line
        assert line is not None, "a line is under the hand"
        self.lines += another
        self._prefetched = False
        self._echoed = another and self.echo is not Echo.NONE
        if another:
            for sentence in self.echo.sentences(line, self.layout):
                self.say(sentence)
            key, below = self.key("FEEL", "G"), self.under.keep(line)
            for sentence in self.under.figured.sentences(line, key, below):
                self.say(sentence)
