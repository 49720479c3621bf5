"""The numbers behind each picture, which are drawn, and which `--csv` prints.

Deflections are shares of the full swing: 0 is rest, 1 the other end. Rows and
columns of actuators count from 0, from the far left.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.spelling import to_braille
from vbraille.pictures.table import FigureTable, contrast_words, tuning_words
from vbraille.render.braille.mappings import MAPPINGS
from vbraille.render.braille.models import STRESS2, VBD
from vbraille.render.braille.profiles import Profile
from vbraille.render.braille.reference import SWINGS, deflections

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from vbraille.braille.geometry import Geometry
    from vbraille.render.braille.mappings import Mapping
    from vbraille.render.braille.models import Model
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.render.braille.tuning import Tuning

# Lévesque 2009, fig. 4.3, and the VBD's nominal and textured dots of 3.2.
LEVELS = {Profile.RAISED_COSINE: (0.0, 0.25, 1.0), Profile.HALF_SINE: (0.0, 1.0)}
# Narrower than ε = 0.7 mm, wider than ε, wider than 2ε: the cases of fig. 3.10.
STRAIN_WIDTHS_MM = (0.5, 1.0, 2.0)
# The letter of fig. 4.5, z: dots in all three rows and in both columns, no two rows alike.
LETTER = np.array([0b110101], np.uint8)


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
    style: BrailleStyle,
    masks: NDArray[np.uint8] = LETTER,
    methods: Sequence[Mapping] = (),
    model: Model = STRESS2,
) -> FigureTable:
    """Compute the deflection of each row of a display along a letter, for each mapping.

    Lévesque 2009, fig. 4.5, and the two methods of its author's later code.

    Parameters
    ----------
    masks : uint8[cells]
        Dot masks of the letter, or of several.
    methods
        The mappings to compare; all that the display has rows for, if none is given.
    model
        The display.

    Returns
    -------
    Table
        ``method``, ``x_mm`` (of the actuator) and ``deflection_row_0`` and on.
    """
    # All columns sample the same function (eq. 3.1): one of them shows it.
    column = replace(model.display, columns=1)
    methods = methods or [way for way in MAPPINGS.values() if way.rows <= column.rows]
    geometry, tuning = style.geometry, style.tuning
    extent = geometry.extent_mm(len(masks))
    x = _grid(-1.0, extent + 1.0, _step_mm(geometry.dot_width_mm))
    frames = [
        deflections(x, masks, replace(style, mapping=way), column)[:, :, 0] for way in methods
    ]
    columns = {
        "method": np.repeat([method.name for method in methods], x.size),
        "x_mm": np.tile(x, len(methods)),
        **_numbered("deflection_row_", np.concatenate(frames).T),
    }
    letters = to_braille(masks.tolist())
    title = f"{model.title}: {letters} on {column.rows} actuator rows{tuning_words(tuning)}"
    return FigureTable("mapping", title, columns)


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
        ``dot_width_mm``, ``pitch_mm`` (ε), ``x_mm`` (of the left of the two; the
        dot's left edge is at 0), ``deflection_left``, ``deflection_right`` and
        ``strain_per_mm`` (full swings per mm; positive is expansion).
    """
    pitch = VBD.display.column_pitch_mm
    widths = sorted({*STRAIN_WIDTHS_MM, geometry.dot_width_mm})
    parts = []
    for width in widths:
        x = _grid(-pitch - 0.5, max(widths) + 0.5, _step_mm(width))
        left = _swing(x, width, VBD.style.profile, tuning)
        right = _swing(x + pitch, width, VBD.style.profile, tuning)
        constant = np.full(x.size, width), np.full(x.size, pitch)
        parts.append((*constant, x, left, right, (right - left) / pitch))
    names = (
        "dot_width_mm",
        "pitch_mm",
        "x_mm",
        "deflection_left",
        "deflection_right",
        "strain_per_mm",
    )
    joined = (np.concatenate(values) for values in zip(*parts, strict=True))
    title = f"{VBD.title}: strain between neighbours, ε = {pitch:g} mm apart{tuning_words(tuning)}"
    return FigureTable("strain", title, dict(zip(names, joined, strict=True)))


def _swing(
    u_mm: ArrayLike, width_mm: float, shape: Profile, tuning: Tuning
) -> NDArray[np.floating]:
    return tuning.contrast * SWINGS[shape](u_mm, width_mm, tuning)


def _grid(low: float, high: float, step: float) -> NDArray[np.floating]:
    """Make the multiples of a step from `low` to `high`, 0 among them."""
    return np.arange(math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9) + 1) * step


def _step_mm(width_mm: float) -> float:
    return min(0.01, width_mm / 100)


def _numbered(name: str, series: NDArray[np.floating]) -> dict[str, NDArray]:
    return {f"{name}{number}": values for number, values in enumerate(series)}
