"""A book under the hand: the line that is read, how it feels, and the ways through it."""

from __future__ import annotations

import math
import sys
import unicodedata
from typing import TYPE_CHECKING, Any

from vbraille.braille.cells import dots_of
from vbraille.errors import InputError, VbrailleError
from vbraille.layout import Layout
from vbraille.reading.commands import Where
from vbraille.reading.hand import HELD, HandWatch
from vbraille.reading.outputs import Cue
from vbraille.reading.places import around, nearest
from vbraille.reading.surface import Part, Surface

if TYPE_CHECKING:
    import re
    from collections.abc import Callable, Iterator, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from vbraille.layout import Line
    from vbraille.reading.device import ReadingDevice
    from vbraille.reading.figures import BookFigures
    from vbraille.reading.outputs import Output
    from vbraille.reading.places import KeptBook
    from vbraille.render import BrailleStyle
    from vbraille.translate import Book

_GATHERED, _COUNTED = 20, 2  # blocks at a time, for a search to come and for numbers of lines
_MOST_UNCOUNTED = 50  # blocks that are laid out for the number of a line, which take 0.1 s
_KEPT_EVERY_S, _WATCHED_EVERY_S = 0.3, 0.5
_LONGEST_S = 0.25  # from one look to the next, as far as scrolling by time is concerned
_TRAIL = 100  # places that are kept to go back to


