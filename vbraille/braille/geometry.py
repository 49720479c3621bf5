"""Places of a line's dots on the virtual surface.

Lengths are in millimetres, x grows to the reader's right, and x = 0 is the left
edge of the line's first cell, which is the left edge of its left dot column.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace

from vbraille.errors import InputError, check_range

BOUNDS_MM = {
    "dot_width_mm": (0.1, 20.0),
    "dot_spacing_mm": (0.1, 50.0),
    "cell_gap_mm": (0.1, 50.0),
    "row_spacing_mm": (0.1, 50.0),
    "line_pitch_mm": (1.0, 500.0),
    "travel_mm": (1.0, 10_000.0),
}


@dataclass(frozen=True, slots=True)
class Geometry:
    """Distances of a line of virtual braille, in mm.

    Parameters
    ----------
    dot_width_mm
        Width of a dot along x, twice its radius.
    dot_spacing_mm
        Distance from the centre of a cell's left dot column to that of its right one.
    cell_gap_mm
        Distance from the right dot column of a cell to the left one of the next.
    row_spacing_mm
        Distance between the centres of neighbouring dot rows.
    line_pitch_mm
        Distance between the first dot rows of neighbouring lines.
    travel_mm
        How far the carriage goes. Lévesque 2009 gives none for the two sliders; the
        300 mm of the presets are our choice.

    Raises
    ------
    ValueError
        If a length is out of `BOUNDS_MM`, or a dot is wider than a cell.
    """

    dot_width_mm: float
    dot_spacing_mm: float
    cell_gap_mm: float
    row_spacing_mm: float
    line_pitch_mm: float
    travel_mm: float = 300.0

    def __post_init__(self) -> None:
        for field in fields(self):
            low, high = BOUNDS_MM[field.name]
            name = field.name.removesuffix("_mm").replace("_", " ")
            check_range(name, getattr(self, field.name), low, high, " mm")
        if self.dot_width_mm > self.cell_pitch_mm:
            raise ValueError(
                f"dot width is {self.dot_width_mm:g} mm; it must be at most the cell pitch, "
                f"here {self.cell_pitch_mm:g} mm"
            )

    @property
    def cell_pitch_mm(self) -> float:
        """Distance from a dot column of one cell to the same column of the next."""
        return self.dot_spacing_mm + self.cell_gap_mm

    def extent_mm(self, cells: int) -> float:
        """Return the right end of the last dot column of a line of some cells; 0 for no cells."""
        if cells == 0:
            return 0.0
        return (cells - 1) * self.cell_pitch_mm + self.dot_spacing_mm + self.dot_width_mm

    def cells_per_line(self, span_mm: float) -> int:
        """Count the cells that an array of the given span can cross whole within the travel.

        Raises
        ------
        InputError
            If there is no room for a single cell.
        """
        least = span_mm + self.dot_width_mm + self.dot_spacing_mm
        room = self.travel_mm - least
        # 1e-9: a travel given for exactly n cells must not lose one to rounding.
        if room < -1e-9:
            raise InputError(
                f"a travel of {self.travel_mm:g} mm is too short for one cell; "
                f"it must be at least {least:g} mm"
            )
        return 1 + math.floor(room / self.cell_pitch_mm + 1e-9)


# Lévesque 2009, 3.3: tuned width and spacing; the character pitch is 6 mm scaled by 4.0 / 2.29.
# The line pitch is our choice, 10 mm scaled likewise: the device shows one row of dots.
VBD = Geometry(
    dot_width_mm=2.0,
    dot_spacing_mm=4.0,
    cell_gap_mm=6.48,
    row_spacing_mm=4.0,
    line_pitch_mm=17.5,
)
# Lévesque 2009, 4.2; the line pitch is our choice, 1.4 × that on paper, as for the dot rows.
STRESS2 = Geometry(
    dot_width_mm=2.6,
    dot_spacing_mm=3.7,
    cell_gap_mm=7.4,
    row_spacing_mm=3.6,
    line_pitch_mm=14.0,
)
# Lévesque 2009, 6.2, and the Latero: along the line as on the STReSS² of ch. 4, since the columns
# are as far apart; rows of dots on every second row of actuators, 1.4 and 1.6125 mm apart. The line
# pitch is ours, as much larger than the row spacing as there. The travel is the carrier's.
STRESS2_8X8 = replace(STRESS2, row_spacing_mm=2.8, line_pitch_mm=11.0, travel_mm=220.0)
# Lévesque 2009, 5.2 and 6.2: the same array on a carrier that goes less far.
PANTOGRAPH = replace(STRESS2_8X8, travel_mm=113.0)
LATERO = replace(STRESS2, row_spacing_mm=3.225, line_pitch_mm=12.5, travel_mm=281.0)
# Embossed paper: 2.29 and 3.71 mm as in Lévesque 2009; the others are common values.
STANDARD = Geometry(
    dot_width_mm=1.5,
    dot_spacing_mm=2.29,
    cell_gap_mm=3.71,
    row_spacing_mm=2.29,
    line_pitch_mm=10.0,
)

PRESETS = {
    "vbd": VBD,
    "stress2": STRESS2,
    "stress2-8x8": STRESS2_8X8,
    "pantograph": PANTOGRAPH,
    "latero": LATERO,
    "standard": STANDARD,
}
