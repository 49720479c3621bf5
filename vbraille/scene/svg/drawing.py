"""Drawings as scenes: the walk through an SVG file, which makes patterns of its shapes."""

from __future__ import annotations

import cmath
import math
import os
import re
from dataclasses import dataclass
from dataclasses import replace as changed
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.locations import FoundScene, Remarks
from vbraille.scene.measures import LEAST_MM
from vbraille.scene.patterns import (
    Circle,
    Fill,
    Group,
    Label,
    PathShape,
    Polygon,
    StraightLine,
    Uniform,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.svg import outlines
from vbraille.scene.svg.document import (
    BLACK,
    INITIAL,
    INKSCAPE,
    LONGEST_TEXT,
    MOST_ELEMENTS,
    PX_MM,
    AffineMap,
    Color,
    Style,
    StyleSheets,
    about,
    affine,
    angle_of,
    color_of,
    description_of,
    fit,
    id_of,
    link_of,
    name_of,
    origin_of,
    plain,
    read_tree,
    share_of,
    short,
    target_of,
    title_of,
    transform_of,
    turned,
    view_box_of,
)
from vbraille.scene.svg.looks import LEAST_SHARE, ClassLook, dashes_of, fill_of, stroke_of
from vbraille.scene.svg.outlines import MOST_POINTS, SHAPES, TOO_FAR
from vbraille.scene.traversal import lines_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.svg.document import Box, Element, Point
    from vbraille.scene.svg.outlines import Contour, Ring

# Elements that only stand in a drawing to be used, or say something about it.
_SILENT = frozenset(
    ("", "clipPath", "cursor", "defs", "desc", "filter", "font", "linearGradient", "marker",
     "mask", "metadata", "pattern", "radialGradient", "script", "style", "title", "view")
)  # fmt: skip
_SHOWN = SHAPES | {"g", "a", "svg", "switch", "symbol", "use", "text"}
_UNFELT = ("filter", "mask", "translate", "rotate", "scale")
_OWN_BOXES = ("fill-box", "content-box", "stroke-box", "border-box")
# The size of braille is the device's, not the drawing's, and is not known here. These are a
# Latero's, which are among the largest: labels placed by them meet nothing on other devices.
_CELL_MM, _HEIGHT_MM, _LINE_MM = 11.1, 9.0, 12.5
_ANCHORS = {"start": 0.0, "middle": 0.5, "end": 1.0}
# How far the foot of letters is above the place of a text, as a share of the height of a cell.
_BASELINES = {"middle": 0.5, "central": 0.5, "hanging": 1.0, "text-before-edge": 1.0,
              "text-top": 1.0}  # fmt: skip
_PARTS = ("tspan", "a", "textPath", "tref")
_MOST_DEPTH = 100
_MOST_NESTED = 20  # groups that are kept one in another; deeper ones are parts of those around
_MOST_LINKS = 10  # gradients that take their colours from others
_MOST_CORNERS = 2000  # of a polygon
_MOST_SCALE = 1e9
_LANGUAGE = re.compile(r"[A-Za-z]{2,3}(?:-[A-Za-z0-9]{1,8})*")
_XML_LANG = "{http://www.w3.org/XML/1998/namespace}lang"


@dataclass(frozen=True, slots=True)
class _Place:
    """Properties that elements have of those that they stand in.

    Parameters
    ----------
    matrix
        Map from their coordinates to mm on the canvas.
    style
        Style of the element around them.
    look
        Look that the scene gives to the class around them; None for none.
    strength
        Product of the opacities around them.
    clip
        Area that they are cut to; None for no such area.
    cutting
        Area to which the shapes of a clip path are added; None elsewhere.
    context
        Place of the element whose paints context-fill and context-stroke are; None for none.
    depth, groups
        How deep they stand, and in how many groups that are kept.
    named
        Whether their ids are kept, which belong to one place.
    """

    matrix: AffineMap
    style: Style
    look: ClassLook | None = None
    strength: float = 1.0
    clip: list[Ring] | None = None
    cutting: list[Ring] | None = None
    context: _Place | None = None
    depth: int = 0
    groups: int = 0
    named: bool = True


@dataclass(slots=True)
class _Line:
    """A line of a text: the place of its start, middle or end, its style and its characters."""

    element: Element
    style: Style
    place: complex
    text: str = ""


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
    try:
        drawing = SvgDrawing(str(path), root, class_looks or {})
        elements = drawing.elements()
    except RecursionError:
        raise InputError(f"{path} has brackets nested too deep; simplify its styles") from None
    width, height = (round(one * PX_MM, 4) for one in drawing.size_px)
    try:
        canvas = Canvas(width_mm=width, height_mm=height)
    except ValueError as error:
        raise InputError(f"{path} cannot be a canvas: its {error}") from None
    scene = Scene(
        canvas=canvas,
        title=title_of(root),
        description=description_of(root),
        elements=tuple(elements),
    )
    language = root.get(_XML_LANG) or root.get("lang") or ""
    if _LANGUAGE.fullmatch(language):
        scene = replace(scene, language=language)
    return FoundScene(scene, lines_of(scene.elements, drawing.made), drawing.warnings())


def size_px(root: Element, style: Style, name: str) -> Point:
    """Width and height of a drawing, in pixels of 1/96 inch.

    Where they are not given as lengths, they are those of the viewBox.

    Raises
    ------
    InputError
        If there is none of these.
    """
    sizes = [
        None if "%" in text else style.length(text, 0.0)
        for text in (style["width"], style["height"])
    ]
    if (view := view_box_of(root.get("viewBox"))) is not None:
        known = [size / own for size, own in zip(sizes, view[2:], strict=True) if size is not None]
        factor = known[0] if known else 1.0
        sizes = [
            factor * own if size is None else size
            for size, own in zip(sizes, view[2:], strict=True)
        ]
    width, height = (size or 0.0 for size in sizes)
    if min(width, height) <= 0:
        raise InputError(f"{name} has no size; give its svg element a width and a height")
    return width, height


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
        self._remarks = Remarks()
        self.made: dict[int, tuple[AnyPattern, int]] = {}
        self._ids: dict[str, Element] = {}
        for element in root.iter():
            if own_id := element.get("id"):
                self._ids.setdefault(own_id, element)
            handled = any(str(key).startswith("on") for key in element.keys())  # noqa: SIM118 - no dict
            if handled or name_of(element) == "script":
                self.note(element, "its script is never run")
        self._named: set[str] = set()
        self._used: list[Element] = []
        self._met: set[str] = set()  # names of classes that the scene gives a look
        self._elements = self._points = 0
        self._language = _user_language()
        try:
            self._sheets = StyleSheets(root, self.note)
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
        self._style = self._sheets.of(root, Style(INITIAL))
        self.size_px = size_px(root, self._style, name)
        self._initial = Style(INITIAL, self.size_px, self.size_px)
        self._style = changed(self._initial, values=self._style.values)

    def elements(self) -> list[AnyPattern]:
        """Patterns of the whole drawing."""
        if self._style["display"] == "none":
            return []
        # What is beyond the page is kept.
        style = changed(self._style, values={**self._style.values, "overflow": "visible"})
        strength = share_of(style["opacity"])
        place = _Place(AffineMap(PX_MM), style, strength=strength)
        return self._in_view(self._root, place, self.size_px)

    def note(self, element: Element, remark: str) -> None:
        """Keep a remark on an element."""
        name, own_id = name_of(element) or "element", element.get("id")
        called = f"{name} {short(own_id)}" if own_id else name
        self._remarks.note(remark, element.sourceline or 0, called)

    def warnings(self) -> tuple[str, ...]:
        """All remarks, one sentence for the same one on several elements."""
        unmet = [name for name in self._class_looks if name not in self._met]
        return self._remarks.said() + tuple(
            f"nothing that is shown has the class, label or id {name}, which the scene speaks of"
            for name in unmet
        )

    def _lined(self, element: Element, patterns: Iterable[AnyPattern]) -> list[AnyPattern]:
        """Patterns of an element, after its line in the file was kept for them."""
        found = [*patterns]
        self.made |= {id(one): (one, element.sourceline or 0) for one in found}
        return found

    def _inside(self, element: Element, place: _Place) -> list[AnyPattern]:
        """Patterns of the elements in another."""
        if place.depth >= _MOST_DEPTH:
            raise InputError(
                f"{self._name} line {element.sourceline}: elements are more than {_MOST_DEPTH} "
                "deep; ungroup some of what is around them"
            )
        children = list(element)
        if name_of(element) == "switch":
            children = [one for one in children if name_of(one) in _SHOWN and self._holds(one)][:1]
        return [one for child in children for one in self._drawn(child, place)]

    def _in_view(self, element: Element, place: _Place, size: Point) -> list[AnyPattern]:
        """Patterns of the elements in a viewport at the origin, cut to it and fitted into it."""
        if place.style["overflow"] in ("hidden", "scroll"):
            ends = 0j, complex(size[0], 0.0), complex(*size), complex(0.0, size[1])
            box = outlines.ring_of(map(place.matrix, ends))
            clip = [box] if place.clip is None else outlines.cut([box], place.clip)
            place = changed(place, clip=clip)
        view = view_box_of(element.get("viewBox"))
        if view is not None:
            inner = fit(view, size, element.get("preserveAspectRatio") or "")
            place = changed(place, matrix=place.matrix @ inner)
            size = view[2:]
        place = changed(place, style=changed(place.style, view=size))
        return [] if place.clip == [] else self._inside(element, place)

    def _holds(self, element: Element) -> bool:
        """Tell whether the conditions of an element hold, such as its language."""
        if (element.get("requiredExtensions") or "").strip():
            return False
        languages = element.get("systemLanguage")
        wanted = [f"{one.strip().lower()}-" for one in (languages or "").split(",") if one.strip()]
        mine = f"{self._language}-"
        return languages is None or any(
            one.startswith(mine) or mine.startswith(one) for one in wanted
        )

    def _drawn(
        self, element: Element, around: _Place, sizes: tuple[str | None, ...] = ()
    ) -> list[AnyPattern]:
        """Patterns of an element; ``sizes`` are the width and height that its use gives it."""
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise InputError(
                f"{self._name} line {element.sourceline}: with the elements that it uses it has "
                f"more than {MOST_ELEMENTS} elements; use fewer"
            )
        name = name_of(element)
        if name in _SILENT or (name == "symbol" and not sizes) or not self._holds(element):
            return []
        if name not in _SHOWN:
            picture = '; put the picture into a scene file, as kind = "image"'
            self.note(element, f"it is ignored{picture * (name == 'image')}")
            return []
        style = self._sheets.of(element, around.style)
        look = self._look(element) or around.look
        strength = around.strength * share_of(style["opacity"])
        faint = strength <= LEAST_SHARE and around.cutting is None
        if style["display"] == "none" or faint or (look and look.hidden):
            return []
        place = changed(
            around,
            style=style,
            look=look,
            strength=strength,
            depth=around.depth + 1,
        )
        for word in _UNFELT:
            if style[word] != "none":
                self.note(element, f"its {word} is ignored")
        place = changed(place, matrix=place.matrix @ self._matrix(element, place))
        if place.matrix.scale == 0.0:
            return []  # it is drawn as nothing
        if not place.matrix.scale < _MOST_SCALE:
            self.note(element, f"{TOO_FAR}; it is left out")
            return []
        place = self._clipped(element, place)
        if place.clip == []:
            return []
        title, description = title_of(element), description_of(element)
        own_id = id_of(element) if place.named else ""
        if own_id and own_id in self._named:
            self.note(element, "another element has the same id, so it is left without")
            own_id = ""
        kept = bool(title or description or own_id) and place.groups < _MOST_NESTED
        found = self._made(element, changed(place, groups=place.groups + kept), sizes)
        if not found or not kept:
            return found
        self._named.add(own_id)
        pattern, *others = found
        if others or pattern.title or pattern.id:
            pattern = Group(parts=tuple(found))
        words = replace(pattern, id=own_id, title=title, description=description)
        return self._lined(element, [words])

    def _made(
        self, element: Element, place: _Place, sizes: tuple[str | None, ...]
    ) -> list[AnyPattern]:
        """Patterns of an element that is shown, without its title, description and id."""
        name = name_of(element)
        if name == "use":
            return self._of_use(element, place)
        if name in ("svg", "symbol"):
            return self._of_svg(element, place, sizes)
        if name not in SHAPES and name != "text":
            return self._inside(element, place)
        if place.style["visibility"] in ("hidden", "collapse"):
            return []
        try:
            if name == "text":
                return self._of_text(element, place)
            return self._of_shape(element, place)
        except ValueError as error:
            self.note(element, f"{error}; it is left out")
            return []

    def _of_text(self, element: Element, place: _Place) -> list[AnyPattern]:
        """Labels of a text, one for each of its lines.

        A label stands so that its cells end at the line's foot. Its length is not known before it
        is translated; where the anchor is its middle or end, a cell for each character is taken.
        Lines of a text stand at least as far apart as lines of braille.
        """
        if place.cutting is not None:
            self.note(element, "a text does not cut; it is ignored")
            return []
        lines: list[_Line] = []
        self._gather(element, place.style, lines)
        along = cmath.rect(1.0, cmath.phase(place.matrix.p + place.matrix.q))
        down = along * 1j
        before: complex | None = None
        found: list[AnyPattern] = []
        for line in lines:
            text = plain(line.text, LONGEST_TEXT)
            if not text:
                continue
            share = _ANCHORS[line.style["text-anchor"]]
            base = _BASELINES.get(line.style["dominant-baseline"], 0.0)
            corner = place.matrix(line.place)
            corner -= down * _HEIGHT_MM * (1 - base) + along * share * len(text) * _CELL_MM
            if before is not None:
                below = ((corner - before) / down).real
                corner += down * (_LINE_MM - below if 0 < below < _LINE_MM else 0.0)
            before = corner
            label = Label(
                text=text,
                place_mm=(round(corner.real, 4) + 0.0, round(corner.imag, 4) + 0.0),
                angle_deg=round(math.degrees(cmath.phase(along)), 4) + 0.0,
                amplitude=round(place.strength, 4),
            )
            found += self._lined(line.element, [label])
        return found

    def _gather(self, element: Element, style: Style, lines: list[_Line]) -> None:
        """Add the lines of a text or a part of it, which begins one where it has a place."""
        before = lines[-1].place if lines else 0j
        start = self._start_of(element, style, before)
        if start is not None or not lines:
            lines.append(_Line(element, style, start or 0j))
        lines[-1].text += element.text or ""
        for child in element:
            if name_of(child) in _PARTS:
                inner = self._sheets.of(child, style)
                if inner["display"] != "none" and inner["visibility"] != "hidden":
                    self._gather(child, inner, lines)
            lines[-1].text += child.tail or ""

    def _start_of(self, element: Element, style: Style, before: complex) -> complex | None:
        """Place of a part of a text; None if it goes on where the part before ends."""
        if name_of(element) == "textPath":
            self.note(
                element, "its path is not followed: the text is straight from where it begins"
            )
            path = self._ids.get(link_of(element)[1:])
            segments, _ = outlines.segments_of("" if path is None else path.get("d") or "")
            return segments[0].end if len(segments) else None
        if element.get("rotate"):
            self.note(element, "its letters are turned, which is not felt")
        found: dict[str, str] = {}
        for name in ("x", "y", "dx", "dy"):
            words = (element.get(name) or "").replace(",", " ").split()
            if words:
                found[name] = words[0]
            if words[1:]:
                self.note(element, f"its letters have places in {name}; the first one counts")
        move = style.place(found.get("dx"), found.get("dy"))
        if "x" not in found and "y" not in found and not move.imag:
            return None
        place = style.place(found.get("x"), found.get("y"))
        x = place.real if "x" in found else before.real
        y = place.imag if "y" in found else before.imag
        return complex(x, y) + move

    def _of_use(self, element: Element, place: _Place) -> list[AnyPattern]:
        """Patterns of the element that a use shows, at its place."""
        link = link_of(element)
        target = self._ids.get(link[1:]) if link.startswith("#") else None
        if target is None:
            why = "which is not there" if link.startswith("#") else "but nothing is fetched"
            self.note(element, f"it uses {short(link)!r}, {why}; ignored")
            return []
        if target in self._used or target in element.iterancestors():
            self.note(element, "it uses an element that it stands in; ignored")
            return []
        start = AffineMap(r=place.style.place(element.get("x"), element.get("y")))
        there = changed(place, matrix=place.matrix @ start, named=False, context=place)
        self._used.append(target)
        found = self._drawn(target, there, (element.get("width"), element.get("height")))
        self._used.pop()
        return self._lined(element, found)

    def _of_svg(
        self, element: Element, place: _Place, sizes: tuple[str | None, ...]
    ) -> list[AnyPattern]:
        """Patterns of a drawing in a drawing, which is fitted into its rectangle and cut to it."""
        style = place.style
        size: list[float] = []
        for key, given, whole in zip(
            ("width", "height"), sizes or (None, None), style.view, strict=True
        ):
            texts = (given, style[key], "100%")
            lengths = (style.length(text, whole) for text in texts)
            size.append(next(one for one in lengths if one is not None))
        if min(size) <= 0:
            self.note(element, "it has no size, and is left out")
            return []
        start = AffineMap(r=style.place(element.get("x"), element.get("y")))
        return self._in_view(
            element, changed(place, matrix=place.matrix @ start), (size[0], size[1])
        )

    def _of_shape(self, element: Element, place: _Place) -> list[AnyPattern]:
        """Patterns of a shape and of its markers, the lowest first."""
        path = outlines.path_of(element, place.style)
        segments, whole = outlines.segments_of(path)
        if not whole:
            self.note(
                element, "its path is not understood from some place on; the rest is left out"
            )
        room = MOST_POINTS - self._points
        contours = outlines.contours_of(segments, place.matrix, room)
        self._count_points([one.ring for one in contours])
        if place.cutting is not None:
            place.cutting.extend(self._areas(element, contours, place, "clip-rule"))
            return []
        fill, lines = self._look_of_shape(element, place)
        width = lines["stroke"].width_mm if lines.get("stroke") else 0.0
        if place.clip and contours and outlines.is_within(contours, width / 2, place.clip):
            place = changed(place, clip=None)
        patterns: list[AnyPattern] = []
        if fill is not None or lines:
            patterns = self._patterns(element, contours, place, fill, lines)
            if not patterns and place.clip is None and whole:
                self.note(element, "it has no size, and is left out")
        if place.strength < 1.0:
            amplitude = round(place.strength, 4)
            patterns = [replace(one, amplitude=amplitude) for one in patterns]
        return self._lined(element, patterns) + self._markers(segments, place)

    def _count_points(self, rings: list[Ring]) -> None:
        self._points += sum(map(len, rings))
        if self._points > MOST_POINTS:
            raise InputError(
                f"{self._name} has more than {MOST_POINTS} places on its lines; simplify it"
            )

    def _look_of_shape(self, element: Element, place: _Place) -> tuple[Fill | None, dict[str, Any]]:
        """Fill of a shape, and its stroke or its dots."""
        look, style = place.look or ClassLook(), place.style

        def note(remark: str) -> None:
            self.note(element, remark)

        is_line = name_of(element) == "line"
        fill = None if is_line else look.fill
        if fill is None and not is_line:
            color = self._color(element, place, "fill")
            fill = color and fill_of(color, note)
        if look.dots is not None:
            return fill, {"dots": look.dots}
        stroke = look.stroke
        if stroke is None:
            scale = place.matrix.scale
            if style["vector-effect"] == "non-scaling-stroke":
                view = view_box_of(self._root.get("viewBox")) or (0.0, 0.0, *self.size_px)
                scale = PX_MM * fit(view, self.size_px, "").scale
            width = style.length(style["stroke-width"], style.diagonal) or 0.0
            color = self._color(element, place, "stroke")
            stroke = color and stroke_of(color, width * scale, dashes_of(style, scale), note)
        return fill, {"stroke": stroke} if stroke else {}

    def _color(self, element: Element, place: _Place, what: str) -> Color | None:
        """Colour of a fill or a stroke, with all its transparency; None for no paint."""
        color = self._paint(element, place, what, place.style[what])
        share = share_of(place.style[f"{what}-opacity"])
        return color and color._replace(alpha=color.alpha * share)

    def _paint(self, element: Element, place: _Place, what: str, text: str) -> Color | None:
        """Colour that a paint of a fill or a stroke is, or that stands for it."""
        word = text.strip().lower()
        if word == "none":
            return None
        if word == "currentcolor":
            return color_of(place.style["color"]) or BLACK
        if word.startswith("context-"):
            there, which = place.context, word.removeprefix("context-")
            return there and self._paint(element, there, what, there.style[which])
        if not word.startswith("url("):
            return color_of(text.strip())
        found = self._ids.get(target_of(text))
        if found is not None and name_of(found).endswith(("Gradient", "pattern")):
            color = self._gradient(found)
            if color == BLACK:
                self.note(element, f"its {what} is a gradient or a pattern, felt as plain black")
            if color is not None:
                return color
        if fallback := text.partition(")")[2].strip():
            return self._paint(element, place, what, fallback)
        self.note(element, f"its {what} is a gradient that is not there; it has none")
        return None

    def _gradient(self, element: Element) -> Color | None:
        """Colour that stands for a gradient or a pattern: its one colour, or black.

        None for a gradient without any colour.
        """
        if name_of(element) == "pattern":
            return BLACK
        stops: list[Element] = []
        for _ in range(_MOST_LINKS):
            stops = stops or [child for child in element if name_of(child) == "stop"]
            element = self._ids.get(link_of(element)[1:], element)
        colors: set[Color] = set()
        for stop in stops:
            style = self._sheets.of(stop, self._initial)
            color = color_of(style["stop-color"]) or BLACK
            colors.add(color._replace(alpha=color.alpha * share_of(style["stop-opacity"])))
        plain = len(colors) == 1 or all(color.alpha <= LEAST_SHARE for color in colors)
        return next(iter(colors), None) if plain else BLACK

    def _areas(
        self, element: Element, contours: list[Contour], place: _Place, rule: str
    ) -> list[Ring]:
        """Areas within contours by a fill rule, cut to the clip."""
        rings = [one.ring for one in contours if len(one.ring) >= 3]
        areas, right = outlines.filled(rings, place.style[rule])
        if not right:
            self.note(element, "it has too many places to find where it overlaps itself; "
                      "it is filled by the even-odd rule")  # fmt: skip
        if place.clip is not None:
            areas = outlines.cut(areas, place.clip)
        if areas is not rings:
            self._count_points(areas)
        return areas

    def _patterns(
        self,
        element: Element,
        contours: list[Contour],
        place: _Place,
        fill: Fill | None,
        lines: dict[str, Any],
    ) -> list[AnyPattern]:
        """Patterns of outlines, the lowest first."""
        whole, name = place.clip is None, name_of(element)
        if whole and name in ("circle", "ellipse"):
            middle, (rx, ry) = outlines.round_of(element, place.style)
            radius = rx * place.matrix.scale
            if rx == ry and place.matrix.keeps_circles and LEAST_MM <= radius <= 10_000.0:
                (center,) = outlines.in_mm(outlines.ring_of([place.matrix(middle)]))
                return [Circle(center_mm=center, radius_mm=round(radius, 4), fill=fill, **lines)]
        rings = [outlines.in_mm(one.ring) for one in contours]
        if whole and name in ("rect", "polygon") and len(contours) == 1 and contours[0].closed:
            corners = len(rings[0])
            if corners == 4 or (name == "polygon" and corners <= _MOST_CORNERS):
                try:
                    return [Polygon(vertices_mm=rings[0], fill=fill, **lines)]
                except ValueError:
                    pass  # its edges cross
        if whole and name == "line" and contours:
            start, end = rings[0]
            return [StraightLine(start_mm=start, end_mm=end, **lines)]
        found: list[AnyPattern] = []
        if fill is not None:
            areas = tuple(map(outlines.in_mm, self._areas(element, contours, place, "fill-rule")))
            if areas and areas == tuple(rings) and whole and all(one.closed for one in contours):
                return [PathShape(contours_mm=areas, closed=True, fill=fill, **lines)]
            if areas:
                found.append(PathShape(contours_mm=areas, closed=True, fill=fill))
        stroke = lines.get("stroke")
        if stroke is not None and place.clip is not None:
            cut = outlines.cut(outlines.stroked(contours, stroke.width_mm), place.clip)
            self._count_points(cut)
            # White lines are smooth, and hide what is below.
            level = Uniform(level=float(stroke.amplitude > 0), amplitude=stroke.amplitude or 1.0)
            fill = Fill(texture=level, fade_mm=min(stroke.width_mm / 2, 1.0))
            areas = tuple(map(outlines.in_mm, cut))
            return [*found, PathShape(contours_mm=areas, closed=True, fill=fill)] if cut else found
        for closed in (True, False):
            parts = tuple(
                ring for ring, one in zip(rings, contours, strict=True) if one.closed == closed
            )
            if parts and lines:
                found.append(PathShape(contours_mm=parts, closed=closed, **lines))
        return found

    def _clipped(self, element: Element, place: _Place) -> _Place:
        """Place of an element with its own clip-path."""
        written = place.style["clip-path"]
        if written == "none":
            return place
        target = self._ids.get(target_of(written))
        box: Box | None = (0.0, 0.0, 1.0, 1.0)
        if target is not None and target.get("clipPathUnits") == "objectBoundingBox":
            box = self._box(element, place)
        if target is None or name_of(target) != "clipPath" or target in self._used or box is None:
            self.note(element, f"its clip-path {short(written, 40)} is ignored")
            return place
        around = changed(self._style_around(target), view=place.style.view)
        style = self._sheets.of(target, around)
        matrix = place.matrix @ affine(box[2], 0.0, 0.0, box[3], box[0], box[1])
        rings: list[Ring] = []
        inner = changed(place, matrix=matrix, style=style, cutting=rings, clip=None, named=False)
        inner = changed(inner, matrix=matrix @ self._matrix(target, inner))
        self._used.append(target)
        inner = self._clipped(target, inner)
        for child in target:
            self._drawn(child, inner)
        self._used.pop()
        clip, right = outlines.filled(rings, "nonzero")
        if not right:
            self.note(element, "its clip-path has too many places or crossings; it is ignored")
            return place
        if place.clip is not None:
            clip = outlines.cut(clip, place.clip)
        return changed(place, clip=clip)

    def _style_around(self, element: Element) -> Style:
        """Style of the elements around one that is used from elsewhere."""
        style = self._initial
        for one in reversed(list(element.iterancestors())):
            style = self._sheets.of(one, style)
        return style

    def _markers(self, segments: Any, place: _Place) -> list[AnyPattern]:
        """Patterns of the markers at the vertices of a path."""
        start, middle, end = (
            self._ids.get(target_of(place.style[f"marker-{at}"])) for at in ("start", "mid", "end")
        )
        if start is middle is end is None or place.depth >= _MOST_DEPTH:
            return []
        corners = outlines.corners_of(segments)
        at_ends = [
            (start, corners[:1], 180.0),
            (middle, corners[1:-1], 0.0),
            (end, corners[-1:], 0.0),
        ]
        return [
            one
            for marker, here, turn in at_ends
            if marker is not None and name_of(marker) == "marker"
            for one in self._marker(marker, here, place, turn)
        ]

    def _marker(
        self, marker: Element, corners: list[outlines.Corner], place: _Place, turn: float
    ) -> list[AnyPattern]:
        """Patterns of a marker at vertices; ``turn`` is what auto-start-reverse adds there."""
        around = place.style
        size = around.place(marker.get("markerWidth", "3"), marker.get("markerHeight", "3"))
        unit = around.length(around["stroke-width"], around.diagonal) or 0.0
        if marker.get("markerUnits") == "userSpaceOnUse":
            unit = 1.0
        style = self._sheets.of(marker, self._style_around(marker))
        faint = share_of(style["opacity"]) <= LEAST_SHARE
        if min(size.real, size.imag, unit) <= 0 or faint or marker in self._used:
            return []
        box = (size.real, size.imag)
        view = view_box_of(marker.get("viewBox")) or (0.0, 0.0, *box)
        fitted = fit(view, box, marker.get("preserveAspectRatio") or "")
        middle = fitted(around.place(marker.get("refX"), marker.get("refY")))
        orient = (marker.get("orient") or "0").strip()
        inner = changed(place, style=style, context=place, named=False, depth=place.depth + 1)
        found: list[AnyPattern] = []
        self._used.append(marker)
        for corner in corners:
            self._elements += 1
            degrees = angle_of(orient)
            if orient.startswith("auto"):
                way = corner.before + corner.after
                degrees = math.degrees(cmath.phase(way)) + turn * (orient != "auto")
            matrix = place.matrix @ AffineMap(r=corner.place) @ turned(degrees) @ AffineMap(unit)
            inner = changed(inner, matrix=matrix @ AffineMap(r=-middle))
            found += self._in_view(marker, inner, box)
        self._used.pop()
        return found

    def _matrix(self, element: Element, place: _Place) -> AffineMap:
        """Map of an element's transform about its origin."""
        written = place.style["transform"]
        if written == "none":
            return AffineMap()
        box: Box = (0.0, 0.0, *place.style.view)
        if place.style["transform-box"] in _OWN_BOXES:
            own = self._box(element, place)
            if own is None:
                self.note(element, "its transform-box is ignored; only shapes have one")
            box = own or box
        matrix = transform_of(written, place.style, box)
        if matrix is None:
            self.note(element, "its transform is not understood; it is drawn without")
            return AffineMap()
        origin = origin_of(place.style["transform-origin"], place.style, box)
        if origin is None:
            self.note(element, "its transform-origin is not understood; it is ignored")
        return about(origin or 0j, matrix)

    def _box(self, element: Element, place: _Place) -> Box | None:
        """Box around a shape, in its own units; None for others than shapes."""
        if name_of(element) not in SHAPES:
            return None
        segments, _ = outlines.segments_of(outlines.path_of(element, place.style))
        if not len(segments):
            return None
        left, top, right, bottom = segments.boundingbox()
        return left, top, right - left, bottom - top

    def _look(self, element: Element) -> ClassLook | None:
        """Look that the scene gives to an element's class, label or id."""
        classes = (element.get("class") or "").split()
        names = (*classes, element.get(f"{INKSCAPE}label"), element.get("id"))
        known = [name for name in names if name and name in self._class_looks]
        self._met.update(known)
        return self._class_looks[known[0]] if known else None