class Reader(Surface):
    """A book, the line of it under the hand, and the style that it is shown in.

    Parameters
    ----------
    book
        The book.
    device, outputs, key_set
        As of `Explored`.
    kept
        Where the place in the book and its bookmarks are kept.
    lines
        Numbers of the first and last line to read; None for the end.
    cells
        Number of cells in a line; None for as many as the hand can go over.
    attended
        Whether a person is at a keyboard, so that the end of the book is not the end of reading.
    by_hand
        Whether the next line comes when the hand returns.
    echo
        What is printed of each line; with "none", commands say which line they lead to.
    figures
        The figures of the book; None if none is felt.
    save
        Function that saves a style in a profile, and gives a sentence on that.
    changed
        Function that gives the book anew if its file has changed; None if it has not.

    Attributes
    ----------
    first, last : int
        Places at which the first line to read begins, and the last one.
    back : list[int]
        Places before jumps.
    undo : list[BrailleStyle]
        Styles before changes.
    lines_read : int
        Number of lines that were under the hand.

    Raises
    ------
    InputError
        If there is no such line.
    """

    where = Where.BOOK

    def __init__(
        self,
        book: Book,
        device: ReadingDevice,
        outputs: Sequence[Output],
        kept: KeptBook,
        *,
        lines: tuple[int, int | None] = (1, None),
        cells: int | None = None,
        key_set: str = "usual",
        attended: bool = True,
        by_hand: bool = True,
        echo: str = "none",
        figures: BookFigures | None = None,
        save: Callable[[BrailleStyle], str] | None = None,
        changed: Callable[[], Book | None] = lambda: None,
    ) -> None:
        super().__init__(device, outputs, key_set, device.model.style, by_hand=by_hand)
        self.kept, self.figures, self.save, self.attended = kept, figures, save, attended
        self._cells, self._echo, self._changed = cells, echo, changed
        self.layout = Layout(book, cells or self.width)
        first = self.layout.line(lines[0])
        last = None if lines[1] is None else self.layout.line(lines[1])
        if first is None:
            count = self.layout.count()
            raise InputError(
                f"{book.source.name} has {count} lines; line {lines[0]} is past the end"
            )
        self._start, self.first = first, first.place
        self.last = sys.maxsize if last is None else last.place
        self.back: list[int] = []
        self.undo: list[BrailleStyle] = []
        self.pattern: re.Pattern[str] | None = None  # what is searched for
        self.forward = True
        self.typed: dict[str, list[str]] = {}  # by question
        self.skip_blank = False
        self.scroll_cells_s = self._cells_due = 0.0  # cells a second by time; 0 for by hand
        self.has_pages: bool | None = None  # whether the book says where pages begin, once known
        self.note_from: int | None = None  # place of the reference that led to a note
        self.lines_read = 0
        self._found: int | None = None  # place of the last hit or mark that was gone to
        self._ticked_s = self._kept_s = self._watched_s = 0.0
        self._unkept: Line | None = None
        self._counts = True  # whether lines ahead are still counted
        self._ended = self._figure_due = False  # whether the end was said, and what is to be said

    def begin(self) -> None:
        """Put the line at the place that is kept under the hand, or the first of those to read."""
        found = self.layout.place(self.kept.find(self.book.source, self.say))
        self.show(found[0] if found and self.has(found[0]) else self._start)

    # What is there

    @property
    def book(self) -> Book:
        """The book."""
        return self.layout.book

    @property
    def line(self) -> Line:
        """Line under the hand."""
        return self.part.line

    @property
    def lines(self) -> list[Line]:
        """Lines that are shown."""
        return [part.line for part in self.parts if part is not None]

    @property
    def text(self) -> str:
        """Text of the line under the hand."""
        return self.line.text.strip()

    @property
    def line_masks(self) -> NDArray[np.uint8]:
        """Dot masks of the line under the hand, uint8[cells]."""
        return self.line.masks

    @property
    def _finger(self) -> int | None:
        """Number of the cell under the finger, from the left of what is shown."""
        x_mm = self.device.x_mm
        return None if x_mm is None else math.floor(x_mm / self.style.geometry.cell_pitch_mm)

    @property
    def cell(self) -> int | None:
        """Cell of the line under the finger; None if there is none."""
        part, finger = self.part, self._finger
        if finger is None or not max(-part.first, 0) <= finger < len(part):
            return None
        return part.first + finger

    @property
    def place(self) -> int:
        """Place in the text of the cell under the finger, or of the first that is shown."""
        for cell in (self.cell, max(self.part.first, 0)):
            span = None if cell is None else self.line.source(cell)
            if span is not None:
                return span[0]
        return self.line.place

    @property
    def found_here(self) -> int | None:
        """Place of the last hit or mark that was gone to, if it is on the line; otherwise None."""
        line, found = self.line, self._found
        return found if found is not None and line.place <= found < line.end else None

    @property
    def named(self) -> str:
        """Name of the line in sentences: "line 12", or where it is in a text not yet counted."""
        if self.is_counted(self.line):
            return f"line {self.layout.number(self.line)}"
        return f"at {100 * self.book.source.progress(self.line.place):.0f} percent"

    def is_counted(self, line: Line) -> bool:
        """Tell whether the number of a line is known, or soon found."""
        return line.block.number - self.layout.counted <= _MOST_UNCOUNTED

    def has(self, line: Line) -> bool:
        """Tell whether a line is among those that are read."""
        end = max(line.place, line.end - 1)  # the place of a blank line is its only one
        return line.place <= self.last and end >= self.first

    def beside(self, step: int) -> Line | None:
        """Line after the one under the hand, or before it where the step is -1."""
        return self._neighbour(self.line, step)

    def _neighbour(self, line: Line, step: int) -> Line | None:
        """Line after one, or before it, of those that are read."""
        following = self.layout.beside(line, step)
        while following is not None and self.skip_blank and not following.masks.any():
            following = self.layout.beside(following, step)
        return following if following is not None and self.has(following) else None

    def echoed(self, echo: str) -> Iterator[str]:
        """Sentences that are printed of the line: its number, its cells and its text."""
        if echo != "none":
            yield self.named.replace("line ", "line: ")
        yield from super().echoed(echo)

    # What is under the hand

    def show(self, line: Line, cell: int = 0, *, under: bool = False) -> None:
        """Put the part of a line with a cell under the hand, or that cell under the finger."""
        before, finger = self.parts and self.line, self._finger
        first = max(cell, 0) // self.width * self.width
        if under and finger is not None:
            first = cell - min(max(finger, 0), self.width - 1)
        row = self.finger_row if 0 <= self.finger_row < self.rows else 0
        self._lay(Part(line, self.width, first), row)
        self._arrive(another=before != line)

    def _lay(self, part: Part, row: int) -> None:
        """Show a part of a line, on a page in a row with the lines around it."""
        above = self._beyond(part, -1, row)[::-1]
        below = self._beyond(part, 1, self.rows - row - 1)
        self.show_parts([*[None] * (row - len(above)), *above, part, *below], row)

    def _beyond(self, part: Part, step: int, most: int) -> list[Part]:
        """Parts of the lines after that of a part, or before it."""
        # Where a part was moved under the finger, the others begin where they do.
        first = part.first if part.first >= 0 and part.first % part.width == 0 else 0
        line, found = part.line, list[Part]()
        while len(found) < most and (line := self._neighbour(line, step)) is not None:
            found.append(Part(line, part.width, first))
        return found

    def _arrive(self, *, another: bool = True) -> None:
        """Tell of the line that is under the hand now."""
        self._ended = False
        self._unkept = self.line
        self._cells_due = max(len(self.part), 1)
        self._watch = HandWatch(
            self.display.span_mm,
            self.end_mm,
            self.named,
            by_hand=self.by_hand and not self.rows,
            otherwise="n brings the next line" if self.attended else "Ctrl-C stops",
        )
        if another:
            self.lines_read += 1
            for output in self.outputs:
                output.show(self)
            self._figure_due = self.figures is not None

    def announce(self, what: str = "") -> None:
        """Say which line a command has led to, unless that is printed already."""
        if self._echo == "none":
            self.say(f"{what}, {self.named}" if what else self.named)

    def jump(self, place: int, what: str = "", *, remember: bool = True) -> None:
        """Go to a place of the text, and say what is there; refuse it if that is not read."""
        found = self.layout.place(place)
        if found is None or not self.has(found[0]):
            self.refuse("outside the lines being read")
            return
        if remember:
            self._remember()
        line, cell = found
        if what and self._echo != "none":
            self.say(what)
        self.show(line, cell, under=line == self.line and self.cell is not None)
        self._found = place
        self.announce(what)

    def _remember(self) -> None:
        self.back.append(self.place)
        del self.back[:-_TRAIL]

    def follow(self, ticks: NDArray[np.void]) -> None:
        """Look where the hand went, and give what follows once it is done with this."""
        followed = self.track(ticks)
        if followed is None:
            self._watch.rest()
            return
        if followed.line:
            self._arrive()
        if followed.reached:
            following = self.beside(1)
            last = following is None or following.block.page_number
            if self.rows:
                last = self.line is self.lines[-1]
            self.say("", Cue.PAGE_END if last else Cue.LINE_END)
        tick, alone = ticks[-1], self.device.hand_done and not self.attended
        felt = int(tick["line"]) == self.number and not int(tick["flags"]) & HELD
        missed = alone and felt  # the end, between two ticks
        asked = followed.done and self.by_hand and not self.scroll_cells_s and not self._ended
        if missed and self.device.once:
            self.done = True
        elif missed or asked:
            self.go_on()
        elif not self._ended:
            patient = self.device.held
            for sentence in self._watch.watch(ticks, reached=self.reached, patient=patient):
                self.say(sentence)
            self.hopeless = self._watch.hopeless

    def go_on(self) -> None:
        """Give the next part of the line, or what follows; at the end, say so."""
        if self.pan(1) or self.turn_page(1):
            return
        self.scroll_cells_s = 0.0
        self._unkept = None
        self.kept.keep(0, 0.0, "")  # another reading begins at the beginning
        if self.attended:
            self._ended = True
            self.say("end of the text", Cue.LIMIT)
        else:
            self.done = True

    def pan(self, step: int) -> bool:
        """Show the next parts of the lines, or those before; False if there are none."""
        here = self.part
        first = max(here.first + step * here.width, 0)
        if (step < 0 and here.first <= 0) or first >= max(map(len, self.lines)):
            return False
        moved = [part and Part(part.line, part.width, first) for part in self.parts]
        self.show_parts(moved, self.row)
        self._arrive(another=False)
        return True

    def turn_page(self, step: int) -> bool:
        """Show the next page of the surface, or the one before; False if there is none."""
        line = self._neighbour(self.lines[-1 if step > 0 else 0], step)
        if line is None:
            return False
        part = Part(line, self.width)
        if step < 0:
            part = [part, *self._beyond(part, -1, self.rows - 1)][-1]
        self._lay(part, 0)
        if 0 <= self.finger_row < len(self.parts):
            self.enter(self.finger_row)
        if self.rows:
            first, *others = self.lines
            said = self.named
            if others and self.is_counted(others[-1]):
                said = f"lines {self.layout.number(first)} to {self.layout.number(others[-1])}"
            self.say(f"page: {said}", Cue.PAGE_END)
        self._arrive()
        return True

    def idle(self, now_s: float) -> None:
        """Keep the place, take what is ready, and let time bring the next line."""
        if self._unkept is not None and now_s - self._kept_s >= _KEPT_EVERY_S:
            self._kept_s = now_s
            self.keep()
        if now_s - self._watched_s >= _WATCHED_EVERY_S:
            self._watched_s = now_s
            self._read_anew()
        if self._figure_due and self.figures is not None:
            self._figure_due = False
            if said := self.figures.said(self.line):
                self.say(said)
        passed_s, self._ticked_s = min(now_s - self._ticked_s, _LONGEST_S), now_s
        if self.scroll_cells_s and not (self.device.paused or self._ended):
            self._cells_due -= passed_s * self.scroll_cells_s
            if self._cells_due <= 0:
                self.go_on()
        self.book.source.gather(_GATHERED)
        if self._counts:
            try:
                counted = self.layout.counted
                self.layout.count_on(_COUNTED)
                self._counts = self.layout.counted > counted
            except VbrailleError:  # which is said once reading comes to it
                self._counts = False

    def keep(self) -> None:
        """Keep the place now."""
        line, self._unkept = self._unkept, None
        if line is not None:
            self.kept.keep(line.place, self.book.source.progress(line.place), around(line))

    def come_back(self) -> None:
        """Put the text under the hand again, after a figure was felt in its place."""
        self.inside = None
        self.show_parts(self.parts, self.row)
        self._arrive(another=False)
        self.say(self.named)

    def route(self, cell: int) -> None:
        """Say what is at a cell of the line, and bring it under the finger."""
        if cell < len(self.line):
            self._remember()
            self.show(self.line, cell, under=True)
        self.say(self.cell_said(cell))

    def cell_said(self, cell: int | None) -> str:
        """Sentence on a cell of the line: its dots, what it stands for, and its word."""
        line = self.line
        if cell is None or not 0 <= cell < len(line):
            return "nothing under the finger"
        dots = "-".join(map(str, dots_of(int(line.masks[cell]))))
        first, after = line.source(cell) or (0, 0)
        begin, word = line.block.start, line.word(cell)
        printed = line.block.text[first - begin : after - begin].strip() if after else ""
        said = (
            f"dots {dots}" if dots else "no dots",
            letter_said(printed),
            f"in {word}" if word not in ("", printed) else "",
        )
        return ", ".join(filter(None, said))

    # How it feels

    def tune(self, **changes: Any) -> None:
        """Show this line and those after it in another style.

        Where distances change, lines are laid out anew, and what is under the finger stays there.

        Raises
        ------
        InputError
            If a value is out of range, or leaves no room for a cell.
        """
        before = self.style
        self.use(before.replace(**changes))
        self.undo.append(before)

    def use(self, style: BrailleStyle) -> None:
        """Show lines in a style, laid out anew where that changes their length."""
        place, under, before = self.place, self.cell is not None, self.sizes
        self.fit(style)
        if self.sizes == before:
            self.render()
        else:
            self.lay_out(self.book, place, under=under)

    def lay_out(self, book: Book, place: int, *, under: bool) -> None:
        """Lay the text out by another table or width, with a place of it under the hand."""
        layout = Layout(book, self._cells or self.width)
        line, cell = layout.place(place) or (layout.last(), 0)
        assert line is not None, "a book has a line"
        self.layout, self._counts = layout, True
        self.show(line, cell, under=under)

    def _read_anew(self) -> None:
        """Read a file anew that has changed, at the same place."""
        words, place, before = around(self.line), self.line.place, self.book.source
        try:
            book = self._changed()
            if book is None:
                return
            self.lay_out(book, nearest(book.source, words, place), under=False)
        except InputError as error:
            self.refuse(f"the file has changed and cannot be read again: {error}")
            return
        self.back = []
        before.close()
        self.say(f"the file has changed; read again, {self.named}")


def letter_said(text: str) -> str:
    """Letters as they are; another character by its name."""
    if len(text) != 1 or text.isalnum():
        return text
    return unicodedata.name(text, f"U+{ord(text):04X}").lower()
