"""Report on a scene for its author: what it holds, and what may be hard to feel."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from vbraille.carriers.carrier import LATERO, PANTOGRAPH, TACTOGRAPH
from vbraille.scene.bounds import Box, bounds
from vbraille.scene.patterns import Fill, Group, Image, Label, Moving, Shape, Tile
from vbraille.scene.signals import made_of
from vbraille.scene.textures import LinearGrating, Uniform
from vbraille.scene.traversal import (
    children,
    drawn_vibrations,
    each,
    mapped,
    placed,
    signals_of,
    vibrations,
    waves_of,
)
from vbraille.scene.zooming import is_there
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from vbraille.scene.locations import OpenedScene
    from vbraille.scene.measures import RidgeWave
    from vbraille.scene.patterns import AnyPattern, Operation
    from vbraille.scene.scene import Scene
    from vbraille.scene.strokes import Vibration

    Boxes = Mapping[Image | Label, Box]

LEAST_BLANK_MM = 2.5
MOST_TEXTURES = 5
LEAST_STROKE_MM, MOST_STROKE_MM = 2.0, 10.0
# Frequencies that differ by less cannot be told apart (8.6).
LEAST_DIFFERENCE_HZ = 20.0
# A vibration drowns what is nearer than this (8.6); the distance is that between elements (8.2.1).
LEAST_GAP_MM = 2.5
# Size of the largest array of 8 × 8, the Latero's, which reaches beyond its centre's travel.
_ARRAY_MM = (9.0, 12.7)
# Parts of a group that are compared with each other.
_MOST_COMPARED = 200

# When a wave is felt badly (8.6 and 9.7), and what is said of it then.
_WAVES = (
    (
        lambda what, wave: "grating" in what and wave.in_mm and wave.length < 2.0,
        "of {0.length:g} mm, which is felt as noise; 2 to 15 mm are felt best",
    ),
    (
        lambda what, wave: "grating" in what and wave.in_mm and wave.length > 15.0,
        "of {0.length:g} mm, which is felt weakly; 2 to 15 mm are felt best",
    ),
    (
        lambda _, wave: wave.flow_hz > 5.0,
        "that moves by {0.flow_hz:.3g} waves a second; 1 to 5 are felt best",
    ),
)
# What is said of two vibrations that an operation puts together.
_MEETINGS = {
    "multiply": "masks a vibration of {0} with one of {1}: {2}; mask by a pattern that is still",
    "add": (
        "adds a vibration of {0} to one of {1}, and the sum ends at full deflection; overwrite, "
        'or write operation = "weighted"'
    ),
    "maximum": "takes the larger of vibrations of {0} and {1}, which neither is; overwrite instead",
}


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
    advice
        Sentences about what is hard to feel, and about vibrations that meet.
    """

    kinds: dict[str, int]
    elements: tuple[ElementReport, ...]
    textures: int
    advice: tuple[str, ...]


def check_scene(opened: OpenedScene, known: Boxes) -> SceneReport:
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
            number=number + 1,
            kind=kind_of(wrote),
            name=" ".join((shown.title or shown.id or getattr(shown, "text", "")).split()),
            place=opened.place(number),
            box=bounds(shown, known),
            vibration_hz=tuple(sorted(frequencies(shown))),
        )
        for number, (wrote, shown) in enumerate(zip(written.elements, scene.elements, strict=True))
    )
    return SceneReport(
        kinds=dict(counts.most_common()),
        elements=elements,
        textures=_texture_count(scene),
        advice=(*_advice(scene, elements, known), *_signal_advice(opened)),
    )


def kind_of(pattern: AnyPattern) -> str:
    """Kind of a pattern as files have it.

    >>> from vbraille.scene.textures import UniformVibration
    >>> kind_of(UniformVibration())
    'vibration'
    """
    return str(pattern.__struct_config__.tag)


def frequencies(*patterns: AnyPattern) -> set[float]:
    """Frequencies in Hz at which something in patterns vibrates."""
    return _swinging(one for pattern in patterns for one in vibrations(pattern))


def _swinging(found: Iterable[Vibration | None]) -> set[float]:
    return {one.frequency_hz for one in found if one is not None and one.amplitude}


def _advice(scene: Scene, elements: Sequence[ElementReport], known: Boxes) -> Iterator[str]:
    width_mm, height_mm = scene.canvas.width_mm, scene.canvas.height_mm
    reaches = [
        (c.travel_mm + _ARRAY_MM[0], c.height_mm + _ARRAY_MM[1], c.name)
        for c in (PANTOGRAPH, TACTOGRAPH, LATERO)
    ]
    if not any(width_mm <= width and height_mm <= height for width, height, _ in reaches):
        width, height, name = max(reaches)
        yield (
            f"canvas is larger than any known carriage reaches; the largest, the {name}, reaches "
            f"{width:g} × {height:g} mm"
        )
    if not elements:
        yield "the scene has no elements, so nothing can be felt; write some under [[elements]]"
    by_sentence: dict[str, list[ElementReport]] = {}
    for element, shown in zip(elements, scene.elements, strict=True):
        place, felt = _place_advice(element, shown, scene), _felt_advice(shown)
        for sentence in dict.fromkeys((*place, *felt, *_meetings(shown, known))):
            by_sentence.setdefault(sentence, []).append(element)
    for sentence, (first, *others) in by_sentence.items():
        also = f" (and {count(len(others), 'other')})" if others else ""
        yield f"{first.place}: {first.said()}{also} {sentence}"
    for sentence in _between(scene.operation, scene.elements, known):
        yield f"the scene {sentence}"
    for low, high in pairwise(sorted(frequencies(*scene.elements))):
        if high - low < LEAST_DIFFERENCE_HZ:
            yield (
                f"vibrations of {low:g} and {high:g} Hz cannot be told apart; set them "
                f"{LEAST_DIFFERENCE_HZ:g} Hz apart or more"
            )
    textures = _texture_count(scene)
    if textures > MOST_TEXTURES:
        yield (
            f"there are {textures} different textures; more than {MOST_TEXTURES} are "
            "hard to tell apart"
        )


