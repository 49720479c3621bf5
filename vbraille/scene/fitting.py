"""Whole cycles on paths that close: which of ridge and gap gives way.

Lévesque 2009, 8.4.1 and 8.4.3, asks for a whole number of cycles and does not say how. The rule is
that of its author's later code: the number of cycles is the nearest whole one; without a gap the
ridge changes; with a gap the gap alone changes if there is still room for one, or else both.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from vbraille.scene.joints import edge_lengths_mm, places_along_mm
from vbraille.scene.patterns import Circle, PathShape, Polygon
from vbraille.scene.shapes import StraightLine

if TYPE_CHECKING:
    from vbraille.scene.textures import AxialGrating, TurnPeak

TURN_DEG = 360.0


class Cycle(NamedTuple):
    """Lengths of a grating's ridge and of the gap after it, in mm or in degrees."""

    ridge: float
    gap: float

    @property
    def length(self) -> float:
        """Length λ of the cycle."""
        return self.ridge + self.gap


def fitted(cycle: Cycle, length: float) -> Cycle:
    """Change a cycle a little, so that a whole number of it, at least one, fills a length."""
    cycles = max(1, math.floor(length / cycle.length + 0.5))
    new = length / cycles
    if cycle.gap == 0.0:
        return Cycle(new, 0.0)
    if new > cycle.ridge:
        return Cycle(cycle.ridge, new - cycle.ridge)
    factor = new / cycle.length
    return Cycle(cycle.ridge * factor, cycle.gap * factor)


def path_lengths_mm(shape: StraightLine | Circle | Polygon | PathShape) -> tuple[float, ...]:
    """Compute the length of a shape's path, or of each of a path's contours.

    A circle has 2πR; a polygon what is left of its edges between its corners and, if they are
    rounded, the arcs round them.
    """
    if isinstance(shape, StraightLine):
        return (math.dist(shape.start_mm, shape.end_mm),)
    if isinstance(shape, Circle):
        return (math.tau * shape.radius_mm,)
    if isinstance(shape, Polygon):
        return (places_along_mm(shape)[-1],)
    return tuple(
        sum(edge_lengths_mm(contour, closed=shape.closed)) for contour in shape.contours_mm
    )


def stroke_cycles(shape: StraightLine | Circle | Polygon | PathShape) -> tuple[Cycle, ...]:
    """Compute the cycles that a texture along a shape's stroke has, one for each contour.

    Where the path is open, or the texture wants no whole cycles, they are as they were written.
    Without a texture along the stroke there are none.
    """
    along = None if shape.stroke is None else shape.stroke.along
    if along is None:
        return ()
    cycle = Cycle(along.ridge_mm, along.gap_mm)
    is_open = isinstance(shape, StraightLine) or (isinstance(shape, PathShape) and not shape.closed)
    whole = along.whole_cycles and not is_open
    return tuple(fitted(cycle, length) if whole else cycle for length in path_lengths_mm(shape))


def axial_cycle(grating: AxialGrating) -> Cycle:
    """Compute the cycle that an axial grating has, in degrees.

    With a distortion the cycles fill what the turn is then: the difference of x' (eq. 8.6) at its
    end and at its beginning.
    """
    cycle = Cycle(grating.ridge_deg, grating.gap_deg)
    if not grating.whole_cycles:
        return cycle
    peak = grating.distortion
    turn = TURN_DEG if peak is None else _distorted(TURN_DEG, peak) - _distorted(0.0, peak)
    return fitted(cycle, turn)


def _distorted(x: float, peak: TurnPeak) -> float:
    """X' of eq. 8.6: x and (K - 1) times the area of the tent over the part up to x."""
    length, u = peak.length_deg, x - peak.center_deg
    if u <= 0.0:
        tent = max(0.0, length + u) ** 2
    else:
        tent = 2 * length * length - max(0.0, length - u) ** 2
    return x + (peak.factor - 1.0) * tent / (2 * length)
