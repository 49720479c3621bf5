"""Drawings as scenes: the walk through an SVG file, which makes patterns of its shapes."""

from __future__ import annotations

import cmath
import math
import os
import re
from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass
from dataclasses import replace as changed
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.intersections import meeting_edges
from vbraille.scene.locations import FoundScene
from vbraille.scene.measures import LEAST_MM
from vbraille.scene.patterns import Circle, Fill, Group, PathShape, Polygon, StraightLine, Uniform
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.svg import outlines
from vbraille.scene.svg.document import (
    INKSCAPE,
    MOST_DEPTH,
    MOST_ELEMENTS,
    called,
    ids_of,
    link_of,
    name_of,
    read_tree,
    short,
    target_of,
)
from vbraille.scene.svg.labels import TextReader, description_of, id_of, title_of
from vbraille.scene.svg.looks import LEAST_SHARE, ClassLook, dashes_of, fill_of, stroke_of
from vbraille.scene.svg.outlines import MOST_POINTS, SHAPES, TOO_FAR, Contour
from vbraille.scene.svg.styles import StyleSheets
from vbraille.scene.svg.values import (
    BLACK,
    PX_MM,
    AffineMap,
    Color,
    Paint,
    Units,
    angle_of,
    color_of,
    fit,
    length_of,
    origin_of,
    paint_of,
    share_of,
    transform_of,
    turned_by,
    view_box_of,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from pathlib import Path

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.strokes import Stroke
    from vbraille.scene.svg.document import Element
    from vbraille.scene.svg.outlines import Ring
    from vbraille.scene.svg.styles import Style
    from vbraille.scene.svg.values import Box, Point
    from vbraille.scene.traversal import Steps

# Elements that only stand in a drawing to be used, or say something about it.
_SILENT = frozenset(
    ("", "clipPath", "cursor", "defs", "desc", "filter", "font", "linearGradient", "marker",
     "mask", "metadata", "pattern", "radialGradient", "script", "style", "symbol", "title", "view")
)  # fmt: skip
_CONTAINERS = frozenset(("g", "a", "svg", "switch", "use", "text"))
_IGNORED = {"image": 'it is ignored; put the picture into a scene file, as kind = "image"'}
_OWN_BOXES = frozenset(("fill-box", "content-box", "stroke-box", "border-box"))
_MOST_NESTED = 20  # groups that are kept one in another; deeper ones are parts of those around
_MOST_LINKS = 10  # gradients that take their colours from others
_MOST_CROSSED = 2000  # places of a contour that is searched for crossings
_NAMED_LINES = 5
_LANGUAGE = re.compile(r"[A-Za-z]{2,3}(?:-[A-Za-z0-9]{1,8})*")
_XML_LANG = "{http://www.w3.org/XML/1998/namespace}lang"


@dataclass(frozen=True, slots=True)
class DrawnNode:
    """A pattern, the line of its element, and the same of its parts."""

    pattern: AnyPattern
    line: int
    parts: tuple[DrawnNode, ...] = ()


@dataclass(frozen=True, slots=True)
class _Place:
    """Properties that elements have of those that they stand in.

    Parameters
    ----------
    matrix
        Map from their coordinates to mm on the canvas.
    style
        Style of the element around them.
    view
        Width and height of the viewport.
    look
        Look that the scene gives to the class around them; None for none.
    strength
        Product of the opacities around them.
    clip
        Area that they are cut to, in mm; None for no such area.
    context
        Paints of fill and stroke that context-fill and context-stroke stand for.
    depth, groups
        How deep they stand, and in how many groups that are kept.
    named
        Whether their ids are kept, which belong to one place.
    """

    matrix: AffineMap
    style: Mapping[str, str]
    view: Point
    look: ClassLook | None = None
    strength: float = 1.0
    clip: tuple[Ring, ...] | None = None
    context: tuple[Paint, Paint] = (Paint("none"), Paint("none"))
    depth: int = 0
    groups: int = 0
    named: bool = True


def read_svg(path: Path, class_looks: Mapping[str, ClassLook] | None = None) -> FoundScene:
    """Read a drawing as a scene.

    Shapes become shapes, and texts labels. Curves are flattened to 0.05 mm. Fills and lines of a
    colour have the texture that stands for it, unless the scene gives another to their class; see
    docs/drawings.md. Nothing of a drawing is run, and nothing that it refers to is fetched.

    Parameters
    ----------
    path
        The file.
    class_looks
        Looks of shapes, by their class, by the label that Inkscape gives them, or by their id. A
        group's holds for all that stands in it.

    Returns
    -------
    FoundScene
        The scene, the lines of its elements, and remarks on all that is felt otherwise than drawn.

    Raises
    ------
    InputError
        If the file is none that `read_tree` reads, has no size, or has more than 50,000 elements
        or 500,000 places together with what it uses again.
    """
    root = read_tree(path)
    drawing = SvgDrawing(str(path), root, class_looks or {})
    nodes = drawing.nodes()
    language = root.get(_XML_LANG) or root.get("lang") or ""
    scene = Scene(
        canvas=_canvas(drawing.size_px, str(path)),
        title=title_of(root),
        description=description_of(root),
        elements=tuple(node.pattern for node in nodes),
    )
    if _LANGUAGE.fullmatch(language):
        scene = replace(scene, language=language)
    lines: dict[Steps, int] = {}
    left: list[tuple[Steps, DrawnNode]] = [(("elements", n), node) for n, node in enumerate(nodes)]
    while left:
        steps, node = left.pop()
        if node.line:
            lines[steps] = node.line
        left += [((*steps, "parts", n), part) for n, part in enumerate(node.parts)]
    return FoundScene(scene, lines, drawing.warnings())


def size_px(root: Element, style: Mapping[str, str], name: str) -> tuple[float, float]:
    """Width and height of a drawing, in pixels of 1/96 inch.

    Where they are not given as lengths, they are those of the viewBox.

    Raises
    ------
    InputError
        If there is none of these.
    """
    view = view_box_of(root.get("viewBox"))
    units = Units((0.0, 0.0), (0.0, 0.0))
    given = [
        None if "%" in (text or "") else length_of(text, 0.0, units)
        for text in (style.get("width"), style.get("height"))
    ]
    width, height = given
    if view is not None:
        if width is None and height is None:
            width, height = view[2:]
        elif width is None:
            width = (height or 0.0) * view[2] / view[3]
        elif height is None:
            height = width * view[3] / view[2]
    if not width or not height or width <= 0 or height <= 0:
        raise InputError(f"{name} has no size; give its svg element a width and a height")
    return width, height


def _canvas(size: Point, name: str) -> Canvas:
    width, height = (round(one * PX_MM, 4) for one in size)
    try:
        return Canvas(width_mm=width, height_mm=height)
    except ValueError as error:
        raise InputError(f"{name} cannot be a canvas: its {error}") from None


def _user_language() -> str:
    """Language of the user, as the system has it; English where it has none."""
    said = next(filter(None, map(os.environ.get, ("LC_ALL", "LC_MESSAGES", "LANG"))), "")
    language = said.partition(".")[0].replace("_", "-").lower()
    return language if language not in ("", "c", "posix") else "en"


class SvgDrawing:
    """A drawing that becomes patterns, and the remarks on it so far.

    Parameters
    ----------
    name
        Name of its file, for messages.
    root
        Root element, ``svg``.
    class_looks
        Looks that the scene gives to classes.
    """

    def __init__(self, name: str, root: Element, class_looks: Mapping[str, ClassLook]) -> None:
        self._name, self._root, self._class_looks = name, root, class_looks
        self._ids = ids_of(root)
        self._notes: dict[str, list[tuple[int, str]]] = defaultdict(list)
        self._named: set[str] = set()
        self._used: list[Element] = []
        self._met: set[str] = set()  # names of classes that the scene gives a look
        self._elements = self._points = 0
        self._language = _user_language()
        try:
            self._sheets = StyleSheets(root, self.note)
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
        self._texts = TextReader(self._sheets, self._ids, self.note)
        no_size = Units((0.0, 0.0), (0.0, 0.0))
        self.size_px = size_px(root, self._sheets.of(root, {}, no_size), name)

    def nodes(self) -> list[DrawnNode]:
        """Patterns of the whole drawing."""
        for element in self._root.iter():
            if name_of(element) == "script":
                self.note(element, "it is never run, and ignored")
            if any(str(key).startswith("on") for key in element.keys()):  # noqa: SIM118 - no dict
                self.note(element, "its script is never run")
        view = view_box_of(self._root.get("viewBox"))
        matrix = AffineMap(a=PX_MM, d=PX_MM)
        if view is not None:
            how = self._root.get("preserveAspectRatio") or ""
            matrix = matrix @ fit(view, self.size_px, how)
        place = _Place(matrix, {}, self.size_px if view is None else view[2:])
        style = self._sheets.of(self._root, {}, self._units(place))
        strength = share_of(style.get("opacity")) if "opacity" in style else 1.0
        if style.get("display") == "none":
            return []
        return self._inside(self._root, changed(place, style=style, strength=strength or 0.0))

    def note(self, element: Element, remark: str) -> None:
        """Keep a remark on an element."""
        self._notes[remark].append((element.sourceline or 0, called(element)))

    def warnings(self) -> tuple[str, ...]:
        """All remarks, one sentence for the same one on several elements."""
        said = []
        for remark, places in self._notes.items():
            (line, name), *others = places
            sentence = f"line {line}: {name}: {remark}" if line else f"{name}: {remark}"
            if others:
                lines = sorted({str(line) for line, _ in others}, key=int)
                sentence += f"; and {len(others)} more, in line{'s' * (len(lines) > 1)} "
                sentence += ", ".join(lines[:_NAMED_LINES])
                sentence += " and others" * (len(lines) > _NAMED_LINES)
            said.append(sentence)
        said += [
            f"nothing that is shown has the class, label or id {name}, which the scene speaks of"
            for name in self._class_looks
            if name not in self._met
        ]
        return tuple(said)

    def _units(self, place: _Place) -> Units:
        units = Units(place.view, self.size_px)
        font = length_of(place.style.get("font-size"), 16.0, units)
        return changed(units, font=font if font is not None else 16.0)

    def _inside(self, element: Element, place: _Place) -> list[DrawnNode]:
        """Patterns of the elements in another."""
        if place.depth >= MOST_DEPTH:
            raise InputError(
                f"{self._name} line {element.sourceline}: {called(element)} is more than "
                f"{MOST_DEPTH} deep; ungroup some of what is around it"
            )
        children = list(element)
        if name_of(element) == "switch":
            shown = (*SHAPES, *_CONTAINERS)
            children = [one for one in children if name_of(one) in shown and self._holds(one)][:1]
        return [node for child in children for node in self._one(child, place)]

    def _holds(self, element: Element) -> bool:
        """Tell whether the conditions of an element hold, such as its language."""
        if (element.get("requiredExtensions") or "").strip():
            return False
        languages = element.get("systemLanguage")
        if languages is None:
            return True
        wanted = [one.strip().lower() for one in languages.split(",")]
        return any(
            f"{one}-".startswith(f"{self._language}-") or f"{self._language}-".startswith(f"{one}-")
            for one in wanted
            if one
        )

    def _one(self, element: Element, around: _Place) -> list[DrawnNode]:
        """Patterns of an element."""
        name = name_of(element)
        self._count(element)
        if name in _SILENT or not self._holds(element):
            return []
        if name not in SHAPES and name not in _CONTAINERS:
            self.note(element, _IGNORED.get(name, "it is ignored"))
            return []
        return self._shown(element, name, around)

    def _shown(
        self,
        element: Element,
        name: str,
        around: _Place,
        sizes: tuple[str | None, str | None] = (None, None),
    ) -> list[DrawnNode]:
        """Patterns of an element that may be shown; ``sizes`` are those that a use gives."""
        style = self._sheets.of(element, around.style, self._units(around))
        look = self._look(element) or around.look
        strength = around.strength * self._share(style, "opacity")
        if style.get("display") == "none" or strength <= LEAST_SHARE or (look and look.hidden):
            return []
        place = changed(around, style=style, look=look, strength=strength, depth=around.depth + 1)
        for word in ("filter", "mask"):
            if style.get(word, "none") not in ("none", ""):
                self.note(element, f"its {word} is ignored")
        for word in ("translate", "rotate", "scale"):
            if style.get(word, "none") != "none":
                self.note(element, f"its style's {word} is ignored; write it as a transform")
        matrix = self._matrix(element, name, place)
        if matrix.scale == 0.0:
            return []  # it is drawn as nothing
        place = changed(place, matrix=around.matrix @ matrix)
        place = self._clipped(element, name, place)
        if place.clip == ():
            return []
        return self._kept(element, name, place, sizes)

    def _kept(
        self,
        element: Element,
        name: str,
        place: _Place,
        sizes: tuple[str | None, str | None],
    ) -> list[DrawnNode]:
        """Patterns of an element that is shown, with its title, description and id."""
        title, description = title_of(element), description_of(element)
        own_id = id_of(element) if place.named else ""
        if own_id in self._named:
            self.note(element, "another element has the same id, so it is left without")
            own_id = ""
        kept = bool(title or description or own_id)
        kept = kept and place.groups < _MOST_NESTED
        inner = changed(place, groups=place.groups + 1) if kept else place
        found = self._made(element, name, inner, sizes)
        if not found or not kept:
            return found
        if own_id:
            self._named.add(own_id)
        line = element.sourceline or 0
        if len(found) == 1 and not (found[0].pattern.title or found[0].pattern.id):
            one = replace(found[0].pattern, id=own_id, title=title, description=description)
            return [DrawnNode(one, line, found[0].parts)]
        parts = tuple(node.pattern for node in found)
        group = Group(id=own_id, title=title, description=description, parts=parts)
        return [DrawnNode(group, line, tuple(found))]

    def _made(
        self,
        element: Element,
        name: str,
        place: _Place,
        sizes: tuple[str | None, str | None],
    ) -> list[DrawnNode]:
        """Patterns of an element that is shown, without its title, description and id."""
        if name == "use":
            return self._of_use(element, place)
        if name in ("svg", "symbol"):
            return self._of_svg(element, place, sizes)
        if name not in SHAPES and name != "text":
            return self._inside(element, place)
        if place.style.get("visibility") in ("hidden", "collapse"):
            return []
        line = element.sourceline or 0
        with self._noting(element):
            if name == "text":
                amplitude = round(min(place.strength, 1.0), 4)
                return [
                    DrawnNode(replace(label, amplitude=amplitude), one.sourceline or line)
                    for one, label in self._texts.labels(
                        element, place.matrix, place.style, self._units(place)
                    )
                ]
            return self._shape(element, name, place)
        return []

    def _shape(self, element: Element, name: str, place: _Place) -> list[DrawnNode]:
        """Patterns of a shape and of its markers, the lowest first."""
        units, style = self._units(place), place.style
        path = outlines.path_of(element, style, units)
        segments, whole = outlines.segments_of(path)
        if not whole:
            self.note(
                element, "its path is not understood from some place on; the rest is left out"
            )
        contours = outlines.contours_of(segments, place.matrix, MOST_POINTS + 1 - self._points)
        self._points += sum(len(one.points_mm) for one in contours)
        if self._points > MOST_POINTS:
            raise InputError(
                f"{self._name} has more than {MOST_POINTS} places on its lines; simplify it"
            )
        fill, stroke, dots = self._drawn(element, name, place, units)
        if place.clip is not None and _is_inside(contours, stroke, place.clip):
            place = changed(place, clip=None)
        line = element.sourceline or 0
        patterns: list[AnyPattern] = []
        if fill is not None or stroke is not None or dots is not None:
            circle = None
            lines = {"stroke": stroke, "dots": dots}
            if name in ("circle", "ellipse") and place.clip is None:
                circle = self._circle(element, place, units, {**lines, "fill": fill})
            patterns = (
                [circle] if circle else self._patterns(element, name, contours, place, fill, lines)
            )
            if not patterns and place.clip is None and whole:
                self.note(element, "it has no size, and is left out")
        if place.strength < 1.0:
            amplitude = round(place.strength, 4)
            patterns = [replace(one, amplitude=amplitude) for one in patterns]
        nodes = [DrawnNode(one, line) for one in patterns]
        return nodes + self._markers(segments, place, units)

    def _drawn(
        self, element: Element, name: str, place: _Place, units: Units
    ) -> tuple[Fill | None, Stroke | None, Any]:
        """Fill, stroke and dots of a shape."""
        look = place.look or ClassLook()
        style = place.style

        def note(remark: str) -> None:
            self.note(element, remark)

        fill = None if name == "line" else look.fill
        if fill is None and name != "line":
            color = self._color(element, place, "fill")
            fill = None if color is None else fill_of(color, note)
        if look.dots is not None or look.stroke is not None:
            return fill, look.stroke, look.dots
        color = self._color(element, place, "stroke")
        if color is None:
            return fill, None, None
        scale = self._stroke_scale(style, place)
        width = length_of(style.get("stroke-width", "1"), units.diagonal, units) or 0.0
        stroke = stroke_of(color, width * scale, dashes_of(style, scale, units), note)
        return fill, stroke, None

    def _stroke_scale(self, style: Mapping[str, str], place: _Place) -> float:
        """Millimetres of a unit of a stroke's width."""
        if style.get("vector-effect", "").strip() != "non-scaling-stroke":
            return place.matrix.scale
        view = view_box_of(self._root.get("viewBox"))
        if view is None:
            return PX_MM
        how = self._root.get("preserveAspectRatio") or ""
        return (AffineMap(a=PX_MM, d=PX_MM) @ fit(view, self.size_px, how)).scale

    def _color(self, element: Element, place: _Place, what: str) -> Color | None:
        """Colour of a fill or a stroke, with all its transparency; None for no paint."""
        paint = self._paint(place, what)
        color = paint.color
        if paint.kind == "url":
            gradient = self._gradient(paint.target)
            if gradient is None:
                kind = paint.otherwise or "none"
                if kind == "none":
                    if not paint.otherwise:
                        self.note(
                            element, f"its {what} is a gradient that is not there; it has none"
                        )
                    return None
                color = paint.color if kind == "color" else self._current(place.style)
            else:
                color = gradient
                if color == BLACK:
                    self.note(
                        element, f"its {what} is a gradient or a pattern, felt as plain black"
                    )
        elif paint.kind == "currentcolor":
            color = self._current(place.style)
        elif paint.kind != "color":
            return None
        return changed(color, alpha=color.alpha * self._share(place.style, f"{what}-opacity"))

    def _paint(self, place: _Place, what: str) -> Paint:
        """Paint of a fill or a stroke, as it is written or as the context has it."""
        usual = "black" if what == "fill" else "none"
        paint = paint_of(place.style.get(what, usual)) or Paint("none")
        if paint.kind.startswith("context-"):
            return place.context[paint.kind == "context-stroke"]
        if paint.kind == "currentcolor":
            return Paint("color", self._current(place.style))
        return paint

    def _current(self, style: Mapping[str, str]) -> Color:
        return color_of(style.get("color", "black")) or BLACK

    def _gradient(self, name: str) -> Color | None:
        """Colour that stands for a gradient or a pattern: black; None if there is none of the name.

        A gradient of one colour has this colour, and one without any colour is none.
        """
        element = self._ids.get(name)
        if element is None or not name_of(element).endswith(("Gradient", "pattern")):
            return None
        if name_of(element) == "pattern":
            return BLACK
        stops: list[Element] = []
        for _ in range(_MOST_LINKS):
            stops = [child for child in element if name_of(child) == "stop"]
            after = self._ids.get(link_of(element)[1:])
            if stops or after is None:
                break
            element = after
        colors: list[Color] = []
        for stop in stops:
            written = {str(key): str(value) for key, value in stop.items()}
            for part in (stop.get("style") or "").split(";"):
                key, _, value = part.partition(":")
                written[key.strip()] = value.strip()
            color = color_of(written.get("stop-color", "black")) or BLACK
            opacity = share_of(written.get("stop-opacity", "1"))
            colors.append(changed(color, alpha=color.alpha * (1.0 if opacity is None else opacity)))
        if not colors:
            return None
        if all(color == colors[0] for color in colors):
            return colors[0]
        if all(color.alpha <= LEAST_SHARE for color in colors):
            return colors[0]
        return BLACK

    def _share(self, style: Mapping[str, str], name: str) -> float:
        share = share_of(style[name]) if name in style else 1.0
        return 1.0 if share is None else share

    def _circle(
        self, element: Element, place: _Place, units: Units, drawn: Mapping[str, Any]
    ) -> Circle | None:
        """Circle that a circle or an ellipse is on the canvas; None if it is none there."""
        (x, y), (rx, ry) = outlines.round_of(element, place.style, units)
        radius = rx * place.matrix.scale
        if rx != ry or not place.matrix.keeps_circles or not LEAST_MM <= radius <= 10_000.0:
            return None
        center = place.matrix.put(complex(x, y))
        return Circle(
            center_mm=(round(center.real, 4) + 0.0, round(center.imag, 4) + 0.0),
            radius_mm=round(radius, 4),
            **drawn,
        )

    def _patterns(
        self,
        element: Element,
        name: str,
        contours: list[Contour],
        place: _Place,
        fill: Fill | None,
        lines: Mapping[str, Any],
    ) -> list[AnyPattern]:
        """Patterns of outlines, the lowest first."""
        rings = [one.points_mm for one in contours if len(one.points_mm) >= 3]
        shown = any(lines.values())
        cornered = (
            len(contours) == 1
            and contours[0].closed
            and (name == "polygon" or (name == "rect" and len(rings) == 1 and len(rings[0]) == 4))
        )
        if cornered and place.clip is None and not _crosses(rings[0]) and (fill or shown):
            return [Polygon(vertices_mm=rings[0], fill=fill, **lines)]
        found: list[AnyPattern] = []
        if fill is not None and rings:
            areas, right = outlines.filled(rings, place.style.get("fill-rule", "nonzero"))
            if not right:
                self.note(element, "it has too many places to find where it overlaps itself; "
                          "it is filled by the even-odd rule")  # fmt: skip
            if place.clip is not None:
                areas = outlines.cut(areas, place.clip)
            together = areas == rings and len(rings) == len(contours)
            together = together and all(one.closed for one in contours) and place.clip is None
            if areas and (not shown or together):
                return [PathShape(contours_mm=tuple(areas), closed=True, fill=fill, **lines)]
            if areas:
                found.append(PathShape(contours_mm=tuple(areas), closed=True, fill=fill))
        if not shown:
            return found
        stroke: Stroke | None = lines["stroke"]
        if place.clip is not None and contours and stroke is not None:
            areas = outlines.stroked(contours, stroke.width_mm, place.style)
            if not outlines.is_within(areas, place.clip):
                level = Uniform(
                    level=1.0 if stroke.amplitude else 0.0, amplitude=stroke.amplitude or 1.0
                )
                inner = Fill(
                    texture=level, fade_mm=stroke.width_mm / 2 if stroke.width_mm < 2 else 1.0
                )
                if areas := outlines.cut(areas, place.clip):
                    found.append(PathShape(contours_mm=tuple(areas), closed=True, fill=inner))
                return found
        if name == "line" and contours:
            start, end = contours[0].points_mm
            return [StraightLine(start_mm=start, end_mm=end, **lines)]
        for closed in (True, False):
            points = tuple(one.points_mm for one in contours if one.closed == closed)
            if points:
                found.append(PathShape(contours_mm=points, closed=closed, **lines))
        return found

    def _of_use(self, element: Element, place: _Place) -> list[DrawnNode]:
        """Patterns of the element that a use shows, at its place."""
        link = link_of(element)
        if not link.startswith("#"):
            self.note(element, f"it uses {short(link)!r}; nothing is fetched, so it is ignored")
            return []
        target = self._ids.get(link[1:])
        if target is None:
            self.note(element, f"it uses {short(link)!r}, which is not there; ignored")
            return []
        if target in self._used or any(target is one for one in element.iterancestors()):
            self.note(element, "it uses an element that it stands in; ignored")
            return []
        units = self._units(place)
        x = length_of(element.get("x"), units.view[0], units) or 0.0
        y = length_of(element.get("y"), units.view[1], units) or 0.0
        there = changed(
            place,
            matrix=place.matrix @ AffineMap(e=x, f=y),
            named=False,
            context=(self._paint(place, "fill"), self._paint(place, "stroke")),
        )
        self._used.append(target)
        if name_of(target) in ("symbol", "svg"):
            self._count(target)
            sizes = element.get("width"), element.get("height")
            found = self._shown(target, name_of(target), there, sizes)
        else:
            found = self._one(target, there)
        self._used.pop()
        line = element.sourceline or 0
        return [DrawnNode(node.pattern, line, node.parts) for node in found]

    def _of_svg(
        self,
        element: Element,
        place: _Place,
        sizes: tuple[str | None, str | None],
    ) -> list[DrawnNode]:
        """Patterns of a drawing in a drawing, which is fitted into its rectangle and cut to it."""
        units = self._units(place)
        x = length_of(element.get("x"), units.view[0], units) or 0.0
        y = length_of(element.get("y"), units.view[1], units) or 0.0
        size: list[float] = []
        for key, given, whole in zip(("width", "height"), sizes, place.view, strict=True):
            texts = (given, place.style.get(key), "100%")
            lengths = (length_of(text, whole, units) for text in texts)
            size.append(next(one for one in lengths if one is not None))
        width, height = size
        if width <= 0 or height <= 0:
            self.note(element, "it has no size, and is left out")
            return []
        matrix = place.matrix @ AffineMap(e=x, f=y)
        clip = place.clip
        if place.style.get("overflow", "hidden") in ("hidden", "scroll"):
            clip = self._cut_to_box(place.clip, matrix, (0.0, 0.0, width, height))
        view = view_box_of(element.get("viewBox"))
        if view is not None:
            how = element.get("preserveAspectRatio") or ""
            matrix = matrix @ fit(view, (width, height), how)
            width, height = view[2:]
        inner = changed(place, matrix=matrix, view=(width, height), clip=clip)
        return [] if clip == () else self._inside(element, inner)

    def _cut_to_box(
        self, clip: tuple[Ring, ...] | None, matrix: AffineMap, box: Box
    ) -> tuple[Ring, ...]:
        """Area of a box, cut to the area around it."""
        left, top, width, height = box
        corners = (
            (left, top),
            (left + width, top),
            (left + width, top + height),
            (left, top + height),
        )
        places = [matrix.put(complex(*corner)) for corner in corners]
        ring = tuple((round(one.real, 4), round(one.imag, 4)) for one in places)
        return (ring,) if clip is None else tuple(outlines.cut([ring], clip))

    def _clipped(self, element: Element, name: str, place: _Place) -> _Place:
        """Place of an element with its own clip-path."""
        written = place.style.get("clip-path", "none").strip()
        if written in ("none", ""):
            return place
        target = self._ids.get(target_of(written))
        if target is None or name_of(target) != "clipPath":
            self.note(element, f"its clip-path {short(written, 40)} is ignored")
            return place
        matrix = place.matrix
        if target.get("clipPathUnits") == "objectBoundingBox":
            box = self._box(element, name, place)
            if box is None:
                self.note(element, "its clip-path is ignored")
                return place
            matrix = matrix @ AffineMap(a=box[2], d=box[3], e=box[0], f=box[1])
        rings: list[Ring] = []
        inner = changed(place, matrix=matrix, style={}, clip=None)
        with self._noting(target):
            style = self._sheets.of(target, self._style_around(target), self._units(place))
            inner = changed(inner, style=style)
            inner = changed(inner, matrix=matrix @ self._matrix(target, "clipPath", inner))
            for child in target:
                rings += self._clip_rings(child, inner)
        rings, _ = outlines.filled(rings, "nonzero")
        if self._holds(target) and style.get("clip-path", "none") not in ("none", ""):
            self.note(target, "its own clip-path is ignored")
        clip = rings if place.clip is None else outlines.cut(rings, place.clip)
        return changed(place, clip=tuple(clip))

    def _clip_rings(self, element: Element, around: _Place) -> list[Ring]:
        """Area of a shape in a clip path."""
        name = name_of(element)
        if name == "use":
            target = self._ids.get(link_of(element)[1:])
            if target is None or name_of(target) not in SHAPES:
                return []
            units = self._units(around)
            x = length_of(element.get("x"), units.view[0], units) or 0.0
            y = length_of(element.get("y"), units.view[1], units) or 0.0
            style = self._sheets.of(element, around.style, units)
            inner = changed(around, style=style)
            moved = self._matrix(element, name, inner) @ AffineMap(e=x, f=y)
            return self._clip_rings(target, changed(inner, matrix=around.matrix @ moved))
        if name == "text":
            self.note(element, "a text does not cut; it is ignored")
        if name not in SHAPES or not self._holds(element):
            return []
        style = self._sheets.of(element, around.style, self._units(around))
        hidden = style.get("display") == "none" or style.get("visibility") in ("hidden", "collapse")
        if hidden:
            return []
        place = changed(around, style=style)
        matrix = around.matrix @ self._matrix(element, name, place)
        segments, _ = outlines.segments_of(outlines.path_of(element, style, self._units(place)))
        contours = outlines.contours_of(segments, matrix, MOST_POINTS)
        rings = [one.points_mm for one in contours if len(one.points_mm) >= 3]
        return outlines.filled(rings, style.get("clip-rule", "nonzero"))[0]

    def _style_around(self, element: Element) -> Style:
        """Style of what stands around an element that is used from elsewhere."""
        style: Style = {}
        units = Units(self.size_px, self.size_px)
        for one in reversed(list(element.iterancestors())):
            style = self._sheets.of(one, style, units)
        return style

    def _markers(self, segments: Any, place: _Place, units: Units) -> list[DrawnNode]:
        """Patterns of the markers at the vertices of a path."""
        style = place.style
        written = [style.get(f"marker-{at}", "none") for at in ("start", "mid", "end")]
        named = [target_of(text) for text in written]
        if not any(named):
            return []
        corners = outlines.corners_of(segments)
        found: list[DrawnNode] = []
        width = length_of(style.get("stroke-width", "1"), units.diagonal, units) or 0.0
        last = len(corners) - 1
        for number, corner in enumerate(corners):
            ends = [(0, number == 0), (1, 0 < number < last), (2, number == last)]
            for at, here in ends:
                marker = self._ids.get(named[at]) if here else None
                if marker is not None and name_of(marker) == "marker":
                    found += self._marker(marker, corner, place, width, first=at == 0)
        return found

    def _marker(
        self,
        marker: Element,
        corner: outlines.Corner,
        place: _Place,
        width: float,
        *,
        first: bool,
    ) -> list[DrawnNode]:
        """Patterns of a marker at a vertex."""
        if marker in self._used or place.depth >= MOST_DEPTH:
            return []
        self._count(marker)
        units = self._units(place)
        sizes = [marker.get(name) or "3" for name in ("markerWidth", "markerHeight")]
        size = [
            length_of(text, whole, units) or 0.0
            for text, whole in zip(sizes, units.view, strict=True)
        ]
        unit = 1.0 if marker.get("markerUnits") == "userSpaceOnUse" else width
        if size[0] <= 0 or size[1] <= 0 or unit <= 0:
            return []
        orient = (marker.get("orient") or "0").strip()
        way = corner.before + corner.after
        degrees = math.degrees(cmath.phase(way)) if way else 0.0
        if orient == "auto-start-reverse":
            degrees += 180.0 * first
        elif orient != "auto":
            degrees = angle_of(orient) or 0.0
        view = view_box_of(marker.get("viewBox"))
        fitted = AffineMap()
        if view is not None:
            fitted = fit(view, (size[0], size[1]), marker.get("preserveAspectRatio") or "")
        box = view or (0.0, 0.0, size[0], size[1])
        reference = [
            length_of(marker.get(name), whole, units) or 0.0
            for name, whole in zip(("refX", "refY"), units.view, strict=True)
        ]
        middle = fitted.put(complex(*reference))
        matrix = place.matrix @ AffineMap(e=corner.place.real, f=corner.place.imag)
        matrix = matrix @ turned_by(degrees) @ AffineMap(a=unit, d=unit)
        matrix = matrix @ AffineMap(e=-middle.real, f=-middle.imag)
        around = self._style_around(marker)
        style = self._sheets.of(marker, around, Units(self.size_px, self.size_px))
        clip = place.clip
        if style.get("overflow", "hidden") in ("hidden", "scroll"):
            clip = self._cut_to_box(clip, matrix, (0.0, 0.0, size[0], size[1]))
        inner = changed(
            place,
            matrix=matrix @ fitted,
            style=style,
            view=box[2:],
            clip=clip,
            context=(self._paint(place, "fill"), self._paint(place, "stroke")),
            named=False,
            depth=place.depth + 1,
        )
        if clip == () or inner.matrix.scale == 0 or self._share(style, "opacity") <= LEAST_SHARE:
            return []
        self._used.append(marker)
        found = self._inside(marker, inner)
        self._used.pop()
        return found

    def _matrix(self, element: Element, name: str, place: _Place) -> AffineMap:
        """Map of an element's transform about its origin."""
        written = place.style.get("transform")
        if written is None or written.strip() in ("", "none"):
            return AffineMap()
        units = self._units(place)
        box: Box = (0.0, 0.0, *place.view)
        if place.style.get("transform-box", "").strip() in _OWN_BOXES:
            own = self._box(element, name, place)
            if own is None:
                self.note(element, "its transform-box is ignored; only shapes have one")
            box = own or box
        matrix = transform_of(written, units, box)
        if matrix is None:
            self.note(element, "its transform is not understood; it is drawn without")
            return AffineMap()
        origin = origin_of(place.style.get("transform-origin", "0 0"), units, box)
        if origin is None:
            self.note(element, "its transform-origin is not understood; it is ignored")
        x, y = (0.0, 0.0) if origin is None else (origin.real, origin.imag)
        return AffineMap(e=x, f=y) @ matrix @ AffineMap(e=-x, f=-y)

    def _box(self, element: Element, name: str, place: _Place) -> Box | None:
        """Box around a shape, in its own units; None for others than shapes."""
        if name not in SHAPES:
            return None
        text = outlines.path_of(element, place.style, self._units(place))
        points: list[Point] = []
        with self._noting(element):
            for contour in outlines.contours_of(outlines.segments_of(text)[0], AffineMap()):
                points += contour.points_mm
        if not points:
            return None
        (left, top), (right, bottom) = (
            tuple(map(end, zip(*points, strict=True))) for end in (min, max)
        )
        return left, top, right - left, bottom - top

    def _look(self, element: Element) -> ClassLook | None:
        """Look that the scene gives to an element's class, label or id."""
        if not self._class_looks:
            return None
        classes = (element.get("class") or "").split()
        names = (*classes, element.get(f"{INKSCAPE}label"), element.get("id"))
        known = [name for name in names if name and name in self._class_looks]
        self._met.update(known)
        return self._class_looks[known[0]] if known else None

    def _count(self, element: Element) -> None:
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise InputError(
                f"{self._name} line {element.sourceline}: with the elements that it uses it has "
                f"more than {MOST_ELEMENTS} elements; use fewer"
            )

    @contextmanager
    def _noting(self, element: Element) -> Iterator[None]:
        """Leave out an element that cannot be drawn, and say so."""
        try:
            yield
        except ValueError as error:
            self.note(element, f"{error}; it is left out")
        except OverflowError:
            self.note(element, f"{TOO_FAR}; it is left out")


def _is_inside(contours: list[Contour], stroke: Stroke | None, clip: tuple[Ring, ...]) -> bool:
    """Tell whether a shape with its stroke is wholly within an area, as the box around it shows."""
    points = [point for contour in contours for point in contour.points_mm]
    if not points:
        return True
    reach = 0.0 if stroke is None else stroke.width_mm / 2
    left, right = min(x for x, _ in points) - reach, max(x for x, _ in points) + reach
    top, bottom = min(y for _, y in points) - reach, max(y for _, y in points) + reach
    if right - left < LEAST_MM or bottom - top < LEAST_MM:
        return False
    box = ((left, top), (right, top), (right, bottom), (left, bottom))
    return outlines.is_within([box], clip)


def _crosses(points_mm: Ring) -> bool:
    """Tell whether a contour crosses itself, or is so long that it may."""
    if len(points_mm) > _MOST_CROSSED:
        return True
    try:
        return meeting_edges(points_mm) is not None
    except ValueError:  # it would take too long to find out
        return True
