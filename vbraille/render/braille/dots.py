"""Profiles of braille dots, and their texture and contrast."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import chebyshev

from vbraille.errors import check_range

if TYPE_CHECKING:
    from numpy.typing import NDArray

# The kernels' polynomial of T_k has six coefficients; finer texture than this is below what the
# source's encoders resolve.
MOST_TEXTURE_CYCLES = 11


@dataclass(frozen=True, slots=True)
class Tuning:
    """Texture and contrast of braille, which a reader may change while reading.

    Parameters
    ----------
    texture
        Level T in [0, 1], from no texture to what Lévesque 2009 calls "textured" (VBD) or to the
        texture alone (STReSS², eq. 4.3).
    contrast
        Share of the full swing, in [0, 1].
    cycles
        Half-cycles of texture in a dot's radius, k of eq. 4.2; an odd number, so that the waveform
        meets rest at both edges. The VBD does not use it.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    texture: float = 0.0
    contrast: float = 1.0
    cycles: int = 7

    def __post_init__(self) -> None:
        for name in ("texture", "contrast"):
            check_range(name, getattr(self, name), 0, 1)
        if self.cycles % 2 != 1 or not 1 <= self.cycles <= MOST_TEXTURE_CYCLES:
            raise ValueError(
                f"texture cycles are {self.cycles}; "
                f"they must be an odd number, 1 to {MOST_TEXTURE_CYCLES}"
            )


class Profile(IntEnum):
    """Swing of the deflection across a dot."""

    HALF_SINE = 0
    """The profile of the VBD: Lévesque 2009, 3.2; its texture's phase and norm are our choice."""
    RAISED_COSINE = 1
    """The profile of the STReSS²: Lévesque 2009, eqs. 4.1-4.3."""

    def texture_period_mm(self, dot_width_mm: float, cycles: int) -> float:
        """Tell the wavelength of the texture along x, in mm."""
        if self is Profile.HALF_SINE:
            return dot_width_mm / 4
        return dot_width_mm / cycles


def half_sine_peak(level: float) -> float:
    """Find M(a), the largest value of sin θ + a sin 8θ on [0, π], with a = level / 8."""
    a = level / 8
    theta = np.linspace(0, np.pi, 4097)
    best = theta[np.argmax(np.sin(theta) + a * np.sin(8 * theta))]
    for _ in range(4):  # Newton, on the derivative
        slope = np.cos(best) + 8 * a * np.cos(8 * best)
        best -= slope / (-np.sin(best) - 64 * a * np.sin(8 * best))
    return float(np.sin(best) + a * np.sin(8 * best))


def coefficients(profile: Profile, tuning: Tuning) -> NDArray[np.float64]:
    """Compute the coefficients from which the kernels make a dot's profile; float64[6]."""
    shape = np.zeros(6)
    if profile is Profile.HALF_SINE:
        shape[0] = 1 / half_sine_peak(tuning.texture)
        shape[1] = tuning.texture * shape[0]  # a = T / 8, and sin 8θ brings a factor of 8
    else:
        odd = chebyshev.cheb2poly([0] * tuning.cycles + [1])[1::2]  # coefficients of T_k, k odd
        shape[: odd.size] = tuning.texture * odd / 2
        shape[0] += (1 - tuning.texture) / 2
    return shape
