"""Waves that reach the skin along a line in an exploration, and how fast they change.

The equations are those of `vbraille.sessions.simulated.observer`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

CUTOFF_HZ = 200.0
FINEST_MM = 0.02
STILL_MM_S = 1.0
SPEED_SPAN_S = 0.02  # time for measuring a speed; counts of 45 µm make it 2 mm/s exact
MOST_MM_S = 1000.0
_REACHED = 0.9  # share of a way that must have been felt
_MOST = 1000  # points of a dot
_LEAST = np.finfo(float).tiny
_TAILS = 4  # reach of a kernel in standard deviations


@dataclass(frozen=True, slots=True, eq=False)
class FeltFrames:
    """Frames that a hand was given, with places and times, tick by tick.

    Parameters
    ----------
    frames : float[n, rows, columns]
        Deflections that were sent, 0 … 1.
    x_mm : float64[n]
        Places of the array's centre; NaN where one is not known.
    time_s : float64[n]
        Times of the ticks, counted from any moment.
    y_mm, theta_rad : float64[n], optional
        Places down the canvas, and angles by which the array is turned, where a picture is felt.
    """

    frames: NDArray[np.floating]
    x_mm: NDArray[np.float64]
    time_s: NDArray[np.float64]
    y_mm: NDArray[np.float64] | None = None
    theta_rad: NDArray[np.float64] | None = None

    def within(self, low_mm: float, high_mm: float) -> FeltFrames:
        """Ticks whose place is known, with the array's centre between two places."""
        near = (self.x_mm >= low_mm) & (self.x_mm <= high_mm)
        if near.all():
            return self
        return FeltFrames(self.frames[near], self.x_mm[near], self.time_s[near])

    def speeds_mm_s(self) -> NDArray[np.float64]:
        """Speed at each tick, never negative; float64[n]."""
        before = np.maximum(self.time_s - SPEED_SPAN_S / 2, self.time_s[0])
        after = np.minimum(self.time_s + SPEED_SPAN_S / 2, self.time_s[-1])
        way = np.interp(after, self.time_s, self.x_mm) - np.interp(before, self.time_s, self.x_mm)
        return np.abs(way) / np.maximum(after - before, 1e-9)


def smoothing_mm(speed_mm_s: float) -> float:
    """Width σ of the smoothing by equation 2 at a speed, in mm."""
    per_mm_s = math.sqrt(math.log(2)) / (2 * math.pi * CUTOFF_HZ)
    return math.hypot(FINEST_MM, min(speed_mm_s, MOST_MM_S) * per_mm_s)


def reference_per_mm2(width_mm: float, pitch_mm: float) -> float:
    """Unit of evidence E₀: equation 3 for the wave [1 + cos(2πu/W)] / 2, not smoothed."""
    u_mm = (np.arange(1000) + 0.5) / 1000 * width_mm - width_mm / 2

    def slope(at_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        inside = np.abs(at_mm) < width_mm / 2
        return np.where(inside, -np.sin(2 * np.pi * at_mm / width_mm) * np.pi / width_mm, 0.0)

    rate = (slope(u_mm + pitch_mm / 2) - slope(u_mm - pitch_mm / 2)) / pitch_mm
    return float(np.sqrt(np.mean(rate**2)))


@dataclass(frozen=True, slots=True, eq=False)
class Wave:
    """Strains or swings felt along a line, at the places that sensors came over.

    Parameters
    ----------
    u_mm : float64[m]
        Places along the line, increasing.
    felt : float64[m, channels]
        Strongest values that were felt at each place.
    """

    u_mm: NDArray[np.float64]
    felt: NDArray[np.float64]

    @classmethod
    def best(
        cls, x_mm: NDArray[np.float64], felt: NDArray[np.floating], pitch_mm: float, steps: int
    ) -> Wave:
        """Keep the strongest values that were felt at each place.

        A place is a pitch / steps long. Of all that sensors felt at one place of the line, what had
        most energy is kept. So each value was really felt, exactly where it says.

        Parameters
        ----------
        x_mm : float64[n]
            Places of the first sensor, n > 0.
        felt : float[n, sensors, channels]
            Values felt by sensors that stand a pitch apart.
        pitch_mm, steps
            Distance between two sensors, and number of places on it.
        """
        u_mm = (x_mm[:, None] + pitch_mm * np.arange(felt.shape[1])).ravel()
        values = felt.reshape(u_mm.size, -1).astype(np.float64)
        place = ((u_mm - u_mm.min()) * (steps / pitch_mm)).astype(np.intp)
        order = np.lexsort((np.einsum("nc,nc->n", values, values), place))
        kept = order[np.append(np.diff(place[order]) > 0, True)]
        kept = kept[np.argsort(u_mm[kept])]
        return cls(u_mm[kept], values[kept])

    def rms_rates(
        self, left_mm: float, right_mm: float, sigma_mm: float, step_mm: float, gap_mm: float
    ) -> NDArray[np.float64]:
        """Rms rates of the smoothed wave between two places, by equation 3.

        The smoothed wave is a weighted mean. The weight of a value is the length of the line that
        it stands for, times a Gaussian of its distance. The sum is divided by that of the weights,
        so that uneven places do not look like waves.

        Parameters
        ----------
        sigma_mm
            Width of the smoothing.
        step_mm
            Distance between the points at which the rate is taken.
        gap_mm
            Longest distance between two values between which the line counts as felt.

        Returns
        -------
        float64[channels]
            Rates; NaN if too little of the way was felt.
        """
        at_mm = np.linspace(
            left_mm, right_mm, min(round((right_mm - left_mm) / step_mm), _MOST) + 1
        )
        step_mm = at_mm[1] - at_mm[0]
        reach_mm = _TAILS * sigma_mm
        gaps_mm = np.diff(self.u_mm)
        halves = np.minimum(gaps_mm, gap_mm) / 2
        stands_for = np.append(halves, gap_mm / 2) + np.append(gap_mm / 2, halves)
        after = np.searchsorted(self.u_mm, at_mm[:-1] + step_mm / 2)
        covered = np.concatenate(([False], gaps_mm <= gap_mm, [False]))[after]
        if np.mean(covered) < _REACHED:
            return np.full(self.felt.shape[1], np.nan)
        near = slice(*np.searchsorted(self.u_mm, (left_mm - reach_mm, right_mm + reach_mm)))
        away = (at_mm[:, None] - self.u_mm[near]) / sigma_mm
        weights = np.exp(-(away**2) / 2) * stands_for[near]
        smooth = weights @ self.felt[near] / np.maximum(weights.sum(axis=1, keepdims=True), _LEAST)
        rates = np.diff(smooth, axis=0)[covered] / step_mm
        return np.sqrt(np.mean(rates**2, axis=0))
