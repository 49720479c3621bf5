"""Sensations of the simulated reader in a trial: cells, strengths, lengths."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.sessions.simulated.observer import TIE, Observer

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.braille.geometry import Geometry
    from vbraille.sessions.simulated.skin import FeltFrames

WIDTH, GAP, SPACING, CELL_GAP = "dot_width_mm", "dot_gap_mm", "dot_spacing_mm", "cell_gap_mm"
LENGTHS = (WIDTH, GAP, SPACING, CELL_GAP)


def nominal_mm(parameter: str, geometry: Geometry) -> float:
    """Value of a length that the reader was told, by the nominal distances."""
    if parameter == GAP:
        return geometry.dot_spacing_mm - geometry.dot_width_mm
    return getattr(geometry, parameter)


@dataclass(frozen=True, slots=True)
class DotPair:
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


def felt_mm(
    observer: Observer, parameter: str, exploration: FeltFrames, pair: DotPair | None
) -> float:
    """Length that is felt of a stimulus; NaN if it is not felt."""
    if parameter in (WIDTH, GAP):
        return observer.lengths_mm(exploration)[(WIDTH, GAP).index(parameter)]
    dots_mm = observer.dots_mm(exploration)
    if pair is None or len(dots_mm) != pair.columns:
        return math.nan
    distance_mm = dots_mm[pair.first + 1, 0] - dots_mm[pair.first, 0]
    more_mm = (distance_mm - pair.distance_mm) / max(pair.cells, 1)
    return float(nominal_mm(parameter, observer.geometry) + more_mm)


def nearer(
    lengths: Sequence[float], nominal: float, noise: float, random: np.random.Generator
) -> int:
    """Choose the one of some lengths that is felt nearest to a length, from 1; the first of a tie.

    Noise is in units of that length, and so is what counts as equal without noise.
    """
    drawn = noise * nominal * random.standard_normal(len(lengths))
    off = [
        math.inf if math.isnan(felt) else abs(felt + more - nominal)
        for felt, more in zip(lengths, drawn, strict=True)
    ]
    tie, best = 0.0 if noise else TIE * nominal, 0
    for place, distance in enumerate(off):
        best = place if distance < off[best] - tie else best
    return best + 1


@dataclass(frozen=True, slots=True)
class FeltTrial:
    """A trial as the simulated reader feels it.

    Parameters
    ----------
    observer
        Reader of the trial's condition.
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
    felt: Sequence[FeltFrames]
    places: Sequence[int]
    asked: slice
    parameter: str
    pair: DotPair | None
    turns: int = 0

    @property
    def by_length(self) -> bool:
        """True if stimuli differ in a length."""
        return self.parameter in LENGTHS

    def cells(self, random: np.random.Generator) -> list[int | None]:
        """Dot masks of the cells asked for; None for a cell that was not read."""
        return self.observer.read(self.felt[0], self.places[0], random)[self.asked]

    def strength(self, stimulus: int = 0) -> float:
        """Strength of the strongest dot asked for, in units of E₀; 0 if the hand was on none."""
        evidence = self.observer.felt(self.felt[stimulus], self.places[stimulus])[self.asked]
        return 0.0 if np.isnan(evidence).all() else float(np.nanmax(evidence))

    def values(self) -> tuple[list[float], float]:
        """Give the value of each stimulus, NaN for one not felt, and the unit of noise.

        Values are lengths in mm, and the unit is then the nominal length; or strengths in units of
        E₀, and the unit is 1.
        """
        if not self.by_length:
            return [self.strength(place) for place in range(len(self.felt))], 1.0
        lengths = [felt_mm(self.observer, self.parameter, each, self.pair) for each in self.felt]
        return lengths, nominal_mm(self.parameter, self.observer.geometry)

    def share(self) -> float:
        """Value of the last stimulus as a share of the first; of a single one, of the unit.

        It is 0 if one of them was not felt.
        """
        values, unit = self.values()
        standard = unit if len(values) == 1 else values[0]
        share = values[-1] / standard if standard > 0 else 0.0
        return 0.0 if math.isnan(share) else share
