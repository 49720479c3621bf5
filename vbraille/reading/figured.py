"""Figures on a page: which stand there, which is under the finger, and what the page becomes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from vbraille.translate.source import MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.display import Display
    from vbraille.layout.pages import Line
    from vbraille.reading.activity import Activity
    from vbraille.reading.cues import Cue
    from vbraille.reading.surface import Surface
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.render.program import Program

_ROUNDING = 1e-9  # of a line pitch


class Figure(Protocol):
    """A tactile picture that stands in a text.

    Attributes
    ----------
    title : str
        Title of the picture.
    width_mm, height_mm : float
        Size of its canvas.
    """

    title: str
    width_mm: float
    height_mm: float

    def name_at(self, x_mm: float, y_mm: float) -> str:
        """Name of the element at a place of its canvas, in mm; empty if none has one there."""
        ...


class Figures(Protocol):
    """The tactile pictures of a text, which are read when a line comes that stands for one."""

    def find(self, address: str) -> Figure | None:
        """Give the picture of an address; None if there is none, which is said once."""
        ...

    @property
    def ready(self) -> bool:
        """Whether a page can be made at once."""
        ...

    def feel(
        self, address: str, say: Callable[[str], None], cue: Callable[[Cue], None]
    ) -> Activity:
        """Put a figure alone under the hand, in place of the text.

        Raises
        ------
        InputError
            If there is none, or it cannot be felt on the device.
        """
        ...

    def page(
        self,
        lines: Sequence[NDArray[np.uint8]],
        start_mm: float,
        style: BrailleStyle,
        placed: Sequence[tuple[Figure, float]],
    ) -> Program | None:
        """Make one picture of a page and its figures; None if it cannot be, which is said.

        Parameters
        ----------
        lines : sequence of uint8[cells]
            Dot masks of each line of the page.
        start_mm
            Place at which the lines begin.
        style
            How the braille is shown.
        placed
            Figures, each with the place of its upper edge on the page, in mm.
        """
        ...


class PlacedFigure(NamedTuple):
    """A figure that stands on a page, below the line in a row, and its upper edge in mm."""

    figure: Figure
    row: int
    top_mm: float


class Here(NamedTuple):
    """Title of the figure under the finger, and name of its element there, or an empty one."""

    title: str
    name: str


def figure_address(line: Line) -> str:
    """Address of the figure that a line stands for, if it ends there; empty if there is none."""
    for mark in line.block.marks:
        if mark.kind is MarkKind.IMAGE and mark.target and len(line.cells):
            ends_here = int(line.cells.starts[0]) < mark.end <= line.cells.end
            if ends_here:
                return mark.target
    return ""


def figure_of_block(line: Line) -> str:
    """Address of the figure that a line's block stands for; empty if there is none."""
    found = (mark.target for mark in line.block.marks if mark.kind is MarkKind.IMAGE)
    return figure_address(line) or next(filter(None, found), "")


