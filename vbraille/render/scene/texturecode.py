"""Words of textures and images; `texturekernels` has what they do."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vbraille.render.machine import words
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.fitting import Cycle, axial_cycle
from vbraille.scene.measures import travel_deg
from vbraille.scene.textures import Gradual, TurnPeak

if TYPE_CHECKING:
    from vbraille.render.scene.blocks import WordBlock
    from vbraille.scene.bitmap import Bitmap
    from vbraille.scene.textures import AxialGrating, LinearGrating, Peak, RadialGrating


def say_linear(grating: LinearGrating, block: WordBlock) -> None:
    """Say a linear grating."""
    angle = math.radians(travel_deg(grating.wave_angle_deg, grating.ridge_angle_deg))
    right, down = math.cos(angle), math.sin(angle)
    x, y = grating.start_mm
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    waveform = _waveform(cycle, grating.velocity_mm_s, grating.distortion)
    block.say(words.LINEAR, right, down, x * right + y * down, *waveform)


def say_radial(grating: RadialGrating, block: WordBlock) -> None:
    """Say a radial grating."""
    cycle = Cycle(grating.ridge_mm, grating.gap_mm)
    waveform = _waveform(cycle, grating.velocity_mm_s, grating.distortion)
    block.say(words.RADIAL, *grating.center_mm, *waveform)


def say_axial(grating: AxialGrating, block: WordBlock) -> None:
    """Say an axial grating."""
    cycle = axial_cycle(grating)
    waveform = _waveform(cycle, grating.velocity_deg_s, grating.distortion)
    factor = 1.0 if grating.distortion is None else max(1.0, grating.distortion.factor)
    inner_mm, outer_mm = grating.fade_mm
    radius = factor / math.radians(cycle.length)
    slope = 1.0 / ((outer_mm - inner_mm) * radius)
    fade = (grating.middle, inner_mm * radius, slope)
    block.say(words.AXIAL, *grating.center_mm, grating.start_deg, *fade, *waveform)


def say_bitmap(bitmap: Bitmap, block: WordBlock) -> None:
    """Say a bitmap."""
    rows, columns = bitmap.intensities.shape
    outside = round(bitmap.outside * WHOLE)
    framed = np.pad(bitmap.intensities, 1, constant_values=outside)
    per_mm = columns / bitmap.width_mm, rows / bitmap.height_mm
    x, y = bitmap.place_mm
    # The middle of the frame's first pixel is half a pixel beyond the corner.
    first = x - 0.5 / per_mm[0], y - 0.5 / per_mm[1]
    numbers = (*first, *per_mm, columns + 2, rows + 2, 0.0)
    block.say_table(words.IMAGE, *numbers, at=6, entries=framed.ravel())


def _waveform(
    cycle: Cycle, velocity: float, distortion: Gradual | Peak | TurnPeak | None
) -> tuple[float, ...]:
    own = (cycle.length, cycle.ridge, velocity, 1.0)
    if distortion is None:
        return (*own, 0.0)
    if isinstance(distortion, Gradual):
        begin, length, is_peak = distortion.start_mm, distortion.length_mm, False
    elif isinstance(distortion, TurnPeak):
        begin, length = distortion.center_deg - distortion.length_deg, distortion.length_deg
        is_peak = True
    else:
        begin, length = distortion.center_mm - distortion.length_mm, distortion.length_mm
        is_peak = True
    return (*own, distortion.factor - 1.0, begin, length, float(is_peak))
