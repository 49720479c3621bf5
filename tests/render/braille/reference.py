"""The deflections in plain numpy, straight from the equations: the twin of the kernels.

It is slow and short on purpose; the tests hold `vbraille.render.kernels` to it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import PLACES, dots_of
from vbraille.render import Profile

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.display import Display
    from vbraille.render.braille.style import BrailleStyle, Tuning


def bump(p: ArrayLike) -> NDArray[np.float64]:
    """Compute a STReSS² dot on [-1, 1] (eq. 4.1); p is the distance from its centre in radii."""
    p = np.asarray(p, np.float64)
    return np.where(np.abs(p) <= 1, np.cos(np.pi * p), -1.0)


def texture(p: ArrayLike, cycles: int) -> NDArray[np.float64]:
    """Compute the texture of the STReSS² on [-1, 1] (eq. 4.2), with k = cycles, odd."""
    p = np.asarray(p, np.float64)
    return np.where(np.abs(p) <= 1, np.cos(cycles * np.pi * p), -1.0)


def raised_cosine(u_mm: ArrayLike, width_mm: float, tuning: Tuning) -> NDArray[np.float64]:
    """Compute a STReSS² dot's swing in [0, 1] (eq. 4.3); u is the distance from its left edge."""
    p = (np.asarray(u_mm, np.float64) - width_mm / 2) / (width_mm / 2)
    level = tuning.texture
    delta = (1 - level) * bump(p) + level * texture(p, tuning.cycles)
    return (delta + 1) / 2


def half_sine_peak(level: float) -> float:
    """Find M(a), the largest value of sin θ + a sin 8θ on [0, π], with a = level / 8."""
    a = level / 8
    theta = np.linspace(0, np.pi, 4097)
    best = theta[np.argmax(np.sin(theta) + a * np.sin(8 * theta))]
    for _ in range(4):  # Newton, on the derivative
        slope = np.cos(best) + 8 * a * np.cos(8 * best)
        best -= slope / (-np.sin(best) - 64 * a * np.sin(8 * best))
    return float(np.sin(best) + a * np.sin(8 * best))


def half_sine(u_mm: ArrayLike, width_mm: float, tuning: Tuning) -> NDArray[np.float64]:
    """Compute the swing of a VBD dot in [0, 1]; u is the distance from its left edge.

    Lévesque 2009, 3.2: half a sinusoid, with a second one of 1/8 of its
    amplitude and wavelength for texture. Phase and norm are our choice:
    [sin(πu/W) + a sin(8πu/W)] / M(a), a = T/8.
    """
    u = np.asarray(u_mm, np.float64)
    theta = np.pi * u / width_mm
    value = np.sin(theta) + tuning.texture / 8 * np.sin(8 * theta)
    inside = (u > 0) & (u < width_mm)
    return np.where(inside, value / half_sine_peak(tuning.texture), 0.0)


SWINGS = {Profile.HALF_SINE: half_sine, Profile.RAISED_COSINE: raised_cosine}


def deflections(
    x_mm: ArrayLike,
    masks: NDArray[np.uint8],
    style: BrailleStyle,
    display: Display,
    anchor_mm: float | None = None,
) -> NDArray[np.float64]:
    """Compute the frames of a line for places of the array's centre.

    Parameters
    ----------
    x_mm : float64[n]
        Places of the given point of the array, along the line.
    masks : uint8[cells]
        Dot masks of the line's cells.
    style, display
        Style in which the line is shown, and the display that it is shown on.
    anchor_mm
        How far right of the left column that point is; None for the array's centre.

    Returns
    -------
    float64[n, rows, columns]
        Deflections, 0 … 1.
    """
    anchor_mm = display.span_mm / 2 if anchor_mm is None else anchor_mm
    x = np.atleast_1d(np.asarray(x_mm, np.float64))
    geometry, mapping, tuning = style.geometry, style.mapping, style.tuning
    surface = (x - anchor_mm)[:, None] + display.column_offsets_mm()  # eq. 3.1
    swing = np.zeros((x.size, display.rows, display.columns))
    own = style.rows_on(display)
    for cell, mask in enumerate(masks):
        for dot in dots_of(int(mask)):
            right, dot_row = PLACES[dot]
            edge = cell * geometry.cell_pitch_mm + right * geometry.dot_spacing_mm
            bump_mm = SWINGS[style.profile](surface - edge, geometry.dot_width_mm, tuning)
            for row, shown in enumerate(mapping.right if right else mapping.left, own.start):
                if shown == dot_row:
                    swing[:, row] = np.maximum(swing[:, row], bump_mm)
    idle = np.zeros(display.rows)
    idle[own] = mapping.idle()
    sign = 1 - 2 * idle
    return idle[:, None] + sign[:, None] * tuning.contrast * swing
