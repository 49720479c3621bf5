"""Carriers: how far each goes, how finely it measures, and a display that stands on it.

The Latero is its array and its carrier in one, so that its array is here, too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

from vbraille.display import Display


@dataclass(frozen=True, slots=True)
class Carrier:
    """A carrier: it moves a display, and measures where it is.

    Parameters
    ----------
    name
        Name in sentences.
    travel_mm, height_mm
        How far the array's centre goes along x and along y.
    turns
        Whether it measures which way the array is turned.
    counts_per_mm
        Resolution where it is worst, in counts a mm; the places between are measured more finely.
    """

    name: str
    travel_mm: float
    height_mm: float
    turns: bool
    counts_per_mm: float

    def under(self, display: Display) -> Display:
        """Make the display that an array is when it stands on this carrier."""
        return replace(
            display,
            name=f"{display.name} on the {self.name}",
            travel_mm=self.travel_mm,
            height_mm=self.height_mm,
            turns=self.turns,
            counts_per_mm=self.counts_per_mm,
        )


# Lévesque 2009, ch. 7: "22 × 15 cm" were left of a letter page when the disc under the array had
# grown; at worst 45.2 µm.
TACTOGRAPH: Final = Carrier(
    "Tactograph",
    220.0,
    150.0,
    turns=True,
    counts_per_mm=1 / 0.0452,
)
# Lévesque 2009, 5.2 and 6.2: a canvas of 11.3 × 6.0 cm, measured to "better than 13 µm"; the reader
# keeps the array upright, and nothing measures it: θ = 0. Its five arms are not in the source.
PANTOGRAPH: Final = Carrier(
    "Pantograph",
    113.0,
    60.0,
    turns=False,
    counts_per_mm=1 / 0.013,
)
# Its tray, and the disc under the array, whose edge cannot leave it: the array's centre goes over
# 281 × 217.5 mm. A count too many or too few in each of its three joints moves the array by 76.5 µm
# at worst.
LATERO_TRAY_MM: Final = (381.0, 317.5)
LATERO_DISC_MM: Final = 100.0
LATERO: Final = Carrier(
    "Latero",
    LATERO_TRAY_MM[0] - LATERO_DISC_MM,
    LATERO_TRAY_MM[1] - LATERO_DISC_MM,
    turns=True,
    counts_per_mm=1 / 0.0766,
)
# By the author's later code: 8 bits, of which it uses 0 … 150.
LATERO_ARRAY: Final = Display(
    name="Latero",
    rows=8,
    columns=8,
    column_pitch_mm=1.2,
    row_pitch_mm=1.6125,
    levels=151,
    rest_side="right",
    rate_hz=1000.0,
    contactor_mm=(0.5, 1.4),
)
