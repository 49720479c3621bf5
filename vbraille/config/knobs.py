"""Knobs of a style: what keeps one from turning, the mappings in turn, and values for files.

`vbraille.config.options` declares them. Mappings and dot rows are no numbers; the ones that a
display can show come one after the other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.braille.dots import DOT_ROWS
from vbraille.config.options import knobs
from vbraille.errors import InputError
from vbraille.render.braille.mappings import MAPPINGS, single_row
from vbraille.render.braille.profiles import Profile

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.config.options import StyleKnob
    from vbraille.display import Display
    from vbraille.render.braille.mappings import Mapping
    from vbraille.render.braille.style import BrailleStyle

_CELL = ("dot_width_mm", "dot_spacing_mm", "cell_gap_mm")
_SHOWN_ROWS = DOT_ROWS - 1  # the row of dots 7 and 8 is not shown alone
KNOBS = {knob.key: knob for knob in knobs()}


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
