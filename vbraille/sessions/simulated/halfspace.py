"""A second model of the skin for the simulated reader: strain below an elastic half-space.

This model was written down and committed before it was asked for any prediction. It stands beside
that of `vbraille.sessions.simulated.observer`, whose equations 1 and 2, best of the passes and
answer it takes over. It claims nothing about anybody's skin.

**The medium.** Phillips and Johnson (1981, Tactile spatial resolution III, J. Neurophysiol. 46)
predicted how slowly adapting afferents answer to bars, edges and gratings: the skin is an elastic
half-space, homogeneous, isotropic and incompressible, in plane strain; a receptor lies at a depth
of some 0.5 to 1 mm; and its answer follows the largest compressive strain there. They press the
surface in; our contactors stretch it sideways, and the same medium is solved for that.

Let the surface z = 0 be displaced along x by U e^(iκx), without normal stress. With k = |κ|, the
displacement that is free of divergence, in equilibrium and dies away with depth is

    u_x = U (1 - kz) e^(-kz) e^(iκx),    u_z = -iκ U z e^(-kz) e^(iκx),           (4)

with the pressure -2iμκ U e^(-kz) e^(iκx); it also leaves the surface flat, since an incompressible
half-space does not couple the two directions at its surface (Johnson, Contact mechanics, 1985,
chapter 2). With s = du_x/dx at the surface, the strain at depth z is therefore

    ε_xx = -ε_zz = h * s,    γ/2 = g * s,                                         (5)
    h(x) = 2 z x² / [π (x² + z²)²],    g(x) = x (x² - z²) / [π (x² + z²)²],

* being convolution along x. h is Cerruti's and Flamant's solution in plane strain, but for a
factor; the transform of h is (1 - kz) e^(-kz), and g is its Hilbert transform. The principal
strains are ±e, and the largest compressive strain is

    e = √(ε_xx² + (γ/2)²).                                                        (6)

**The surface.** Between neighbouring contactors the surface is stretched evenly by (1); outside of
the array it is not stretched. A contactor moves the skin by as much as it swings. So (5) is a sum
over the pairs of contactors, with

    ∫h dx = [arctan(x/z) - x z / (x² + z²)] / π,                                  (7)
    ∫g dx = [ln(x² + z²) / 2 + z² / (x² + z²)] / π.

**The receptors.** One lies below the middle of each pair, at z = 0.75 mm: the middle of the depths
above. The number is ours, and so is the place. Pairs whose middle is less than 2 z from an end of
the array have none, for what the skin does beside the array is not known; an array that is shorter
than that has one in its middle, or two.

**Evidence.** ε_xx and γ/2 of the best moment at each place are smoothed by the Gaussian of (2) and
give e. The evidence of a dot of width W, centred at c, is

    E = √ mean e²,    |u - c| ≤ W / 2,                                            (8)

in units of E₀: the same for the wave w = [1 + cos(2πu/W)] / 2, without smoothing, in an array
without end that has a contactor pair over each place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

DEPTH_MM = 0.75
_ARRAY = 40  # pairs on either side of a receptor that stand for an array without end


def strains_below(pairs: int, pitch_mm: float) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Strain below each pair of contactors for a strain of 1 between each pair, equations 5 and 7.

    Parameters
    ----------
    pairs
        Number of pairs of neighbouring contactors.
    pitch_mm
        Distance between two contactors.

    Returns
    -------
    float64[pairs, pairs], float64[pairs, pairs]
        ε_xx and γ/2; the first index is that of the pair that is stretched, the second that of the
        receptor.
    """
    place = np.arange(pairs)
    middle_mm = (place - place[:, None]) * pitch_mm  # from the pair to the receptor
    ends = middle_mm - pitch_mm / 2, middle_mm + pitch_mm / 2
    along, shear = (antiderivative(ends[1]) - antiderivative(ends[0]) for antiderivative in _BOTH)
    return along, shear


def without_receptors(pairs: int, pitch_mm: float) -> int:
    """Number of pairs at each end of the array that have no receptor below them."""
    too_near = sum((place + 0.5) * pitch_mm < 2 * DEPTH_MM for place in range(pairs))
    return min(too_near, (pairs - 1) // 2)


def _along(x_mm: NDArray[np.floating]) -> NDArray[np.floating]:
    z = DEPTH_MM
    return (np.arctan(x_mm / z) - x_mm * z / (x_mm**2 + z**2)) / np.pi


def _shear(x_mm: NDArray[np.floating]) -> NDArray[np.floating]:
    squares = x_mm**2 + DEPTH_MM**2
    return (np.log(squares) / 2 + DEPTH_MM**2 / squares) / np.pi


_BOTH = (_along, _shear)


def reference_strain(width_mm: float, pitch_mm: float) -> float:
    """Unit of evidence E₀: equation 8 for the wave [1 + cos(2πu/W)] / 2, not smoothed."""
    u_mm = (np.arange(1000) + 0.5) / 1000 * width_mm - width_mm / 2

    def wave(at_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        inside = np.abs(at_mm) < width_mm / 2
        return np.where(inside, (1 + np.cos(2 * np.pi * at_mm / width_mm)) / 2, 0.0)

    pair_mm = u_mm[:, None] + np.arange(-_ARRAY, _ARRAY + 1) * pitch_mm
    strain = (wave(pair_mm + pitch_mm / 2) - wave(pair_mm - pitch_mm / 2)) / pitch_mm
    along, shear = (below[:, _ARRAY] for below in strains_below(2 * _ARRAY + 1, pitch_mm))
    return float(np.sqrt(np.mean((strain @ along) ** 2 + (strain @ shear) ** 2)))
