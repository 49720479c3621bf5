"""Textures, which cover the whole canvas: uniform ones, gratings, and what changes their frequency.

Lévesque 2009, 8.4.1.
"""

from __future__ import annotations

import math
from typing import Annotated

from vbraille.scene.measures import (
    LEAST_APART_MM,
    MOST_FREQUENCY_HZ,
    Angle,
    Coordinate,
    Distance,
    Frequency,
    Length,
    Measured,
    Point,
    RidgeWave,
    Share,
    Velocity,
    limits,
)
from vbraille.scene.pattern import Pattern

Factor = Annotated[float, limits(0.05, 20.0)]
Turn = Annotated[float, limits(0.0, 360.0, "°")]
Arc = Annotated[float, limits(0.5, 360.0, "°")]


class Gradual(Measured, frozen=True, kw_only=True, tag_field="kind", tag="gradual"):
    """A spatial frequency that changes from one place to another: Lévesque 2009, eq. 8.5.

    Parameters
    ----------
    factor
        Factor K of the frequency beyond the change, 0.05 to 20; below 1 ridges become longer.
    start_mm, length_mm
        Distance along the wave at which the change begins, and how far it goes on.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    factor: Factor = 5.0
    start_mm: Coordinate = 0.0
    length_mm: Length = 100.0


class Peak(Measured, frozen=True, kw_only=True, tag_field="kind", tag="peak"):
    """A spatial frequency that changes around a place and back: Lévesque 2009, eq. 8.6 (mended).

    Parameters
    ----------
    factor
        Factor K of the frequency at that place, 0.05 to 20.
    center_mm, length_mm
        Distance along the wave of that place, and how far the change reaches to either side.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    factor: Factor = 5.0
    center_mm: Coordinate = 0.0
    length_mm: Length = 50.0


class TurnPeak(Measured, frozen=True, kw_only=True):
    """A frequency of an axial grating that changes around an angle and back: eq. 8.6 in degrees.

    Parameters
    ----------
    factor
        Factor K of the frequency at that angle, 0.05 to 20.
    center_deg, length_deg
        The angle, from where the grating starts, and how far the change reaches to either side.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    factor: Factor = 5.0
    center_deg: Turn = 180.0
    length_deg: Arc = 40.0


class Uniform(Pattern, frozen=True, kw_only=True, tag="uniform"):
    """The same deflection everywhere; useful as a part of others.

    Parameters
    ----------
    level
        The deflection, from 0 to 1.

    Raises
    ------
    ValueError
        If it is out of range.
    """

    level: Share = 1.0


class UniformVibration(Pattern, frozen=True, kw_only=True, tag="vibration"):
    """The same vibration everywhere: Lévesque 2009, eqs. 8.1 and 8.2.

    Parameters
    ----------
    frequency_hz
        Frequency of the swings, 0.1 to 50 Hz.

    Raises
    ------
    ValueError
        If it is out of range.
    """

    frequency_hz: Frequency = MOST_FREQUENCY_HZ


class SignalLevel(Pattern, frozen=True, kw_only=True, tag="signal"):
    """A signal as a deflection, the same everywhere: what a blend chooses by, or masks a group.

    Parameters
    ----------
    name
        Name of the signal.
    """

    name: str


class Grating(Pattern, frozen=True, kw_only=True):
    """Base of gratings whose ridges and gaps have lengths in mm.

    Parameters
    ----------
    ridge_mm, gap_mm
        Length of a ridge and of the gap after it, along the wave, or outwards of a ring.
    distortion
        Change of the spatial frequency along the wave, or outwards; None for none.
    velocity_mm_s
        Speed of the ridges in the direction of the wave, or of the rings outwards (eq. 9.2); not
        beside a distortion.
    velocity_by
        Name of a signal that is the share of this speed at which they move; empty for all of it.
    """

    ridge_mm: Length
    gap_mm: Distance = 0.0
    distortion: Gradual | Peak | None = None
    velocity_mm_s: Velocity = 0.0
    velocity_by: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_distortion(self.distortion, self.velocity_mm_s)

    @property
    def wave(self) -> RidgeWave:
        """Length and speed of its ridges and gaps."""
        return RidgeWave(self.ridge_mm + self.gap_mm, self.velocity_mm_s)


class LinearGrating(Grating, frozen=True, kw_only=True, tag="linear-grating"):
    """Ridges and gaps along a direction: Lévesque 2009, eq. 8.4.

    Parameters
    ----------
    wave_angle_deg, ridge_angle_deg
        Direction in which the wave travels, or in which the ridges lie; one of them, in degrees
        from +x (right) towards +y (down). Without either the wave travels along x.
    start_mm
        Place at which a ridge begins.

    Raises
    ------
    ValueError
        If a number is out of range, or both angles are given.
    """

    wave_angle_deg: Angle | None = None
    ridge_angle_deg: Angle | None = None
    start_mm: Point = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.wave_angle_deg is not None and self.ridge_angle_deg is not None:
            raise ValueError("ridge_angle_deg cannot be given beside wave_angle_deg; leave one out")

    @property
    def travel_deg(self) -> float:
        """Direction in which its wave travels, in degrees from +x towards +y.

        A file says either that or the direction of the ridges, a quarter turn less (Lévesque 2009,
        6.3.3 and 8.4.1, which use the two differently). Without either the wave travels along x.
        """
        if self.ridge_angle_deg is not None:
            return math.fmod(self.ridge_angle_deg + 90.0, 360.0)
        return self.wave_angle_deg or 0.0


class RadialGrating(Grating, frozen=True, kw_only=True, tag="radial-grating"):
    """Rings of ridges around a place: Lévesque 2009, eq. 8.4 with a distance as abscissa.

    Parameters
    ----------
    center_mm
        Place around which they stand, and where a ridge begins.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    center_mm: Point


