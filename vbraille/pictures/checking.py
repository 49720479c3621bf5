"""Report on a picture for its author: what it holds, and what may be hard to feel.

What is hard to feel is of Lévesque 2009, 8.2, 8.4.5, 8.6 and 9.7, where nothing else is said.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from msgspec.structs import replace

from vbraille.carriers.carrier import LATERO, PANTOGRAPH, TACTOGRAPH
from vbraille.errors import InputError
from vbraille.pictures.composing import compose
from vbraille.pictures.index import is_open, label_of
from vbraille.pictures.keys import crowded
from vbraille.render.braille.models import STRESS2_8X8
from vbraille.render.compiling import SceneMap
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.geometry import Box, around, bounds, drawn_radius_mm
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Group,
    Image,
    Label,
    LinearGrating,
    Moving,
    PathShape,
    Polygon,
    Shape,
    Tile,
    Uniform,
)
from vbraille.scene.signals import made_of
from vbraille.scene.traversal import (
    children,
    drawn_vibrations,
    each,
    mapped,
    placed,
    points_of,
    signals_of,
    vibrations,
    waves_of,
)
from vbraille.scene.zooming import is_there, levels
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.pictures.loading import LoadedScene
    from vbraille.scene.measures import RidgeWave
    from vbraille.scene.patterns import AnyPattern, Vibration
    from vbraille.scene.scene import Scene

    Boxes = Mapping[Image | Label, Box]

_MOST_TEXTURES: Final = 5
_LEAST_STROKE_MM, _MOST_STROKE_MM = 2.0, 10.0
_LEAST_WAVE_MM, _MOST_WAVE_MM = 2.0, 15.0
_MOST_FLOW_HZ: Final = 5.0
_LEAST_DIFFERENCE_HZ: Final = 20.0
# A vibration drowns what is nearer than this (8.6); it is the distance of elements, too (8.2.1).
_LEAST_BLANK_MM: Final = 2.5
# Size of the largest array of 8 × 8, the Latero's, which reaches beyond its centre's travel.
_ARRAY_MM = (9.0, 12.7)
# Ours: two vibrations that are no farther apart are under one fingertip, as wide as the array.
_TOGETHER_MM: Final = 9.0
# Ours: what swings less than so much of the full swing is hardly felt beside what swings fully.
_LEAST_AMPLITUDE: Final = 0.2
_FELT, _SOLID = 0.001, 0.98  # shares of a place that are felt, and that hide what is below
_STEP_MM: Final = 0.25  # between the places at which it is looked what is felt
_MOST_STEPS: Final = 1_200  # of these along a side of the canvas
_MOST_PARTS: Final = 300
_MOST_SAID: Final = 20  # pairs of parts
_MOST_COMPARED: Final = 200  # parts of a group, with each other
# What is said of two vibrations that an operation puts together.
_MEETINGS = {
    "multiply": (
        "masks a vibration of {0} with one of {1}, and they beat or make sharp peaks, which may "
        "harm the actuators; mask by a pattern that is still"
    ),
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
        Title, or else text, or else id; empty if it has none.
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
        Sentences about what is hard to feel, or not felt as its author means it.
    """

    kinds: dict[str, int]
    elements: tuple[ElementReport, ...]
    textures: int
    advice: tuple[str, ...]


def check_scene(loaded: LoadedScene) -> SceneReport:
    """Look through a picture for what it holds and what can be better.

    Where parts are there at some zooms only, it is looked at from each of these on.
    """
    opened, known = loaded.opened, loaded.boxes()
    written, scene = opened.written, opened.resolved
    elements = tuple(
        ElementReport(
            number=number + 1,
            kind=wrote.kind,
            name=label_of(shown),
            place=opened.place(number),
            box=bounds(shown, known),
            vibration_hz=tuple(sorted(_frequencies(shown))),
        )
        for number, (wrote, shown) in enumerate(zip(written.elements, scene.elements, strict=True))
    )
    counts = Counter(one.kind for one in each(*written.textures.values(), *written.elements))
    textures = _texture_count(scene)
    said = dict.fromkeys(_advice(loaded, elements, known))
    if textures > _MOST_TEXTURES:
        text = f"there are {textures} different textures; more than {_MOST_TEXTURES} are"
        said[f"{text} hard to tell apart"] = None
    said |= dict.fromkeys(_Felt(loaded, elements).advice())
    for zoom in levels(*scene.elements):
        try:
            found = [*_Felt(loaded.zoomed(zoom), elements).advice()]
        except InputError as error:
            found = [str(error)]
        said |= {f"at a zoom of {zoom:g}, {one}": None for one in found if one not in said}
    return SceneReport(dict(counts.most_common()), elements, textures, tuple(said))


