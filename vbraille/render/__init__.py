"""A line of cells and a carriage position become deflections.

Knows no file, no device and no clock. The kernels are compiled when a
`Renderer` is first made, not when this is imported.
"""

from vbraille.render.arrays import LATERO, STRESS2_ARRAY, VBD_ARRAY, ActuatorArray
from vbraille.render.mappings import MAPPINGS, Mapping, single_row
from vbraille.render.models import MODELS, STRESS2, VBD, Model, Profile
from vbraille.render.tuning import Tuning

__all__ = [
    "LATERO",
    "MAPPINGS",
    "MODELS",
    "STRESS2",
    "STRESS2_ARRAY",
    "VBD",
    "VBD_ARRAY",
    "ActuatorArray",
    "Mapping",
    "Model",
    "Profile",
    "Tuning",
    "single_row",
]
