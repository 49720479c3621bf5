"""The numbers behind each picture, which are drawn, and which `--csv` prints.

Deflections are shares of the full swing: 0 is rest, 1 the other end. Rows and
columns of actuators count from 0, from the far left.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.braille.cells import PLACES, mask_of
from vbraille.braille.spelling import to_braille
from vbraille.render.braille.mappings import MAPPINGS, NONE, single_row
from vbraille.render.braille.models import STRESS2, VBD
from vbraille.render.braille.style import Profile

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TextIO

    from numpy.typing import ArrayLike, NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.layout import Line
    from vbraille.render.braille.models import Model
    from vbraille.render.braille.style import BrailleStyle, Tuning


@dataclass(frozen=True, slots=True, eq=False)
class FigureTable:
    """All that one picture draws.

    Parameters
    ----------
    kind
        Kind of the picture: profile, mapping, wave, strain or page.
    title
        Title of the picture, in a line.
    columns
        Values by name, all of one length; the names tell the units. NaN stands
        where a row has no such value.
    panels
        Name of the column of whose values each has a panel; empty for one panel.
    """

    kind: str
    title: str
    columns: dict[str, NDArray]
    panels: str = ""

    def __getitem__(self, name: str) -> NDArray:
        return self.columns[name]

    def where(self, name: str, value: object) -> FigureTable:
        """Return the rows in which a column has a value."""
        chosen = self.columns[name] == value
        return replace(self, columns={n: v[chosen] for n, v in self.columns.items()})


def write_csv(table: FigureTable, stream: TextIO) -> None:
    """Write a table, its column names first, and its numbers to the sixth decimal."""
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(table.columns)
    rows = zip(*(values.tolist() for values in table.columns.values()), strict=True)
    writer.writerows(map(_spell, row) for row in rows)


def tuning_words(tuning: Tuning) -> str:
    """Name the texture, and the contrast if it is turned down, for the end of a title."""
    return f", T = {100 * tuning.texture:g} %{contrast_words(tuning)}"


def contrast_words(tuning: Tuning) -> str:
    """Name the contrast for the end of a title; nothing if it is full."""
    return "" if tuning.contrast == 1 else f", contrast {100 * tuning.contrast:g} %"


def _spell(value: str | float) -> str:
    if isinstance(value, str):
        return value
    if math.isnan(value):
        return ""
    return f"{round(value, 6) + 0.0:.12g}"  # + 0.0, so that no "-0" is written


def page(lines: Sequence[Line], model: Model, *, x_mm: float, first: int = 1) -> FigureTable:
    """Dots of some lines where they stand on the surface, and the array upon the first of them.

    Parameters
    ----------
    lines
        The lines from the top; the first dot row of the first line is at y = 0.
    model
        The display that shows them, and the style.
    x_mm
        Place of the array's centre.
    first
        Number of the first line.

    Returns
    -------
    Table
        A row for each dot, then a row for each actuator; ``what`` tells which. Both have
        ``line`` (its number), ``x_mm`` and ``y_mm`` (of the centre; y grows to the reader) and
        ``width_mm`` (of the dot, or the column pitch). Dots have ``cell`` (from 0), ``dot``
        (1 … 8) and ``raised`` (0 or 1); actuators have ``row``, ``column`` and ``deflection``.
    """
    style, geometry, array = model.style, model.style.geometry, model.display
    eight = any((line.masks > 0x3F).any() for line in lines)
    places = list(PLACES.items())[: 8 if eight else 6]
    frame = style.render(lines[0].masks, array).path(np.array([x_mm]))[0]
    left, top = x_mm - array.span_mm / 2, _first_row_mm(model)
    across, along = array.column_offsets_mm(), array.row_offsets_mm()
    rows: list[dict[str, Any]] = [
        {
            "what": "dot",
            "line": first + number,
            "x_mm": cell * geometry.cell_pitch_mm
            + right * geometry.dot_spacing_mm
            + geometry.dot_width_mm / 2,
            "y_mm": number * geometry.line_pitch_mm + down * geometry.row_spacing_mm,
            "width_mm": geometry.dot_width_mm,
            "cell": cell,
            "dot": dot,
            "raised": bool(mask & mask_of([dot])),
        }
        for number, line in enumerate(lines)
        for cell, mask in enumerate(line.masks.tolist())
        for dot, (right, down) in places
    ]
    rows += [
        {
            "what": "actuator",
            "line": first,
            "x_mm": left + across[column],
            "y_mm": top + along[row],
            "width_mm": array.column_pitch_mm,
            "row": row,
            "column": column,
            "deflection": deflection,
        }
        for (row, column), deflection in np.ndenumerate(frame)
    ]
    names = dict.fromkeys([*rows[0], "cell", "dot", "raised", *rows[-1]])
    columns = {name: np.array([row.get(name, math.nan) for row in rows]) for name in names}
    title = (
        f"{model.title}: line {first}, left column at {left:g} mm, "
        f"{style.mapping.name}{tuning_words(style.tuning)}"
    )
    return FigureTable("page", title, columns)


def _first_row_mm(model: Model) -> float:
    """Tell where actuator row 0 is when the first row that shows dots is upon these dots."""
    style = model.style
    first = style.rows_on(model.display).start
    pairs = zip(style.mapping.left, style.mapping.right, strict=True)
    shown = ((row, dot_row) for row, pair in enumerate(pairs, first) for dot_row in pair)
    row, dot_row = next((place for place in shown if place[1] != NONE), (0, 0))
    return dot_row * style.geometry.row_spacing_mm - row * model.display.row_pitch_mm


# Lévesque 2009, fig. 4.3, and the VBD's nominal and textured dots of 3.2.
LEVELS = {Profile.RAISED_COSINE: (0.0, 0.25, 1.0), Profile.HALF_SINE: (0.0, 1.0)}
# Narrower than ε = 0.7 mm, wider than ε, wider than 2ε: the cases of fig. 3.10.
STRAIN_WIDTHS_MM = (0.5, 1.0, 2.0)
# The letter of fig. 4.5, z: dots in all three rows and in both columns, no two rows alike.
LETTER = np.array([0b110101], np.uint8)
_ONE_DOT = np.array([1], np.uint8)


def profile(model: Model) -> FigureTable:
    """Compute the deflection across one dot, at each texture level of Lévesque 2009.

    Lévesque 2009, fig. 4.3 (STReSS²) and 3.2 (VBD).

    Parameters
    ----------
    model
        The display and the style, which gives the dots' width, their contrast, and the texture's
        cycles. The style's texture level is added to the others if it is not there yet.

    Returns
    -------
    Table
        ``u_mm``, the distance from the dot's left edge, and a column
        ``deflection_T<percent>`` for each level T.
    """
    style, tuning = model.style, model.style.tuning
    width = style.geometry.dot_width_mm
    u = width * np.arange(-80, 481) / 400  # edges and centre are on the grid
    columns: dict[str, NDArray] = {"u_mm": u}
    for level in sorted({*LEVELS[style.profile], tuning.texture}):
        columns[f"deflection_T{100 * level:g}"] = _swing(
            u, width, style.profile, replace(tuning, texture=level)
        )
    cycles = f", k = {tuning.cycles}" if style.profile is Profile.RAISED_COSINE else ""
    title = f"{model.title}: profile of a dot {width:g} mm wide{cycles}{contrast_words(tuning)}"
    return FigureTable("profile", title, columns)


def mapping(
    style: BrailleStyle, masks: NDArray[np.uint8] = LETTER, model: Model = STRESS2
) -> FigureTable:
    """Compute the deflection of each row of a display along a letter, for each mapping.

    Lévesque 2009, fig. 4.5, and the two methods of its author's later code.

    Parameters
    ----------
    masks : uint8[cells]
        Dot masks of the letter, or of several.
    model
        The display.

    Returns
    -------
    Table
        ``method``, ``x_mm`` (of the actuator) and ``deflection_row_0`` and on.
    """
    # All columns sample the same function (eq. 3.1): one of them shows it.
    column = replace(model.display, columns=1)
    methods = [way for way in MAPPINGS.values() if way.rows <= column.rows]
    geometry, tuning = style.geometry, style.tuning
    extent = geometry.extent_mm(len(masks))
    x = _grid(-1.0, extent + 1.0, _step_mm(geometry.dot_width_mm))
    frames = [replace(style, mapping=way).render(masks, column).path(x)[:, :, 0] for way in methods]
    columns = {
        "method": np.repeat([method.name for method in methods], x.size),
        "x_mm": np.tile(x, len(methods)),
        **_numbered("deflection_row_", np.concatenate(frames).T),
    }
    letters = to_braille(masks.tolist())
    title = f"{model.title}: {letters} on {column.rows} actuator rows{tuning_words(tuning)}"
    return FigureTable("mapping", title, columns, "method")


def wave(model: Model) -> FigureTable:
    """Compute the deflection of each column while the array passes one dot.

    Lévesque 2009, eq. 3.1 and figs. 3.8-3.9.

    Parameters
    ----------
    model
        The display and the style. The dot's left edge is at 0.

    Returns
    -------
    Table
        ``x_mm``, the carriage's position, which is the left column's, and
        ``deflection_column_0`` and on.
    """
    array, style = model.display, model.style
    width, tuning = style.geometry.dot_width_mm, style.tuning
    x = _grid(-array.span_mm - width / 4, width * 5 / 4, _step_mm(width))
    surface = x + array.column_offsets_mm()[:, None]  # eq. 3.1
    swing = _swing(surface, width, style.profile, tuning)
    title = f"{model.title}: the array passes a dot {width:g} mm wide{tuning_words(tuning)}"
    return FigureTable("wave", title, {"x_mm": x, **_numbered("deflection_column_", swing)})


def strain(geometry: Geometry, tuning: Tuning) -> FigureTable:
    """Compute two neighbouring actuators of the VBD, and the strain of the skin between them.

    Lévesque 2009, 3.2 and fig. 3.10: (δ_{i+1} - δ_i) / ε.

    Parameters
    ----------
    geometry
        Distances, of which the dot width is added to `STRAIN_WIDTHS_MM` if it is not there yet.

    Returns
    -------
    Table
        ``dot_width_mm``, ``x_mm`` (of the left of the two; the dot's left edge is at 0),
        ``deflection_left``, ``deflection_right`` and ``strain_per_mm`` (full swings per mm;
        positive is expansion).
    """
    pitch = VBD.display.column_pitch_mm
    widths = sorted({*STRAIN_WIDTHS_MM, geometry.dot_width_mm})
    parts: list[dict[str, NDArray]] = []
    for width in widths:
        x = _grid(-pitch - 0.5, max(widths) + 0.5, _step_mm(width))
        left, right = (_swing(at, width, VBD.style.profile, tuning) for at in (x, x + pitch))
        parts.append(
            {
                "dot_width_mm": np.full(x.size, width),
                "x_mm": x,
                "deflection_left": left,
                "deflection_right": right,
                "strain_per_mm": (right - left) / pitch,
            }
        )
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    title = f"{VBD.title}: strain between neighbours, ε = {pitch:g} mm apart{tuning_words(tuning)}"
    return FigureTable("strain", title, columns, "dot_width_mm")


def _swing(
    u_mm: ArrayLike, width_mm: float, shape: Profile, tuning: Tuning
) -> NDArray[np.floating]:
    """Swing of a dot at distances from its left edge, float[n] or float[m, n]."""
    geometry = replace(VBD.style.geometry, dot_width_mm=width_mm)
    style = replace(
        VBD.style, profile=shape, mapping=single_row(1), geometry=geometry, tuning=tuning
    )
    one = replace(VBD.display, columns=1)
    places_mm = np.asarray(u_mm, np.float64)
    return style.render(_ONE_DOT, one).path(places_mm.ravel())[:, 0, 0].reshape(places_mm.shape)


def _grid(low: float, high: float, step: float) -> NDArray[np.float64]:
    """Make the multiples of a step from `low` to `high`, 0 among them."""
    return np.asarray(
        np.arange(math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9) + 1) * step,
        np.float64,
    )


def _step_mm(width_mm: float) -> float:
    return min(0.01, width_mm / 100)


def _numbered(name: str, series: NDArray[np.floating]) -> dict[str, NDArray]:
    return {f"{name}{number}": values for number, values in enumerate(series)}