def _frequencies(*patterns: AnyPattern) -> set[float]:
    """Frequencies in Hz at which something in patterns vibrates."""
    return _swinging(one for pattern in patterns for one in vibrations(pattern))


def _swinging(found: Iterable[Vibration | None]) -> set[float]:
    return {one.frequency_hz for one in found if one is not None and one.amplitude}


def _texture_count(scene: Scene) -> int:
    """Number of textures that differ by more than their place, in a resolved scene."""

    def nowhere(pattern: AnyPattern) -> AnyPattern:
        places = {} if isinstance(pattern, Shape | Tile) else placed(pattern, lambda *_: (0.0, 0.0))
        return replace(pattern, id="", title="", description="", **places)

    found: list[AnyPattern] = []
    for element in scene.elements:
        parts = [*each(element)]
        if not any(isinstance(one, Shape | Dots | Image | Label) for one in parts):
            found.append(element)
        for part in parts:
            filled: Any = getattr(part, "fill", part)
            found.append(getattr(filled, "texture", None) or Uniform())
    return len({mapped(one, nowhere) for one in found if not isinstance(one, Uniform)})


def _advice(loaded: LoadedScene, elements: Sequence[ElementReport], known: Boxes) -> Iterator[str]:
    """Sentences on what the values of a scene tell."""
    opened, scene = loaded.opened, loaded.opened.resolved
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
    by_sentence: dict[str, list[str]] = {}
    for element, shown in zip(elements, scene.elements, strict=True):
        sentences = [
            *_on_place(element, shown, scene),
            *_on_waves(shown),
            *_on_meeting(shown, known),
        ]
        for sentence in dict.fromkeys(sentences):
            by_sentence.setdefault(sentence, []).append(f"{element.place}: {element.said()}")
    for sentence, (first, *others) in by_sentence.items():
        also = f" (and {count(len(others), 'other')})" if others else ""
        yield f"{first}{also} {sentence}"
    for sentence in _between(scene.operation, scene.elements, known):
        yield f"the scene {sentence}"
    for low, high in pairwise(sorted(_frequencies(*scene.elements))):
        if high - low < _LEAST_DIFFERENCE_HZ:
            yield (
                f"vibrations of {low:g} and {high:g} Hz cannot be told apart; set them "
                f"{_LEAST_DIFFERENCE_HZ:g} Hz apart or more"
            )
    written = opened.written
    patterns = each(*written.elements, *written.textures.values())
    used = {name for one in patterns for _, name in signals_of(one)}
    used |= {name for one in written.signals.values() for name in made_of(one)}
    for name in written.signals:
        if name not in used:
            place = opened.locations.place(("signals", name))
            yield f"{place}: signal {name} is used by nothing; use it, or leave it out"
    for label in crowded(loaded):
        text = " ".join(label.text.split())
        yield f'label "{text}" does not fit; map and feel show a number for it with --key'


def _on_place(element: ElementReport, shown: AnyPattern, scene: Scene) -> Iterator[str]:
    """Sentences about where an element stands."""
    box, canvas = element.box, scene.canvas
    if not is_there(shown, 1.0):
        return  # Its place depends on the zoom.
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


def _on_waves(element: AnyPattern) -> Iterator[str]:
    """Sentences about strokes and waves in an element that are felt badly."""
    best = f"{_LEAST_WAVE_MM:g} to {_MOST_WAVE_MM:g} mm are felt best"
    for pattern in each(element):
        if isinstance(pattern, Shape) and pattern.stroke is not None:
            width_mm = pattern.stroke.width_mm
            if not _LEAST_STROKE_MM <= width_mm <= _MOST_STROKE_MM:
                yield (
                    f"has a stroke of {width_mm:g} mm; from {_LEAST_STROKE_MM:g} to "
                    f"{_MOST_STROKE_MM:g} mm they are felt best"
                )
        for what, wave in _waves(pattern):
            length = wave.length if wave.in_mm and "grating" in what else _LEAST_WAVE_MM
            if length < _LEAST_WAVE_MM:
                yield f"has {what} of {length:g} mm, which is felt as noise; {best}"
            if length > _MOST_WAVE_MM:
                yield f"has {what} of {length:g} mm, which is felt weakly; {best}"
            if wave.flow_hz > _MOST_FLOW_HZ:
                yield (
                    f"has {what} that moves by {wave.flow_hz:.3g} waves a second; 1 to "
                    f"{_MOST_FLOW_HZ:g} are felt best"
                )


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


