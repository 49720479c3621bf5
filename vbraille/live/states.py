"""Parts of the state that pages of the live view are told, made of what they show."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

import numpy as np

from vbraille.config.settings import KNOBS, fixed
from vbraille.live.messages import ArrayShown, KnobShown, LineShown
from vbraille.render.braille.mappings import NONE
from vbraille.render.braille.models import swing_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.layout.blocks import Line
    from vbraille.render.braille.style import BrailleStyle

_DISTANCES = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm", "line_pitch_mm")


def array_shown(display: Display) -> ArrayShown:
    """Actuators of a display as a page draws them."""
    return ArrayShown(
        name=display.name,
        rows=display.rows,
        columns=display.columns,
        column_pitch_mm=display.column_pitch_mm,
        row_pitch_mm=display.row_pitch_mm,
        swing_mm=swing_of(display),
        rest_right=display.rest_side == "right",
        travel_mm=display.travel_mm,
        height_mm=display.height_mm,
        turns=display.turns,
        rate_hz=display.rate_hz,
    )


def geometry_shown(geometry: Geometry) -> dict[str, float]:
    """Distances of braille, by name, in mm."""
    distances = asdict(geometry)
    return {name: float(distances[name]) for name in _DISTANCES}


def rows_shown(style: BrailleStyle, display: Display) -> list[tuple[int, int]]:
    """Rows of dots that each row of actuators shows: of the left dot column and of the right one.

    A row of dots counts from 0; -1 stands for none.
    """
    shown = [(NONE, NONE)] * display.rows
    shown[style.rows_on(display)] = zip(style.mapping.left, style.mapping.right, strict=True)
    return shown


def knobs_shown(style: BrailleStyle) -> list[KnobShown]:
    """Knobs of a style, with their values and bounds."""
    return [
        KnobShown(
            name=knob.key,
            label=knob.label,
            unit=knob.unit,
            value=float(knob.value(style)),
            step=float(knob.step),
            low=float(knob.low),
            high=float(knob.high),
            fixed=fixed(knob, style),
        )
        for knob in KNOBS.values()
    ]


def cells_shown(
    number: int,
    masks: Iterable[int],
    text: str = "",
    *,
    top_mm: float = 0.0,
    under: bool = False,
) -> LineShown:
    """Cells as a page draws them, of which it is not known what of a text each stands for."""
    cells = [int(mask) for mask in masks]
    return LineShown(number, text, 0.0, top_mm, cells, [(0, 0)] * len(cells), under)


def line_shown(
    line: Line,
    *,
    first: int = 0,
    count: int | None = None,
    start_mm: float = 0.0,
    top_mm: float = 0.0,
    number: int | None = None,
    under: bool = False,
) -> LineShown:
    """A line, or a part of it, as a page draws it.

    Parameters
    ----------
    line
        The line.
    first
        Cell of the line that stands first; below 0 that many blank cells stand before the line.
    count
        Number of cells that are shown; None for all from there on.
    start_mm, top_mm
        Places of the left edge of the first of these cells, and of the upper edge of the line.
    number
        Number by which records call the line; None for the line's own.
    under
        Whether the line is under the hand.
    """
    count = len(line) - first if count is None else count
    wanted = np.arange(first, first + count)
    at = np.where((wanted >= 0) & (wanted < len(line)), wanted, len(line))
    cells = np.append(line.masks, np.uint8(0))[at]
    sources = np.full((len(line) + 1, 2), -1, np.int64)
    sources[line.indent : -1] = _sources(line)
    sources = sources[at]
    text = "" if line.block.cells is not None else line.text
    known = sources[sources[:, 0] >= 0]
    cut_from = 0
    if known.size and count < len(line):  # of a long line, only what is shown
        cut_from = int(known[:, 0].min())
        text = text[cut_from : int(known[:, 1].max())]
    sources = np.clip(np.where(sources < 0, cut_from, sources) - cut_from, 0, len(text))
    return LineShown(
        number=line.number if number is None else number,
        text=text,
        start_mm=start_mm,
        top_mm=top_mm,
        cells=cells.tolist(),
        sources=[(begin, end) for begin, end in sources.tolist()],
        under=under,
    )


def _sources(line: Line) -> NDArray[np.int64]:
    """Begin and end in the line's text of what each cell after the indent stands for."""
    starts, places = line.cells.starts, line.block.text.places
    after = np.searchsorted(starts, starts, side="right")
    following = np.append(starts, line.cells.end)[after]
    there = np.searchsorted(places, np.stack((starts, following), axis=1)) - line.first
    return np.clip(there, 0, line.after - line.first)
