"""The numbers of the page: its dots on the surface and the array upon a line."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.dots import PLACES, mask_of
from vbraille.pictures.table import FigureTable, tuning_words
from vbraille.render.braille.mappings import NONE
from vbraille.render.braille.reference import deflections

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.layout.pages import Line
    from vbraille.render.braille.models import Model


def page(
    lines: Sequence[Line],
    model: Model,
    *,
    x_mm: float,
    line_index: int = 0,
) -> FigureTable:
    """Dots of some lines where they stand on the surface, and the array upon one of them.

    Parameters
    ----------
    lines
        The lines from the top; the first dot row of the first line is at y = 0.
    model
        The display that shows them, and the style.
    x_mm
        Place of the array's centre.
    line_index
        The line that the array is on, from 0.

    Returns
    -------
    Table
        A row for each dot, then a row for each actuator; ``what`` tells which. Both have
        ``line`` (its number), ``x_mm`` and ``y_mm`` (of the centre; y grows to the reader) and
        ``width_mm`` (of the dot, or the column pitch). Dots have ``cell`` (from 0), ``dot``
        (1 … 8) and ``raised`` (0 or 1); actuators have ``row``, ``column`` and ``deflection``.

    Raises
    ------
    ValueError
        If there is no line of that index.
    """
    if not 0 <= line_index < len(lines):
        raise ValueError(f"line index is {line_index}; there are {len(lines)} lines, from 0")
    style, geometry = model.style, model.style.geometry
    six = not any((line.masks > 0x3F).any() for line in lines)
    parts = [_dots(line, n * geometry.line_pitch_mm, geometry, six) for n, line in enumerate(lines)]
    line, array = lines[line_index], model.display
    row, column = (grid.ravel() for grid in np.indices(array.shape))
    frame = deflections(x_mm, line.masks, style, array)
    top = line_index * geometry.line_pitch_mm + _first_row_mm(model)
    parts.append(
        {
            "what": np.full(row.size, "actuator"),
            "line": np.full(row.size, line.number),
            "x_mm": x_mm - array.span_mm / 2 + array.column_offsets_mm()[column],
            "y_mm": top + array.row_offsets_mm()[row],
            "width_mm": np.full(row.size, array.column_pitch_mm),
            "row": row,
            "column": column,
            "deflection": frame.ravel(),
        }
    )
    names = dict.fromkeys(name for part in (parts[0], parts[-1]) for name in part)
    columns = {
        name: np.concatenate([p.get(name, np.full(len(p["what"]), np.nan)) for p in parts])
        for name in names
    }
    title = (
        f"{model.title}: line {line.number}, left column at {x_mm - array.span_mm / 2:g} mm, "
        f"{style.mapping.name}{tuning_words(style.tuning)}"
    )
    return FigureTable("page", title, columns)


def _dots(line: Line, top_mm: float, geometry: Geometry, six: bool) -> dict[str, NDArray]:
    """Tell the places of the dots of a line whose first dot row is at `top_mm`."""
    dots = list(PLACES)[: 6 if six else 8]
    bits = [mask_of([dot]) for dot in dots]
    right, dot_row = np.array([PLACES[dot] for dot in dots]).T
    cell = np.repeat(np.arange(len(line)), len(dots))
    centre = right * geometry.dot_spacing_mm + geometry.dot_width_mm / 2
    return {
        "what": np.full(cell.size, "dot"),
        "line": np.full(cell.size, line.number),
        "x_mm": cell * geometry.cell_pitch_mm + np.tile(centre, len(line)),
        "y_mm": top_mm + np.tile(dot_row * geometry.row_spacing_mm, len(line)),
        "width_mm": np.full(cell.size, geometry.dot_width_mm),
        "cell": cell,
        "dot": np.tile(dots, len(line)),
        "raised": (line.masks[:, None] & bits != 0).astype(np.uint8).ravel(),
    }


def _first_row_mm(model: Model) -> float:
    """Tell where actuator row 0 is when the first row that shows dots is upon these dots."""
    style = model.style
    first = style.rows_on(model.display).start
    pairs = zip(style.mapping.left, style.mapping.right, strict=True)
    shown = ((row, dot_row) for row, pair in enumerate(pairs, first) for dot_row in pair)
    row, dot_row = next((place for place in shown if place[1] != NONE), (0, 0))
    return dot_row * style.geometry.row_spacing_mm - row * model.display.row_pitch_mm
