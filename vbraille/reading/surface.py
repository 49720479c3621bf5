"""What lies on the surface under the hand: a part of one line, or a page of lines."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.reading.window import Window

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.layout.pages import Line
    from vbraille.reading.ranged import LineRange
    from vbraille.render import BrailleStyle

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
        """Whether there is a line in a row."""
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
    """How far below the last line's edge a finger must get to be off the page, in line pitches."""
    return style.straying.band / 2 + FOOT_PITCHES


def _no_rows(_: Line) -> int:
    """Keep no rows free below a line."""
    return 0


def around(
    lines: LineRange,
    window: Window,
    row: int,
    rows: int,
    *,
    skip_blank: bool = False,
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
    skip_blank
        Whether lines without dots are left out.
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
    above = _fitting(_walk(lines, number, -1, skip_blank=skip_blank), row, keep)
    left = rows - row - 1 - free
    below = _fitting(_walk(lines, number, 1, skip_blank=skip_blank), left, keep)
    found = [*above[::-1], (window.line, free), *below]
    before = row - sum(1 + free for _, free in above)
    return _stacked([(part(line), free) for line, free in found], before=before, row=row)


def turned(
    lines: LineRange,
    surface: Surface,
    step: int,
    rows: int,
    *,
    skip_blank: bool = False,
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
    skip_blank
        Whether lines without dots are left out.
    keep
        Function that tells how many rows to keep free below a line for its figure.
    """
    at = surface.there[-1 if step > 0 else 0]
    found = _fitting(_walk(lines, at.line.number, step, skip_blank=skip_blank), rows, keep)
    if not found:
        return None
    if step < 0:
        found.reverse()
        top, end = found[0][0].number, found[-1][0].number
        if lines.following(top, -1, skip_blank=skip_blank) is None:  # the first page is a whole one
            left = rows - sum(1 + free for _, free in found)
            found += _fitting(_walk(lines, end, 1, skip_blank=skip_blank), left, keep)
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


def _walk(lines: LineRange, number: int, step: int, *, skip_blank: bool) -> Iterator[Line]:
    """Lines after one, or before it, one after the other."""
    line = lines.following(number, step, skip_blank=skip_blank)
    while line is not None:
        yield line
        line = lines.following(line.number, step, skip_blank=skip_blank)