def _on_meeting(element: AnyPattern, known: Boxes) -> Iterator[str]:
    """Sentences about vibrations that meet in an element, and what becomes of them."""
    for pattern in each(element):
        whole = _swinging([pattern.vibration])
        inside = _swinging(drawn_vibrations(pattern)) | _frequencies(*children(pattern))
        if whole and inside:
            yield (
                f"vibrates as a whole at {_hz(whole)}, and what is in it at {_hz(inside)}; "
                "leave one of them out"
            )
        fill: Any = getattr(pattern, "fill", None)
        stroke: Any = getattr(pattern, "stroke", None)
        is_near = fill and stroke and not fill.blended and fill.gap_mm < _LEAST_BLANK_MM
        if is_near and _swinging([stroke.vibration]) and not _frequencies(fill.texture):
            yield (
                f"has a fill that begins {fill.gap_mm:g} mm from a stroke that vibrates, which "
                f"drowns what is near; make the fill's gap {_LEAST_BLANK_MM:g} mm or more"
            )
        if isinstance(pattern, Group):
            if pattern.by is not None and _frequencies(pattern.by):
                yield (
                    f"blends by a pattern that vibrates at {_hz(_frequencies(pattern.by))}; "
                    "blend by one that is still"
                )
            yield from _between(pattern.operation, pattern.parts, known)


def _between(operation: str, parts: Sequence[AnyPattern], known: Boxes) -> list[str]:
    """Sentences about vibrations of parts that an operation puts together where they overlap."""
    if operation not in _MEETINGS:
        return []
    vibrating = [(bounds(part, known), hz) for part in parts if (hz := _frequencies(part))]
    said: set[str] = set()
    for (box, hz), (other_box, other_hz) in combinations(vibrating[:_MOST_COMPARED], 2):
        if box is None or other_box is None or not box.common(other_box).is_empty:
            said.add(_MEETINGS[operation].format(_hz(hz), _hz(other_hz)))
    return sorted(said)


def _hz(found: set[float]) -> str:
    return f"{' and '.join(f'{one:g}' for one in sorted(found))} Hz"


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """A part of an element that is felt by itself, and where.

    Parameters
    ----------
    number, pattern
        Number of its element, from 0, and the part.
    covers
        Whether it hides what is written before it.
    box
        Rectangle around it on the canvas, in mm.
    where
        Rows and columns of the canvas that the masks are of.
    felt, solid
        Where it is felt, and where it hides all that is below; bool[rows, columns].
    """

    number: int
    pattern: AnyPattern
    covers: bool
    box: Box
    where: tuple[slice, slice]
    felt: NDArray[np.bool_]
    solid: NDArray[np.bool_]

    def edge(self) -> NDArray[np.int64]:
        """Rows and columns of the edge of where it is felt; int64[n, 2]."""
        near = np.pad(self.felt, 1)
        inner = near[:-2, 1:-1] & near[2:, 1:-1] & near[1:-1, :-2] & near[1:-1, 2:]
        return np.argwhere(self.felt & ~inner) + np.array([one.start for one in self.where])


