"""A line or a page of text as frames: what the actuators do as the array goes over it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from html import escape
from itertools import islice
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.display import check_rate
from vbraille.errors import InputError
from vbraille.layout import Layout
from vbraille.live.states import line_shown
from vbraille.render.braille.models import STRESS2, Model, check_shown, model_of
from vbraille.translate import Book, choose_table, text_source
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from vbraille.display import Display
    from vbraille.layout import Line
    from vbraille.recording import Print, Recording
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.render.program import Program
    from vbraille.translate import BrailleTable

Path = tuple["NDArray[np.float64]", "NDArray[np.float64]", "NDArray[np.float64]"]
_MOST_FRAMES = 10_000_000
MOST_LINES = 1000  # of a page


@dataclass(frozen=True, slots=True, eq=False)
class _Rendered:
    """Lines of a text on a display, in a style.

    Parameters
    ----------
    display, style
        Display and style that they are rendered for.
    lines
        Lines with their text, and with the character that each cell stands for.
    program
        The lines as the engine takes them.
    first : int
        Number of the first line in its text, from 1.
    """

    display: Display
    style: BrailleStyle
    lines: tuple[Line, ...]
    program: Program
    first: int

    def _recording(self, path: Path, rate_hz: float) -> Recording:
        from vbraille.recording import Recording  # loads h5py

        display = replace(self.display, rate_hz=check_rate(rate_hz))
        part, frames = self.program.poses(*path)
        return Recording(
            np.arange(len(frames)) / rate_hz,
            *path,
            frames,
            replace(model_of(display), display=display, style=self.style),
            [line.masks for line in self.lines],
            part.clip(0, len(self.lines) - 1),
            part,
            first_line=self.first,
            prints=[print_of(line) for line in self.lines],
        )


@dataclass(frozen=True, slots=True, eq=False)
class RenderedLine(_Rendered):
    """A line of text with every frame along it.

    Parameters
    ----------
    display, style
        Display and style that the line is rendered for.
    positions_mm : float64[n]
        Place of the array's centre in each frame; 0 is where the line begins.
    frames : float64[n, rows, columns]
        Deflections, 0 (rest) to 1 (full swing).
    """

    positions_mm: NDArray[np.float64]
    frames: NDArray[np.float64]

    @property
    def line(self) -> Line:
        """The line, with its text, and with the character that each cell stands for."""
        return self.lines[0]

    @property
    def cells(self) -> Cells:
        """Cells of the line as the line would be embossed."""
        return Cells.bare(self.line.masks)

    @property
    def text(self) -> str:
        """Text that the line stands for."""
        return self.line.text

    def __len__(self) -> int:
        return self.positions_mm.size

    def at(self, x_mm: float) -> NDArray[np.float64]:
        """Frame whose place comes nearest to a place of the array's centre.

        Returns
        -------
        float64[rows, columns]
            Deflections, 0 (rest) to 1 (full swing).
        """
        return self.frames[np.abs(self.positions_mm - x_mm).argmin()]

    def recording(self, speed_mm_s: float = 60.0) -> Recording:
        """Make what a hand feels that goes along the line once at a steady speed, in mm/s.

        Raises
        ------
        InputError
            If the speed is not above 0.
        """
        if not 0 < speed_mm_s < math.inf:
            raise InputError(f"speed_mm_s is {speed_mm_s:g}; it must be above 0")
        x_mm = self.positions_mm
        return self._recording(_path(x_mm, self.program.own_y_mm), speed_mm_s / (x_mm[1] - x_mm[0]))

    def plot(self, axes: Any = None) -> Any:
        """Draw the deflections over the places of the array, an actuator a row.

        Parameters
        ----------
        axes : matplotlib.axes.Axes
            Axes to draw on; None for new ones.

        Returns
        -------
        matplotlib.axes.Axes
            They have the title, labels and scale; rest is white and full swing is black.
        """
        from vbraille.pictures.draw import plot_frames  # loads matplotlib

        return plot_frames(self.positions_mm, self.frames, self.text, axes)

    def _repr_html_(self) -> str:
        """Line for a notebook: its text, and its cells in Unicode."""
        return f"<p>{escape(self.text)}<br>{self.cells.to_unicode()}</p>"


@dataclass(frozen=True, slots=True, eq=False)
class RenderedPage(_Rendered):
    """Lines of a text, one below the other, which give the frame of any pose over them.

    Parameters
    ----------
    display, style
        Display and style that the page is rendered for.
    lines
        Lines with their text, and with the character that each cell stands for.
    program
        The page as the engine takes it.
    first : int
        Number of the first line in its text, from 1.
    """

    def frames(
        self,
        x_mm: ArrayLike,
        y_mm: ArrayLike,
        theta_rad: ArrayLike = 0.0,
    ) -> NDArray[np.float64]:
        """Frames along a path over the page.

        Parameters
        ----------
        x_mm, y_mm : float[n]
            Places of the array's centre: to the right of where the lines begin, and below the
            upper edge of the first line. The middle of line n is (n - ½) line pitches down.
        theta_rad : float[n]
            Angles by which the array is turned, anticlockwise.

        Returns
        -------
        float64[n, rows, columns]
            Deflections, 0 (rest) to 1 (full swing).

        Raises
        ------
        ValueError
            If the places are not of one length, or not finite.
        """
        return self.program.poses(*_path(x_mm, y_mm, theta_rad))[1].astype(np.float64)

    def recording(
        self,
        x_mm: ArrayLike,
        y_mm: ArrayLike,
        theta_rad: ArrayLike = 0.0,
        *,
        rate_hz: float = 1000.0,
    ) -> Recording:
        """Make what a hand feels on a path over the page, whose places are 1 / rate_hz apart.

        Parameters
        ----------
        x_mm, y_mm, theta_rad : float[n]
            Path, as of `frames`.
        rate_hz
            Number of places a second.

        Raises
        ------
        ValueError
            If the places are not of one length, or not finite.
        InputError
            If the rate cannot be.
        """
        return self._recording(_path(x_mm, y_mm, theta_rad), rate_hz)


def render_text(
    text: str,
    display: Model | Display = STRESS2,
    *,
    style: BrailleStyle | None = None,
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    line: int | None = None,
    step_mm: float = 0.06,
) -> RenderedLine:
    """Render a line of text: frames from the left stop until the whole array is past its end.

    Parameters
    ----------
    text
        Text of the line, which begins at the margin.
    display
        Display that the line is shown on: a `Model` such as `VBD` or `STRESS2`, or any `Display`.
    style
        How braille is shown; None for how the display is read unless told otherwise. Make others
        with `BrailleStyle.replace`, as in ``VBD.style.replace(texture=0.5)``.
    language, grade
        Language and grade, such as "fr" and 1; without a grade the language's usual table is taken.
    table
        Name of a liblouis table, in place of a language.
    line
        Number of the line, from 1, where the text takes more than one.
    step_mm
        Distance between two frames: 0.06 mm is a hand at 60 mm/s and 1000 frames a second.

    Raises
    ------
    InputError
        If something cannot be used, or the text takes several lines and none is chosen.

    Examples
    --------
    >>> import vbraille
    >>> made = vbraille.render_text("Hello", display=vbraille.VBD)
    >>> made.cells.to_unicode(), made.frames.shape[1:]
    ('⠠⠓⠑⠇⠇⠕', (1, 12))
    >>> float(made.frames.max())
    1.0
    """
    model, layout = _laid_out(text, display, style, choose_table(language, grade, table))
    if line is None and layout.line(2) is not None:
        raise InputError(
            f"the text takes {count(layout.count(), 'line')} on the {model.title}; say which with "
            f"line=1, and so on"
        )
    number = 1 if line is None else line
    if number < 1:
        raise InputError(f"line is {line}; it must be 1 or more")
    found = layout.line(number)
    if found is None:
        raise InputError(f"the text ends at line {layout.count()}; line {number} is past that")
    half_mm = model.display.span_mm / 2
    way_mm = model.style.geometry.extent_mm(len(found)) + 2 * half_mm
    if not way_mm / _MOST_FRAMES <= step_mm <= way_mm:
        raise InputError(
            f"step_mm is {step_mm:g}; it must be {way_mm / _MOST_FRAMES:.2g} to {way_mm:.3g} mm"
        )
    positions_mm = np.arange(0.0, way_mm + step_mm / 2, step_mm) - half_mm
    program = _shown(lambda: model.style.render(found.masks, model.display))
    frames = program.path(positions_mm).astype(np.float64)
    how = model.display, model.style, (found,), program, number
    return RenderedLine(*how, positions_mm, frames)


def render_page(
    text: str,
    display: Model | Display = STRESS2,
    *,
    style: BrailleStyle | None = None,
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    first: int = 1,
    last: int | None = None,
) -> RenderedPage:
    r"""Lay lines of a text out one below the other, as a carriage of two axes reads them.

    Parameters
    ----------
    text, display, style, language, grade, table
        As of `render_text`.
    first, last
        Numbers of the first and the last line, from 1; without a last one, all that there are, up
        to `MOST_LINES`.

    Raises
    ------
    InputError
        If something cannot be used, or the text has no such lines.

    Examples
    --------
    >>> import vbraille
    >>> page = vbraille.render_page("one\ntwo", display=vbraille.STRESS2_8X8)
    >>> [line.text for line in page.lines], page.frames([10.0, 20.0], [5.5, 16.5]).shape
    (['one', 'two'], (2, 8, 8))
    """
    model, layout = _laid_out(text, display, style, choose_table(language, grade, table))
    check_lines(first, last)
    lines = tuple(islice(layout.lines(first, last), MOST_LINES + 1))
    if not lines or (last is not None and len(lines) <= last - first):
        raise InputError(f"the text ends at line {layout.count()}; give lines up to that")
    if len(lines) > MOST_LINES:
        raise InputError(f"a page has at most {MOST_LINES} lines; say which with first and last")
    masks = [line.masks for line in lines]
    program = _shown(lambda: model.style.render_page(masks, model.display))
    return RenderedPage(model.display, model.style, lines, program, first)


def _shown(render: Callable[[], Program]) -> Program:
    """Program that a function makes, where a display has the rows for it."""
    try:
        return render()
    except ValueError as error:
        raise InputError(str(error)) from None


def check_lines(first: int, last: int | None) -> None:
    """Raise `InputError` for numbers of lines that are no range."""
    if first < 1:
        raise InputError(f"first is {first}; it must be 1 or more")
    if last is not None and last < first:
        raise InputError(f"last is {last} and first is {first}; last must not be before first")


def _path(x_mm: ArrayLike, y_mm: ArrayLike, theta_rad: ArrayLike = 0.0) -> Path:
    """Places and angles of a path, checked, in arrays of one length."""
    poses = [np.atleast_1d(np.asarray(of, np.float64)) for of in (x_mm, y_mm, theta_rad)]
    x, y, theta = (np.ascontiguousarray(of) for of in np.broadcast_arrays(*poses))
    if x.ndim != 1 or not all(np.isfinite(of).all() for of in (x, y, theta)):
        raise ValueError("places of a path must be finite numbers, in arrays of one length")
    return x, y, theta


def print_of(line: Line) -> Print:
    """Print of a line, as pages of the live view show it under the braille."""
    from vbraille.recording import Print  # loads h5py

    shown = line_shown(line)
    return Print(shown.text, np.array(shown.sources, np.int32).reshape(-1, 2))


def _laid_out(
    text: str, display: Model | Display, style: BrailleStyle | None, table: BrailleTable
) -> tuple[Model, Layout]:
    """Lay a text out in the lines of a display."""
    model = read_as(display, style)
    width = model.style.geometry.cells_per_line(model.display.span_mm)
    return model, Layout(Book(text_source(text, keep_lines=True), table), width)


def read_as(display: Model | Display, style: BrailleStyle | None) -> Model:
    """Model of a display; without a style, as it is usually read, on all of its way."""
    check_shown(display, style)
    model = display if isinstance(display, Model) else model_of(display)
    if style is None:
        geometry = replace(model.style.geometry, travel_mm=model.display.travel_mm)
        style = model.style.replace(geometry=geometry)
    return replace(model, style=style)
