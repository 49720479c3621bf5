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
    first: float, second: float, nominal: float, noise: float, random: np.random.Generator
) -> int:
    """Choose the one of two lengths that is felt nearer to a length: 1 or 2; 1 if they tie.

    Noise is in units of that length, and so is what counts as equal without noise.
    """
    drawn = noise * nominal * random.standard_normal(2)
    off = [
        math.inf if math.isnan(felt) else abs(felt + more - nominal)
        for felt, more in zip((first, second), drawn, strict=True)
    ]
    return 2 if off[1] < off[0] - (0.0 if noise else TIE * nominal) else 1


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
        Number by which two stimuli are compared; empty if there is one stimulus.
    pair
        Dots by which a distance is told; None if there are none.
    """

    observer: Observer
    felt: Sequence[FeltFrames]
    places: Sequence[int]
    asked: slice
    parameter: str
    pair: DotPair | None

    @property
    def by_length(self) -> bool:
        """True if two stimuli are compared by a length."""
        return self.parameter in LENGTHS

    def cells(self, random: np.random.Generator) -> list[int | None]:
        """Dot masks of the cells asked for; None for a cell that was not read."""
        return self.observer.read(self.felt[0], self.places[0], random)[self.asked]

    def strength(self, stimulus: int = 0) -> float:
        """Strength of the strongest dot asked for, in units of E₀; 0 if the hand was on none."""
        touch = self.observer.felt(self.felt[stimulus], self.places[stimulus])
        evidence = touch.evidence[self.asked]
        return 0.0 if np.isnan(evidence).all() else float(np.nanmax(evidence))

    def values(self) -> tuple[float, float, float]:
        """Give the value of each of two stimuli, NaN for one not felt, and the unit of noise.

        Values are lengths in mm, and the unit is then the nominal length; or strengths in units of
        E₀, and the unit is 1.
        """
        if not self.by_length:
            return self.strength(0), self.strength(1), 1.0
        one, two = (
            felt_mm(self.observer, self.parameter, each, self.pair) for each in self.felt[:2]
        )
        return one, two, nominal_mm(self.parameter, self.observer.geometry)