class _Felt:
    """A picture at one zoom, with what can be felt of each of its parts alone."""

    def __init__(self, loaded: LoadedScene, elements: Sequence[ElementReport]) -> None:
        self._loaded, self._scene, self._elements = loaded, loaded.scene, elements
        self._known = loaded.boxes()
        size = self._scene.canvas.width_mm, self._scene.canvas.height_mm
        self._canvas = Box(0.0, 0.0, *size)
        self._step_mm = max(_STEP_MM, max(size) / _MOST_STEPS)

    def advice(self) -> Iterator[str]:
        """Sentences on what is not felt as its author means it."""
        try:
            compose(self._loaded, STRESS2_8X8.display, rate_hz=STRESS2_8X8.display.rate_hz)
        except InputError as error:
            yield f"{error}, so that it cannot be felt"
            return
        parts: list[_Part] = []
        for number, element in enumerate(self._scene.elements):
            for pattern, sentence in _faint(element):
                yield self._said(number, pattern, sentence)
            for pattern in each(element):
                for sentence in (*self._on_image(pattern), *self._on_fill(pattern)):
                    yield self._said(number, pattern, sentence)
            for pattern, covers in _open(element, self._scene.operation == "overwrite"):
                box = bounds(pattern, self._known)
                if box is not None and len(parts) <= _MOST_PARTS:
                    box = box.common(self._canvas)
                    where, hides = self._shown(pattern, box, is_mask=True)
                    felt = np.full(hides.shape, isinstance(pattern, Label)) | (hides >= _FELT)
                    if felt.any():
                        solid = hides >= _SOLID
                        parts.append(_Part(number, pattern, covers, box, where, felt, solid))
        if len(parts) > _MOST_PARTS:
            yield f"only the first {_MOST_PARTS} parts were looked at for what hides what"
            parts.pop()
        covered = self._nowhere()
        for part in reversed(parts):
            under = covered[part.where]
            if under[part.felt].all():
                what = "is wholly hidden by what is written after it; write it later, or leave it "
                yield self._said(part.number, part.pattern, f"{what}out")
            if part.covers and not part.pattern.factor:
                under |= part.solid
        yield from self._beside(parts)

    def _said(self, number: int, pattern: AnyPattern, sentence: str) -> str:
        element = self._elements[self._loaded.numbers[number]]
        part = ""
        if pattern is not self._scene.elements[number]:
            part = f", its {pattern.kind} {label_of(pattern)}".rstrip()
        return f"{element.place}: {element.said()}{part} {sentence}"

    def _called(self, part: _Part) -> str:
        name = f"element {self._loaded.numbers[part.number] + 1}"
        is_whole = part.pattern is self._scene.elements[part.number]
        return name if is_whole else f"the {label_of(part.pattern) or part.pattern.kind} of {name}"

    def _nowhere(self) -> NDArray[np.bool_]:
        """Mask of the whole canvas in which nothing is."""
        height, width = self._canvas.bottom / self._step_mm, self._canvas.right / self._step_mm
        return np.zeros((math.ceil(height), math.ceil(width)), np.bool_)

    def _shown(
        self, pattern: AnyPattern, box: Box, *, is_mask: bool = False
    ) -> tuple[tuple[slice, slice], NDArray[np.float32]]:
        """Rows and columns of a box of the canvas, and a pattern by itself there."""
        if box.is_empty:
            return (slice(0), slice(0)), np.zeros((0, 0), np.float32)
        step = self._step_mm
        rows = slice(int(box.top / step), math.ceil(box.bottom / step))
        columns = slice(int(box.left / step), math.ceil(box.right / step))
        x_mm, y_mm = ((np.arange(float(at.start), at.stop) + 0.5) * step for at in (columns, rows))
        alone = replace(self._scene, elements=(pattern,), operation="overwrite")
        shown = SceneMap(alone, self._loaded.assets)
        return (rows, columns), shown.deflections(x_mm, y_mm, is_mask=is_mask, every_layer=True)

    def _on_image(self, image: AnyPattern) -> Iterator[str]:
        """Sentence about an image whose lines are down."""
        if not isinstance(image, Image) or image.outside:
            return
        intensities = self._loaded.assets.bitmaps[image].intensities
        if not intensities.any():
            other = "gray" if image.channel == "alpha" else "alpha"
            yield (
                f'is down all over in its channel "{image.channel}", so nothing of it is felt; '
                f'write channel = "{other}", or inverted_source = true'
            )
        elif np.median(intensities) == WHOLE and not image.inverted_source:
            yield (
                "is up over more than half of it, as black on white paper is; write "
                "inverted_source = true to feel what is black"
            )

    def _on_fill(self, shape: AnyPattern) -> Iterator[str]:
        """Sentences about a shape without room for its fill, or for the waves of that."""
        if not isinstance(shape, Circle | Polygon | PathShape) or shape.fill is None:
            return
        fill = shape.fill
        box = around(points_of(shape)).grown(shape.radius_mm if isinstance(shape, Circle) else 0.0)
        if isinstance(fill.texture, LinearGrating):
            angle, wave_mm = math.radians(fill.texture.travel_deg), fill.texture.wave.length
            across_mm = abs((box.right - box.left) * math.cos(angle))
            across_mm += abs((box.bottom - box.top) * math.sin(angle))
            if wave_mm > across_mm:
                yield (
                    f"is filled with waves of {wave_mm:g} mm, longer than the {across_mm:.1f} mm "
                    "that it is wide; shorten them"
                )
        if fill.gap_mm and not fill.blended:
            gap_mm = drawn_radius_mm(shape) + fill.gap_mm
            bare: dict[str, Any] = {"fill": replace(fill, texture=Uniform(), gap_mm=gap_mm)}
            bare |= dict.fromkeys({"stroke", "dots", "cue", "markers"} & {*shape.__struct_fields__})
            inside = replace(shape, inverted=False, vibration=None, **bare)
            box = box.common(self._canvas)
            if not box.is_empty and not self._shown(inside, box)[1].any():
                yield (
                    f"has a gap of {fill.gap_mm:g} mm before its fill, which leaves nothing of it; "
                    "make the gap smaller"
                )

    def _beside(self, parts: list[_Part]) -> Iterator[str]:
        """Sentences about labels that lie on shapes, and parts with too little blank between."""
        told = 0
        for number, first in enumerate(parts):
            here = self._nowhere()
            here[first.where] = first.felt
            for second in parts[number + 1 :]:
                layers = {first.pattern.factor, second.pattern.factor}
                never = len(layers) == 2 and all(layers)  # they may never be there together
                if never or first.box.grown(_TOGETHER_MM).common(second.box).is_empty:
                    continue
                common = int(here[second.where][second.felt].sum())
                sentences = self._near(first, second) if not common and told < _MOST_SAID else ()
                for sentence in sentences:
                    told += 1
                    yield self._said(first.number, first.pattern, sentence)
                label, other = (
                    (first, second) if isinstance(first.pattern, Label) else (second, first)
                )
                is_over = label is second and label.covers and common == label.felt.size
                if common and isinstance(label.pattern, Label) and not is_over:
                    what = f"lies on {self._called(other)}; move it to where nothing else is felt"
                    yield self._said(label.number, label.pattern, what)

    def _near(self, first: _Part, second: _Part) -> Iterator[str]:
        """Sentence about two parts that are too close together."""
        both = (first, second)
        if first.number == second.number and all(isinstance(one.pattern, Dots) for one in both):
            return  # such as the dots of an image
        vibrating = [one for one in both if _frequencies(one.pattern)]
        other, blank_mm = self._called(second), self._blank_mm(first, second)
        # Nearer, they touch; and where a stroke begins is felt no finer.
        if len(vibrating) == 2 and _LEAST_BLANK_MM <= blank_mm < _TOGETHER_MM:
            yield (
                f"vibrates {blank_mm:.0f} mm from {other}, which vibrates, too; both are under "
                "one finger, and each drowns the other: let one be still, or set them "
                f"{_TOGETHER_MM:g} mm apart"
            )
        elif self._step_mm < blank_mm < _LEAST_BLANK_MM - 1.01 * self._step_mm:
            more = ", which a vibration fills" if vibrating else ""
            yield (
                f"stands less than {_LEAST_BLANK_MM:g} mm from {other}, with {blank_mm:.1f} mm "
                f"of blank{more}"
            )

    def _blank_mm(self, one: _Part, other: _Part) -> float:
        """Distance between two parts that have no place in common; infinite if it is large."""
        first, second = one.edge(), other.edge()
        reach = math.ceil(_TOGETHER_MM / self._step_mm) + 1
        for _ in range(2):  # only what is near the other's box counts
            low, high = second.min(axis=0) - reach, second.max(axis=0) + reach
            first, second = second, first[((first >= low) & (first <= high)).all(axis=1)]
            if not len(second):
                return math.inf
        least = min(float(np.hypot(*(first - place).T).min()) for place in second)
        return max(least - 1.0, 0.0) * self._step_mm


def _open(pattern: AnyPattern, covers: bool) -> Iterator[tuple[AnyPattern, bool]]:
    """Parts of a pattern that are felt by themselves, and whether each hides those before it."""
    if isinstance(pattern, Group) and is_open(pattern):
        for part in pattern.parts:
            yield from _open(part, covers and pattern.operation == "overwrite")
    else:
        yield pattern, covers


def _faint(pattern: AnyPattern, factor: float = 1.0) -> Iterator[tuple[AnyPattern, str]]:
    """Parts that swing too little to be felt."""
    factor *= pattern.amplitude
    if 0.0 < factor < _LEAST_AMPLITUDE:
        yield (
            pattern,
            f"swings by {factor:.2g} of the full swing, which is hardly felt; from "
            f"{_LEAST_AMPLITUDE:g} on it is",
        )
        return
    for part in children(pattern):
        yield from _faint(part, factor)
