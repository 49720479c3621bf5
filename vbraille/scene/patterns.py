"""Patterns: everything that can stand in a tactile picture, as frozen values that check themselves.

A pattern gives a deflection from 0, rest, to 1 for each place of the canvas (Lévesque 2009, ch. 8).
The classes are tables of scene files at the same time: their fields are the keys of the file.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from vbraille.errors import check_range
from vbraille.scene.measures import (
    LEAST_APART_MM,
    LEAST_MM,
    MOST_FREQUENCY_HZ,
    MOST_MM,
    Angle,
    Coordinate,
    Distance,
    Frequency,
    Length,
    Measured,
    Point,
    RidgeWave,
    Share,
    Size,
    Velocity,
    check_file,
    limits,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray


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


Zoom = Annotated[float, limits(0.5, 16.0)]


class Pattern(Measured, frozen=True, kw_only=True, tag_field="kind"):
    """Base of patterns of every kind.

    The changes are made in this order: amplitude, inversion, vibration, factor.

    Parameters
    ----------
    id
        Name by which other elements and people call it; empty if it has none.
    title, description
        What it is, in a word and in a sentence, for the person who feels it; empty for nothing.
    amplitude
        Factor of its deflections, from 0 to 1.
    inverted
        Whether 1 - δ is shown in place of δ.
    vibration
        Vibration of its high or of its low parts; None for none.
    words
        Words that are said in place of its title when the finger comes to it; empty for none.
    sound
        Name of a WAV file that is played then, seen from the file of the scene; empty for none.
    factor
        Name of a signal by which its deflections, and what it hides of others, are multiplied;
        empty for none.
    zoom_from, zoom_to
        Zooms of the picture from which on it is there, and from which on it is not; None for no
        such limit. The picture as it is written has a zoom of 1.

    Raises
    ------
    ValueError
        If a value is out of range, or two cannot go together.
    """

    id: str = ""
    title: str = ""
    description: str = ""
    amplitude: Share = 1.0
    inverted: bool = False
    vibration: Vibration | None = None
    words: str = ""
    sound: str = ""
    factor: str = ""
    zoom_from: Zoom | None = None
    zoom_to: Zoom | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.sound:
            check_file(self.sound, "sound")
        begins, ends = self.zoom_from, self.zoom_to
        if begins is not None and ends is not None and begins >= ends:
            raise ValueError(
                f"zoom_to is {ends:g}, and zoom_from {begins:g}, so that it is never there; "
                "give zoom_to a larger number"
            )

    @property
    def kind(self) -> str:
        """Kind as files have it, such as "linear-grating"."""
        return str(self.__struct_config__.tag)


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


MOST_VERTICES = 20_000
_PIECE = 2_000_000  # pairs of edges whose boxes are compared at once
_SLACK_MM = 1e-9


def meeting_edges(vertices_mm: tuple[Point, ...]) -> tuple[int, int] | None:
    """Numbers, from 1, of two edges that have a place in common; None if there are none.

    Edge 1 goes from the first vertex to the second, the last one back to the first. Edges that
    follow each other have a vertex in common, which is right; they meet only if the second goes
    back over the first.

    Parameters
    ----------
    vertices_mm
        Three vertices or more, of which no two that follow each other are one place.

    Raises
    ------
    ValueError
        If there are more than 20,000.

    >>> meeting_edges(((0, 0), (10, 10), (10, 0), (0, 10)))
    (1, 3)
    """
    starts = np.array(vertices_mm, np.float64)
    number = len(starts)
    if number > MOST_VERTICES:
        raise ValueError(
            f"vertices are {number}; there can be {MOST_VERTICES}, so draw it as a path"
        )
    ends, before = np.roll(starts, -1, axis=0), np.roll(starts, 1, axis=0)
    back = (_turns(before, starts, ends) == 0) & (
        ((before - starts) * (ends - starts)).sum(axis=1) > 0
    )
    if back.any():
        index = int(np.argmax(back))
        first, second = sorted(((index - 1) % number + 1, index + 1))
        return first, second
    low, high = np.minimum(starts, ends) - _SLACK_MM, np.maximum(starts, ends) + _SLACK_MM
    rows = max(_PIECE // number, 1)
    for begin in range(0, number, rows):
        some = slice(begin, begin + rows)
        near = np.ones((len(starts[some]), number), bool)
        for axis in range(2):
            near &= low[some, None, axis] <= high[None, :, axis]
            near &= high[some, None, axis] >= low[None, :, axis]
        first, second = np.nonzero(near)
        first += begin
        apart = (second > first + 1) & ((first > 0) | (second < number - 1))
        first, second = first[apart], second[apart]
        a, b, c, d = starts[first], ends[first], starts[second], ends[second]
        meet = (_turns(a, b, c) * _turns(a, b, d) <= 0) & (_turns(c, d, a) * _turns(c, d, b) <= 0)
        if meet.any():
            at = int(np.argmax(meet))
            return int(first[at]) + 1, int(second[at]) + 1
    return None


def _turns(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Signs of the turns at b on the ways from a to c."""
    along, away = b - a, c - a
    return np.sign(along[:, 0] * away[:, 1] - along[:, 1] * away[:, 0])


