"""A reader: the lines of a book under the hand, one after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.layout.pages import Layout
from vbraille.reading.beside import Beside
from vbraille.reading.context import Context
from vbraille.reading.cues import Cue
from vbraille.reading.echo import Echo
from vbraille.reading.keeping import Keeping
from vbraille.reading.looking import Looking
from vbraille.reading.prompt import Prompt
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
    from vbraille.layout.pages import Line
    from vbraille.reading.beside import KeptLike
    from vbraille.reading.queries import Query
    from vbraille.render import BrailleStyle, Model
    from vbraille.simulation.steering import Steering
    from vbraille.translate import Book

_TRAIL = 100  # places that are kept to go back to
_NS_PER_S = 1_000_000_000


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
    at
        Place of the source at which to begin; None for the first line.
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
    context : Context
        Meaning of the keys at the moment.
    prompt : Prompt or None
        What is being typed.
    looking : Looking
        What is looked for in the whole book.
    skip_blank : bool
        Whether lines without a dot are passed over.
    fold_accents : bool
        Whether a search takes letters with accents and without for the same.
    sought : str
        Text that was looked for last.
    backward : bool
        Whether it was looked for backward.
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
        at: int | None = None,
        advance: bool = True,
        stay: bool = False,
        echo: Echo = Echo.NONE,
        steering: Steering | None = None,
        beside: Beside | None = None,
    ) -> None:
        beside = Beside() if beside is None else beside
        self.layout = layout
        self.engine = engine
        self.say = say
        self.echo = echo
        self.bound, self.cue, self.scroll = beside.bound, beside.cue, beside.scroll
        self.seeker = beside.seeker
        self.looking = Looking(say, verbose=beside.verbose)
        self.keeping = Keeping(beside.kept)
        key = self.key("LNDN", "n") if stay else ""
        self.under = UnderHand(engine, model, steering, say, by_hand=advance, key=key)
        self.context = Context.READING
        self.prompt: Prompt | None = None
        self.skip_blank = self.fold_accents = self.backward = False
        self.sought = ""
        self.lines = 0
        self.done = False
        # Whether lines are as wide as somebody says, and not as wide as the hand can go.
        self._fixed = layout.width != self.under.width
        self._first, self._last = first, last
        self._at = at
        self._advance = advance
        self._stay = stay
        self._trail: list[int] = []
        self._hit: int | None = None
        self._finished = False  # whether the end was said, until a key brings another line
        self._prefetched = False

    @property
    def kept(self) -> KeptLike:
        """What is kept of the book."""
        return self.keeping.kept

    @kept.setter
    def kept(self, kept: KeptLike | None) -> None:
        self.keeping = Keeping(kept)

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
        if self.window is None or x_mm is None:
            return None
        return self.window.cell_at(x_mm, self.style.geometry)

    @property
    def character(self) -> int:
        """Place of the source under the finger; where the line begins if there is none."""
        return self._character_of(self.cell)

    def _character_of(self, cell: int | None) -> int:
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
        if self._at is not None and self.jump(self._at, back=False):
            return
        line = self.layout.line(self._first)
        if line is None:
            self.done = True
        else:
            self._put(Window(line, self.under.width))

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in ticks, which are all since the last call."""
        if not ticks.size:
            return
        felt = self.under.felt(ticks)
        if felt.size:
            self._follow(felt)
        self._attend(float(ticks["time_ns"][-1]) / _NS_PER_S, resting=not felt.size)

    def _follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was while it felt the line."""
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
            self.layout.line(self.line_number + 1)
        self.under.watch(ticks, finished=self._finished)

    def _attend(self, now_s: float, *, resting: bool) -> None:
        """Do what is done by time: take what was found, keep the place, scroll."""
        if self.seeker is not None:
            self.looking.poll(self.seeker, self.layout.book.source, now_s)
        self.keeping.step(now_s)
        scroll, window = self.scroll, self.window
        if scroll is None or not scroll.on or resting or self._finished or window is None:
            return
        if scroll.due(len(window), now_s):
            self.go_on()

    def _end_cue(self) -> Cue:
        """Signal for the end of the line: whether it is also that of a page."""
        following = self.layout.line(self.line_number + 1)
        if following is None or (self.window is not None and self.window.right is not None):
            return Cue.LINE_END
        if following.block.kind is BlockKind.PAGE:
            return Cue.PAGE_END
        return Cue.PAGE_END if self.line_number % LINES_PER_PAGE == 0 else Cue.LINE_END

    def go_on(self) -> None:
        """Put what follows under the hand; if there is nothing, reading is finished."""
        if self.window is not None and not self.pan(1) and not self.go_by(1):
            self._finish()

    def pan(self, step: int) -> bool:
        """Put the next part of the line under the hand, or the one before; False without one."""
        here = self.window
        window = None if here is None else here.right if step > 0 else here.left
        if window is not None:
            self._put(window)
        return window is not None

    def show_part(self, window: Window) -> None:
        """Put another part of the line under the hand."""
        self._put(window)

    def go_by(self, step: int, *, at_end: bool = False) -> bool:
        """Put the next line under the hand, or the one before; False if that is not to be read.

        Parameters
        ----------
        step
            1 for the next line, -1 for the one before; lines without dots may be passed over.
        at_end
            Whether to show the last part of the line.
        """
        number = self.line_number + step
        while self._allows(number) and (line := self.layout.line(number)) is not None:
            if not self.skip_blank or line.masks.any():
                window = Window(line, self.under.width)
                self._put(window.last if at_end else window)
                return True
            number += step
        return False

    def go(self, number: int) -> bool:
        """Put the line of a number under the hand; False if it is none of those to read."""
        line = self.layout.line(number) if self._allows(number) else None
        if line is None:
            return False
        self._put(Window(line, self.under.width))
        return True

    def jump(self, character: int, *, back: bool = True) -> bool:
        """Put the line of a place of the source under the hand; False if it is none of those.

        Parameters
        ----------
        back
            Whether to keep the present place, for `jump_back`.
        """
        before = self.character
        found = self.layout.place(character)
        if found is None or not self._allows(found[0].number):
            return False
        if back:
            self.keep_way_back(before)
        line, cell = found
        self._put(Window(line, self.under.width).showing(cell))
        return True

    def keep_way_back(self, character: int | None = None) -> None:
        """Have `jump_back` go to a place, the present one if none is given."""
        self._trail.append(self.character if character is None else character)
        del self._trail[:-_TRAIL]

    def jump_back(self) -> bool:
        """Go back to where the reader was before the last jump; False if there was none."""
        return bool(self._trail) and self.jump(self._trail.pop(), back=False)

    @property
    def limits(self) -> tuple[int, int | None]:
        """Numbers of the first and the last line to read; None for the end."""
        return self._first, self._last

    def tune(self, **turned: Any) -> None:
        """Show this line and those after it in another style, with values as `BrailleStyle` has.

        Where distances change the text is laid out again, and what is under the finger stays
        there.

        Raises
        ------
        InputError
            If a value is out of range.
        """
        self.show_in(self.style.replace(**turned))

    def show_in(self, style: BrailleStyle) -> None:
        """Show this line and those after it in a style, laid out again if its distances differ.

        Raises
        ------
        InputError
            If there is no room for a cell.
        """
        width = self.under.width_in(style)
        pitch_mm = self.style.geometry.cell_pitch_mm
        if (style.geometry.cell_pitch_mm, width) == (pitch_mm, self.under.width):
            self.under.show_in(style)
        else:
            self.lay_out_again(style=style)

    def lay_out_again(
        self,
        book: Book | None = None,
        width: int | None = None,
        style: BrailleStyle | None = None,
    ) -> None:
        """Lay the text out in another way; the character under the finger stays under it.

        Parameters
        ----------
        book
            The text in other cells, as by another table.
        width
            Number of cells in a line; None for what it was, or for what the style has room for.
        style
            How lines are shown; None for what it was.

        Raises
        ------
        InputError
            If there is no room for a cell.
        """
        cell, character, before = self.cell, self.character, self.layout
        if style is not None:
            self.under.show_in(style)
        self._fixed = self._fixed or width is not None
        lines = width or (before.width if self._fixed else self.under.width)
        self.layout = Layout(before.book if book is None else book, lines)
        self._first, self._last = self._limits_in(before)
        found = self.layout.place(character)
        if found is None:  # nothing from here on is shown any more
            self._finish()
            return
        line, new_cell = found
        window = Window(line, self.under.width)
        x_mm = self.engine.x_mm
        if cell is None or x_mm is None:
            self._put(window.showing(new_cell))
        else:
            self._put(window.under(new_cell, x_mm, self.style.geometry))

    def _limits_in(self, before: Layout) -> tuple[int, int | None]:
        """First and last line to read, whose numbers were those of another layout."""
        numbers: list[int | None] = []
        for number in (self._first, self._last):
            line = before.line(number) if number is not None and number > 1 else None
            place = None if line is None else self.layout.place(first_character(line))
            numbers.append(number if place is None else place[0].number)
        return numbers[0] or 1, numbers[1]

    def find(self, query: Query, then: Callable[[int | None], None]) -> None:
        """Look for something in the book, and call a function with its place, or None.

        What is near comes at once; what is far may come while reading goes on.
        """
        self.looking.find(self.layout.book.source, query, then, self.seeker)

    def ask(
        self,
        what: str,
        how: str,
        label: str,
        then: Callable[[Reader, str], None],
        *,
        again: str = "",
    ) -> None:
        """Ask for a text, which is then typed in silence.

        Parameters
        ----------
        what, how
            What it is for, and how it is typed.
        label
            What the text is called when it is said.
        then
            Function that is called with the reader and the text.
        again
            The text if nothing is typed.
        """
        self.prompt = Prompt(label, lambda text: then(self, text), again)
        self.context = Context.PROMPT
        self.say(f"{what}: {how}")

    @property
    def hit(self) -> int | None:
        """Place of what was found last; None if that is not on the line under the hand."""
        line, hit = self.line, self._hit
        if line is None or hit is None or not len(line.cells):
            return None
        return hit if int(line.cells.starts[0]) <= hit < line.cells.end else None

    def arrive(self, place: int | None) -> bool:
        """Go to what was found, say which line that is, and keep it as `hit`; False if none."""
        if place is None or not self.jump(place):
            return False
        self._hit = place
        self.announce()
        return True

    def announce(self) -> None:
        """Say which line is under the hand, unless its echo does."""
        if self.echo is Echo.NONE and self.line is not None:
            self.say(place_sentence(self.layout, self.line))

    def key(self, name: str, usual: str) -> str:
        """Key that calls a command, for a sentence."""
        keys = () if self.bound is None else self.bound.keys_of(name)
        return keys[0] if keys else usual

    def quit(self) -> None:
        """Stop reading."""
        self.done = True

    def leave(self) -> None:
        """Keep the place at which reading goes on another time; nothing is read after this."""
        self.looking.cancel(self.seeker)
        self.keeping.leave()

    def _allows(self, number: int) -> bool:
        if self._last is not None and number > self._last:
            return False
        return number >= self._first or (self._first == 1 and not is_counted(self.layout))

    def _finish(self) -> None:
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

    def _put(self, window: Window) -> None:
        another = self.line is None or self.line.number != window.line.number
        self.under.put(window, line_name(self.layout, window.line))
        self.lines += another
        self._finished = self._prefetched = False
        if another:
            for sentence in self.echo.sentences(window.line, self.layout):
                self.say(sentence)
        self.keeping.moved(self._character_of(None))
