"""The displays of Lévesque 2009 and the Latero, how each is read, and how any other display is."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.braille import geometry
from vbraille.carriers import carrier
from vbraille.display import Display
from vbraille.errors import InputError
from vbraille.render.braille.mappings import MAPPINGS, single_row
from vbraille.render.braille.style import BrailleStyle, Profile, Tuning

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry

# Difference that is allowed between the pitches of an array and of a model, as a share.
PITCH_TOLERANCE = 0.01
# Number of rows in a mapping that shows all dot rows of a cell one actuator row apart.
_LEAST_ROWS = 3
# Way of a contactor from rest to full deflection. The source says that the actuators of its later
# arrays deflect "about ± 0.1 mm"; that it is so of both models, and of other displays, is assumed,
# and only pictures depend on it: a skin that loads the contactors moves them less.
SWING_MM = 0.2


@dataclass(frozen=True, slots=True)
class Model:
    """A display, and the style in which it is read unless told otherwise.

    Parameters
    ----------
    name
        Name in options; empty for a display that has none there.
    title
        Name in sentences.
    display
        Display that it is.
    style
        Style in which braille is shown on the display.
    """

    name: str
    title: str
    display: Display
    style: BrailleStyle

    def on(self, geometry: Geometry, rate_hz: float = 1000.0) -> Display:
        """Make the display with the travel of a geometry, at a rate in Hz."""
        return replace(self.display, travel_mm=geometry.travel_mm, rate_hz=rate_hz)


# Lévesque 2009, ch. 3: one row, pitch ε = 0.7 mm; the row pitch has no meaning.
VBD = Model(
    "vbd",
    "VBD",
    Display(
        name="simulated VBD",
        rows=1,
        columns=12,
        column_pitch_mm=0.7,
        row_pitch_mm=0.7,
        rest_side="left",
    ),
    BrailleStyle(Profile.HALF_SINE, single_row(1), geometry.VBD, Tuning(texture=0.0)),
)
# Lévesque 2009, 4.2 and 5.2: an active area of 12.0 × 10.8 mm.
STRESS2 = Model(
    "stress2",
    "STReSS²",
    Display(
        name="simulated STReSS²",
        rows=6,
        columns=10,
        column_pitch_mm=1.2,
        row_pitch_mm=1.8,
    ),
    BrailleStyle(
        Profile.RAISED_COSINE, MAPPINGS["alternate"], geometry.STRESS2, Tuning(texture=1.0)
    ),
)
# Lévesque 2009, 6.2, on the Tactograph of ch. 7; contactors as in its author's later code. Of eight
# rows every second one shows a row of dots: 2.8 mm apart, which comes nearest to the 2.5 mm of
# paper (4.2 mm on every third row), and in the order of that code, from the far row on.
_ARRAY_8X8 = Display(
    name="simulated STReSS² 8 × 8",
    rows=8,
    columns=8,
    column_pitch_mm=1.2,
    row_pitch_mm=1.4,
    contactor_mm=(0.5, 1.2),
)
STRESS2_8X8 = Model(
    "stress2-8x8",
    "STReSS² 8 × 8",
    carrier.TACTOGRAPH.under(_ARRAY_8X8),
    replace(STRESS2.style, mapping=MAPPINGS["eight-dots"], geometry=geometry.STRESS2_8X8),
)
# The same array on the Pantograph of Lévesque 2009, 6.2, as in the experiments of 6.4: a smaller
# surface, and an array that is kept upright and not measured.
PANTOGRAPH = Model(
    "pantograph",
    "STReSS² 8 × 8 on the Pantograph",
    carrier.PANTOGRAPH.under(_ARRAY_8X8),
    replace(STRESS2_8X8.style, geometry=geometry.PANTOGRAPH),
)
# Not in the source: its successor.
LATERO = Model(
    "latero",
    "Latero",
    carrier.LATERO.under(replace(carrier.LATERO_ARRAY, name="simulated Latero")),
    replace(STRESS2.style, mapping=MAPPINGS["eight-dots"], geometry=geometry.LATERO),
)
MODELS = {model.name: model for model in (STRESS2, STRESS2_8X8, PANTOGRAPH, LATERO, VBD)}


def same_array(one: Display, other: Display) -> bool:
    """Tell whether two displays have as many actuators, as far apart; a single row has no pitch."""
    columns = one.columns, one.column_pitch_mm, other.column_pitch_mm
    rows = one.rows, one.row_pitch_mm, other.row_pitch_mm
    return one.shape == other.shape and all(
        lines == 1 or math.isclose(pitch_mm, other_mm, rel_tol=PITCH_TOLERANCE)
        for lines, pitch_mm, other_mm in (columns, rows)
    )


def model_of(display: Display) -> Model:
    """Choose the model by which a device's display is read: the one that it resembles most.

    A display that has the array of a known model is that model. Any other display of six rows or
    more is read as the STReSS² is, in its middle rows. Three to five rows show each row of dots on
    a row of actuators. One or two rows show one row of dots, as the VBD does.
    """
    for model in MODELS.values():
        if same_array(display, model.display):
            return replace(model, display=display)
    if display.rows >= STRESS2.style.mapping.rows:
        style = STRESS2.style
    elif display.rows >= _LEAST_ROWS:
        style = replace(STRESS2.style, mapping=MAPPINGS["three-rows"])
    else:
        style = VBD.style
    return Model("", display.name, display, style)


def check_shown(display: object, style: object = None) -> None:
    """Raise InputError if what is given for a display is none, or for a style, if there is one."""
    if not isinstance(display, Model | Display):
        known = MODELS.get(display.lower()) if isinstance(display, str) else None
        hint = f"vbraille.{known.name.upper()}" if known else "vbraille.VBD, vbraille.STRESS2"
        raise InputError(
            f"display is {display!r}; give {hint}{'' if known else ' or a vbraille.Display'}"
        )
    if not isinstance(style, BrailleStyle | None):
        raise InputError(
            f"style is {style!r}; give a vbraille.BrailleStyle, such as vbraille.VBD.style"
        )
