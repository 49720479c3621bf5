"""The numbers of a style that a reader turns: their bounds, steps and units."""

from __future__ import annotations

from typing import Any, NamedTuple

_PLACES = 6  # decimal places, so that ten steps of 0.1 are 1


class Knob(NamedTuple):
    """A number of a style.

    Parameters
    ----------
    name
        Name of its option, and in a profile.
    field
        Field of `BrailleStyle.replace`.
    low, high, step
        Bounds, and the step of a key.
    unit
        "mm", or empty.
    kind
        float, or int where only whole steps from `low` make sense.
    """

    name: str
    field: str
    low: float
    high: float
    step: float
    unit: str = ""
    kind: type = float

    @property
    def label(self) -> str:
        """Name in sentences, such as "dot width"."""
        return self.name.replace("_", " ")

    def value(self, style: Any) -> float:
        """Value that a style has."""
        return getattr(style.geometry if self.unit else style.tuning, self.field)

    def said(self, value: float) -> str:
        """Words for a value, such as "dot width: 2.2 mm"."""
        return f"{self.label}: {value:g} {self.unit}".rstrip()

    def turned(self, value: float, steps: int) -> float:
        """Value after some steps up, or down if negative; it stops at the bounds."""
        return self.nearest(value + steps * self.step)

    def nearest(self, value: float) -> float:
        """Possible value that is nearest to another."""
        within = min(max(value, self.low), self.high)
        if self.kind is int:
            return round(self.low + self.step * round((within - self.low) / self.step))
        return round(within, _PLACES)

    def fits(self, style: Any) -> bool:
        """Tell whether the knob changes anything in a style; the VBD's texture has one period."""
        return self.name != "texture_cycles" or style.profile != 0


KNOBS = {
    knob.name: knob
    for knob in (
        Knob("texture", "texture", 0, 1, 0.1),
        Knob("contrast", "contrast", 0, 1, 0.1),
        Knob("texture_cycles", "cycles", 1, 11, 2, kind=int),
        Knob("dot_width", "dot_width_mm", 0.1, 20, 0.2, "mm"),
        Knob("dot_spacing", "dot_spacing_mm", 0.1, 50, 0.2, "mm"),
        Knob("cell_gap", "cell_gap_mm", 0.1, 50, 0.2, "mm"),
        Knob("line_pitch", "line_pitch_mm", 1, 500, 0.5, "mm"),
    )
}


def profile_values(style: Any) -> dict[str, Any]:
    """Values of a style that a profile keeps, by the names of their options."""
    values: dict[str, Any] = {
        name: knob.value(style) for name, knob in KNOBS.items() if knob.fits(style)
    }
    if style.mapping.rows == 1:
        values["dot_row"] = style.mapping.left[0] + 1
    else:
        values["mapping"] = style.mapping.name
    return values