class Figured:
    """The figures of a text that is read, and those of the page under the hand.

    Parameters
    ----------
    figures
        Function that gives the figures of the text, called for the first; None if none is felt.
    display
        Display that pages are shown on.
    """

    def __init__(self, figures: Callable[[], Figures] | None, display: Display) -> None:
        self._begin = figures
        self._figures: Figures | None = None
        self._display = display
        self.placed: tuple[PlacedFigure, ...] = ()
        self._row = -1  # of the page, that the finger was in last

    def of(self, line: Line) -> Figure | None:
        """Give the figure that a line stands for; None if it stands for none that can be felt."""
        address = figure_address(line)
        figures = self.all if address else None
        return None if figures is None else figures.find(address)

    @property
    def all(self) -> Figures | None:
        """The figures of the text; None if none is felt."""
        if self._figures is None and self._begin is not None:
            self._figures = self._begin()
        return self._figures

    def rows_below(self, line: Line, pitch_mm: float, rows: int) -> int:
        """Tell how many rows a page of so many keeps free below a line; 0 if none fits there."""
        figure = self.of(line) if rows else None
        if figure is None or figure.width_mm > self._display.travel_mm:
            return 0
        needed = math.ceil(figure.height_mm / pitch_mm - _ROUNDING)
        return needed if needed < rows else 0

    def forget(self) -> None:
        """Take note that the page under the hand shows no figure."""
        self.placed, self._row = (), -1

    @property
    def ready(self) -> bool:
        """Whether figures can join a page at once."""
        return self._figures is None or self._figures.ready

    def sentences(self, line: Line, key: str, below: int) -> Iterator[str]:
        """Sentences on the figure that a line stands for, if it stands for one.

        Parameters
        ----------
        line
            The line.
        key
            Key that has the figure felt alone.
        below
            Number of rows that it has below the line; 0 if it is not on the page.
        """
        figure = self.of(line)
        if figure is not None:
            size = f"{figure.width_mm:g} mm × {figure.height_mm:g} mm"
            where = "below this line" if below else f"{key} feels it"
            yield f"figure: {figure.title}, {size}; {where}"

    def on(self, surface: Surface) -> Iterator[tuple[int, Figure]]:
        """Rows of a page below which figures belong, with the figures."""
        for row in surface.kept:
            window = surface.windows[row]
            figure = None if window is None else self.of(window.line)
            if figure is not None:
                yield row, figure

    def width_mm(self, surface: Surface) -> float:
        """Width of the widest figure that belongs on a page; 0 if none does."""
        return max((figure.width_mm for _, figure in self.on(surface)), default=0.0)

    def page(self, surface: Surface, style: BrailleStyle) -> Program | None:
        """Make one picture of a page and the figures on it; None if it shows none."""
        self.forget()
        pitch_mm = style.geometry.line_pitch_mm
        found = [
            PlacedFigure(figure, row, (row + 1) * pitch_mm) for row, figure in self.on(surface)
        ]
        if not found or self._figures is None:
            return None
        blank = np.zeros(0, np.uint8)
        masks = [blank if part is None else part.masks for part in surface.windows]
        placed = [(figure, top_mm) for figure, _, top_mm in found]
        program = self._figures.page(masks, surface.window.start_mm, style, placed)
        if program is not None:
            self.placed = tuple(found)
        return program

    def under(self, x_mm: float | None, y_mm: float | None) -> PlacedFigure | None:
        """Give the figure of the page that is at a place in mm; None if none is there."""
        if x_mm is None or y_mm is None:
            return None
        for placed in self.placed:
            figure, _, top_mm = placed
            if 0 <= x_mm <= figure.width_mm and 0 <= y_mm - top_mm <= figure.height_mm:
                return placed
        return None

    def here(self, x_mm: float | None, y_mm: float | None) -> Here | None:
        """Tell what of the page's figures is at a place in mm; None if no figure is there."""
        placed = self.under(x_mm, y_mm)
        if placed is None or x_mm is None or y_mm is None:
            return None
        return Here(placed.figure.title, placed.figure.name_at(x_mm, y_mm - placed.top_mm))

    def rows_of(
        self, y_mm: NDArray[np.float64], style: BrailleStyle, rows: int
    ) -> NDArray[np.int64]:
        """Rows of a page with figures, which one picture has not: those of the places of a finger.

        It stays in a row until it is beyond the edge by half of the band, as on any page.
        """
        at = y_mm / style.geometry.line_pitch_mm
        nearest = np.floor(np.clip(np.nan_to_num(at, nan=-1.0), -1, rows)).astype(np.int64)
        found = np.empty_like(nearest)
        half = 0.5 + style.straying.band / 2
        begun = 0
        while begun < at.size:
            stays = np.abs(at[begun:] - self._row - 0.5) <= half
            left = np.flatnonzero(~(stays | (nearest[begun:] == self._row)))
            stop = begun + int(left[0]) if left.size else at.size
            found[begun:stop] = self._row
            if stop < at.size:
                self._row = int(nearest[stop])
            begun = stop
        return found
