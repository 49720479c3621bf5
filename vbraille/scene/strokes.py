"""Drawing of shapes: strokes with their profile and textures, dots, and markers at vertices.

Lévesque 2009, 8.4.3 and 8.4.4.
"""

from __future__ import annotations

from typing import Annotated, Literal

from vbraille.errors import check_range
from vbraille.scene.measures import (
    LEAST_MM,
    MOST_FREQUENCY_HZ,
    MOST_MM,
    Distance,
    Frequency,
    Length,
    Measured,
    RidgeWave,
    Share,
    Velocity,
    limits,
)


class Vibration(Measured, frozen=True, kw_only=True):
    """A vibration of a pattern: neighbouring actuators swing against each other.

    Lévesque 2009, eqs. 8.1-8.3.

    Parameters
    ----------
    frequency_hz
        Frequency of the swings, 0.1 to 50 Hz.
    amplitude
        Share A of the deflection that swings: 1 down to rest, 0 not at all.
    of
        Which part swings: "high", what is up (eq. 8.13: δ · δ¹), or "low", what is down
        (1 - (1 - δ) δ¹; of a stroke, eq. 8.14).

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    frequency_hz: Frequency = MOST_FREQUENCY_HZ
    amplitude: Share = 1.0
    of: Literal["high", "low"] = "high"


class Across(Measured, frozen=True, kw_only=True):
    """A texture across a stroke or from the middle of a dot: Lévesque 2009, eq. 8.10.

    Parameters
    ----------
    amplitude
        Weight k_t of the texture, from 0 to 1.
    cycles
        Number n of cycles across the whole width; odd, so that it meets rest at the edge.

    Raises
    ------
    ValueError
        If a number is out of range, or the cycles are even.
    """

    amplitude: Share = 0.5
    cycles: Annotated[int, limits(1, 100)] = 7

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.cycles % 2 == 0:
            raise ValueError(f"cycles is {self.cycles}; it must be odd")


class Along(Measured, frozen=True, kw_only=True):
    """A grating along a stroke, which cuts into it: Lévesque 2009, eqs. 8.11 and 8.12.

    Parameters
    ----------
    ridge_mm, gap_mm
        Length of the grating's ridge, where the stroke is cut, and of the gap, where it is whole.
    amplitude
        How deep the cuts are, as a share.
    whole_edges
        Whether the stroke's edges are left whole (eq. 8.12 instead of 8.11).
    whole_cycles
        Whether the lengths are changed a little so that a closed path has a whole number of
        cycles.
    velocity_mm_s
        Speed of the grating along the path, in the order of the path's points (eq. 9.2, with the
        sign that moves ridges towards larger places).
    velocity_by
        Name of a signal that is the share of this speed at which they move; empty for all of it.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    ridge_mm: Length = 2.0
    gap_mm: Distance = 0.0
    amplitude: Share = 1.0
    whole_edges: bool = False
    whole_cycles: bool = True
    velocity_mm_s: Velocity = 0.0
    velocity_by: str = ""

    @property
    def wave(self) -> RidgeWave:
        """Length and speed of its ridges and gaps."""
        return RidgeWave(self.ridge_mm + self.gap_mm, self.velocity_mm_s)


class Stroke(Measured, frozen=True, kw_only=True):
    """The stroke of a line, a circle, a polygon or a path: Lévesque 2009, eqs. 8.7-8.14.

    Parameters
    ----------
    width_mm
        Width w of the stroke.
    edge_mm
        Length ε of its edge; "smooth" for half of the width, which is the most that it can be.
    amplitude
        Deflection k of its middle, from 0 to 1.
    outlined
        Whether only the outline of the stroke is up (eq. 8.8); the width must be four edges then.
    across, along
        Texture across and along it; None for none.
    vibration
        Vibration of what is up in it, or of what a texture along it has cut; None for none.

    Raises
    ------
    ValueError
        If a number is out of range, or two of them cannot go together.
    """

    width_mm: Length = 4.0
    edge_mm: float | Literal["smooth"] = 1.0
    amplitude: Share = 1.0
    outlined: bool = False
    across: Across | None = None
    along: Along | None = None
    vibration: Vibration | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.edge_mm != "smooth":
            check_range("edge", self.edge_mm, LEAST_MM, MOST_MM, " mm")
        if self.outlined and self.along is not None:
            raise ValueError("outlined cannot be given beside along; whole_edges keeps the outline")
        four = self.outlined or (self.along is not None and self.along.whole_edges)
        if four and self.width_mm < 4 * self.edge:
            raise ValueError(
                f"width is {self.width_mm:g} mm; it must be at least four edges of "
                f"{self.edge:g} mm, or the outline fills the stroke"
            )
        low = self.vibration is not None and self.vibration.of == "low"
        if low and self.along is None:
            raise ValueError('vibration of = "low" needs a texture along the stroke; add along')

    @property
    def edge(self) -> float:
        """Length of the edge that the stroke has, in mm."""
        half = self.width_mm / 2
        return half if self.edge_mm == "smooth" else min(self.edge_mm, half)


def _check_high(vibration: Vibration | None, what: str) -> None:
    """Refuse a vibration of what is down in something that is up throughout."""
    if vibration is not None and vibration.of == "low":
        raise ValueError(f'vibration of = "low" is not for {what}, which are up; write "high"')


