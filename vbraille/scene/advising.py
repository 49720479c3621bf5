"""What tactile graphics ask of a drawing: Lévesque 2009, 8.2.1 and 8.6."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.carriers.carrier import LATERO, PANTOGRAPH, TACTOGRAPH
from vbraille.scene.bounds import Box, bounds
from vbraille.scene.labels import Label
from vbraille.scene.moving import ONE
from vbraille.scene.patterns import Circle, Group, Image, PathShape, Polygon, Tile
from vbraille.scene.shapes import Shape
from vbraille.scene.textures import LinearGrating, RadialGrating, Uniform
from vbraille.scene.walking import each, with_children

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.scene import Canvas, Scene

LEAST_BLANK_MM = 2.5
MOST_TEXTURES = 5
LEAST_WAVE_MM, MOST_WAVE_MM = 2.0, 15.0
LEAST_STROKE_MM, MOST_STROKE_MM = 2.0, 10.0
# Size of the largest array of 8 × 8, the Latero's, which reaches beyond its centre's travel.
_ARRAY_MM = (9.0, 12.7)
# Pairs of elements that stand side by side, and are looked at.
_MOST_PAIRS = 50_000


def of_canvas(canvas: Canvas) -> Iterator[str]:
    """Sentences about a canvas that no carriage reaches all of."""
    carriers = [PANTOGRAPH, TACTOGRAPH, LATERO]
    reaches = [(c.travel_mm + _ARRAY_MM[0], c.height_mm + _ARRAY_MM[1], c.name) for c in carriers]
    if any(canvas.width_mm <= width and canvas.height_mm <= height for width, height, _ in reaches):
        return
    width, height, name = max(reaches)
    yield (
        f"canvas is larger than any known carriage reaches; the largest, the {name}, reaches "
        f"{width:g} × {height:g} mm"
    )


def of_element(element: AnyPattern, box: Box | None, canvas: Canvas) -> Iterator[str]:
    """Sentences about an element by itself: where it stands, its gratings and its strokes."""
    if box is not None:
        if box.is_empty:
            yield "can nowhere be felt; its parts have no place in common"
        elif box.common(Box(0.0, 0.0, canvas.width_mm, canvas.height_mm)).is_empty:
            yield "is wholly outside the canvas, and cannot be felt; move it"
        else:
            beyond = max(
                -box.left, -box.top, box.right - canvas.width_mm, box.bottom - canvas.height_mm
            )
            if beyond > 1e-6:
                yield f"reaches {beyond:.1f} mm beyond the canvas"
    for pattern in each(element):
        if isinstance(pattern, LinearGrating | RadialGrating):
            yield from _of_wave("a grating", pattern.ridge_mm + pattern.gap_mm)
        if isinstance(pattern, Shape) and pattern.stroke is not None:
            stroke = pattern.stroke
            if not LEAST_STROKE_MM <= stroke.width_mm <= MOST_STROKE_MM:
                yield (
                    f"has a stroke of {stroke.width_mm:g} mm; from {LEAST_STROKE_MM:g} to "
                    f"{MOST_STROKE_MM:g} mm they are felt best"
                )
            if stroke.along is not None:
                length = stroke.along.ridge_mm + stroke.along.gap_mm
                yield from _of_wave("a grating along a stroke", length)


def _of_wave(what: str, wave_mm: float) -> Iterator[str]:
    if wave_mm < LEAST_WAVE_MM:
        yield f"has {what} of {wave_mm:g} mm, which is felt as noise; 2 to 15 mm are felt best"
    elif wave_mm > MOST_WAVE_MM:
        yield f"has {what} of {wave_mm:g} mm, which is felt weakly; 2 to 15 mm are felt best"


def textures_of(scene: Scene) -> int:
    """Number of textures that differ by more than their place, in a resolved scene."""
    found: set[AnyPattern] = set()
    for pattern in each(*scene.elements):
        if isinstance(pattern, Circle | Polygon | PathShape) and pattern.fill is not None:
            found.add(_nowhere(pattern.fill.texture))
        elif isinstance(pattern, Image) and pattern.texture is not None:
            found.add(_nowhere(pattern.texture))
    for element in scene.elements:
        if _is_texture(element):
            found.add(_nowhere(element))
    return len({one for one in found if not isinstance(one, Uniform)})


def _is_texture(element: AnyPattern) -> bool:
    if isinstance(element, Group):
        return all(map(_is_texture, element.parts))
    return bounds(element) is None and not isinstance(element, Image | Label | Shape)


def _nowhere(pattern: AnyPattern) -> AnyPattern:
    """Texture without its name and its place."""
    bare = replace(pattern, id="", title="", description="")
    if not isinstance(pattern, Shape | Tile):
        places = {name: (0.0, 0.0) for name in ONE if hasattr(pattern, name)}
        bare = replace(bare, **places)
    return with_children(bare, lambda _, part: _nowhere(part))


def hiding(scene: Scene, boxes: Sequence[Box | None]) -> Iterator[tuple[int, str]]:
    """Numbers from 0 of elements that hide all that is before them, with what is said of each."""
    if scene.operation != "overwrite":
        return
    for number, (element, box) in enumerate(zip(scene.elements, boxes, strict=True)):
        if number and box is None and not isinstance(element, Image | Label):
            yield (
                number,
                "is everywhere, and hides all elements before it; write it first, or fill a shape "
                "with it",
            )


def too_close(boxes: Sequence[Box | None]) -> tuple[list[tuple[int, int, float]], bool]:
    """Elements between which there is too little blank, by the rectangles around them.

    Elements that overlap are not meant: one stands on the other.

    Parameters
    ----------
    boxes
        Rectangle around each element; None for one that is everywhere.

    Returns
    -------
    pairs
        Numbers from 0 of two elements, and the blank between them in mm.
    all_compared
        Whether all were compared; very many that stand side by side are not.
    """
    placed = sorted(
        (box.left, number, box)
        for number, box in enumerate(boxes)
        if box is not None and not box.is_empty
    )
    found: list[tuple[int, int, float]] = []
    left = _MOST_PAIRS
    active: list[tuple[float, int, Box]] = []
    for start, number, box in placed:
        active = [one for one in active if one[2].right + LEAST_BLANK_MM > start]
        left -= len(active)
        if left < 0:
            return found, False
        for _, other_number, other in active:
            dx = max(box.left - other.right, other.left - box.right, 0.0)
            dy = max(box.top - other.bottom, other.top - box.bottom, 0.0)
            blank = (dx * dx + dy * dy) ** 0.5
            if 0.0 < blank < LEAST_BLANK_MM - 1e-6:
                first, second = sorted((number, other_number))
                found.append((first, second, blank))
        active.append((start, number, box))
    return sorted(found), True