class Label(Pattern, frozen=True, kw_only=True, tag="label"):
    """Braille in the picture: a text, translated by the same tables as books are.

    Parameters
    ----------
    text
        The text.
    place_mm
        Top left corner of its first cell.
    width_mm
        Width at which its lines are broken; None for one line.
    table
        Language or table of liblouis; empty for that of the scene.
    angle_deg
        Direction of its lines, from +x towards +y.

    Raises
    ------
    ValueError
        If the text is empty, or a number is out of range.
    """

    text: str
    place_mm: Point
    width_mm: Annotated[float, limits(1.0, MOST_MM, " mm")] | None = None
    table: str = ""
    angle_deg: Angle = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.text.strip():
            raise ValueError("text is empty; a label needs one")


class Dots(Pattern, frozen=True, kw_only=True, tag="dots"):
    """Dots at any places, which share their look; where they overlap, the larger counts.

    Parameters
    ----------
    centers_mm
        Middles of the dots.
    dot
        How the dots look.

    Raises
    ------
    ValueError
        If there are none, or a number is out of range.
    """

    centers_mm: tuple[Point, ...]
    dot: DotStyle = DotStyle()

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.centers_mm:
            raise ValueError("centers are missing; give at least one")


class FromFile(Pattern, frozen=True, kw_only=True):
    """Base of patterns that are made from a picture in a file.

    Parameters
    ----------
    file
        Name of a PNG, GIF, BMP, JPEG or SVG file, seen from the file of the scene.
    place_mm
        Place of the top left corner on the canvas.
    width_mm, height_mm
        Size on the canvas; if one of them is left out, it follows from the other and from the
        picture's shape.

    Raises
    ------
    ValueError
        If the file is none of this machine, or a number is out of range.
    """

    file: str
    place_mm: Point = (0.0, 0.0)
    width_mm: Size | None = None
    height_mm: Size | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_file(self.file)


class ImageDots(FromFile, frozen=True, kw_only=True, tag="image-dots"):
    """Dots where a grayscale image has blobs: Lévesque 2009, 6.3.1 and eq. 6.1.

    A blob is a connected set of bright pixels. Its dot stands at its centre of mass and has its
    largest gray as amplitude. How a blob becomes a dot is not in the source; this is ours to
    choose.

    Parameters
    ----------
    threshold
        Gray, from 0 to 1, above which a pixel belongs to a blob.
    by_area
        Whether a dot has its blob's area, and not the radius of ``dot``.
    dot
        How the dots look.
    cell_mm
        Width and height of a cell: there is a dot in the middle of each cell of a grid over the
        image instead, whose mean gray is its amplitude (5.3, with cells of 1.2 by 1.8 mm). No dot
        is then larger than its cell. None for blobs.

    Raises
    ------
    ValueError
        If the file is none of this machine, or a number is out of range.
    """

    threshold: Share = 0.1
    by_area: bool = True
    cell_mm: tuple[Size, Size] | None = None
    dot: DotStyle = DotStyle(plateau=0.25)


