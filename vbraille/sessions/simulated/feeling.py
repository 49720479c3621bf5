"""Sensations of the simulated reader in a trial: cells, strengths, lengths, pictures.

**Pictures.** The reader knows some pictures, and says which of them was felt. At moments that are
spread evenly over the exploration each actuator is felt for 20 ms, a period of the strongest
vibration: the mean and the standard deviation of its deflection, so that a vibration is felt by its
strength and not by its phase. Each known picture is thought of under the same poses, and the one
whose frames differ least, by the root of the mean square over moments and actuators, is named.
Normal noise is added to each difference, in units of their mean over the pictures; where nothing
tells pictures apart, a draw decides.

This is the best that frames can tell to one who knows exactly where the array is. People do not:
they have to find out where their finger is, and remember it. No number of the model was fitted to
anybody, and it claims nothing about people; it is for trying protocols out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.sessions.simulated.observer import FeltFrames, Observer

WIDTH, GAP, SPACING = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm"
LENGTHS = (WIDTH, GAP, SPACING)
MOMENTS = 48
_WINDOW_S = 0.02
_SAMPLES = 5  # of a moment, 4 ms apart
TIE = 0.04  # difference that counts as equal without noise, in units of the nominal length


@dataclass(frozen=True, slots=True)
class FeltTrial:
    """A trial as the simulated reader feels it.

    Parameters
    ----------
    observer
        Reader of the trial's condition.
    random
        Generator of the noise.
    felt
        Frames and places of each stimulus.
    places
        Number of cells in the line of each stimulus.
    asked
        Cells of these lines that are asked for.
    parameter
        Number in which stimuli differ; empty if strings are read.
    turns
        How often the participant has turned the last stimulus.
    """

    observer: Observer
    random: np.random.Generator
    felt: Sequence[FeltFrames]
    places: Sequence[int]
    asked: slice
    parameter: str
    turns: int = 0

    @property
    def noise(self) -> float:
        """Standard deviation of the noise, in units of values."""
        return self.observer.noise

    @property
    def by_length(self) -> bool:
        """True if stimuli differ in a length."""
        return self.parameter in LENGTHS

    @property
    def unit(self) -> float:
        """Unit of values: the length that the reader was told, in mm; 1 for strengths."""
        geometry = self.observer.geometry
        if self.parameter == GAP:
            return geometry.dot_spacing_mm - geometry.dot_width_mm
        return getattr(geometry, self.parameter) if self.by_length else 1.0

    def jitter(self) -> float:
        """Draw noise, in units of values."""
        return self.noise * float(self.random.standard_normal())

    def cells(self) -> list[int | None]:
        """Dot masks of the cells asked for; None for a cell that was not read."""
        evidence = self.observer.felt(self.felt[0], self.places[0])
        return self.observer.answer(evidence, self.random)[self.asked]

    def strength(self, stimulus: int = 0) -> float:
        """Strength of the strongest dot asked for, in units of E₀; 0 if the hand was on none."""
        evidence = self.observer.felt(self.felt[stimulus], self.places[stimulus])[self.asked]
        return float(np.nan_to_num(evidence).max())

    def values(self) -> list[float]:
        """Lengths of the stimuli in mm, or their strengths in units of E₀; 0 of one not felt."""
        if self.by_length:
            return list(map(self._length_mm, self.felt))
        return [self.strength(place) for place in range(len(self.felt))]

    def drawn(self) -> np.ndarray:
        """Values with noise."""
        noise = self.noise * self.random.standard_normal(len(self.felt))
        return self.values() + self.unit * noise

    def share(self) -> float:
        """Value of the last stimulus as a share of the first, or of a single one of the unit."""
        *first, last = self.values()
        standard = first[0] if first else self.unit
        return last / standard if standard > 0 else 0.0

    def _length_mm(self, exploration: FeltFrames) -> float:
        """Return the width of the first dot, or the way from it to the next one."""
        dots_mm = self.observer.dots_mm(exploration)
        if len(dots_mm) < (1 if self.parameter == WIDTH else 2):
            return 0.0
        start_mm, end_mm = dots_mm[0]
        if self.parameter == WIDTH:
            return float(end_mm - start_mm)
        return float(dots_mm[1, 0] - (end_mm if self.parameter == GAP else start_mm))


def moments(felt: FeltFrames) -> NDArray[np.intp]:
    """Ticks at which an exploration is felt; intp[m, samples], with m at most `MOMENTS`."""
    known = np.flatnonzero(np.isfinite(felt.x_mm))
    if not known.size:
        return np.zeros((0, _SAMPLES), np.intp)
    ends = felt.time_s[known[0]], felt.time_s[known[-1]] - _WINDOW_S
    starts = np.linspace(ends[0], max(ends), MOMENTS)
    steps = np.arange(_SAMPLES) * (_WINDOW_S / _SAMPLES)
    at = np.searchsorted(felt.time_s[known], starts[:, None] + steps).clip(max=known.size - 1)
    return known[at]


def differences(felt: FeltFrames, known: Sequence[Any]) -> NDArray[np.float64]:
    """Return how much each of some programs differs from what was felt; float64[pictures]."""
    at = moments(felt)
    if not at.size:
        return np.zeros(len(known))
    places = (felt.x_mm, felt.y_mm, felt.theta_rad, felt.time_s)
    poses = [np.zeros(at.size) if each is None else each[at.ravel()] for each in places]
    frames = felt.frames[at]
    given = _impression(frames)
    thought = [_impression(program.poses(*poses)[1].reshape(frames.shape)) for program in known]
    return np.array([np.sqrt(np.mean((each - given) ** 2)) for each in thought])


def _impression(frames: NDArray[np.floating]) -> NDArray[np.float64]:
    """Means and standard deviations, float64[2, m, ...], of frames [m, samples, ...]."""
    return np.stack([frames.mean(axis=1), frames.std(axis=1)])


def most_like(
    apart: NDArray[np.float64], names: Sequence[str], noise: float, random: np.random.Generator
) -> str:
    """Return the name of the picture that differs least from what was felt, with noise."""
    drawn = random.standard_normal(apart.size)
    if np.ptp(apart) > 0:
        drawn = apart / apart.mean() + noise * drawn
    return names[int(drawn.argmin())]
