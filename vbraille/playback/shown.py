"""What a page shows of braille that was recorded: the array, the cells and the distances."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Final

from vbraille.live.messages import ArrayShown, LineShown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.render import BrailleStyle

# Lévesque 2009, 8.5.3: actuators deflect about ± 0.1 mm. No recording tells it.
SWING_MM: Final = 0.2
_LENGTHS: Final = (
    "dot_width_mm",
    "dot_spacing_mm",
    "cell_gap_mm",
    "row_spacing_mm",
    "line_pitch_mm",
)


def array_shown(display: Display) -> ArrayShown:
    """Describe the actuators of a display."""
    return ArrayShown(
        display.name,
        display.rows,
        display.columns,
        display.column_pitch_mm,
        display.row_pitch_mm,
        SWING_MM,
        display.rest_side == "right",
        display.travel_mm,
        display.height_mm,
        display.turns,
        display.rate_hz,
    )


def distances_shown(geometry: Geometry) -> dict[str, float]:
    """Distances of braille, by their names."""
    told = asdict(geometry)
    return {name: told[name] for name in _LENGTHS}


def rows_shown(style: BrailleStyle, display: Display) -> list[tuple[int, int]]:
    """For each row of actuators, which dot rows it shows of a cell's left and right dots."""
    shown = [(-1, -1)] * display.rows
    mapping = style.mapping
    shown[style.rows_on(display)] = zip(mapping.left, mapping.right, strict=True)
    return shown


def line_shown(
    number: int, masks: Iterable[int], top_mm: float = 0.0, *, under: bool = False
) -> LineShown:
    """Describe a line of cells, of whose text nothing is known."""
    cells = [int(mask) for mask in masks]
    return LineShown(number, "", 0.0, top_mm, cells, [(0, 0)] * len(cells), under)
