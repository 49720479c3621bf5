"""Deflections of the actuators, from a picture and the pose of the array.

This room knows no file, no device and no clock. The kernels are compiled when a `Program` is first
made, not when this is imported.
"""

from vbraille.render.braille.mappings import MAPPINGS, Mapping, single_row
from vbraille.render.braille.models import (
    LATERO,
    MODELS,
    PANTOGRAPH,
    STRESS2,
    STRESS2_8X8,
    VBD,
    Model,
    model_of,
)
from vbraille.render.braille.style import BrailleStyle, Profile, Straying, Tuning

__all__ = [
    "LATERO",
    "MAPPINGS",
    "MODELS",
    "PANTOGRAPH",
    "STRESS2",
    "STRESS2_8X8",
    "VBD",
    "BrailleStyle",
    "Mapping",
    "Model",
    "Profile",
    "Straying",
    "Tuning",
    "model_of",
    "single_row",
]
