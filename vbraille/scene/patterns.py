"""Patterns: everything that can stand in a tactile picture, as frozen values that check themselves.

A pattern gives a deflection from 0, rest, to 1 for each place of the canvas (Lévesque 2009, ch. 8).
The classes are tables of scene files at the same time: their fields are the keys of the file.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from vbraille.scene.intersections import meeting_edges
from vbraille.scene.measures import (
    LEAST_APART_MM,
    MOST_MM,
    Angle,
    Distance,
    Length,
    Measured,
    Point,
    Share,
    Size,
    Velocity,
    check_file,
    limits,
)
from vbraille.scene.pattern import Pattern
from vbraille.scene.strokes import DotStyle, Dotting, MovingCue, Stroke, VertexMarkers
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    Uniform,
    UniformVibration,
)


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
