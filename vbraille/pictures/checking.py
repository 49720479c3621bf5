"""Faults of a picture that show only in what is felt of it, for its author."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Final

import numpy as np
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.pictures.composing import compose
from vbraille.pictures.index import distance_mm, is_open, label_of, outlines
from vbraille.pictures.keys import crowded
from vbraille.render.braille.models import STRESS2_8X8
from vbraille.render.compiling import SceneMap
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.bounds import Box, bounds
from vbraille.scene.checking import LEAST_BLANK_MM, frequencies, kind_of
from vbraille.scene.patterns import Circle, Dots, Group, Image, Label, PathShape, Polygon
from vbraille.scene.textures import LinearGrating
from vbraille.scene.traversal import children, each
from vbraille.scene.zooming import levels

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.loading import LoadedScene
    from vbraille.scene.patterns import AnyPattern, Fill

_STEP_MM: Final = 0.25  # between the places at which it is looked what is felt
_MOST_STEPS: Final = 1_200  # of these along a side of the canvas
_MOST_PARTS: Final = 300
_MOST_SAID: Final = 20  # pairs of parts
# Ours: two vibrations that are no farther apart are under one fingertip, as wide as the array.
_TOGETHER_MM: Final = 9.0
_FELT, _SOLID = 0.001, 0.98
# Ours: what swings less than so much of the full swing is hardly felt beside what swings fully.
LEAST_AMPLITUDE: Final = 0.2
_GRID: Final = 40  # places along each side of a shape at which it is looked how wide it is


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """A part of an element that is felt by itself, and where, in steps of the canvas.

    Parameters
    ----------
    number
        Number of its element, from 0.
    pattern
        The part.
    covers
        Whether it hides what is written before it.
    top, left
        Row and column of the masks' first place.
    felt, solid
        Where it is felt, and where it hides all that is below; bool[rows, columns].
    """

    number: int
    pattern: AnyPattern
    covers: bool
    top: int
    left: int
    felt: NDArray[np.bool_]
    solid: NDArray[np.bool_]

    @property
    def is_label(self) -> bool:
        """Tell whether the part is braille."""
        return isinstance(self.pattern, Label)

    @property
    def is_dots(self) -> bool:
        """Tell whether the part is dots."""
        return isinstance(self.pattern, Dots)

    @property
    def where(self) -> tuple[slice, slice]:
        """Rows and columns of the masks on the canvas."""
        rows, columns = self.felt.shape
        return slice(self.top, self.top + rows), slice(self.left, self.left + columns)

    def edge(self) -> NDArray[np.int64]:
        """Places on the edge of where it is felt, in steps; int64[n, 2]."""
        around = np.pad(self.felt, 1)
        inner = around[:-2, 1:-1] & around[2:, 1:-1] & around[1:-1, :-2] & around[1:-1, 2:]
        return np.argwhere(self.felt & ~inner) + np.array((self.top, self.left))


def felt_advice(loaded: LoadedScene) -> tuple[str, ...]:
    """List sentences about what cannot be felt as its author means it.

    They are about parts that are hidden, too weak or too close together, labels that lie on shapes,
    fills without room, waves that are longer than their shape, and what no display can show.

    Where parts are there at some zooms only, the picture is looked at from each of these on.
    """
    said = dict.fromkeys(_Check(loaded).advice())
    for label in crowded(loaded):
        text = " ".join(label.text.split())
        said[f'label "{text}" does not fit; map and feel show a number for it with --key'] = None
    for zoom in levels(*loaded.opened.resolved.elements):
        try:
            advice = [*_Check(loaded.zoomed(zoom)).advice()]
        except InputError as error:
            advice = [str(error)]
        said |= {f"at a zoom of {zoom:g}, {one}": None for one in advice if one not in said}
    return tuple(said)


class _Check:
    """Looks through one scene."""

    def __init__(self, loaded: LoadedScene) -> None:
        self._loaded, self._scene = loaded, loaded.scene
        self._known = loaded.boxes()
        canvas = self._scene.canvas
        longest_mm = max(canvas.width_mm, canvas.height_mm)
        self._step_mm = max(_STEP_MM, longest_mm / _MOST_STEPS)
        height, width = canvas.height_mm / self._step_mm, canvas.width_mm / self._step_mm
        self._size = math.ceil(height), math.ceil(width)

    def advice(self) -> Iterator[str]:
        """Give the sentences."""
        try:
            compose(self._loaded, STRESS2_8X8.display, rate_hz=STRESS2_8X8.display.rate_hz)
        except InputError as error:
            yield f"{error}, so that it cannot be felt"
            return
        for number, element in enumerate(self._scene.elements):
            for pattern, sentence in (*_faint(element), *_shapes(element), *self._images(element)):
                yield self._said(number, pattern, sentence)
        found: list[_Part] = []
        for number, element in enumerate(self._scene.elements):
            covers = self._scene.operation == "overwrite"
            for pattern, is_covering in _open(element, covers):
                if len(found) == _MOST_PARTS:
                    yield f"only the first {_MOST_PARTS} parts were looked at for what hides what"
                    break
                part = self._part(number, pattern, covers=is_covering)
                if part is not None:
                    found.append(part)
        yield from self._hidden(found)
        yield from self._beside(found)

    def _images(self, element: AnyPattern) -> Iterator[tuple[AnyPattern, str]]:
        """Images that are down all over, or whose paper is up and not what is drawn on it."""
        for pattern in each(element):
            if not isinstance(pattern, Image) or pattern.outside:
                continue
            intensities = self._loaded.assets.bitmaps[pattern].intensities
            if not intensities.any():
                other = "gray" if pattern.channel == "alpha" else "alpha"
                yield (
                    pattern,
                    (
                        f'is down all over in its channel "{pattern.channel}", so nothing of it '
                        f'is felt; write channel = "{other}", or inverted_source = true'
                    ),
                )
            elif np.median(intensities) == WHOLE and not pattern.inverted_source:
                yield (
                    pattern,
                    (
                        "is up over more than half of it, as black on white paper is; write "
                        "inverted_source = true to feel what is black"
                    ),
                )

    def _said(self, number: int, pattern: AnyPattern, sentence: str) -> str:
        element = self._scene.elements[number]
        whole = f"{kind_of(element)} {label_of(element)}".strip()
        if pattern is not element:
            whole += f", its {kind_of(pattern)} {label_of(pattern)}".rstrip()
        place = self._loaded.place(number)
        return f"{place}: {self._element(number)}, {whole} {sentence}"

    def _element(self, number: int) -> str:
        """Words for an element by its number in its file."""
        return f"element {self._loaded.numbers[number] + 1}"

    def _part(self, number: int, pattern: AnyPattern, *, covers: bool) -> _Part | None:
        """Find where a part is felt; None for one that is everywhere, or nowhere on the canvas."""
        box, step = bounds(pattern, self._known), self._step_mm
        canvas = Box(0.0, 0.0, self._scene.canvas.width_mm, self._scene.canvas.height_mm)
        if box is None or box.common(canvas).is_empty:
            return None
        box = box.common(canvas)
        top, left = int(box.top / step), int(box.left / step)
        rows = np.arange(float(top), min(math.ceil(box.bottom / step), self._size[0]))
        columns = np.arange(float(left), min(math.ceil(box.right / step), self._size[1]))
        alone = replace(self._scene, elements=(pattern,), operation="overwrite")
        shown = SceneMap(alone, self._loaded.assets)
        places = (columns + 0.5) * step, (rows + 0.5) * step
        hides = shown.deflections(*places, is_mask=True, every_layer=True)
        felt = hides >= _FELT
        if isinstance(pattern, Label):
            felt = np.ones_like(felt)
        return _Part(number, pattern, covers, top, left, felt, hides >= _SOLID)

    def _hidden(self, parts: list[_Part]) -> Iterator[str]:
        """Sentences about parts of which nothing is left to feel."""
        covered = np.zeros(self._size, bool)
        for part in reversed(parts):
            under = covered[part.where]
            if part.felt.any() and not (part.felt & ~under).any():
                yield self._said(
                    part.number,
                    part.pattern,
                    "is wholly hidden by what is written after it; write it later, or leave it out",
                )
            if part.covers and not part.pattern.factor:
                under |= part.solid

    def _beside(self, parts: list[_Part]) -> Iterator[str]:
        """Sentences about labels that lie on shapes, and parts with too little blank between."""
        near = math.ceil(LEAST_BLANK_MM / self._step_mm) + 1
        far = math.ceil(_TOGETHER_MM / self._step_mm) + 1
        told = 0
        for first, second in combinations(parts, 2):
            layers = first.pattern.factor, second.pattern.factor
            if all(layers) and layers[0] != layers[1]:
                continue  # they may never be there together
            vibrate = [bool(frequencies(part.pattern)) for part in (first, second)]
            reach = far if all(vibrate) else near
            if any(
                one.start - reach >= other.stop or other.start - reach >= one.stop
                for one, other in zip(first.where, second.where, strict=True)
            ):
                continue
            common = self._common(first, second)
            if common:
                label, other = sorted((first, second), key=lambda part: not part.is_label)
                is_before = other is first and common == label.felt.size and label.covers
                if label.is_label and not is_before:
                    what = f"lies on {self._called(other)}; move it to where nothing else is felt"
                    yield self._said(label.number, label.pattern, what)
                continue
            of_one = first.number == second.number
            if told == _MOST_SAID or (of_one and first.is_dots and second.is_dots):
                continue  # such as the dots of an image
            blank_mm, other = self._blank_mm(first, second, reach), self._called(second)
            # Nearer, they touch; and where a stroke begins is felt no finer.
            if all(vibrate) and LEAST_BLANK_MM <= blank_mm < _TOGETHER_MM:
                what = (
                    f"vibrates {blank_mm:.0f} mm from {other}, which vibrates, too; both are under "
                    "one finger, and each drowns the other: let one be still, or set them "
                    f"{_TOGETHER_MM:g} mm apart"
                )
            elif self._step_mm < blank_mm < LEAST_BLANK_MM - 1.01 * self._step_mm:
                more = ", which a vibration fills" if any(vibrate) else ""
                what = (
                    f"stands less than {LEAST_BLANK_MM:g} mm from {other}, with {blank_mm:.1f} mm "
                    f"of blank{more}"
                )
            else:
                continue
            told += 1
            yield self._said(first.number, first.pattern, what)

    def _called(self, part: _Part) -> str:
        name = self._element(part.number)
        is_whole = part.pattern is self._scene.elements[part.number]
        inner = label_of(part.pattern) or kind_of(part.pattern)
        return name if is_whole else f"the {inner} of {name}"

    def _common(self, one: _Part, other: _Part) -> int:
        """Count the places at which two parts are felt."""
        top, left = max(one.top, other.top), max(one.left, other.left)
        first, second = (part.felt[top - part.top :, left - part.left :] for part in (one, other))
        rows, columns = np.minimum(first.shape, second.shape)
        return int((first[:rows, :columns] & second[:rows, :columns]).sum())

    def _blank_mm(self, one: _Part, other: _Part, reach: int) -> float:
        """Distance between two parts that have no place in common; infinite beyond a reach."""
        first, second = one.edge(), other.edge()
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
    if 0.0 < factor < LEAST_AMPLITUDE:
        yield (
            pattern,
            f"swings by {factor:.2g} of the full swing, which is hardly felt; from "
            f"{LEAST_AMPLITUDE:g} on it is",
        )
        return
    for part in children(pattern):
        yield from _faint(part, factor)


def _shapes(element: AnyPattern) -> Iterator[tuple[AnyPattern, str]]:
    """Shapes whose fill has no room, or waves that are longer than it."""
    for pattern in each(element):
        if not isinstance(pattern, Circle | Polygon | PathShape) or pattern.fill is None:
            continue
        around = outlines(pattern)
        points = np.concatenate(around) if around else np.zeros((1, 2))
        low, high = points.min(axis=0), points.max(axis=0)
        fill: Fill = pattern.fill
        texture = fill.texture
        if isinstance(texture, LinearGrating):
            wave_mm = texture.wave.length
            angle = math.radians(texture.travel_deg)
            width, height = high - low
            across_mm = abs(width * math.cos(angle)) + abs(height * math.sin(angle))
            if wave_mm > across_mm:
                yield (
                    pattern,
                    f"is filled with waves of {wave_mm:g} mm, longer than the "
                    f"{across_mm:.1f} mm that it is wide; shorten them",
                )
        if fill.blended or not fill.gap_mm:
            continue
        places = np.stack(np.meshgrid(*np.linspace(low, high, _GRID).T), axis=-1).reshape(-1, 2)
        room_mm = max(
            min(distance_mm(outline, x_mm, y_mm) for outline in around)
            for x_mm, y_mm in places.tolist()
        )
        stroke_mm = 0.0 if pattern.stroke is None else pattern.stroke.width_mm / 2
        if stroke_mm + fill.gap_mm >= room_mm:
            yield (
                pattern,
                f"has a gap of {fill.gap_mm:g} mm before its fill, which leaves nothing of it; "
                "make the gap smaller",
            )
