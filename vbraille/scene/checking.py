"""Report on a scene for its author: what it holds, and what may be hard to feel."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from msgspec.structs import replace

from vbraille.carriers.carrier import LATERO, PANTOGRAPH, TACTOGRAPH
from vbraille.scene.bounds import EMPTY, Box, bounds
from vbraille.scene.measures import travel_deg
from vbraille.scene.patterns import (
    Circle,
    Group,
    Image,
    Label,
    Moving,
    PathShape,
    Polygon,
    Shape,
    Tile,
)
from vbraille.scene.signals import made_of
from vbraille.scene.textures import LinearGrating, Uniform
from vbraille.scene.traversal import (
    ONE,
    children,
    drawn_vibrations,
    each,
    signals_of,
    vibrations,
    with_children,
)
from vbraille.scene.zooming import is_there
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from vbraille.scene.locations import OpenedScene
    from vbraille.scene.measures import Point, RidgeWave
    from vbraille.scene.patterns import AnyPattern, Operation
    from vbraille.scene.scene import Canvas, Scene
    from vbraille.scene.strokes import Vibration

    Boxes = Mapping[Image | Label, Box]


@dataclass(frozen=True, slots=True)
class ElementReport:
    """An element of a scene, as its author knows it.

    Parameters
    ----------
    number
        Number of the element, from 1.
    kind
        Kind as the file has it.
    name
        Title, or else id, or else text; empty if it has none.
    place
        File and line.
    box
        Rectangle around it; None if it is everywhere, or is not known.
    vibration_hz
        Frequencies at which something in it vibrates.
    """

    number: int
    kind: str
    name: str
    place: str
    box: Box | None
    vibration_hz: tuple[float, ...]

    def said(self) -> str:
        """Words for the element: its number, its kind and its name."""
        return f"element {self.number}, {self.kind}{f' {self.name}' if self.name else ''}"


@dataclass(frozen=True, slots=True)
class SceneReport:
    """Report on a scene: what it holds, and what is to be said about it.

    Parameters
    ----------
    kinds
        Number of patterns of each kind, at any depth, as they are written.
    elements
        The elements in order.
    textures
        Number of different textures.
    vibrations
        Sentences about vibrations that meet.
    advice
        Sentences about what tactile graphics ask.
    """

    kinds: dict[str, int]
    elements: tuple[ElementReport, ...]
    textures: int
    vibrations: tuple[str, ...]
    advice: tuple[str, ...]


def check_scene(opened: OpenedScene, known: Mapping[Image | Label, Box]) -> SceneReport:
    """Look through a scene for what it holds and what can be better.

    Parameters
    ----------
    opened
        The scene.
    known
        Boxes of its images and labels.
    """
    scene, written = opened.resolved, opened.written
    counts = Counter(kind_of(one) for one in each(*written.textures.values(), *written.elements))
    elements = tuple(
        ElementReport(
            number=number,
            kind=kind_of(wrote),
            name=_name(shown),
            place=opened.place(number - 1),
            box=bounds(shown, known),
            vibration_hz=tuple(sorted(frequencies(shown))),
        )
        for number, (wrote, shown) in enumerate(
            zip(written.elements, scene.elements, strict=True), 1
        )
    )
    return SceneReport(
        kinds=dict(sorted(counts.items(), key=lambda item: (-item[1], item[0]))),
        elements=elements,
        textures=_texture_count(scene),
        vibrations=tuple(_vibrations(scene, elements, known)),
        advice=(*_advice(scene, elements), *_signal_advice(opened)),
    )


def kind_of(pattern: AnyPattern) -> str:
    """Kind of a pattern as files have it.

    >>> from vbraille.scene.textures import UniformVibration
    >>> kind_of(UniformVibration())
    'vibration'
    """
    return str(pattern.__struct_config__.tag)


def _name(pattern: AnyPattern) -> str:
    text = pattern.text if isinstance(pattern, Label) else ""
    return " ".join((pattern.title or pattern.id or text).split())


def _vibrations(
    scene: Scene, elements: Sequence[ElementReport], known: Mapping[Image | Label, Box]
) -> Iterator[str]:
    found = {one for element in elements for one in element.vibration_hz}
    told = [
        (number, sentence)
        for number, element in enumerate(scene.elements)
        for sentence in _beats_within(element, known)
    ]
    yield from _grouped(told, elements)
    for sentence in _beats_between(scene.operation, scene.elements, known):
        yield f"the scene {sentence}"
    yield from _alike(found)


def _advice(scene: Scene, elements: Sequence[ElementReport]) -> Iterator[str]:
    yield from _canvas_advice(scene.canvas)
    if not elements:
        yield "the scene has no elements, so nothing can be felt; write some under [[elements]]"
    # Where what is not there as the picture is written has its place depends on the zoom.
    there = [is_there(element, 1.0) for element in scene.elements]
    boxes = [element.box for element in elements]
    told = [
        (number, sentence)
        for number, (element, box) in enumerate(zip(scene.elements, boxes, strict=True))
        for sentence in dict.fromkeys(
            _element_advice(element, box if there[number] else None, scene.canvas)
        )
    ]
    told += _hidden(scene, [box if at else EMPTY for box, at in zip(boxes, there, strict=True)])
    yield from _grouped(told, elements)
    textures = _texture_count(scene)
    if textures > MOST_TEXTURES:
        yield (
            f"there are {textures} different textures; more than {MOST_TEXTURES} are "
            "hard to tell apart"
        )


def _signal_advice(opened: OpenedScene) -> Iterator[str]:
    """Sentences about signals that nothing uses."""
    written = opened.written
    patterns = each(*written.elements, *written.textures.values())
    used = {name for one in patterns for _, name in signals_of(one)}
    used |= {name for one in written.signals.values() for name in made_of(one)}
    for name in written.signals:
        if name not in used:
            place = opened.locations.place(("signals", name))
            yield f"{place}: signal {name} is used by nothing; use it, or leave it out"


def _grouped(told: Sequence[tuple[int, str]], elements: Sequence[ElementReport]) -> Iterator[str]:
    """Sentences about elements; what holds for many is said once."""
    by_sentence: dict[str, list[int]] = {}
    for number, sentence in told:
        by_sentence.setdefault(sentence, []).append(number)
    for sentence, numbers in by_sentence.items():
        first = elements[numbers[0]]
        more = len(numbers) - 1
        also = f" (and {count(more, 'other')})" if more else ""
        yield f"{first.place}: {first.said()}{also} {sentence}"


LEAST_BLANK_MM = 2.5
MOST_TEXTURES = 5
LEAST_WAVE_MM, MOST_WAVE_MM = 2.0, 15.0
MOST_FLOW_HZ = 5.0
LEAST_STROKE_MM, MOST_STROKE_MM = 2.0, 10.0
# Size of the largest array of 8 × 8, the Latero's, which reaches beyond its centre's travel.
_ARRAY_MM = (9.0, 12.7)


def _canvas_advice(canvas: Canvas) -> Iterator[str]:
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


def _element_advice(element: AnyPattern, box: Box | None, canvas: Canvas) -> Iterator[str]:
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
        if isinstance(pattern, Shape) and pattern.stroke is not None:
            stroke = pattern.stroke
            if not LEAST_STROKE_MM <= stroke.width_mm <= MOST_STROKE_MM:
                yield (
                    f"has a stroke of {stroke.width_mm:g} mm; from {LEAST_STROKE_MM:g} to "
                    f"{MOST_STROKE_MM:g} mm they are felt best"
                )
        if pattern.wave is not None:
            along = " along a stroke" if isinstance(pattern, Shape) else ""
            yield from _of_wave(f"a grating{along}", pattern.wave)
        if isinstance(pattern, Shape):
            for flow in pattern.flows:
                if flow != pattern.wave:
                    of_cue = pattern.cue is not None and flow == pattern.cue.wave
                    yield from _of_flow("a cue" if of_cue else "a row of dots", flow)
        elif isinstance(pattern, Moving):
            for wave in each(pattern.part):
                if isinstance(wave, LinearGrating):
                    across = _across(wave, pattern.velocity_mm_s)
                    yield from _of_flow("a grating", wave.wave._replace(speed=across))


def _of_wave(what: str, wave: RidgeWave) -> Iterator[str]:
    """Sentences about a wave that is felt badly, or flows faster than was felt well."""
    if wave.in_mm and wave.length < LEAST_WAVE_MM:
        yield f"has {what} of {wave.length:g} mm, which is felt as noise; 2 to 15 mm are felt best"
    elif wave.in_mm and wave.length > MOST_WAVE_MM:
        yield f"has {what} of {wave.length:g} mm, which is felt weakly; 2 to 15 mm are felt best"
    yield from _of_flow(what, wave)


def _across(wave: LinearGrating, velocity_mm_s: Point) -> float:
    """Speed of a grating along its wave that moves as a whole, in mm/s."""
    angle = math.radians(travel_deg(wave.wave_angle_deg, wave.ridge_angle_deg))
    return velocity_mm_s[0] * math.cos(angle) + velocity_mm_s[1] * math.sin(angle)


def _of_flow(what: str, wave: RidgeWave) -> Iterator[str]:
    """Sentences about a flow that is faster than what was felt well: Lévesque 2009, 9.7."""
    if wave.flow_hz > MOST_FLOW_HZ:
        yield (
            f"has {what} that moves by {wave.flow_hz:.3g} waves a second; 1 to {MOST_FLOW_HZ:g} "
            "are felt best"
        )


def _texture_count(scene: Scene) -> int:
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


def _hidden(scene: Scene, boxes: Sequence[Box | None]) -> Iterator[tuple[int, str]]:
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


# Frequencies that differ by less cannot be told apart (8.6).
LEAST_DIFFERENCE_HZ = 20.0
# A vibration drowns what is nearer than this (8.6); the distance is that between elements (8.2.1).
LEAST_GAP_MM = 2.5
# Parts of a group that are compared with each other.
_MOST_COMPARED = 200


def frequencies(pattern: AnyPattern) -> set[float]:
    """Frequencies in Hz at which something in a pattern vibrates."""
    return {one.frequency_hz for one in vibrations(pattern) if one.amplitude}


def _beats_within(pattern: AnyPattern, known: Boxes) -> Iterator[str]:
    """Sentences about vibrations that meet in a pattern, and what becomes of them.

    Parameters
    ----------
    pattern
        A pattern of a resolved scene.
    known
        Boxes of images and labels; see `bounds`.
    """
    inside = _own(pattern)
    for part in children(pattern):
        inside |= frequencies(part)
    if _changed(pattern) and inside:
        yield (
            f"vibrates as a whole at {_hz(_changed(pattern))}, and what is in it at {_hz(inside)}: "
            f"{_masked(_changed(pattern), inside)}; leave one of them out"
        )
    if isinstance(pattern, Circle | Polygon | PathShape) and pattern.fill is not None:
        fill, stroke = pattern.fill, pattern.stroke
        drowned = stroke is not None and _of(stroke.vibration) and not frequencies(fill.texture)
        if drowned and not fill.blended and fill.gap_mm < LEAST_GAP_MM:
            yield (
                f"has a fill that begins {fill.gap_mm:g} mm from a stroke that vibrates, which "
                f"drowns what is near; make the fill's gap {LEAST_GAP_MM:g} mm or more"
            )
    if isinstance(pattern, Group):
        if pattern.by is not None and frequencies(pattern.by):
            yield (
                f"blends by a pattern that vibrates at {_hz(frequencies(pattern.by))}; "
                "blend by one that is still"
            )
        yield from _beats_between(pattern.operation, pattern.parts, known)
    for part in children(pattern):
        yield from _beats_within(part, known)


def _beats_between(
    operation: Operation, parts: Sequence[AnyPattern], known: Boxes
) -> Iterator[str]:
    """Sentences about vibrations of parts that an operation puts together where they overlap."""
    if operation not in _SAID:
        return
    vibrating = [(part, frequencies(part)) for part in parts]
    vibrating = [(bounds(part, known), hz) for part, hz in vibrating if hz][:_MOST_COMPARED]
    said: set[str] = set()
    for number, (box, hz) in enumerate(vibrating):
        for other_box, other_hz in vibrating[:number]:
            if box is not None and other_box is not None and box.common(other_box).is_empty:
                continue
            said.add(_SAID[operation].format(_hz(other_hz), _hz(hz), _masked(other_hz, hz)))
    yield from sorted(said)


def _alike(found: set[float]) -> Iterator[str]:
    """Sentences about frequencies of a scene that cannot be told apart."""
    for low, high in pairwise(sorted(found)):
        if high - low < LEAST_DIFFERENCE_HZ:
            yield (
                f"vibrations of {low:g} and {high:g} Hz cannot be told apart; set them "
                f"{LEAST_DIFFERENCE_HZ:g} Hz apart or more"
            )


_SAID = {
    "multiply": "masks a vibration of {0} with one of {1}: {2}; mask by a pattern that is still",
    "add": (
        "adds a vibration of {0} to one of {1}, and the sum ends at full deflection; overwrite, "
        'or write operation = "weighted"'
    ),
    "maximum": "takes the larger of vibrations of {0} and {1}, which neither is; overwrite instead",
}


def _own(pattern: AnyPattern) -> set[float]:
    """Frequencies of what a pattern draws itself."""
    return {one.frequency_hz for one in drawn_vibrations(pattern) if one.amplitude}


def _changed(pattern: AnyPattern) -> set[float]:
    return _of(pattern.vibration)


def _of(vibration: Vibration | None) -> set[float]:
    return {vibration.frequency_hz} if vibration is not None and vibration.amplitude else set()


def _masked(one: set[float], other: set[float]) -> str:
    """Tell what becomes of two vibrations of which one masks the other."""
    differences = {abs(a - b) for a in one for b in other}
    if differences == {0.0}:
        return "their swings are narrower and weaker than either's"
    if min(differences - {0.0}) < LEAST_DIFFERENCE_HZ:
        return "they make sharp peaks, which may harm the actuators"
    return "they beat"


def _hz(found: set[float]) -> str:
    return f"{' and '.join(f'{one:g}' for one in sorted(found))} Hz"