class Shape(Pattern, frozen=True, kw_only=True):
    """Base of shapes of every kind: a stroke, or dots in its place.

    Parameters
    ----------
    stroke
        Stroke along the shape; None for none.
    dots
        Dots along the shape, in place of a stroke; None for none.
    cue
        Bands that move along it over these; None for none.

    Raises
    ------
    ValueError
        If it has both a stroke and dots, or a cue and neither.
    """

    stroke: Stroke | None = None
    dots: Dotting | None = None
    cue: MovingCue | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.stroke is not None and self.dots is not None:
            raise ValueError("dots cannot be given beside a stroke; leave one out")
        is_drawn = self.stroke is not None or self.dots is not None
        if self.cue is not None and not is_drawn:
            raise ValueError("cue needs a stroke or dots that it goes along; add one")
        if not is_drawn and getattr(self, "fill", None) is None:
            raise ValueError("a shape needs a stroke, dots or a fill; add one")

    @property
    def outline(self) -> tuple[tuple[tuple[Point, ...], ...], bool]:
        """Places of each contour of its path, and whether they close; a circle has none."""
        return (), True

    @property
    def width_mm(self) -> float:
        """Width of its stroke, or of its dots; 0 without either."""
        if self.stroke is not None:
            return self.stroke.width_mm
        return 0.0 if self.dots is None else 2 * self.dots.dot.radius_mm

    @property
    def cue_width_mm(self) -> float:
        """Width of its cue; 0 without one."""
        return 0.0 if self.cue is None else max(self.cue.width_mm, self.width_mm)

    @property
    def cue_edge_mm(self) -> float:
        """Length of the edge of its cue, which is that of what it is drawn with."""
        edge: float | str = self.width_mm / 2
        if self.stroke is not None:
            edge = self.stroke.edge_mm
        elif self.dots is not None:
            edge = self.dots.dot.edge
        half = self.cue_width_mm / 2
        return half if edge == "smooth" else min(float(edge), half)

    @property
    def is_cued_over(self) -> bool:
        """Tell whether its cue changes the finished shape, and not the texture of its stroke."""
        return self.cue is not None and (
            self.stroke is None or self.stroke.width_mm < self.cue.width_mm
        )


class StraightLine(Shape, frozen=True, kw_only=True, tag="line"):
    """A straight line with round ends: Lévesque 2009, eqs. 8.15-8.17.

    Parameters
    ----------
    start_mm, end_mm
        The two ends; textures along it begin at the first.

    Raises
    ------
    ValueError
        If a number is out of range, or both ends are one place.
    """

    start_mm: Point
    end_mm: Point

    def __post_init__(self) -> None:
        super().__post_init__()
        if math.dist(self.start_mm, self.end_mm) < LEAST_APART_MM:
            raise ValueError("end is where the line starts; a line needs two places")

    @property
    def outline(self) -> tuple[tuple[tuple[Point, ...], ...], bool]:
        """Return its two ends."""
        return ((self.start_mm, self.end_mm),), False


def check_points(what: str, points_mm: tuple[Point, ...], least: int, *, closed: bool) -> None:
    """Refuse too few places, and places that follow each other and are one."""
    if len(points_mm) < least:
        raise ValueError(f"{what} are {len(points_mm)}; there must be {least} or more")
    for number, point in enumerate(points_mm, 1):
        if number > 1 and math.dist(point, points_mm[number - 2]) < LEAST_APART_MM:
            raise ValueError(f"{what}, number {number} is the place before it; leave it out")
    if closed and math.dist(points_mm[-1], points_mm[0]) < LEAST_APART_MM:
        raise ValueError(f"{what}, number {len(points_mm)} is the first place; leave it out")


