"""Parts of the state that pages are told, made of what they show."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Final

import numpy as np

from vbraille.live.messages import ArrayShown, LineShown
from vbraille.render.braille.mappings import NONE
from vbraille.render.braille.models import SWING_MM

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.layout import Line
    from vbraille.render.braille.style import BrailleStyle

_DISTANCES: Final = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm", "row_spacing_mm",
                     "line_pitch_mm")  # fmt: skip


def array_shown(display: Display) -> ArrayShown:
    """Show the actuators of a display."""
    return ArrayShown(
        name=display.name,
        rows=display.rows,
        columns=display.columns,
        column_pitch_mm=display.column_pitch_mm,
        row_pitch_mm=display.row_pitch_mm,
        swing_mm=SWING_MM,
        rest_right=display.rest_side == "right",
        travel_mm=display.travel_mm,
        height_mm=display.height_mm,
        turns=display.turns,
        rate_hz=display.rate_hz,
    )


def geometry_shown(geometry: Geometry) -> dict[str, float]:
    """Give the distances of braille by name, in mm."""
    distances = asdict(geometry)
    return {name: float(distances[name]) for name in _DISTANCES}


def rows_shown(style: BrailleStyle, display: Display) -> list[tuple[int, int]]:
    """Give the dot rows that each row of actuators shows, as `ViewState` has them."""
    shown = [(NONE, NONE)] * display.rows
    shown[style.rows_on(display)] = zip(style.mapping.left, style.mapping.right, strict=True)
    return shown


def cells_shown(
    number: int,
    masks: Iterable[int],
    text: str = "",
    *,
    top_mm: float = 0.0,
    under: bool = False,
) -> LineShown:
    """Show cells of which it is not known what of a text each stands for."""
    cells = [int(mask) for mask in masks]
    return LineShown(number, text, 0.0, top_mm, cells, [(0, 0)] * len(cells), under)


def line_shown(
    line: Line,
    *,
    first: int = 0,
    count: int | None = None,
    top_mm: float = 0.0,
    number: int | None = None,
    under: bool = False,
) -> LineShown:
    """Show a line, or a part of it.

    Parameters
    ----------
    line
        The line.
    first, count
        Cell that stands first, before the line if it is below 0, and how many are shown.
    top_mm
        Upper edge of the line.
    number
        Number of the line in frames; None for the line's own.
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
    cut = 0
    if known.size and count < len(line):  # of a long line, only what is shown
        cut = int(known[:, 0].min())
        text = text[cut : int(known[:, 1].max())]
    sources = np.clip(np.where(sources < 0, cut, sources) - cut, 0, len(text))
    return LineShown(
        number=line.id if number is None else number,
        text=text,
        start_mm=0.0,
        top_mm=top_mm,
        cells=cells.tolist(),
        sources=[(begin, end) for begin, end in sources.tolist()],
        under=under,
    )


def _sources(line: Line) -> NDArray[np.int64]:
    """Give where the text begins and ends that each cell stands for."""
    starts = line.cells.starts
    after = np.searchsorted(starts, starts, side="right")
    following = np.append(starts, line.cells.end)[after]
    there = np.stack((starts, following), axis=1) - line.block.start - line.first
    return np.clip(there, 0, line.after - line.first)
