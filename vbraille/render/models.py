"""The two displays: an array, a dot profile, and the distances tuned for them."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

from vbraille import geometry
from vbraille.render.arrays import STRESS2_ARRAY, VBD_ARRAY, ActuatorArray
from vbraille.render.mappings import MAPPINGS, Mapping, single_row
from vbraille.render.tuning import Tuning

if TYPE_CHECKING:
    from vbraille.geometry import Geometry


class Profile(IntEnum):
    """How the deflection swings across a dot."""

    HALF_SINE = 0
    """The VBD's: Lévesque 2009, 3.2, with the texture's phase and norm made exact by us."""
    RAISED_COSINE = 1
    """The STReSS²'s: Lévesque 2009, eqs. 4.1-4.3."""

    def texture_period_mm(self, dot_width_mm: float, cycles: int) -> float:
        """Wavelength of the texture along x."""
        if self is Profile.HALF_SINE:
            return dot_width_mm / 4
        return dot_width_mm / cycles


@dataclass(frozen=True, slots=True)
class Model:
    """A display with its defaults.

    Parameters
    ----------
    name, title
        What options call it, and what people do.
    array
        Its actuators.
    rest_side
        Where they stand at deflection 0, "left" or "right".
    profile
        Its dots.
    mapping, geometry, tuning
        What it is used with unless told otherwise.
    """

    name: str
    title: str
    array: ActuatorArray
    rest_side: str
    profile: Profile
    mapping: Mapping
    geometry: Geometry
    tuning: Tuning


VBD = Model(
    "vbd",
    "VBD",
    VBD_ARRAY,
    "left",
    Profile.HALF_SINE,
    single_row(1),
    geometry.VBD,
    Tuning(texture=0.0),
)
STRESS2 = Model(
    "stress2",
    "STReSS²",
    STRESS2_ARRAY,
    "right",
    Profile.RAISED_COSINE,
    MAPPINGS["alternate"],
    geometry.STRESS2,
    Tuning(texture=1.0),
)
MODELS = {model.name: model for model in (STRESS2, VBD)}
