"""The walk through a drawing's elements, which makes patterns of what can be felt."""

from __future__ import annotations

from collections import defaultdict
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.patterns import Group
from vbraille.scene.svg.numbers import AffineMap, fit, length_px, numbers_of, transform_of
from vbraille.scene.svg.outlines import MOST_POINTS, TOO_FAR
from vbraille.scene.svg.paint import drawn, share_of
from vbraille.scene.svg.shapes import SHAPES, circle_of, outline, patterns_of
from vbraille.scene.svg.style import classes_of, styled
from vbraille.scene.svg.tree import (
    INKSCAPE,
    MOST_DEPTH,
    MOST_ELEMENTS,
    called,
    link_of,
    name_of,
)
from vbraille.scene.svg.words import description_of, id_of, labels_of, title_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from vbraille.scene.measures import Point
    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.svg.paint import ClassLook
    from vbraille.scene.svg.style import StyleSheet
    from vbraille.scene.svg.tree import Element

# What only stands in a drawing to be used, or says something about it.
_SILENT = frozenset(
    (
        "",
        "clipPath",
        "cursor",
        "defs",
        "desc",
        "filter",
        "font",
        "linearGradient",
        "marker",
        "mask",
        "metadata",
        "pattern",
        "radialGradient",
        "script",
        "style",
        "symbol",
        "title",
        "view",
    )
)
_IGNORED = {
    "image": 'it is ignored; put the picture into a scene file, as kind = "image"',
    "foreignObject": "it is ignored",
}
_PROPERTIES = ("clip-path", "filter", "mask", "marker", "marker-start", "marker-mid", "marker-end")
_MOST_NESTED = 20  # groups that are kept one in another; deeper ones are parts of those around
_NAMED_LINES = 5


@dataclass(frozen=True, slots=True)
class DrawnNode:
    """A pattern, the line of its element, and the same of its parts."""

    pattern: AnyPattern
    line: int
    parts: tuple[DrawnNode, ...] = ()