class AxialGrating(Pattern, frozen=True, kw_only=True, tag="axial-grating"):
    """Ridges like the spokes of a wheel: Lévesque 2009, eq. 8.4 with an angle as abscissa.

    Parameters
    ----------
    center_mm
        Place around which they stand.
    ridge_deg, gap_deg
        Angle of a ridge and of the gap after it.
    start_deg
        Angle at which a ridge begins, from +x towards +y.
    whole_cycles
        Whether the angles are changed a little so that a whole number of cycles goes round.
    fade_mm
        Lengths of the shortest cycle's arc between which the pattern fades towards its middle,
        where cycles would be too short: at the first there is only ``middle``, at the second only
        the grating. What the source does there is not known, so this is ours to choose.
    middle
        Deflection around the centre.
    distortion
        Change of the frequency around an angle; None for none.
    velocity_deg_s
        Speed at which the spokes turn, towards larger angles; not beside a distortion.
    velocity_by
        Name of a signal that is the share of this speed at which they move; empty for all of it.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    center_mm: Point
    ridge_deg: Arc
    gap_deg: Turn = 0.0
    start_deg: Angle = 0.0
    whole_cycles: bool = True
    fade_mm: tuple[float, float] = (0.5, 1.0)
    middle: Share = 1.0
    distortion: TurnPeak | None = None
    velocity_deg_s: Annotated[float, limits(-3600.0, 3600.0, "°/s")] = 0.0
    velocity_by: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.ridge_deg + self.gap_deg > 360.0:
            raise ValueError("ridge and gap are more than a turn together; make them smaller")
        inner_mm, outer_mm = self.fade_mm
        if not 0.0 <= inner_mm <= outer_mm - LEAST_APART_MM <= 100.0:
            raise ValueError("fade is from a smaller to a larger length, from 0 to 100 mm")
        _check_distortion(self.distortion, self.velocity_deg_s)

    @property
    def wave(self) -> RidgeWave:
        """Length and speed of its ridges and gaps."""
        return RidgeWave(self.ridge_deg + self.gap_deg, self.velocity_deg_s, in_mm=False)


def _check_distortion(distortion: object, velocity: float) -> None:
    if distortion is not None and velocity:
        raise ValueError("velocity cannot be given beside a distortion; leave one out")