class Tile(Pattern, frozen=True, kw_only=True, tag="tile"):
    """A pattern repeated over the canvas: δ(p mod (w, h)); Lévesque 2009, 8.4.1.

    Parameters
    ----------
    width_mm, height_mm
        Size of a tile.
    part
        Pattern in each tile, seen from the tile's top left corner; what stands beyond the tile is
        cut off.
    origin_mm
        Place of one tile's top left corner.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    width_mm: Size
    height_mm: Size
    part: AnyPattern
    origin_mm: Point = (0.0, 0.0)


class Moving(Pattern, frozen=True, kw_only=True, tag="moving"):
    """A texture that moves as a whole: δ(p - vt); Lévesque 2009, eq. 9.1.

    Parameters
    ----------
    part
        The texture, or any pattern.
    velocity_mm_s
        How fast it moves, right and down.
    velocity_by
        Name of a signal that is the share of this speed at which it moves; empty for all of it.
    array_at_mm
        Place at which the array is taken to stand, so that what moves is felt to go on under the
        finger whether the hand moves or not; None for where it is.

    Raises
    ------
    ValueError
        If a number is out of range, or a signal is given without a velocity.
    """

    part: AnyPattern
    velocity_mm_s: tuple[Velocity, Velocity] = (0.0, 0.0)
    velocity_by: str = ""
    array_at_mm: Point | None = None


class Image(FromFile, frozen=True, kw_only=True, tag="image"):
    """A bitmap or a drawing as a plain map, or as the mask of a texture: Lévesque 2009, 8.4.2.

    Parameters
    ----------
    channel
        "gray", by which white is up, or "alpha", by which what is opaque is up.
    inverted_source
        Whether black is up, or what is transparent.
    blur_mm
        Standard deviation of the Gauss by which it is blurred, since sharp edges are not pleasant.
    outside
        Intensity beyond its edges.
    nearest
        Whether each place has the intensity of the pixel that it is in, and not one between those
        of the pixels around it. Its blur is alike in pixels then, and ends at twice its deviation
        and at the picture's edges.
    texture
        Pattern that it is the mask of; None for a plain map.

    Raises
    ------
    ValueError
        If the file is none of this machine, or a number is out of range.
    """

    channel: Literal["gray", "alpha"] = "gray"
    inverted_source: bool = False
    blur_mm: Annotated[float, limits(0.0, 100.0, " mm")] = 0.0
    outside: Share = 0.0
    nearest: bool = False
    texture: AnyPattern | None = None


class Fill(Measured, frozen=True, kw_only=True):
    """Filling of a closed shape: Lévesque 2009, fig. 8.21 and eq. 8.20.

    Parameters
    ----------
    texture
        Pattern of the inside.
    gap_mm
        Distance between the stroke's inner edge and the fill.
    fade_mm
        Distance over which the fill grows from there to its full strength.
    blended
        Whether the fill goes on under the stroke, which is blended into it (eq. 8.20); gap and
        fade do not count then.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    texture: AnyPattern
    gap_mm: Distance = 0.0
    fade_mm: Distance = 1.0
    blended: bool = False