@dataclass(frozen=True, slots=True)
class _Place:
    """Properties that elements inherit of those that they stand in.

    Parameters
    ----------
    matrix
        Map from their coordinates to mm on the canvas.
    style
        Style of the element around them.
    view
        Width and height that percentages are of.
    look
        What the scene says of the class around them; None for nothing.
    strength
        Product of the opacities around them.
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
    depth: int = 0
    groups: int = 0
    named: bool = True


@dataclass(slots=True)
class SvgDrawing:
    """A drawing that becomes patterns, and what was said of it so far.

    Parameters
    ----------
    name
        Name of its file, for messages.
    sheet
        Rules of its style sheets.
    ids
        The elements by their ids.
    class_looks
        What the scene says of classes.
    """

    name: str
    sheet: StyleSheet
    ids: Mapping[str, Element]
    class_looks: Mapping[str, ClassLook]
    _notes: dict[str, list[tuple[int, str]]] = field(default_factory=lambda: defaultdict(list))
    _named: set[str] = field(default_factory=set)
    _used: list[str] = field(default_factory=list)
    _met: set[str] = field(default_factory=set)  # the names that the scene says something of
    _elements: int = 0
    _points: int = 0

    def note(self, element: Element, what: str) -> None:
        """Keep something that is to be said of an element."""
        self._notes[what].append((element.sourceline or 0, called(element)))

    def warnings(self) -> tuple[str, ...]:
        """All that is to be said, one sentence for what is the same of several elements."""
        said = []
        for what, places in self._notes.items():
            (line, name), *others = places
            sentence = f"line {line}: {name}: {what}" if line else f"{name}: {what}"
            if others:
                lines = sorted({str(line) for line, _ in others}, key=int)
                more = len(others)
                sentence += f"; and {more} more, in line{'s' * (len(lines) > 1)} "
                sentence += ", ".join(lines[:_NAMED_LINES])
                sentence += " and others" * (len(lines) > _NAMED_LINES)
            said.append(sentence)
        said += [
            f"nothing that is shown has the class, label or id {name}, which the scene speaks of"
            for name in self.class_looks
            if name not in self._met
        ]
        return tuple(said)

    def inside(self, element: Element, place: _Place) -> list[DrawnNode]:
        """Patterns of what stands in an element."""
        if place.depth >= MOST_DEPTH:
            raise InputError(
                f"{self.name} line {element.sourceline}: {called(element)} is more than "
                f"{MOST_DEPTH} deep; ungroup some of what is around it"
            )
        children = list(element)
        if name_of(element) == "switch":
            children = [one for one in children if name_of(one) not in (*_SILENT, "foreignObject")]
            children = children[:1]
        return [node for child in children for node in self._one(child, place)]

    def _one(self, element: Element, around: _Place) -> list[DrawnNode]:
        """Patterns of an element."""
        name = name_of(element)
        self._count(element)
        if name in _SILENT:
            return []
        if name not in SHAPES and name not in ("g", "a", "svg", "switch", "use", "text"):
            self.note(element, _IGNORED.get(name, "it is ignored"))
            return []
        style = styled(element, around.style, self.sheet)
        look = self._look(element) or around.look
        strength = around.strength * share_of(style.get("opacity"))
        if style.get("display") == "none" or strength <= 0 or (look and look.hidden):
            return []
        matrix = self._matrix(element)
        if matrix is None:
            return []
        for word in _PROPERTIES:
            if style.get(word, "none") not in ("none", "") and (
                word in ("clip-path", "filter", "mask") or name in SHAPES
            ):
                self.note(element, f"its {word} is ignored")
        place = _Place(
            around.matrix @ matrix,
            style,
            around.view,
            look,
            strength,
            around.depth + 1,
            around.groups,
            around.named,
        )
        return self._kept(element, name, place)

    def _kept(self, element: Element, name: str, place: _Place) -> list[DrawnNode]:
        """Patterns of an element that is shown, with what it is called."""
        title, description = title_of(element), description_of(element)
        own_id = id_of(element) if place.named else ""
        if own_id in self._named:
            self.note(element, "another element has the same id, so it is left without")
            own_id = ""
        kept = bool(title or description or own_id)
        kept = kept and place.groups < _MOST_NESTED
        inner = _with(place, groups=place.groups + 1) if kept else place
        found = self._made(element, name, inner)
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

    def _made(self, element: Element, name: str, place: _Place) -> list[DrawnNode]:
        """Patterns of an element that is shown, without what it is called."""
        if name == "use":
            return self._of_use(element, place)
        if name == "svg":
            return self._of_svg(element, place)
        if name not in SHAPES and name != "text":
            return self.inside(element, place)
        if place.style.get("visibility") in ("hidden", "collapse"):
            return []
        line = element.sourceline or 0
        with self._noting(element):
            if name == "text":
                return [
                    DrawnNode(
                        replace(label, amplitude=_rounded(place.strength)), one.sourceline or line
                    )
                    for one, label in labels_of(
                        element, place.matrix, place.style, self.sheet, self.ids
                    )
                ]
            return [DrawnNode(one, line) for one in self._shape(element, name, place)]
        return []

    def _shape(self, element: Element, name: str, place: _Place) -> list[AnyPattern]:
        """Patterns of a shape, the lowest first."""
        how = drawn(place.style, place.matrix.scale, place.look)
        if how.fill is None and how.stroke is None and how.dots is None:
            return []
        if name == "line" and how.stroke is None and how.dots is None:
            return []
        for what in how.notes:
            self.note(element, what)
        found: list[AnyPattern] = []
        circle = None
        if name in ("circle", "ellipse"):
            circle = circle_of(element, place.matrix, place.view, how)
        if circle is not None:
            found.append(circle)
        else:
            room = MOST_POINTS + 1 - self._points
            contours = outline(element, place.matrix, place.view, room)
            self._points += sum(len(one.points_mm) for one in contours)
            if self._points > MOST_POINTS:
                raise InputError(
                    f"{self.name} has more than {MOST_POINTS} places on its lines; simplify it"
                )
            notes: list[str] = []
            nonzero = place.style.get("fill-rule") != "evenodd"
            found += patterns_of(name, contours, how, nonzero=nonzero, notes=notes)
            if not found:
                self.note(element, "it has no size, and is left out")
            for what in notes:
                self.note(element, what)
        if place.strength < 1.0:
            return [replace(one, amplitude=_rounded(place.strength)) for one in found]
        return found

    def _of_use(self, element: Element, place: _Place) -> list[DrawnNode]:
        """Patterns of what a use shows, at its place."""
        link = link_of(element)
        if not link.startswith("#"):
            self.note(element, f"it uses {link[:60]!r}; nothing is fetched, so it is ignored")
            return []
        target = self.ids.get(link[1:])
        if target is None:
            self.note(element, f"it uses {link[:60]!r}, which is not there; ignored")
            return []
        if link in self._used:
            self.note(element, "it uses what it stands in; ignored")
            return []
        x, y = (length_px(element.get(of), 0.0) or 0.0 for of in ("x", "y"))
        there = _with(place, matrix=place.matrix @ AffineMap(e=x, f=y), named=False)
        self._used.append(link)
        if name_of(target) in ("symbol", "svg"):
            self._count(target)
            style = styled(target, there.style, self.sheet)
            moved = self._matrix(target) or AffineMap()
            inner = _with(there, matrix=there.matrix @ moved, style=style, depth=place.depth + 1)
            sizes = element.get("width"), element.get("height")
            found = self._of_svg(target, inner, sizes)
        else:
            found = self._one(target, there)
        self._used.pop()
        line = element.sourceline or 0
        return [DrawnNode(node.pattern, line, node.parts) for node in found]

    def _of_svg(
        self, element: Element, place: _Place, sizes: tuple[str | None, str | None] = (None, None)
    ) -> list[DrawnNode]:
        """Patterns of a drawing in a drawing, which is fitted into its rectangle."""
        x, y = (length_px(element.get(of), 0.0) or 0.0 for of in ("x", "y"))
        texts = (sizes[0] or element.get("width"), sizes[1] or element.get("height"))
        both = zip(texts, place.view, strict=True)
        width, height = (length_px(text or "100%", whole) or 0.0 for text, whole in both)
        if width <= 0 or height <= 0:
            self.note(element, "it has no size, and is left out")
            return []
        matrix = place.matrix @ AffineMap(e=x, f=y)
        view = view_of(element)
        if view is not None:
            how = element.get("preserveAspectRatio") or ""
            matrix = matrix @ fit(view, (width, height), how)
            width, height = view[2:]
        return self.inside(element, _with(place, matrix=matrix, view=(width, height)))

    def _matrix(self, element: Element) -> AffineMap | None:
        """Map of an element; None, which is said, if it is not understood."""
        text = element.get("transform")
        if text is None:
            return AffineMap()
        matrix = transform_of(text)
        if matrix is None:
            self.note(element, "its transform is not understood, so it is left out")
        elif matrix.scale == 0.0:
            return None  # it is drawn as nothing
        return matrix

    def _look(self, element: Element) -> ClassLook | None:
        """Tell what the scene says of an element's class, label or id."""
        if not self.class_looks:
            return None
        names = (*classes_of(element), element.get(f"{INKSCAPE}label"), element.get("id"))
        known = [name for name in names if name and name in self.class_looks]
        self._met.update(known)
        return self.class_looks[known[0]] if known else None

    def _count(self, element: Element) -> None:
        self._elements += 1
        if self._elements > MOST_ELEMENTS:
            raise InputError(
                f"{self.name} line {element.sourceline}: what it uses makes it more than "
                f"{MOST_ELEMENTS} elements; use fewer"
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


def start(matrix: AffineMap, style: Mapping[str, str], view: Point) -> _Place:
    """Place of what stands in a drawing's root."""
    return _Place(matrix, style, view)


def view_of(element: Element) -> tuple[float, float, float, float] | None:
    """Left, top, width and height of an attribute viewBox; None for nothing that can be."""
    numbers = numbers_of(element.get("viewBox"))
    if len(numbers) != 4 or not all(0 < size < 1e9 for size in numbers[2:]):
        return None
    left, top, width, height = numbers
    return (left, top, width, height) if abs(left) < 1e9 and abs(top) < 1e9 else None


def _with(place: _Place, **changes: object) -> _Place:
    from dataclasses import replace as changed

    return changed(place, **changes)  # pyright: ignore[reportArgumentType]


def _rounded(strength: float) -> float:
    return round(min(strength, 1.0), 4)
