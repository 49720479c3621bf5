"""Patterns: everything that can stand in a tactile picture, as frozen values that check themselves.

A pattern gives a deflection from 0, rest, to 1 for each place of the canvas (Lévesque 2009, ch. 8).
The classes are tables of scene files at the same time: their fields are the keys of the file.
"""

from __future__ import annotations

from typing import Literal

from vbraille.errors import check_range
from vbraille.scene.crossing import meeting_edges
from vbraille.scene.dots import Dots, ImageDots
from vbraille.scene.labels import Label
from vbraille.scene.measures import (
    Point,
    check_file,
    check_length,
    check_point,
    check_share,
)
from vbraille.scene.pattern import Pattern
from vbraille.scene.shapes import Shape, StraightLine, check_drawn, check_points
from vbraille.scene.strokes import VertexMarkers
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    Uniform,
    UniformVibration,
)
from vbraille.toml.tomlfile import Table


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

    width_mm: float
    height_mm: float
    part: AnyPattern
    origin_mm: Point = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        check_length("width", self.width_mm, 0.1)
        check_length("height", self.height_mm, 0.1)
        check_point("origin", self.origin_mm)


class Image(Pattern, frozen=True, kw_only=True, tag="image"):
    """A bitmap or a drawing as a plain map, or as the mask of a texture: Lévesque 2009, 8.4.2.

    Parameters
    ----------
    file
        Name of a PNG, GIF, BMP, JPEG or SVG file, seen from the file of the scene.
    place_mm
        Place of the top left corner on the canvas.
    width_mm, height_mm
        Size on the canvas; if one of them is left out, it follows from the other and from the
        picture's shape.
    channel
        "gray", by which white is up, or "alpha", by which what is opaque is up.
    inverted_source
        Whether black is up, or what is transparent.
    blur_mm
        Standard deviation of the Gauss by which it is blurred, since sharp edges are not pleasant.
    outside
        Intensity beyond its edges.
    texture
        Pattern that it is the mask of; None for a plain map.

    Raises
    ------
    ValueError
        If the file is none of this machine, or a number is out of range.
    """

    file: str
    place_mm: Point = (0.0, 0.0)
    width_mm: float | None = None
    height_mm: float | None = None
    channel: Literal["gray", "alpha"] = "gray"
    inverted_source: bool = False
    blur_mm: float = 0.0
    outside: float = 0.0
    texture: AnyPattern | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_file(self.file)
        check_point("place", self.place_mm)
        check_length("width", self.width_mm, 0.1)
        check_length("height", self.height_mm, 0.1)
        check_range("blur", self.blur_mm, 0.0, 100.0, " mm")
        check_share("outside", self.outside)


class Fill(Table, frozen=True, kw_only=True):
    """What fills a closed shape: Lévesque 2009, fig. 8.21 and eq. 8.20.

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
    gap_mm: float = 0.0
    fade_mm: float = 1.0
    blended: bool = False

    def __post_init__(self) -> None:
        check_length("gap", self.gap_mm, 0.0)
        check_length("fade", self.fade_mm, 0.0)


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
    radius_mm: float
    fill: Fill | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_point("center", self.center_mm)
        check_length("radius", self.radius_mm)
        check_drawn(self, self.fill)


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
    rounding_offset_mm: float = 0.0
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
        check_length("rounding offset", self.rounding_offset_mm, 0.0)
        check_drawn(self, self.fill)


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
        check_drawn(self, self.fill)


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
    weights: tuple[float, ...] | None = None
    by: AnyPattern | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.parts:
            raise ValueError("parts are missing; give at least one")
        if (self.weights is not None) != (self.operation == "weighted"):
            raise ValueError('weights belong to operation = "weighted", and to no other')
        if self.weights is not None:
            for number, weight in enumerate(self.weights, 1):
                check_share(f"weights, number {number}", weight)
            if len(self.weights) != len(self.parts) or abs(sum(self.weights) - 1.0) > 1e-6:
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
        check_point("move", self.move_mm)


AnyPattern = (
    Uniform
    | UniformVibration
    | LinearGrating
    | RadialGrating
    | AxialGrating
    | Tile
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
