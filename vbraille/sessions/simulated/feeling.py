"""Sensations of the simulated reader in a trial: cells, strengths, lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vbraille.sessions.simulated.observer import FeltFrames, Observer

WIDTH, GAP, SPACING = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm"
LENGTHS = (WIDTH, GAP, SPACING)
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
