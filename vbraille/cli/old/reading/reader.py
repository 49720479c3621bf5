"""A reader: lines under the hand, and all that a person may ask for while reading."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from vbraille.cli.old.reading.advancing import Scroll
from vbraille.cli.old.reading.keys import Context
from vbraille.cli.old.reading.lineviews import TextView
from vbraille.cli.old.reading.outputs import Echo
from vbraille.cli.old.reading.position import (
    LINES_PER_PAGE,
    heading_name,
    line_name,
    page_label,
    place_sentence,
)
from vbraille.cli.old.reading.search.questions import CountLines
from vbraille.cli.old.reading.search.seeker import Search
from vbraille.cli.old.reading.view import Cue, Prompt, View
from vbraille.cli.old.reading.viewport import LineRange, Surface, Window, around, turned
from vbraille.engine.engine import Upright
from vbraille.errors import InputError
from vbraille.translate import BlockKind

if TYPE_CHECKING:
    from collections.abc import Callable

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.cli.old.reading.keptplace import Bookmark
    from vbraille.cli.old.reading.keys import Bound
    from vbraille.cli.old.reading.library import KeptBook
    from vbraille.cli.old.reading.lineviews import Figures
    from vbraille.cli.old.reading.search.questions import Counted, Query
    from vbraille.cli.old.reading.search.seeker import Seeker
    from vbraille.engine.engine import Engine
    from vbraille.layout import Layout, Line
    from vbraille.render import BrailleStyle, Model
    from vbraille.render.braille.mappings import Mapping
    from vbraille.simulation.steering import Steering
    from vbraille.translate import Book, Mark, Source

_NS_PER_S = 1_000_000_000
_KEPT_EVERY_S = 1.0
_TRAIL = 100  # places that are kept to go back to


class Unkept:
    """Bookmarks that last no longer than a reading."""

    fault: str | None = None

    def __init__(self) -> None:
        self._marks: dict[str, Bookmark] = {}

    def bookmarks(self) -> list[Bookmark]:
        """Give all bookmarks, by their place."""
        return sorted(self._marks.values(), key=lambda mark: mark.character)

    def set_bookmark(self, bookmark: Bookmark) -> None:
        """Set a bookmark."""
        self._marks[bookmark.name] = bookmark

    def delete_bookmark(self, name: str) -> None:
        """Delete a bookmark."""
        self._marks.pop(name, None)

    def tend(self) -> None:
        """Write nothing: all is only remembered."""

    def keep_at(self, source: Source, character: int, **place: Any) -> None:
        """Keep no place: there is no other time."""


class PlaceKeeper:
    """Keep the place of a reading, at most once a second.

    Parameters
    ----------
    kept
        Where it is kept; None for nowhere.
    """

    def __init__(self, kept: KeptBook | None) -> None:
        self.kept: KeptBook | Unkept = Unkept() if kept is None else kept
        self._place: tuple[Layout, Line] | None = None  # one that is not kept yet
        self._last_s: float | None = None

    def moved(self, layout: Layout, line: Line) -> None:
        """Take a line at which reading is to go on."""
        self._place = layout, line

    def step(self, now_s: float) -> None:
        """Keep the place, and what could not be kept before, if it is time; called all the time."""
        if self._last_s is None or now_s - self._last_s >= _KEPT_EVERY_S:
            self._last_s = now_s
            self.kept.tend()
            self.leave()

    def start_over(self, layout: Layout) -> None:
        """Keep the beginning, since the text was read to its end."""
        self._place = None
        self._keep(layout, 0, line=1, lines_before=0)

    def leave(self) -> None:
        """Keep the place now."""
        if self._place is None:
            return
        (layout, line), self._place = self._place, None
        self._keep(
            layout,
            line.place,
            line=layout.number_of(line) if layout.counted else None,
            lines_before=layout.lines_before(line),
            page=page_label(layout.book.source, line),
        )

    def _keep(self, layout: Layout, character: int, **told: Any) -> None:
        source, table = layout.book.source, layout.book.table
        name = "" if table is None else table.name
        self.kept.keep_at(source, character, width=layout.width, table=name, **told)


class Reader(View):
    """A reading of one line after the other, each alone or on a page of several.

    The line under the hand is the one that the finger is on: on a page it changes as the finger
    goes up or down. What is put under the hand there comes into the row that the finger is in.
    It speaks in sentences; `vbraille.cli.old.reading.commands` calls its methods.

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
    bound
        Keys and buttons of commands.
    seeker
        Process that looks through the whole book; None to do so here.
    kept
        What is kept of the book between two readings; None to keep it while this one lasts.
    cue
        Function that is called with short signals, beside the sentences.
    save_style
        Function that saves how braille feels, and gives a sentence on that; None if nothing does.
    verbose
        Whether more is said, such as how far a search has come.
    figures
        Function that gives the figures of the text, called when there is one; None if they stay
        unfelt.

    Attributes
    ----------
    range : LineRange
        Lines that are read.
    under : TextView
        What is under the hand.
    scroll : Scroll
        Brings lines by time, when it is on.
    search : Search
        Search in the whole book.
    fold_accents : bool
        Whether a search takes letters with accents and without for the same.
    sought : str
        Text that was looked for last.
    backward : bool
        Whether it was looked for backward.
    lines : int
        Number of lines read so far: those that were under the hand.
    beside : Mapping or None
        Mapping in which the live view shows the line beside the array; None for none.
    """

    does, doing = "read", "reading"

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
        bound: Bound,
        seeker: Seeker | None = None,
        kept: KeptBook | None = None,
        cue: Callable[[Cue], None] = lambda _: None,
        save_style: Callable[[BrailleStyle], str] | None = None,
        verbose: bool = False,
        figures: Callable[[], Figures] | None = None,
    ) -> None:
        super().__init__(engine, say, bound, cue)
        self.range = LineRange(layout, first, last)
        self.echo = echo
        self.scroll = Scroll()
        key = self.key("LNDN", "n") if stay else ""
        self.under = TextView(
            engine, model, steering, say, by_hand=advance, key=key, figures=figures
        )
        self.search = Search(say, seeker, verbose=verbose, counted=self._take_count)
        self.keeping = PlaceKeeper(kept)
        self.save_style = save_style
        self.styles_before: list[BrailleStyle] = []  # before each turn that was not taken back
        # The book as it is read, and as it was before its table was changed last.
        self.book_before: tuple[Book, Book] | None = None
        self.fold_accents, self.backward = True, False
        self.sought = ""
        self.followed: Mark | None = None  # link or reference that was followed last
        self.lines = 0
        self.beside: Mapping | None = None
        # Whether lines are as wide as the user says, and not as wide as the hand can go.
        self._fixed = layout.width != self.under.width
        self._book = layout.book  # which is the one that the other process knows
        self._counting = False
        self._at = at
        self._answers: dict[str, list[str]] = {}  # that were typed, by what they were called
        self._trail: list[int] = []
        self._hit: int | None = None
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
        """Style in which lines are shown."""
        return self.under.style

    @property
    def window(self) -> Window:
        """Part of a line that is under the hand, once reading has started."""
        return self.under.window

    @property
    def line(self) -> Line:
        """Line under the hand, once reading has started."""
        return self.window.line

    @property
    def cell(self) -> int | None:
        """Number of the line's cell under the middle of the array; None if there is none."""
        x_mm = self.engine.x_mm
        if x_mm is None or self.under.figure is not None:
            return None
        return self.window.cell_at(x_mm, self.style.geometry)

    @property
    def character(self) -> int:
        """Place of the source under the finger; where the line begins if there is none."""
        return self.character_of(self.cell)

    def character_of(self, cell: int | None) -> int:
        """Place of the source that a cell of the line stands for; where the line begins if none."""
        window = self.window
        for known in (cell, max(window.offset, 0)):
            source = None if known is None else window.line.source(known)
            if source is not None:
                return source[0]
        return window.line.place

    @property
    def kept(self) -> KeptBook | Unkept:
        """Book as it is kept."""
        return self.keeping.kept

    @property
    def hit(self) -> int | None:
        """Place of what was found last; None if that is not on the line under the hand."""
        line, hit = self.line, self._hit
        if hit is None or not len(line.cells):
            return None
        return hit if int(line.cells.starts[0]) <= hit < line.cells.end else None

    def listener(self) -> View:
        """Give the figure that is felt alone, or this reader."""
        self.leave_figure()
        return self.under.alone or self

    def steer(self) -> None:
        """Have a simulated hand read what is under it."""
        self.under.steer()

    def start(self) -> None:
        """Put the first line under the hand, or the one at which to begin.

        Raises
        ------
        InputError
            If there is no line to read.
        """
        if self._at is not None and self.jump(self._at, back=False):
            return
        first, last = self.range.first, self.range.last
        if first < 1:
            raise InputError(f"first is {first}; it must be 1 or more")
        if last is not None and last < first:
            raise InputError(f"last is {last} and first is {first}; last must not be before first")
        if not self.go(first):
            raise InputError(
                f"the text ends at line {self.layout.count()}; line {first} is past that"
            )

    def step(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand was in ticks, which are all since the last call."""
        if not ticks.size:
            return
        now_s = float(ticks["time_ns"][-1]) / _NS_PER_S
        if self.under.alone is not None:
            self.under.alone.step(ticks)
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
        by_hand = self._advance and not self.scroll.on
        if home and by_hand and not self._finished:
            self.go_on()
            return
        if self.under.reached and not self._prefetched:
            # On the way back to the start there is time for this.
            self._prefetched = True
            self._prefetch()
        self.under.watch(ticks, finished=self._finished)

    def attend(self, now_s: float, *, resting: bool = False) -> None:
        """Do what is done by time: take what was found, keep the place, scroll.

        Parameters
        ----------
        now_s
            Time in seconds by a clock that does not go back.
        resting
            Whether the array rests, so that nothing is read.
        """
        if self.search.seeker is not None:
            self.search.poll(self.layout.book.source, now_s)
            self._count(self.search.seeker)
        self.keeping.step(now_s)
        self.under.complete()
        if self._scrolled != self.under.shown:
            self._scrolled = self.under.shown
            self.scroll.begin(now_s)
        waits = resting or self._finished
        if self.scroll.on and not waits and self.scroll.due(self.under.cells, now_s):
            self.go_on()

    def _count(self, seeker: Seeker) -> None:
        """Have the lines before this one counted, where their number is not known."""
        layout = self.layout
        if self._counting or layout.counted or layout.book is not self._book:
            return
        self._counting = True
        seeker.ask(CountLines(layout.width, layout.block_of(self.line)))

    def _take_count(self, counted: Counted) -> None:
        self._counting = False
        if counted.width == self.layout.width and self.layout.book is self._book:
            self.layout.count_from(counted.block, counted.lines)

    def _end_cue(self) -> Cue:
        """Signal for the end of the line: whether it is also that of a page."""
        following = self.layout.line(self.line.number + 1)
        if following is None or self.window.right is not None:
            return Cue.LINE_END
        if following.block.kind is BlockKind.PAGE:
            return Cue.PAGE_END
        surface = self.under.surface
        if surface.paged:
            return Cue.PAGE_END if self.window is surface.there[-1] else Cue.LINE_END
        number = self.layout.number_of(self.line)
        return Cue.PAGE_END if number % LINES_PER_PAGE == 0 else Cue.LINE_END

    def leave_figure(self) -> None:
        """Go back to the text, if the reader has enough of the figure that is felt alone."""
        if self.under.alone is not None and self.under.alone.done:
            self.under.come_back()
            self._echoed = False
            self.announce()

    def go_on(self) -> None:
        """Put what follows under the hand; if there is nothing, reading is finished."""
        if self.pan(1):
            if self.under.surface.paged:
                self.cue(Cue.PAGE_END)
        elif not self.turn_page(1):
            self.finish()

    def pan(self, step: int) -> bool:
        """Put the next part of the line under the hand, or the one before; False without one.

        On a page the parts of all lines are put there.
        """
        surface = self.under.surface.panned(step)
        if surface is not None:
            self._put(surface)
        return surface is not None

    def turn_page(self, step: int) -> bool:
        """Put the next page under the hand, or the one before; False if there is none.

        It is said which lines a page has. Where one line is shown, that is the page.
        """
        if not self.under.surface.paged:
            return self.go_by(step)
        page = self._turned(step)
        if page is None:
            return False
        self.cue(Cue.PAGE_END)
        self.say(self._page_sentence(page))
        row = self.under.row
        self._put(replace(page, row=row) if page.has(row) else page)
        return True

    def _turned(self, step: int) -> Surface | None:
        """The page after the present one, or before it; None if there are no lines."""
        return turned(self.range, self.under.surface, step, self.under.rows, self.under.keep)

    def _page_sentence(self, page: Surface) -> str:
        """Say the lines of a page, or its beginning while lines are not counted."""
        first, last = page.there[0].line, page.there[-1].line
        if not self.layout.counted:
            return place_sentence(self.layout, first)
        numbers = [self.layout.number_of(line) for line in (first, last)]
        return (
            f"page: line {numbers[0]}" if first is last else "page: lines {} to {}".format(*numbers)
        )

    def _prefetch(self) -> None:
        """Lay out what comes next."""
        if self.under.surface.paged:
            self._turned(1)
        else:
            self.layout.line(self.line.number + 1)

    def go_by(self, step: int, *, at_end: bool = False) -> bool:
        """Put the next line under the hand, or the one before; False if that is not to be read.

        Parameters
        ----------
        step
            1 for the next line, -1 for the one before; lines without dots may be passed over.
        at_end
            Whether to show the last part of the line.
        """
        line = self.range.following(self.line.number, step)
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
        if not self._echoed:
            self.say(place_sentence(self.layout, self.line, what))

    def finish(self) -> None:
        """Come to the end of the text; another reading begins at its beginning."""
        self.cue(Cue.LIMIT)
        self.scroll.on = False
        if self._stay:
            self._finished = True
            self.say(
                f"end of text; {self.key('LNUP', 'p')} goes back, {self.key('QUIT', 'q')} stops"
            )
        else:
            self.done = True
        self.keeping.start_over(self.layout)

    def jump(self, character: int, *, back: bool = True) -> bool:
        """Put the line of a place of the source under the hand; False if it is none of those.

        Parameters
        ----------
        back
            Whether to keep the present place, for `jump_back`.
        """
        found = self.range.place(character)
        if found is None:
            return False
        if back:
            self.keep_way_back()
        line, cell = found
        self.put(Window(line, self.under.width).showing(cell))
        return True

    def arrive(self, place: int | None, what: str = "") -> bool:
        """Go to what was found, and keep it as `hit`.

        Parameters
        ----------
        place
            Place of the source; None for none.
        what
            Words for what was found, which are said with the line; empty for a heading's, if the
            line is one.

        Returns
        -------
        bool
            Whether it is among the lines that are read.
        """
        if place is None or not self.jump(place):
            return False
        self._hit = place
        self.announce_jump(what)
        return True

    def announce_jump(self, what: str = "") -> None:
        """Say which line a jump has led to, and which heading, or something else, that is."""
        self.announce(what or heading_name(self.line))

    def bring_under(self, place: int) -> bool:
        """Move the line so that a place of it is under the finger, and keep that place as `hit`.

        Returns
        -------
        bool
            False if the place is not on the line under the hand, which then stays as it is.
        """
        before, found = self.window, self.range.place(place)
        if found is None or found[0].number != before.line.number:
            return False
        cell = self.cell
        self.keep_way_back()
        self._hit = place
        self._put_under_finger(*found, before, cell, self.style.geometry)
        return True

    def keep_way_back(self, character: int | None = None) -> None:
        """Have `jump_back` go to a place, the present one if none is given."""
        self._trail.append(self.character if character is None else character)
        del self._trail[:-_TRAIL]

    def jump_back(self) -> bool:
        """Go back to where the reader was before the last jump; False if there was none."""
        if not self._trail:
            return False
        self._hit = self._trail.pop()
        return self.jump(self._hit, back=False)

    def find(self, query: Query, then: Callable[[Any], None]) -> None:
        """Look for something in the book, and call a function with its place, or None.

        What is near comes at once; what is far may come while reading goes on.
        """
        self.search.find(self.layout.book.source, query, then)

    def ask(
        self,
        what: str,
        how: str,
        label: str,
        then: Callable[[Reader, str], None],
        *,
        again: str = "",
        others: list[str] | None = None,
        at: int | None = None,
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
        others, at
            Texts that can be brought instead of being typed, and which of them is the present one;
            None for what was typed under the label before.
        """
        if others is None:
            others = self._answers.setdefault(label, [])
        self.prompt = Prompt(label, lambda text: then(self, text), again, others, at)
        self.context = Context.PROMPT
        self.say(f"{what}: {how}")

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
            before = self.under.rows, self.style.geometry.line_pitch_mm
            self.under.show_in(style)
            after = self.under.rows, style.geometry.line_pitch_mm
            if before != after and any((before[0], after[0])):
                self.put(self.window)  # the lines of a page stand elsewhere, or there are more
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
        cell, character, layout = self.cell, self.character, self.layout
        before, geometry = self.window, self.style.geometry
        if style is not None:
            self.under.show_in(style)
        self._fixed = self._fixed or width is not None
        width = width or (layout.width if self._fixed else self.under.width)
        self.range = self.range.relaid(layout.book if book is None else book, width)
        found = self.range.place(character)
        if found is None:  # nothing from here on is shown any more
            self.finish()
            return
        self._put_under_finger(*found, before, cell, geometry)

    def _put_under_finger(
        self, line: Line, cell: int, before: Window, at: int | None, geometry: Geometry
    ) -> None:
        """Put a cell of a line where another one was: under the finger, if that was on one.

        Parameters
        ----------
        before, at
            Part of a line and its cell that were there; None for no cell.
        geometry
            Distances in which it was shown.
        """
        window, x_mm = Window(line, self.under.width), self.engine.x_mm
        if at is None or x_mm is None:
            self.put(window.showing(cell))
        else:
            share = before.share_at(x_mm, geometry)
            self.put(window.under(cell, share, x_mm, self.style.geometry))

    def put(self, window: Window) -> None:
        """Put a part of a line under the hand; on a page, with the lines before and after it."""
        under = self.under
        if under.rows:
            self._put(around(self.range, window, under.row, under.rows, under.keep))
        else:
            self._put(Surface((window,)))

    def _put(self, surface: Surface) -> None:
        another = not self.under.shown or self.line.number != surface.window.line.number
        self.under.put(surface, line_name(self.layout, surface.window.line))
        self._finished = False
        self._came(another=another)

    def _came(self, *, another: bool) -> None:
        """Take note that a line is under the hand, which may be the same as before."""
        line = self.line
        self.lines += another
        self._prefetched = False
        self._echoed = another and self.echo is not Echo.NONE
        if another:
            for sentence in self.echo.sentences(line, self.layout):
                self.say(sentence)
            key, below = self.key("FEEL", "G"), self.under.keep(line)
            for sentence in self.under.figured.sentences(line, key, below):
                self.say(sentence)
        self.keeping.moved(self.layout, line)

    def leave(self) -> None:
        """Keep the place at which reading goes on another time; nothing is read after this."""
        self.search.cancel()
        self.keeping.leave()
