"""What a reader turns while reading: a table of knobs, and how far each of them goes.

A knob is a field of the style with a name, a unit, a step and bounds. Mappings and dot rows are
no numbers; the ones that a display can show come one after the other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.braille.dots import DOT_ROWS
from vbraille.braille.geometry import BOUNDS_MM
from vbraille.errors import InputError
from vbraille.render.braille.mappings import MAPPINGS, single_row
from vbraille.render.braille.profiles import MOST_TEXTURE_CYCLES, Profile

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.render.braille.mappings import Mapping
    from vbraille.render.braille.style import BrailleStyle

_PLACES = 6  # decimal places, so that ten steps of 0.1 are 1
_CELL = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm")
_SHOWN_ROWS = DOT_ROWS - 1  # the row of dots 7 and 8 is not shown alone


@dataclass(frozen=True, slots=True)
class StyleKnob:
    """A number of a style that a reader turns.

    Parameters
    ----------
    name
        Name in commands and in settings files.
    field
        Field that `BrailleStyle.replace` takes.
    label
        Name in sentences.
    unit
        Unit in sentences; empty without one.
    step
        Number that a turn adds.
    low, high
        Bounds of the value.
    """

    name: str
    field: str
    label: str
    unit: str
    step: float
    low: float
    high: float

    def applied(self, style: BrailleStyle, value: float) -> BrailleStyle:
        """Style in which the knob has another value."""
        changes: dict[str, Any] = {self.field: value}
        return style.replace(**changes)

    def value(self, style: BrailleStyle) -> float:
        """Value of a style."""
        part = style.geometry if self.unit == "mm" else style.tuning
        return getattr(part, self.field)

    def said(self, value: float) -> str:
        """Words for a value, such as "dot width: 2.2 mm"."""
        return f"{self.label}: {value:g} {self.unit}".rstrip()

    def turned(self, value: float, steps: int) -> float:
        """Value after so many steps up, or down if negative; it stops at the bounds."""
        return self.nearest(value + steps * self.step)

    def nearest(self, value: float) -> float:
        """Value that the knob can have, within its bounds, that is nearest to another."""
        within = min(max(value, self.low), self.high)
        if isinstance(self.low, int):  # only whole steps make sense
            return round(self.low + self.step * round((within - self.low) / self.step))
        return round(within, _PLACES)


def _length(name: str, step: float) -> StyleKnob:
    low, high = BOUNDS_MM[f"{name}_mm"]
    return StyleKnob(f"{name}_mm", f"{name}_mm", name.replace("_", " "), "mm", step, low, high)


KNOBS = {
    knob.name: knob
    for knob in (
        StyleKnob("texture", "texture", "texture", "", 0.1, 0.0, 1.0),
        StyleKnob("contrast", "contrast", "contrast", "", 0.1, 0.0, 1.0),
        StyleKnob("texture_cycles", "cycles", "texture cycles", "", 2, 1, MOST_TEXTURE_CYCLES),
        _length("dot_width", 0.2),
        _length("dot_spacing", 0.2),
        _length("cell_gap", 0.2),
        _length("line_pitch", 0.5),
    )
}


def fixed(knob: StyleKnob, style: BrailleStyle) -> str:
    """Reason why a knob turns nothing in a style; empty if it does."""
    if knob.field == "cycles" and style.profile is Profile.HALF_SINE:
        return "the texture of this display has a fixed wavelength"
    return ""


def obstacle(knob: StyleKnob, geometry: Geometry, display: Display, value: float) -> str:
    """Reason why a knob cannot have a value beside the distances that there are; empty if it can.

    Parameters
    ----------
    geometry
        Distances as they are.
    display
        Display whose carriage must have room for a cell.
    """
    width_mm, spacing_mm, gap_mm = (
        value if name == knob.field else getattr(geometry, name) for name in _CELL
    )
    if width_mm > spacing_mm + gap_mm + 1e-9:
        return "a dot must not be wider than the cell pitch"
    if width_mm + spacing_mm + display.span_mm > geometry.travel_mm:
        return "the carriage would have no room for a cell"
    return ""


def mappings_for(style: BrailleStyle, display: Display) -> list[Mapping]:
    """Mappings that can take the place of a style's own on a display, which is one of them.

    A style that shows one row of dots has one for each row; on another display they are those of
    as few rows as it has, or fewer.
    """
    if style.mapping.rows == 1:
        return [single_row(row) for row in range(1, _SHOWN_ROWS + 1)]
    rows = display.rows - (style.first_row or 0)
    return [mapping for mapping in MAPPINGS.values() if mapping.rows <= rows]


def next_mapping(style: BrailleStyle, display: Display) -> Mapping:
    """Mapping after a style's own, in turn, of those that the display can show."""
    mappings = mappings_for(style, display)
    names = [mapping.name for mapping in mappings]
    at = names.index(style.mapping.name) if style.mapping.name in names else -1
    return mappings[(at + 1) % len(mappings)]


def say_mapping(mapping: Mapping) -> str:
    """Words for a mapping: "mapping: sheared", or "dot row: 2" where it shows one row of dots."""
    if mapping.rows == 1:
        return f"dot row: {mapping.left[0] + 1}"
    return f"mapping: {mapping.name}"


def kept_values(style: BrailleStyle) -> dict[str, float | int | str]:
    """Values of all that can be turned in a style, by the names of a settings file."""
    values: dict[str, float | int | str] = {
        name: knob.value(style) for name, knob in KNOBS.items() if not fixed(knob, style)
    }
    if style.mapping.rows == 1:
        values["dot_row"] = style.mapping.left[0] + 1
    else:
        values["mapping"] = style.mapping.name
    return values


def with_values(
    style: BrailleStyle, display: Display, values: dict[str, float | int | str]
) -> BrailleStyle:
    """Make a style that has the values of a settings file.

    Parameters
    ----------
    style
        Style whose other values stay.
    display
        Display that must be able to show it.
    values
        Values by the names that `kept_values` gives.

    Raises
    ------
    InputError
        If a value is out of range, or not for this display. The message begins with the name of
        the value, with blanks for underscores and without its unit, where one value is at fault.
    """
    changes: dict[str, Any] = {}
    for name, value in values.items():
        if name in KNOBS:
            knob = KNOBS[name]
            if reason := fixed(knob, style):
                raise InputError(f"{knob.label} cannot be set: {reason}")
            changes[knob.field] = value
        else:
            changes["mapping"] = _mapping(style, display, name, value)
    return style.replace(**changes)


def _mapping(style: BrailleStyle, display: Display, name: str, value: object) -> Mapping:
    """Mapping that a settings file names; InputError if the display cannot show it."""
    allowed: dict[object, Mapping] = {
        (m.left[0] + 1 if m.rows == 1 else m.name): m for m in mappings_for(style, display)
    }
    own = "dot_row" if style.mapping.rows == 1 else "mapping"
    if name != own:
        raise InputError(
            f"{name.replace('_', ' ')} is not for this display; {own} chooses which dots it shows"
        )
    if value not in allowed:
        names = ", ".join(map(str, allowed))
        raise InputError(f"{name.replace('_', ' ')} is {value!r}; it must be one of {names}")
    return allowed[value]
