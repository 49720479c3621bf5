"""Sensations of the simulated reader in a trial: cells, strengths, lengths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vbraille.sessions.simulated.observer import FeltFrames, Observer

WIDTH, GAP, SPACING, CELL_GAP = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm", "cell_gap_mm"
LENGTHS = (WIDTH, GAP, SPACING, CELL_GAP)
TIE = 0.04  # difference that counts as equal without noise, in units of the nominal length


class DotPair(NamedTuple):
    """Two neighbouring dot columns of a line, whose distance tells a length.

    Parameters
    ----------
    columns
        Number of dot columns that are shown of the line.
    first
        Number of the first of the two, from 0.
    distance_mm
        Distance between the two by the nominal distances.
    cells
        How many cells further the second one is: 0 in the same cell.
    """

    columns: int
    first: int
    distance_mm: float
    cells: int


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
    pair
        Dots by which a distance is told; None if there are none.
    turns
        How often the participant has turned the last stimulus.
    """

    observer: Observer
    random: np.random.Generator
    felt: Sequence[FeltFrames]
    places: Sequence[int]
    asked: slice
    parameter: str
    pair: DotPair | None = None
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
        dots_mm, pair = self.observer.dots_mm(exploration), self.pair
        if self.parameter == WIDTH and len(dots_mm):
            return float(dots_mm[0, 1] - dots_mm[0, 0])
        if self.parameter == GAP and len(dots_mm) > 1:
            return float(dots_mm[1, 0] - dots_mm[0, 1])
        if pair is None or len(dots_mm) != pair.columns:
            return 0.0
        distance_mm = dots_mm[pair.first + 1, 0] - dots_mm[pair.first, 0]
        more_mm = (distance_mm - pair.distance_mm) / max(pair.cells, 1)
        return float(self.unit + more_mm)
