"""A reader: lines under the hand, and all that somebody may ask for while reading."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.reading.beside import Beside
from vbraille.reading.context import Context
from vbraille.reading.keeping import Keeping
from vbraille.reading.linereader import LineReader
from vbraille.reading.prompt import Prompt
from vbraille.reading.search.queries import CountLines
from vbraille.reading.search.seeker import Search
from vbraille.reading.whereabouts import heading_name
from vbraille.reading.window import Window

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.engine.engine import Engine
    from vbraille.layout.pages import Layout
    from vbraille.reading.beside import KeptLike
    from vbraille.reading.search.queries import Counted, Query
    from vbraille.reading.search.seeker import Seeker
    from vbraille.render import BrailleStyle, Model
    from vbraille.translate import Book
    from vbraille.translate.source import Mark

_TRAIL = 100  # places that are kept to go back to


class Reader(LineReader):
    """Somebody who reads a range of lines: what is under the hand, and how far it has come.

    It speaks in sentences; `vbraille.reading.commands` calls its methods.

    Parameters
    ----------
    layout, engine, model, say
        As for a `LineReader`.
    at
        Place of the source at which to begin; None for the first line.
    beside
        What works beside the reader: keys of somebody's own, search, bookmarks, signals.
    how
        What else a `LineReader` takes.

    Attributes
    ----------
    context : Context
        Meaning of the keys at the moment.
    prompt : Prompt or None
        What is being typed.
    search : Search
        Search in the whole book.
    fold_accents : bool
        Whether a search takes letters with accents and without for the same.
    sought : str
        Text that was looked for last.
    backward : bool
        Whether it was looked for backward.
    """

    def __init__(
        self,
        layout: Layout,
        engine: Engine,
        *,
        model: Model,
        say: Callable[[str], None],
        at: int | None = None,
        beside: Beside | None = None,
        **how: Any,
    ) -> None:
        super().__init__(layout, engine, model=model, say=say, beside=beside, **how)
        beside = Beside() if beside is None else beside
        self.search = Search(say, beside.seeker, verbose=beside.verbose, counted=self._take_count)
        self.keeping = Keeping(beside.kept)
        self.save_style = beside.save_style
        self.styles_before: list[BrailleStyle] = []  # before each turn that was not taken back
        self.context = Context.READING
        self.prompt: Prompt | None = None
        # The book as it is read, and as it was before its table was changed last.
        self.book_before: tuple[Book, Book] | None = None
        self.fold_accents, self.backward = True, False
        self.sought = ""
        self.followed: Mark | None = None  # link or reference that was followed last
        # Whether lines are as wide as somebody says, and not as wide as the hand can go.
        self._fixed = layout.width != self.under.width
        self._book = layout.book  # which is the one that the other process knows
        self._counting = False
        self._at = at
        self._answers: dict[str, list[str]] = {}  # that were typed, by what they were called
        self._trail: list[int] = []
        self._hit: int | None = None

    @property
    def kept(self) -> KeptLike:
        """What is kept of the book."""
        return self.keeping.kept

    @kept.setter
    def kept(self, kept: KeptLike | None) -> None:
        self.keeping = Keeping(kept)

    def start(self) -> None:
        """Put the first line under the hand, or the one at which to begin."""
        if self._at is None or not self.jump(self._at, back=False):
            super().start()

    def attend(self, now_s: float, *, resting: bool) -> None:
        """Do what is done by time: take what was found, keep the place, scroll."""
        if self.search.seeker is not None:
            self.search.poll(self.layout.book.source, now_s)
            self._count(self.search.seeker)
        self.keeping.step(now_s)
        super().attend(now_s, resting=resting)

    def _count(self, seeker: Seeker) -> None:
        """Have the lines before this one counted, where their number is not known."""
        layout, line = self.layout, self.line
        if self._counting or layout.counted or line is None or layout.book is not self._book:
            return
        self._counting = True
        seeker.ask(CountLines(layout.width, layout.block_of(line)))

    def _take_count(self, counted: Counted) -> None:
        self._counting = False
        if counted.width == self.layout.width and self.layout.book is self._book:
            self.layout.count_from(counted.block, counted.lines)

    def _came(self, *, another: bool) -> None:
        super()._came(another=another)
        if self.line is not None:
            self.keeping.moved(self.layout, self.line)

    def jump(self, character: int, *, back: bool = True) -> bool:
        """Put the line of a place of the source under the hand; False if it is none of those.

        Parameters
        ----------
        back
            Whether to keep the present place, for `jump_back`.
        """
        before = self.character
        found = self.range.place(character)
        if found is None:
            return False
        if back:
            self.keep_way_back(before)
        line, cell = found
        self.put(Window(line, self.under.width).showing(cell))
        return True

    def finish(self) -> None:
        """Come to the end of the text; another reading begins at its beginning."""
        super().finish()
        self.keeping.start_over(self.layout)

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
            if before != after and any((before[0], after[0])) and self.window is not None:
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
        before, x_mm, geometry = self.window, self.engine.x_mm, self.style.geometry
        if style is not None:
            self.under.show_in(style)
        self._fixed = self._fixed or width is not None
        width = width or (layout.width if self._fixed else self.under.width)
        self.range = self.range.relaid(layout.book if book is None else book, width)
        found = self.range.place(character)
        if found is None:  # nothing from here on is shown any more
            self.finish()
            return
        line, new_cell = found
        window = Window(line, self.under.width)
        if before is None or cell is None or x_mm is None:
            self.put(window.showing(new_cell))
        else:
            share = before.share_at(x_mm, geometry)
            self.put(window.under(new_cell, share, x_mm, self.style.geometry))

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

    @property
    def hit(self) -> int | None:
        """Place of what was found last; None if that is not on the line under the hand."""
        line, hit = self.line, self._hit
        if line is None or hit is None or not len(line.cells):
            return None
        return hit if int(line.cells.starts[0]) <= hit < line.cells.end else None

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
        line = self.line
        self.announce(what or ("" if line is None else heading_name(line)))

    def bring_under(self, place: int) -> bool:
        """Move the line so that a place of it is under the finger, and keep that place as `hit`.

        Returns
        -------
        bool
            False if the place is not on the line under the hand, which then stays as it is.
        """
        before, found = self.window, self.range.place(place)
        if before is None or found is None or found[0].number != before.line.number:
            return False
        (line, new_cell), cell, x_mm = found, self.cell, self.engine.x_mm
        self.keep_way_back()
        self._hit = place
        window, geometry = Window(line, self.under.width), self.style.geometry
        if cell is None or x_mm is None:
            self.put(window.showing(new_cell))
        else:
            share = before.share_at(x_mm, geometry)
            self.put(window.under(new_cell, share, x_mm, geometry))
        return True

    def leave(self) -> None:
        """Keep the place at which reading goes on another time; nothing is read after this."""
        self.search.cancel()
        self.keeping.leave()
