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

        A place is a pitch / steps long. Of all ticks with the carriage at one place, the one with
        most energy is kept, with all its sensors. Then of all sensors at one place of the line,
        the one with most energy is kept. So each value was really felt, exactly where it says.

        Parameters
        ----------
        x_mm : float64[n]
            Places of the first sensor, n > 0.
        felt : float[n, sensors, channels]
            Values felt by sensors that stand a pitch apart.
        pitch_mm, steps
            Distance between two sensors, and number of places on it.
        """
        sensors = felt.shape[1]
        energy = np.einsum("nsc,nsc->n", felt, felt)
        start_mm = x_mm.min()
        place = ((x_mm - start_mm) * (steps / pitch_mm)).astype(np.intp)
        order = np.lexsort((energy, place))
        place = place[order]
        last = np.append(np.flatnonzero(np.diff(place)), place.size - 1)
        place, kept = place[last], order[last]
        x_mm, felt = x_mm[kept], felt[kept]
        most = np.full((sensors, place[-1] + 1 + (sensors - 1) * steps), -1.0)
        number = np.zeros(place[-1] + 1, np.intp)
        number[place] = np.arange(place.size)
        energy = np.einsum("nsc,nsc->sn", felt, felt)
        for sensor in range(sensors):
            most[sensor, place + sensor * steps] = energy[sensor]
        winner = most.argmax(axis=0)
        at = np.flatnonzero(most.max(axis=0) >= 0)
        winner = winner[at]
        tick = number[at - winner * steps]
        return cls(x_mm[tick] + winner * pitch_mm, felt[tick, winner].astype(np.float64))


class Rates:
    """Rates at which a smoothed wave changes along a line.

    The smoothed wave is a weighted mean. The weight of a value is the length of the line that it
    stands for, times a Gaussian of its distance. The sum is divided by that of the weights, so that
    uneven places do not look like waves.

    Parameters
    ----------
    wave
        The wave, which must have at least one place.
    step_mm
        Distance between the points at which the rate is taken.
    gap_mm
        Longest distance between two values between which the line counts as felt.
    """

    def __init__(self, wave: Wave, step_mm: float, gap_mm: float) -> None:
        u_mm = wave.u_mm
        self._u_mm, self._step_mm, self._gap_mm = u_mm, step_mm, gap_mm
        self._start_mm = float(u_mm[0])
        halves = np.minimum(np.diff(u_mm), gap_mm) / 2
        way = np.append(halves, gap_mm / 2) + np.append(gap_mm / 2, halves)
        # Each value is shared between the two nearest points, so that its place stays exact.
        place, part = np.divmod((u_mm - self._start_mm) / step_mm, 1)
        place = place.astype(np.intp)
        size = int(place[-1]) + 2
        self._weights = np.array(
            [
                np.bincount(place, value * (1 - part), size)
                + np.bincount(place + 1, value * part, size)
                for value in (way, *(way * wave.felt.T))
            ]
        )

    def rms(self, left_mm: float, right_mm: float, sigma_mm: float) -> NDArray[np.float64]:
        """Rms rate between two places by equation 3; float64[channels], NaN if not felt there."""
        smooth, felt = self._smoothed(left_mm, right_mm, sigma_mm)
        if np.mean(felt) < _REACHED:
            return np.full(len(smooth), np.nan)
        rates = np.diff(smooth, axis=1)[:, felt] / self._step_mm
        return np.sqrt(np.mean(rates**2, axis=1))

    def _smoothed(
        self, left_mm: float, right_mm: float, sigma_mm: float
    ) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        """Smoothed wave at points between two places, and whether each step between was felt."""
        first = math.ceil((left_mm - self._start_mm) / self._step_mm)
        count = math.floor((right_mm - self._start_mm) / self._step_mm) - first + 1
        middle_mm = self._start_mm + (first + np.arange(count - 1) + 0.5) * self._step_mm
        felt = self._covered(middle_mm)
        reach = math.ceil(_TAILS * sigma_mm / self._step_mm)
        kernel = np.exp(-((np.arange(-reach, reach + 1) * self._step_mm / sigma_mm) ** 2) / 2)
        points = np.arange(first - reach, first + count + reach)
        known = (points >= 0) & (points < self._weights.shape[1])
        near = np.where(known, self._weights[:, points * known], 0.0)
        total, *sums = (np.convolve(row, kernel, "valid") for row in near)
        return np.array(sums) / np.maximum(total, np.finfo(float).tiny), felt

    def _covered(self, at_mm: NDArray[np.floating]) -> NDArray[np.bool_]:
        after = np.searchsorted(self._u_mm, at_mm)
        inside = (after > 0) & (after < self._u_mm.size)
        after = np.clip(after, 1, max(self._u_mm.size - 1, 1))
        return inside & (self._u_mm[after] - self._u_mm[after - 1] <= self._gap_mm)
