"""The key of a picture: numbers in the place of labels that do not fit, and the page for them.

It follows the guidelines for tactile graphics of the Braille Authority of North America.
"""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.labelling import write_label
from vbraille.pictures.index import label_of
from vbraille.pictures.loading import LoadedScene, with_assets
from vbraille.scene.geometry import Box
from vbraille.scene.locations import Locations, OpenedScene
from vbraille.scene.patterns import Circle, Fill, Label, PathShape, Polygon
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.traversal import each, with_children

if TYPE_CHECKING:
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.scene.patterns import AnyPattern

_MARGIN_MM = 5.0
_SAMPLE_MM = 24.0, 14.0  # of a texture


def crowded(loaded: LoadedScene) -> list[Label]:
    """Labels that reach beyond the canvas, or stand on one that is written before."""
    size = loaded.scene.canvas
    canvas = Box(0.0, 0.0, size.width_mm, size.height_mm)
    standing: list[Box] = []
    found: list[Label] = []
    boxes = loaded.boxes()
    for label in each(*loaded.scene.elements):
        if isinstance(label, Label) and label in boxes:
            box = boxes[label]
            fits = box.common(canvas) == box
            if fits and all(box.common(other).is_empty for other in standing):
                standing.append(box)
            else:
                found.append(label)
    return found


def keyed(loaded: LoadedScene, style: BrailleStyle) -> tuple[LoadedScene, LoadedScene]:
    """Put numbers in the place of labels that do not fit.

    Parameters
    ----------
    loaded
        The picture.
    style
        How the braille of its labels is shown.

    Returns
    -------
    LoadedScene, LoadedScene
        The picture, whose numbers have the texts as titles, and the page that is its key: what each
        number stands for, and a sample of the texture of each shape that has a name.

    Raises
    ------
    InputError
        If all labels fit, and no shape with a name has a texture.
    """
    numbers = {label: str(number) for number, label in enumerate(crowded(loaded), 1)}

    def numbered(_: object, pattern: AnyPattern) -> AnyPattern:
        if isinstance(pattern, Label) and pattern in numbers:
            title = pattern.title or pattern.text
            return replace(pattern, text=numbers[pattern], title=title, width_mm=None)
        return with_children(pattern, numbered)

    scene = loaded.opened.resolved  # with what is there at other zooms, too
    shown = replace(scene, elements=tuple(numbered((), element) for element in scene.elements))
    picture = with_assets(dataclasses.replace(loaded.opened, resolved=shown), style)
    page = _page(loaded, numbers, style)
    opened = OpenedScene(loaded.opened.path, loaded.opened.folder, page, page, Locations())
    return picture, with_assets(opened, style)


def _page(loaded: LoadedScene, numbers: dict[Label, str], style: BrailleStyle) -> Scene:
    """Page of a key, as wide as the picture."""
    scene, width_mm = loaded.scene, loaded.scene.canvas.width_mm
    elements: list[AnyPattern] = []
    y_mm = _MARGIN_MM

    def add(text: str, left_mm: float, table: str, least_mm: float) -> float:
        """Put a text on the page, and give the height of what comes below it."""
        room_mm = width_mm - left_mm - _MARGIN_MM
        label = Label(text=text, place_mm=(left_mm, y_mm), width_mm=room_mm, table=table)
        elements.append(label)
        lines = len(write_label(label, style, scene.language).lines)
        return y_mm + max(lines * style.geometry.line_pitch_mm, least_mm)

    for label, number in numbers.items():
        y_mm = add(f"{number} {' '.join(label.text.split())}", _MARGIN_MM, label.table, 0.0)
    for shape in each(*scene.elements):
        if isinstance(shape, Circle | Polygon | PathShape) and shape.fill and label_of(shape):
            right_mm, bottom_mm = _MARGIN_MM + _SAMPLE_MM[0], y_mm + _SAMPLE_MM[1]
            corners = (
                (_MARGIN_MM, y_mm), (right_mm, y_mm), (right_mm, bottom_mm), (_MARGIN_MM, bottom_mm)
            )  # fmt: skip
            sample = Fill(texture=shape.fill.texture)
            elements.append(Polygon(vertices_mm=corners, fill=sample, title=label_of(shape)))
            y_mm = add(label_of(shape), right_mm + _MARGIN_MM, "", _SAMPLE_MM[1] + _MARGIN_MM)
    if not elements:
        raise InputError(f"{loaded.opened.path} needs no key: its labels fit; leave --key out")
    return Scene(
        canvas=Canvas(width_mm=width_mm, height_mm=y_mm + _MARGIN_MM),
        title=f"Key of {loaded.title}",
        language=scene.language,
        elements=tuple(elements),
        signals=scene.signals,
    )