def _place_advice(element: ElementReport, shown: AnyPattern, scene: Scene) -> Iterator[str]:
    """Sentences about where an element stands."""
    if not is_there(shown, 1.0):
        return  # Its place depends on the zoom.
    box, canvas = element.box, scene.canvas
    if box is None:
        hides = scene.operation == "overwrite" and not isinstance(shown, Image | Label)
        if hides and element.number > 1:
            yield (
                "is everywhere, and hides all elements before it; write it first, or fill a shape "
                "with it"
            )
        return
    beyond_mm = max(-box.left, -box.top, box.right - canvas.width_mm, box.bottom - canvas.height_mm)
    if box.is_empty:
        yield "can nowhere be felt; its parts have no place in common"
    elif box.common(Box(0.0, 0.0, canvas.width_mm, canvas.height_mm)).is_empty:
        yield "is wholly outside the canvas, and cannot be felt; move it"
    elif beyond_mm > 1e-6:
        yield f"reaches {beyond_mm:.1f} mm beyond the canvas"


def _felt_advice(element: AnyPattern) -> Iterator[str]:
    """Sentences about strokes and waves in an element that are felt badly."""
    for pattern in each(element):
        if isinstance(pattern, Shape) and pattern.stroke is not None:
            width_mm = pattern.stroke.width_mm
            if not LEAST_STROKE_MM <= width_mm <= MOST_STROKE_MM:
                yield (
                    f"has a stroke of {width_mm:g} mm; from {LEAST_STROKE_MM:g} to "
                    f"{MOST_STROKE_MM:g} mm they are felt best"
                )
        for what, wave in _waves(pattern):
            for is_bad, sentence in _WAVES:
                if is_bad(what, wave):
                    yield f"has {what} {sentence.format(wave)}"


def _waves(pattern: AnyPattern) -> Iterator[tuple[str, RidgeWave]]:
    """Waves of a pattern, with what they are; of one that moves as a whole as it moves."""
    yield from waves_of(pattern)
    if isinstance(pattern, Moving):
        x_mm_s, y_mm_s = pattern.velocity_mm_s
        for part in each(pattern.part):
            if isinstance(part, LinearGrating):
                angle = math.radians(part.travel_deg)
                across_mm_s = x_mm_s * math.cos(angle) + y_mm_s * math.sin(angle)
                yield "a grating", part.wave._replace(speed=across_mm_s)


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


def _texture_count(scene: Scene) -> int:
    """Number of textures that differ by more than their place, in a resolved scene."""

    def nowhere(pattern: AnyPattern) -> AnyPattern:
        places = {} if isinstance(pattern, Shape | Tile) else placed(pattern, lambda *_: (0.0, 0.0))
        return replace(pattern, id="", title="", description="", **places)

    def is_texture(element: AnyPattern) -> bool:
        if isinstance(element, Group):
            return all(map(is_texture, element.parts))
        return bounds(element) is None and not isinstance(element, Image | Label | Shape)

    found = [element for element in scene.elements if is_texture(element)]
    for pattern in each(*scene.elements):
        textured: Any = getattr(pattern, "fill", pattern)
        found.append(getattr(textured, "texture", None) or Uniform())
    return len({mapped(one, nowhere) for one in found if not isinstance(one, Uniform)})


def _meetings(element: AnyPattern, known: Boxes) -> Iterator[str]:
    """Sentences about vibrations that meet in an element, and what becomes of them."""
    for pattern in each(element):
        whole = _swinging([pattern.vibration])
        inside = _swinging(drawn_vibrations(pattern)) | frequencies(*children(pattern))
        if whole and inside:
            yield (
                f"vibrates as a whole at {_hz(whole)}, and what is in it at {_hz(inside)}: "
                f"{_masked(whole, inside)}; leave one of them out"
            )
        fill: Fill | None = getattr(pattern, "fill", None)
        if fill is not None and not fill.blended and fill.gap_mm < LEAST_GAP_MM:
            stroke: Any = getattr(pattern, "stroke", None)
            if stroke and _swinging([stroke.vibration]) and not frequencies(fill.texture):
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
            yield from _between(pattern.operation, pattern.parts, known)


def _between(operation: Operation, parts: Sequence[AnyPattern], known: Boxes) -> list[str]:
    """Sentences about vibrations of parts that an operation puts together where they overlap."""
    if operation not in _MEETINGS:
        return []
    vibrating = [(bounds(part, known), hz) for part in parts if (hz := frequencies(part))]
    said: set[str] = set()
    for (box, hz), (other_box, other_hz) in combinations(vibrating[:_MOST_COMPARED], 2):
        if box is None or other_box is None or not box.common(other_box).is_empty:
            said.add(_MEETINGS[operation].format(_hz(hz), _hz(other_hz), _masked(hz, other_hz)))
    return sorted(said)


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
