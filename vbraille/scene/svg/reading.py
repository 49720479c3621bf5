"""SVG files as scenes."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.scene.locations import FoundScene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.svg.drawing import SvgDrawing, start, view_of
from vbraille.scene.svg.numbers import PX_MM, AffineMap, fit, length_px
from vbraille.scene.svg.style import StyleSheet, styled
from vbraille.scene.svg.tree import name_of, read_tree, text_of
from vbraille.scene.svg.words import description_of, title_of

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from vbraille.scene.svg.drawing import DrawnNode
    from vbraille.scene.svg.paint import ClassLook
    from vbraille.scene.svg.tree import Element
    from vbraille.scene.traversal import Steps

_LANGUAGE = re.compile(r"[A-Za-z]{2,3}(?:-[A-Za-z0-9]{1,8})*")
_XML_LANG = "{http://www.w3.org/XML/1998/namespace}lang"
_BY_SCRIPT = "its script is never run"


def read_svg(path: Path, class_looks: Mapping[str, ClassLook] | None = None) -> FoundScene:
    """Read a drawing as a scene.

    Paths, rectangles, circles, ellipses, lines, polylines and polygons become shapes, and texts
    labels. Curves are flattened to 0.05 mm. What is filled or drawn with a colour has the texture
    that stands for it, unless the scene says another of its class; see docs/drawings.md. Nothing of
    a drawing is run, and nothing that it refers to is looked up.

    Parameters
    ----------
    path
        The file.
    class_looks
        What shapes become, by their class, by the label that Inkscape gives them, or by their id.
        A group's counts for all that stands in it.

    Returns
    -------
    FoundScene
        The scene, the lines of its elements, and what was ignored.

    Raises
    ------
    InputError
        If the file is none that `vbraille.scene.svg.tree.read_tree` reads, has no size, or has more
        than 50,000 elements or 500,000 places together with what it uses again.
    """
    root = read_tree(path)
    sheet = StyleSheet()
    drawing = SvgDrawing(str(path), sheet, _ids(root), class_looks or {})
    for element in root.iter():
        _look_through(element, sheet, drawing)
    width, height = size_px(root, str(path))
    view = view_of(root)
    matrix = AffineMap(a=PX_MM, d=PX_MM)
    if view is not None:
        matrix = matrix @ fit(view, (width, height), root.get("preserveAspectRatio") or "")
    seen = view[2:] if view is not None else (width, height)
    nodes = drawing.inside(root, start(matrix, styled(root, {}, sheet), seen))
    language = root.get(_XML_LANG) or root.get("lang") or ""
    scene = Scene(
        canvas=_canvas(width, height, str(path)),
        title=title_of(root),
        description=description_of(root),
        elements=tuple(node.pattern for node in nodes),
    )
    if _LANGUAGE.fullmatch(language):
        scene = replace(scene, language=language)
    lines: dict[Steps, int] = {}
    _add_lines(lines, ("elements",), nodes)
    return FoundScene(scene, lines, drawing.warnings())


def size_px(root: Element, name: str) -> tuple[float, float]:
    """Width and height of a drawing, in pixels of 1/96 inch.

    Where they are not given as lengths, they are those of the viewBox.

    Raises
    ------
    InputError
        If there is none of these.
    """
    view = view_of(root)
    given = [
        None if (text or "").strip().endswith("%") else length_px(text, 0.0)
        for text in (root.get("width"), root.get("height"))
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


def _canvas(width: float, height: float, name: str) -> Canvas:
    try:
        return Canvas(width_mm=round(width * PX_MM, 4), height_mm=round(height * PX_MM, 4))
    except ValueError as error:
        raise InputError(f"{name} cannot be a canvas: its {error}") from None


def _ids(root: Element) -> dict[str, Element]:
    """Elements by their ids, the first of each."""
    ids: dict[str, Element] = {}
    for element in root.iter():
        own = element.get("id")
        if own:
            ids.setdefault(own, element)
    return ids


def _look_through(element: Element, sheet: StyleSheet, drawing: SvgDrawing) -> None:
    """Take an element's style sheet, and note scripts."""
    name = name_of(element)
    if name == "script":
        drawing.note(element, "it is never run, and ignored")
    elif name == "style" and (element.get("type") or "text/css").strip() == "text/css":
        before = len(sheet.ignored)
        sheet.add(text_of(element))
        for what in sheet.ignored[before:]:
            drawing.note(element, what)
    if any(str(key).startswith("on") for key in element.keys()):  # noqa: SIM118 - no dict
        drawing.note(element, _BY_SCRIPT)


def _add_lines(lines: dict[Steps, int], steps: Steps, nodes: list[DrawnNode]) -> None:
    """Lines of elements and of their parts, by the keys that lead to them."""
    left = [((*steps, number), node) for number, node in enumerate(nodes)]
    while left:
        place, node = left.pop()
        if node.line:
            lines[place] = node.line
        left += [((*place, "parts", number), part) for number, part in enumerate(node.parts)]