class DotStyle(Measured, frozen=True, kw_only=True):
    """Look of dots: Lévesque 2009, 8.4.4, and eq. 6.1, which is the same with a plateau.

    Parameters
    ----------
    radius_mm
        Distance from the middle of a dot to where it ends.
    edge_mm
        Length of its edge; None for all of the radius that the plateau leaves.
    plateau
        Share of the radius that is flat, instead of an edge: P of eq. 6.1, which prefers 0.25.
    amplitude
        Deflection of its middle, from 0 to 1.
    across
        Texture from its middle outwards; None for none.
    vibration
        Vibration of the dots; None for none.

    Raises
    ------
    ValueError
        If a number is out of range, both an edge and a plateau are given, or what is down vibrates.
    """

    radius_mm: Length = 1.0
    edge_mm: Length | None = None
    plateau: Annotated[float, limits(0.0, 0.95)] | None = None
    amplitude: Share = 1.0
    across: Across | None = None
    vibration: Vibration | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.edge_mm is not None and self.plateau is not None:
            raise ValueError("plateau cannot be given beside edge_mm; leave one of them out")
        _check_high(self.vibration, "dots")

    @property
    def edge(self) -> float:
        """Length of the edge that a dot has, in mm."""
        if self.edge_mm is not None:
            return min(self.edge_mm, self.radius_mm)
        return self.radius_mm * (1.0 - (self.plateau or 0.0))


class Dotting(Measured, frozen=True, kw_only=True):
    """A row of dots along a shape, in place of a stroke: Lévesque 2009, 8.4.4.

    Parameters
    ----------
    dot
        How the dots look.
    separation_mm
        Least distance between the edges of two dots, also of those on two sides of a joint.
    vertex_vibration
        Vibration of the dots on a polygon's vertices; None if they are like the others.
    velocity_mm_s
        Speed at which the dots move along the path, in the order of its points. Those on vertices
        stay; the others come and go there, and at the ends of an open path, over a millimetre.
    velocity_by
        Name of a signal that is the share of this speed at which they move; empty for all of it.

    Raises
    ------
    ValueError
        If a number is out of range, or what is down vibrates.
    """

    dot: DotStyle = DotStyle()
    separation_mm: Distance = 1.0
    vertex_vibration: Vibration | None = None
    velocity_mm_s: Velocity = 0.0
    velocity_by: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_high(self.vertex_vibration, "dots")

    @property
    def wave(self) -> RidgeWave:
        """Distance of two dots, which are no farther apart, and their speed."""
        return RidgeWave(2 * self.dot.radius_mm + self.separation_mm, self.velocity_mm_s)


class MovingCue(Measured, frozen=True, kw_only=True):
    """Bands that move along a shape, over what it is drawn with: Lévesque 2009, 9.3 and 9.3.2.

    Bands m as wide as the stroke change its texture before it is cut to its profile. Those that
    are wider, or go over dots, change the finished shape, with its fill, within a profile of their
    own; past the ends of an open path they fade over half of what it is drawn with.

    Parameters
    ----------
    way
        How they are felt: "vibrate", a blend to a vibration, (1 - m) δ + m δ_vib, which is felt
        best; "blend", to a level, (1 - m) δ + m level; "mask", δ (1 - m); or "add", a weighted
        sum, (1 - share) δ + share m.
    ridge_mm, gap_mm
        Length of a band, and of the gap after it.
    velocity_mm_s
        Speed of the bands along the path, in the order of its points.
    velocity_by
        Name of a signal that is the share of this speed at which they move; empty for all of it.
    width_mm
        Width that they have at least, whatever that of the stroke.
    share, level
        Weight of the sum, and level of the blend.
    vibration
        Vibration of the bands; None for none, or where they vibrate for one of 50 Hz.
    whole_cycles
        Whether the lengths are changed a little so that a closed path, of one contour, has a whole
        number of bands.

    Raises
    ------
    ValueError
        If a number is out of range, or what is down vibrates.
    """

    way: Literal["vibrate", "blend", "mask", "add"] = "vibrate"
    ridge_mm: Length = 2.0
    gap_mm: Distance = 15.0
    velocity_mm_s: Velocity = 50.0
    velocity_by: str = ""
    width_mm: Distance = 10.0
    share: Share = 0.3
    level: Share = 0.5
    vibration: Vibration | None = None
    whole_cycles: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_high(self.vibration, "bands")

    @property
    def wave(self) -> RidgeWave:
        """Length and speed of the bands."""
        return RidgeWave(self.ridge_mm + self.gap_mm, self.velocity_mm_s)

    @property
    def swing(self) -> Vibration | None:
        """Vibration that the bands have; None if they have none."""
        if self.way == "blend":
            return None
        return self.vibration or (Vibration() if self.way == "vibrate" else None)


class VertexMarkers(Measured, frozen=True, kw_only=True):
    """Markers at the vertices of a polygon: Lévesque 2009, 8.4.3, figs. 8.19 and 8.20.

    Parameters
    ----------
    span
        What a marker spans: "angle", the angle given; "square", square to the edges; "edges",
        where the strokes' edges go on; "arc", as far as the round joint goes.
    angle_deg
        Angle of the span "angle".
    blend_mm
        Distance over which a marker goes over into the stroke's texture.
    vibration
        Vibration of the markers.
    plain
        Whether the markers are up all over in place of that, as a stroke without a texture is.

    Raises
    ------
    ValueError
        If a number is out of range, what is down vibrates, or plain markers have a vibration.
    """

    span: Literal["angle", "square", "edges", "arc"] = "edges"
    angle_deg: Annotated[float, limits(1.0, 180.0, "°")] = 30.0
    blend_mm: Length = 1.0
    vibration: Vibration = Vibration()
    plain: bool = False

    def __post_init__(self) -> None:
        super().__post_init__()
        _check_high(self.vibration, "markers")
        if self.plain and self.vibration != Vibration():
            raise ValueError("vibration cannot be given beside plain = true; leave one out")

    @property
    def swing(self) -> Vibration | None:
        """Vibration that the markers have; None if they are plain."""
        return None if self.plain else self.vibration
