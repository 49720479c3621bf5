"""The surface under the hand: a part of one line, or a page of lines, of those that are read."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.layout import Layout

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.layout import Line
    from vbraille.render import BrailleStyle
    from vbraille.translate import Book


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """Cells of a line that the hand can cross at once.

    Parameters
    ----------
    line : Line
        The line.
    width : int
        Largest number of cells that are shown.
    offset : int
        Cell of the line that stands first; below 0 that many blank cells stand before the line.
    start_mm : float
        Place on the surface at which that cell begins, a cell's pitch before 0 at most.
    """

    line: Line
    width: int
    offset: int = 0
    start_mm: float = 0.0

    def __len__(self) -> int:
        return max(0, min(self.width, len(self.line) - self.offset))

    @property
    def masks(self) -> NDArray[np.uint8]:
        """Dot masks of what is shown, uint8[cells]."""
        before = np.zeros(min(max(-self.offset, 0), len(self)), np.uint8)
        return np.concatenate((before, self.line.masks[max(self.offset, 0) :]))[: len(self)]

    @property
    def right(self) -> Window | None:
        """The part after this one; None if the line ends here."""
        following = self.offset + self.width
        return Window(self.line, self.width, following) if following < len(self.line) else None

    @property
    def left(self) -> Window | None:
        """The part before this one; None if the line begins here."""
        before = max(0, self.offset - self.width)
        return Window(self.line, self.width, before) if self.offset > 0 else None

    @property
    def last(self) -> Window:
        """The last part of the line."""
        return self.showing(max(len(self.line) - 1, 0))

    def showing(self, cell: int) -> Window:
        """Part of the line with a cell, of the parts into which the line falls from its start."""
        return Window(self.line, self.width, cell // self.width * self.width)

    def cell_at(self, x_mm: float, geometry: Geometry) -> int | None:
        """Cell of the line at a place on the surface; None if there is none."""
        shown = math.floor((x_mm - self.start_mm) / geometry.cell_pitch_mm)
        cell = shown + self.offset
        return cell if 0 <= shown < len(self) and cell >= 0 else None

    def share_at(self, x_mm: float, geometry: Geometry) -> float:
        """Give the share of its cell that is left of a place on the surface, 0 to 1."""
        return (x_mm - self.start_mm) / geometry.cell_pitch_mm % 1

    def under(self, cell: int, share: float, x_mm: float, geometry: Geometry) -> Window:
        """Part of the line in which a cell is under a finger that is at a place on the surface.

        Parameters
        ----------
        share
            How much of the cell is to be left of the finger, 0 to 1.
        """
        cells = x_mm / geometry.cell_pitch_mm - share  # that stand before it, and a part of one
        shown = math.ceil(cells - 1e-9)
        start_mm = min((cells - shown) * geometry.cell_pitch_mm, 0.0)
        return replace(self, offset=cell - shown, start_mm=start_mm)


@dataclass(frozen=True, slots=True)
class LineRange:
    """Lines of a layout from one number to another.

    Parameters
    ----------
    layout : Layout
        Lines of the book.
    first, last : int or None
        Numbers of the first and last line, from 1; None for the end.
    skip_blank : bool
        Whether lines without a dot are passed over when one follows another.
    """

    layout: Layout
    first: int = 1
    last: int | None = None
    skip_blank: bool = False

    def line(self, number: int) -> Line | None:
        """Line of a number; None if it is none of these."""
        return self.layout.line(number) if self._has(number) else None

    def place(self, character: int) -> tuple[Line, int] | None:
        """Line and cell of a place of the source; None if it is on none of these lines."""
        found = self.layout.place(character)
        return None if found is None or not self._has(found[0].number) else found

    def following(self, number: int, step: int) -> Line | None:
        """Next line after one, or before it where the step is -1."""
        while True:
            line = self.layout.line(number + step) if self._has(number + step) else None
            if line is None or not self.skip_blank or line.masks.any():
                return line
            number = line.number

    def relaid(self, book: Book, width: int) -> LineRange:
        """Lay out the same text in other cells or another width."""
        layout = Layout(book, width)
        numbers: list[int | None] = []
        for number in (self.first, self.last):
            line = self.layout.line(number) if number is not None and number > 1 else None
            place = None if line is None else layout.place(line.place)
            numbers.append(number if place is None else place[0].number)
        return LineRange(layout, numbers[0] or 1, numbers[1], self.skip_blank)

    def _has(self, number: int) -> bool:
        if self.first == 1 and self.last is None:
            return True  # lines may have provisional numbers
        return self.first <= number and (self.last is None or number <= self.last)


MOST_LINES: Final = 64  # of a page on the surface, however high that is
# Below the last line there is room for a finger that goes on to the next page, in line pitches.
FOOT_PITCHES: Final = 0.1


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Parts of lines, one below the other, and the one that the finger is meant to be on.

    Parameters
    ----------
    windows : tuple[Window or None, ...]
        Parts of lines from the top; None where the text has not begun yet, and where a figure
        stands.
    row : int
        Number of the row that is meant, from 0; it is a part of a line.
    paged : bool
        Whether the surface has a second axis, and so rows.
    kept : dict[int, int]
        Number of rows that are kept free for a figure, by the row of the line above it.
    """

    windows: tuple[Window | None, ...]
    row: int = 0
    paged: bool = False
    kept: dict[int, int] = field(default_factory=dict)

    @property
    def window(self) -> Window:
        """Part of a line in the row that is meant."""
        window = self.windows[self.row]
        assert window is not None, "a row with a line"
        return window

    @property
    def there(self) -> tuple[Window, ...]:
        """Parts of lines, without the rows before the text."""
        return tuple(window for window in self.windows if window is not None)

    @property
    def number(self) -> int:
        """Number by which records call the surface: of a page, the number that its top row has."""
        before = next(n for n, window in enumerate(self.windows) if window is not None)
        top = self.there[0].line.number - before
        return top if top > 0 else top - 1  # 0 means that nothing was shown yet

    def has(self, row: int) -> bool:
        """Tell whether there is a line in a row."""
        return 0 <= row < len(self.windows) and self.windows[row] is not None

    def line_rows(self, rows: NDArray[np.int64]) -> NDArray[np.int64]:
        """Rows of the lines that rows belong to: a figure belongs to the line above it."""
        for row, kept in self.kept.items():
            rows = np.where((rows > row) & (rows <= row + kept), row, rows)
        return rows

    def panned(self, step: int) -> Surface | None:
        """The parts after these, or before them where the step is -1; None if there are none."""
        here = self.window
        if not self.paged:
            window = here.right if step > 0 else here.left
            return None if window is None else replace(self, windows=(window,))
        offset = here.offset + here.width if step > 0 else max(0, here.offset - here.width)
        if (step < 0 and here.offset <= 0) or all(len(w.line) <= offset for w in self.there):
            return None
        windows = (None if w is None else Window(w.line, w.width, offset) for w in self.windows)
        return replace(self, windows=tuple(windows))


