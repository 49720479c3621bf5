"""Lines and pages under the hand, with their figures, and how far the hand has come."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from vbraille.cli.old.reading.advancing import LineWatch, PageFoot, too_fast_note
from vbraille.cli.old.reading.viewport import Surface, below_pitches, rows_on
from vbraille.engine.engine import EndOfLine
from vbraille.engine.record import Flag
from vbraille.layout import cells_per_line
from vbraille.simulation.steering import ReadLine, ReadPage
from vbraille.translate import MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.cli.old.reading.view import Cue, View
    from vbraille.cli.old.reading.viewport import Surface, Window
    from vbraille.display import Display
    from vbraille.engine.engine import Engine
    from vbraille.feeling.loading import LoadedScene
    from vbraille.layout import Line
    from vbraille.render import BrailleStyle, Model
    from vbraille.render.program import Program
    from vbraille.simulation.steering import Steering

MOST_CELLS = 512  # that can be shown at once, however close they stand
# A finger that goes across lines is on none of them: nothing of one has faded in before.
_STAY_NS = 120_000_000
# Plain numbers: with an enumeration numpy asks for attributes, and may lose a signal meanwhile.
_PAUSED, _HELD, _TURNED = int(Flag.PAUSED), int(Flag.HELD), int(Flag.TURNED)


class TextView:
    """Part of a line under the hand, or a page of lines of which the finger is on one.

    Parameters
    ----------
    engine
        Engine that drives the device.
    model
        Display, and style in which lines are shown on it.
    steering
        Steering that tells a simulated hand what to read; None if a person reads.
    say
        Function that is called with each thing to be said.
    by_hand
        Whether the next line comes when the hand returns; otherwise a key brings it.
    key
        Key that brings the next line; empty if no reader is at a keyboard.
    figures
        Function that gives the figures of the text; None if they stay unfelt.

    Attributes
    ----------
    surface : Surface
        What lies on the surface, and the row that the finger is in, or was in last.
    style : BrailleStyle
        How lines are shown.
    width : int
        Largest number of cells of a line that are shown.
    rows : int
        Number of lines of a page; 0 where one line is shown.
    shown : int
        Number of times that something else was put under the hand.
    figured : Figured
        The figures of the text, and those of the page under the hand.
    alone : View or None
        Figure that is felt in place of the text; None if the text is under the hand.
    patient : bool
        Whether the hand may do as it likes, since a person moves it in the live view.
    """

    def __init__(
        self,
        engine: Engine,
        model: Model,
        steering: Steering | None,
        say: Callable[[str], None],
        *,
        by_hand: bool,
        key: str,
        figures: Callable[[], Figures] | None = None,
    ) -> None:
        self.surface: Surface  # from the first `put` on
        self.style = model.style
        self.shown = 0
        self.patient = False
        self._engine = engine
        self._display = model.display
        self.width = self.width_in(model.style)
        self.rows = rows_on(model.display, model.style)
        self.figured = Figured(figures, model.display)
        self.alone: View | None = None
        self._awaited = False  # whether the page's figures are still to be compiled
        self._y_mm: float | None = None  # where the finger is, and the part of what is shown there
        self._part = -1
        self._near, self._near_ns = -1, 0  # the row that the finger came to last, and when
        self._foot: PageFoot
        self._steering = steering
        self._say = say
        self._by_hand = by_hand
        self._key = key
        self._end: EndOfLine
        self._end_mm = 0.0
        self._waiting: LineWatch
        self._begun = False  # whether the hand was before the end since the window is there
        self._too_fast_said = False

    @property
    def window(self) -> Window:
        """Part of the line that the finger is on, or was on last."""
        return self.surface.window

    @property
    def row(self) -> int:
        """Row of a page that the finger is in now; the first if it is not on the page."""
        if self._y_mm is None:
            return 0
        if 0 <= self._part < len(self.surface.windows):
            return self._part
        row = math.floor(self._y_mm / self.style.geometry.line_pitch_mm)
        return row if 0 <= row < self.rows else 0

    @property
    def figure(self) -> PlacedFigure | None:
        """Figure of the page that the finger is on; None if it is on none."""
        return self.figured.under(self._engine.x_mm, self._y_mm)

    @property
    def here(self) -> FigureElement | None:
        """Figure and element that the finger is on; None if it is on no figure."""
        return self.figured.here(self._engine.x_mm, self._y_mm)

    def keep(self, line: Line) -> int:
        """Tell how many rows of a page are kept free below a line, for its figure."""
        return self.figured.rows_below(line, self.style.geometry.line_pitch_mm, self.rows)

    @property
    def cells(self) -> int:
        """Number of cells that are shown."""
        return sum(map(len, self.surface.there))

    @property
    def hopeless(self) -> str | None:
        """Reason why the line will not come to its end without help; None without one."""
        return self._waiting.hopeless

    @property
    def reached(self) -> bool:
        """Tell whether the hand has been at the end."""
        return self._end.reached

    def width_in(self, style: BrailleStyle) -> int:
        """Largest number of cells that can be shown in a style.

        Raises
        ------
        InputError
            If there is no room for a cell.
        """
        return min(cells_per_line(style.geometry, self._display), MOST_CELLS)

    def put(self, surface: Surface, name: str) -> None:
        """Put something else under the hand.

        Parameters
        ----------
        surface
            What it is.
        name
            What the line that is meant is called, such as "line 12".
        """
        self.surface = surface
        self.shown += 1
        self._foot = PageFoot(len(surface.windows))
        self._enter(surface.row, name)
        self._show_again()

    def _show_again(self) -> None:
        """Show the surface: braille comes at once, and figures join it when they are compiled."""
        self.figured.forget()
        self._awaited = bool(self.surface.kept)
        self._render(self.surface)
        self.steer()

    def come_back(self) -> None:
        """Put the text under the hand again, after a figure was felt in its place."""
        self._show_again()

    def complete(self) -> None:
        """Have the figures of a page that was put under the hand join its lines."""
        if self._awaited and self.figured.ready:
            self._awaited = False
            self._render_figures(self.surface)

    def _enter(self, row: int, name: str) -> None:
        """Begin to follow the finger along the line of a row."""
        self.surface = replace(self.surface, row=row)
        self._begun = False
        span_mm = self._display.span_mm
        self._end_mm = self._end_of(self.window)
        self._end = EndOfLine(span_mm, self._end_mm)
        by_hand = self._by_hand and not self.surface.paged
        self._waiting = LineWatch(span_mm, self._end_mm, name, by_hand=by_hand, key=self._key)

    def come_to(self, ticks: NDArray[np.void], name: Callable[[Line], str]) -> bool:
        """Take from ticks which line of a page the finger is on, once it has stayed there a moment.

        Parameters
        ----------
        ticks
            Ticks that `felt` has given.
        name
            Function that tells what a line is called.

        Returns
        -------
        bool
            Whether it is another line than before.
        """
        surface = self.surface
        if not surface.paged:
            return False
        rows = surface.line_rows(ticks["part"])
        row = int(rows[-1])
        others = np.flatnonzero(rows != row)
        if others.size or row != self._near:
            self._near = row
            begun = others[-1] + 1 if others.size else 0
            self._near_ns = int(ticks["time_ns"][begun])
        if row == surface.row or not surface.has(row):
            return False
        if int(ticks["time_ns"][-1]) - self._near_ns < _STAY_NS:
            return False
        self._enter(row, name(replace(surface, row=row).window.line))
        return True

    def show_in(self, style: BrailleStyle) -> None:
        """Show lines in another style from now on, this one too."""
        if style.geometry.line_pitch_mm != self.style.geometry.line_pitch_mm:
            self._part = -1  # lines will stand elsewhere
        self.style = style
        self.width = self.width_in(style)
        self.rows = rows_on(self._display, style)
        self._too_fast_said = False
        if not (self.figured.placed and self._render_figures(self.surface)):
            self._render(self.surface)

    def steer(self) -> None:
        """Have a simulated hand read the line under it; a person's hand does so by itself."""
        if self._steering is None:
            return
        if not self.surface.paged:
            self._steering.give(ReadLine(self._end_mm))
            return
        pitch_mm, lines = self.style.geometry.line_pitch_mm, len(self.surface.windows)
        end_mm = max(map(self._end_of, self.surface.there))
        end_mm = max(end_mm, self.figured.width_mm(self.surface))
        below_mm = self._display.height_mm - lines * pitch_mm
        foot_mm = min(below_mm, (below_pitches(self.style) + 0.5) * pitch_mm) * self._by_hand
        self._steering.give(ReadPage(lines, pitch_mm, end_mm, foot_mm))

    def steered_till(self, tick: np.void) -> bool:
        """Tell whether a simulated hand had read the line by a tick; False without one."""
        return self._steering is not None and self._steering.done_at(int(tick["device_ns"]))

    def felt(self, ticks: NDArray[np.void]) -> NDArray[np.void]:
        """Take of some ticks those in which the line was to be felt."""
        if self.figured.placed and ticks.size:
            ticks = ticks.copy()
            lines = len(self.surface.windows)
            ticks["part"] = self.figured.rows_of(ticks["y_mm"], self.style, lines)
        if ticks.size and not math.isnan(ticks["y_mm"][-1]):
            self._y_mm, self._part = float(ticks["y_mm"][-1]), int(ticks["part"][-1])
        ticks = ticks[(ticks["line"] == self.surface.number) & (ticks["flags"] & _PAUSED == 0)]
        if not ticks.size:
            self._waiting.rest()
            self._foot.rest()
        return ticks

    def follow(self, ticks: NDArray[np.void]) -> bool:
        """Look where the hand was while it felt the line: whether it is done with what is shown.

        It is done with a page when it stays below the page's last line.
        """
        # What the device did not take was not felt, and neither was anything beside the line.
        felt = ticks["flags"] & (_HELD | _TURNED) == 0
        paged = self.surface.paged
        if paged:
            felt &= ticks["part"] == self.surface.row
        felt_mm = ticks["x_mm"][felt]
        if not self._begun:  # a hand that was at the end when the line came has not read it
            before = np.flatnonzero(felt_mm < self._end_mm)
            self._begun = bool(before.size)
            felt_mm = felt_mm[before[0] :] if before.size else felt_mm[:0]
        back = self._end.find(felt_mm) is not None
        return self._foot.stays(ticks) if paged else back

    def watch(self, ticks: NDArray[np.void], *, finished: bool) -> None:
        """Say what keeps the hand from the end of the line, and whether it is too fast."""
        if not finished:
            watched = self._waiting.watch(ticks, reached=self._end.reached, patient=self.patient)
            for sentence in watched:
                self._say(sentence)
        if self._too_fast_said or self._end.reached or self.patient or self.figure is not None:
            return
        note = too_fast_note(float(ticks["vx_mm_s"].max()), self.style)
        if note is not None:
            self._too_fast_said = True
            self._say(note)

    def _end_of(self, window: Window) -> float:
        """Place where the last dot of a part of a line ends."""
        return window.start_mm + self.style.geometry.extent_mm(len(window))

    def _render_figures(self, surface: Surface) -> bool:
        """Show a page together with its figures; False if that cannot be."""
        picture = self.figured.page(surface, self.style)
        if picture is not None:
            self.alone = None
            self._engine.show(picture, surface.number)
        return picture is not None

    def _render(self, surface: Surface) -> None:
        if surface.paged:
            blank = np.zeros(0, np.uint8)
            masks = [blank if part is None else part.masks for part in surface.windows]
            program = self.style.render_page(masks, self._display)
        else:
            program = self.style.render(surface.window.masks, self._display)
        start_mm = surface.window.start_mm
        if start_mm:
            program = program.with_anchor(self._display.span_mm / 2 + start_mm)
        self.alone = None
        self._engine.show(program, surface.number)


_ROUNDING = 1e-9  # of a line pitch


class Figure(Protocol):
    """A tactile picture that stands in a text.

    Attributes
    ----------
    title : str
        Title of the picture.
    width_mm, height_mm : float
        Size of its canvas.
    loaded : LoadedScene
        The picture itself.
    """

    title: str
    width_mm: float
    height_mm: float
    loaded: LoadedScene

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
        """Tell whether a page can be made at once."""
        ...

    def feel(self, address: str, say: Callable[[str], None], cue: Callable[[Cue], None]) -> View:
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


class FigureElement(NamedTuple):
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
        """Tell whether figures can join a page at once."""
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

    def here(self, x_mm: float | None, y_mm: float | None) -> FigureElement | None:
        """Tell what of the page's figures is at a place in mm; None if no figure is there."""
        placed = self.under(x_mm, y_mm)
        if placed is None or x_mm is None or y_mm is None:
            return None
        return FigureElement(placed.figure.title, placed.figure.name_at(x_mm, y_mm - placed.top_mm))

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
