"""What keeps a finger on its line of a page, and how far the array may be turned."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, Literal

from vbraille.errors import check_range

# How an array is read that does not stand where the line has its dots, as options name it.
Manner = Literal["line", "free"]
MANNERS: Final[tuple[Manner, ...]] = ("line", "free")

# Measured with hands that drift: `python -m tests.measures.straying`, and docs/measured.md.
BAND: Final = 0.25
BAND_BOUNDS: Final = (0.0, 0.9)
# Farther turned than this, an array shows no braille. Measured likewise, in the same table: the
# ends of a row of actuators then lie over another row of dots than the one that they show.
MOST_TILT_RAD: Final = math.radians(20.0)


@dataclass(frozen=True, slots=True)
class Straying:
    """What a page shows to a finger that strays from the middle of a line.

    Parameters
    ----------
    manner
        "line" if rows of actuators keep to the rows of dots of the line that the finger is on;
        "free" if each actuator shows what lies under it.
    band
        Way in y between going to the next line and coming back, in line pitches, 0 to 0.9: the
        finger stays on its line until it is beyond the line's edge by half of that.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    manner: Manner = "line"
    band: float = BAND

    def __post_init__(self) -> None:
        if self.manner not in MANNERS:
            raise ValueError(f"straying is {self.manner!r}; it must be line or free")
        check_range("band", self.band, *BAND_BOUNDS)