def rows_on(display: Display, style: BrailleStyle) -> int:
    """Number of lines that a page has on a display, with room for a finger below them.

    It is 0 on a display of one axis, or with room for less than a line along the other: that shows
    one line, wherever along y the array is.
    """
    pitches = display.height_mm / style.geometry.line_pitch_mm
    return min(max(0, math.floor(pitches - below_pitches(style) + 1e-9)), MOST_LINES)


def below_pitches(style: BrailleStyle) -> float:
    """Give the way below the last line's edge that takes a finger off the page, in line pitches."""
    return style.straying.band / 2 + FOOT_PITCHES


def _no_rows(_: Line) -> int:
    """Keep no rows free below a line."""
    return 0


def around(
    lines: LineRange,
    window: Window,
    row: int,
    rows: int,
    keep: Callable[[Line], int] = _no_rows,
) -> Surface:
    """Make a page with a part of a line in a row, and what is before and after it around it.

    Parameters
    ----------
    lines
        Lines that are read.
    window
        The part of a line.
    row, rows
        Row that it is put into, and number of rows; a line with a figure goes higher if the figure
        needs that. A figure that would not be on the page as a whole is left out with its line.
    keep
        Function that tells how many rows to keep free below a line for its figure.
    """
    # What stands in the other rows begins where this one does, unless it was moved under a finger.
    offset = window.offset if window.offset >= 0 and window.offset % window.width == 0 else 0

    def part(line: Line) -> Window:
        return (
            window if line is window.line else Window(line, window.width, offset, window.start_mm)
        )

    number, free = window.line.number, keep(window.line)
    row = min(row, rows - 1 - free)
    above = _fitting(_walk(lines, number, -1), row, keep)
    left = rows - row - 1 - free
    below = _fitting(_walk(lines, number, 1), left, keep)
    found = [*above[::-1], (window.line, free), *below]
    before = row - sum(1 + free for _, free in above)
    return _stacked([(part(line), free) for line, free in found], before=before, row=row)


def turned(
    lines: LineRange,
    surface: Surface,
    step: int,
    rows: int,
    keep: Callable[[Line], int] = _no_rows,
) -> Surface | None:
    """Make the page after one, or before it where the step is -1; None if there are no lines.

    Parameters
    ----------
    lines
        Lines that are read.
    surface
        The page.
    rows
        Number of rows of a page.
    keep
        Function that tells how many rows to keep free below a line for its figure.
    """
    at = surface.there[-1 if step > 0 else 0]
    found = _fitting(_walk(lines, at.line.number, step), rows, keep)
    if not found:
        return None
    if step < 0:
        found.reverse()
        top, end = found[0][0].number, found[-1][0].number
        if lines.following(top, -1) is None:  # the first page is a whole one
            left = rows - sum(1 + free for _, free in found)
            found += _fitting(_walk(lines, end, 1), left, keep)
    return _stacked([(Window(line, at.width), free) for line, free in found])


def _fitting(
    found: Iterator[Line], rows: int, keep: Callable[[Line], int]
) -> list[tuple[Line, int]]:
    """Take lines as long as there are rows for them, each with the rows kept free below it."""
    taken: list[tuple[Line, int]] = []
    while rows > 0 and (line := next(found, None)) is not None:
        free = keep(line)
        rows -= 1 + free
        if rows >= 0:
            taken.append((line, free))
    return taken


def _stacked(parts: Iterable[tuple[Window, int]], *, before: int = 0, row: int = 0) -> Surface:
    """Put parts of lines below one another, each with rows below it that are kept free."""
    windows: list[Window | None] = [None] * before
    kept: dict[int, int] = {}
    for window, free in parts:
        if free:
            kept[len(windows)] = free
        windows += [window, *[None] * free]
    return Surface(tuple(windows), row, paged=True, kept=kept)


def _walk(lines: LineRange, number: int, step: int) -> Iterator[Line]:
    """Lines after one, or before it, one after the other."""
    line = lines.following(number, step)
    while line is not None:
        yield line
        line = lines.following(line.number, step)