class Circle(Shape, frozen=True, kw_only=True, tag="circle"):
    """A circle, with or without a fill: Lévesque 2009, eqs. 8.18 and 8.19.

    Parameters
    ----------
    center_mm, radius_mm
        Middle of the circle, and radius to the middle of the stroke.
    fill
        What fills it; None for nothing.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    center_mm: Point
    radius_mm: Length
    fill: Fill | None = None


class Polygon(Shape, frozen=True, kw_only=True, tag="polygon"):
    """A closed polygon whose edges do not cross: Lévesque 2009, 8.4.3.

    Parameters
    ----------
    vertices_mm
        Vertices in order, three or more; the first is where textures along it begin.
    join
        How a texture along the stroke goes round a corner: "straight", to the bisector, where it
        jumps, or "rounded", along an arc round the point where the stroke's edges meet.
    rounding_offset_mm
        How much wider the stroke is taken to be for that arc, which moves its middle away.
    fill
        What fills it; None for nothing.
    markers
        Markers at its vertices; None for none.

    Raises
    ------
    ValueError
        If a number is out of range, there are fewer than three vertices, two that follow each
        other are one place, or edges cross.
    """

    vertices_mm: tuple[Point, ...]
    join: Literal["straight", "rounded"] = "rounded"
    rounding_offset_mm: Distance = 0.0
    fill: Fill | None = None
    markers: VertexMarkers | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_points("vertices", self.vertices_mm, 3, closed=True)
        edges = meeting_edges(self.vertices_mm)
        if edges is not None:
            first, second = edges
            raise ValueError(
                f"vertices make edges that cross or touch, those after number {first} and number "
                f"{second}; set them in order around the shape"
            )

    @property
    def outline(self) -> tuple[tuple[tuple[Point, ...], ...], bool]:
        """Return its vertices."""
        return (self.vertices_mm,), True


class PathShape(Shape, frozen=True, kw_only=True, tag="path"):
    """Lines through many places, open or closed, one or several, as drawings have them.

    Parameters
    ----------
    contours_mm
        The places of each contour, in order; textures along it begin at the first.
    closed
        Whether each contour goes back to its first place.
    fill
        What fills the closed contours, by the even-odd rule; None for nothing.

    Raises
    ------
    ValueError
        If a number is out of range, a contour has too few places, or an open one has a fill.
    """

    contours_mm: tuple[tuple[Point, ...], ...]
    closed: bool = False
    fill: Fill | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.contours_mm:
            raise ValueError("contours are missing; give at least one")
        for number, contour in enumerate(self.contours_mm, 1):
            least = 3 if self.closed else 2
            check_points(f"contours, number {number}", contour, least, closed=self.closed)
        if self.fill is not None and not self.closed:
            raise ValueError("fill needs a closed path; write closed = true")

    @property
    def outline(self) -> tuple[tuple[tuple[Point, ...], ...], bool]:
        """Return its contours."""
        return self.contours_mm, self.closed


Operation = Literal["overwrite", "multiply", "add", "weighted", "maximum", "blend"]


class Group(Pattern, frozen=True, kw_only=True, tag="group"):
    """Patterns put together: Lévesque 2009, 8.4.5.

    Parameters
    ----------
    operation
        "overwrite", layers of which the last is on top (eq. 8.22); "multiply", masking; "add", a
        sum that ends at 1; "weighted", a sum by ``weights``; "maximum"; or "blend", by which
        ``by`` chooses between two parts (eq. 8.21: 0 the first, 1 the second).
    parts
        The patterns.
    weights
        A weight for each part of a weighted sum; they add up to 1.
    by
        Pattern that chooses in a blend.

    Raises
    ------
    ValueError
        If parts, weights and operation do not go together.
    """

    operation: Operation = "overwrite"
    parts: tuple[AnyPattern, ...]
    weights: tuple[Share, ...] | None = None
    by: AnyPattern | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.parts:
            raise ValueError("parts are missing; give at least one")
        if (self.weights is not None) != (self.operation == "weighted"):
            raise ValueError('weights belong to operation = "weighted", and to no other')
        weights = self.weights
        if weights is not None and (
            len(weights) != len(self.parts) or abs(sum(weights) - 1.0) > 1e-6
        ):
            raise ValueError("weights must be one for each part, and add up to 1")
        if (self.by is not None) != (self.operation == "blend"):
            raise ValueError('by belongs to operation = "blend", and to no other')
        if self.operation == "blend" and len(self.parts) != 2:
            raise ValueError(f"parts are {len(self.parts)}; a blend has two")


class Use(Pattern, frozen=True, kw_only=True, tag="use"):
    """Another element or a named texture, by its name, with the changes that are given here.

    Parameters
    ----------
    name
        Id of an element of the scene or of what it includes, or name of a texture.
    move_mm
        How far it is moved, right and down.

    Raises
    ------
    ValueError
        If the name is empty, or a number is out of range.
    """

    name: str
    move_mm: Point = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.name:
            raise ValueError("name is empty; say which element or texture is used")


AnyPattern = (
    Uniform
    | UniformVibration
    | SignalLevel
    | LinearGrating
    | RadialGrating
    | AxialGrating
    | Tile
    | Moving
    | Image
    | ImageDots
    | StraightLine
    | Circle
    | Polygon
    | PathShape
    | Dots
    | Label
    | Group
    | Use
)
