"""A line of text as frames: what the actuators do as the array goes along it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.errors import InputError
from vbraille.layout.texts import cells_per_line, choose_table, lay_out_text
from vbraille.render.braille.models import STRESS2, Model, check_shown, model_of
from vbraille.wording import count

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.braille.cells import Cells
    from vbraille.display import Display
    from vbraille.layout.pages import Line
    from vbraille.render.braille.style import BrailleStyle

_MOST_FRAMES = 10_000_000


@dataclass(frozen=True, slots=True, eq=False)
class RenderedLine:
    """A line of text with every frame along it.

    Parameters
    ----------
    line
        Line with its text, and with the character that each cell stands for.
    display, style
        Display and style that the line is rendered for.
    positions_mm : float64[n]
        Place of the array's centre in each frame; 0 is where the line begins.
    frames : float64[n, rows, columns]
        Deflections, 0 (rest) to 1 (full swing).
    """

    line: Line
    display: Display
    style: BrailleStyle
    positions_mm: NDArray[np.float64]
    frames: NDArray[np.float64]

    @property
    def cells(self) -> Cells:
        """Cells of the line as the line would be embossed."""
        return self.line.printed

    @property
    def text(self) -> str:
        """Text that the line stands for."""
        return self.line.text

    def __len__(self) -> int:
        return self.positions_mm.size


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
    check_shown(display, style)
    model = display if isinstance(display, Model) else model_of(display)
    if style is None:
        geometry = replace(model.style.geometry, travel_mm=model.display.travel_mm)
        style = model.style.replace(geometry=geometry)
    layout = lay_out_text(
        text,
        cells_per_line(style.geometry, model.display),
        choose_table(language, grade, table),
        keep_lines=True,
    )
    if line is None and layout.line(2) is not None:
        raise InputError(
            f"the text takes {count(layout.count(), 'line')} on the {model.title}; say which with "
            f"line=1, and so on"
        )
    if line is not None and line < 1:
        raise InputError(f"line is {line}; it must be 1 or more")
    found = layout.line(line or 1)
    if found is None:
        raise InputError(f"the text ends at line {layout.count()}; line {line} is past that")
    half_mm = model.display.span_mm / 2
    way_mm = style.geometry.extent_mm(len(found)) + 2 * half_mm
    if not way_mm / _MOST_FRAMES <= step_mm <= way_mm:
        raise InputError(
            f"step_mm is {step_mm:g}; it must be {way_mm / _MOST_FRAMES:.2g} to {way_mm:.3g} mm"
        )
    positions_mm = np.arange(0.0, way_mm + step_mm / 2, step_mm) - half_mm
    try:
        program = style.render(found.masks, model.display)
    except ValueError as error:
        raise InputError(str(error)) from None
    frames = program.path(positions_mm).astype(np.float64)
    return RenderedLine(found, model.display, style, positions_mm, frames)
