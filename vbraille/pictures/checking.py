"""Faults of a picture that show only in what is felt of it, for its author."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from msgspec.structs import replace

from vbraille.errors import InputError
from vbraille.pictures.composing import compose
from vbraille.pictures.index import is_open, label_of
from vbraille.pictures.keys import crowded
from vbraille.render.braille.models import STRESS2_8X8
from vbraille.render.compiling import SceneMap
from vbraille.scene.bitmap import WHOLE
from vbraille.scene.bounds import Box, around, bounds, drawn_radius_mm
from vbraille.scene.checking import LEAST_BLANK_MM, frequencies, kind_of
from vbraille.scene.patterns import Circle, Dots, Group, Image, Label, PathShape, Polygon
from vbraille.scene.textures import LinearGrating, Uniform
from vbraille.scene.traversal import children, each, points_of
from vbraille.scene.zooming import levels

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.pictures.loading import LoadedScene
    from vbraille.scene.patterns import AnyPattern

_STEP_MM: Final = 0.25  # between the places at which it is looked what is felt
_MOST_STEPS: Final = 1_200  # of these along a side of the canvas
_MOST_PARTS: Final = 300
_MOST_SAID: Final = 20  # pairs of parts
# Ours: two vibrations that are no farther apart are under one fingertip, as wide as the array.
_TOGETHER_MM: Final = 9.0
_FELT, _SOLID = 0.001, 0.98
# Ours: what swings less than so much of the full swing is hardly felt beside what swings fully.
_LEAST_AMPLITUDE: Final = 0.2


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """A part of an element that is felt by itself, and where.

    Parameters
    ----------
    number
        Number of its element, from 0.
    pattern
        The part.
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
        size = self._scene.canvas.width_mm, self._scene.canvas.height_mm
        self._canvas = Box(0.0, 0.0, *size)
        self._step_mm = max(_STEP_MM, max(size) / _MOST_STEPS)

    def advice(self) -> Iterator[str]:
        """Give the sentences."""
        try:
            compose(self._loaded, STRESS2_8X8.display, rate_hz=STRESS2_8X8.display.rate_hz)
        except InputError as error:
            yield f"{error}, so that it cannot be felt"
            return
        parts: list[_Part] = []
        for number, element in enumerate(self._scene.elements):
            for pattern, sentence in (*_faint(element), *self._alone(element)):
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
        element = self._scene.elements[number]
        whole = f"{kind_of(element)} {label_of(element)}".strip()
        if pattern is not element:
            whole += f", its {kind_of(pattern)} {label_of(pattern)}".rstrip()
        return f"{self._loaded.place(number)}: {self._element(number)}, {whole} {sentence}"

    def _element(self, number: int) -> str:
        """Words for an element by its number in its file."""
        return f"element {self._loaded.numbers[number] + 1}"

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

    def _alone(self, element: AnyPattern) -> Iterator[tuple[AnyPattern, str]]:
        """Images whose lines are down, and shapes without room for their fill or its waves."""
        for pattern in each(element):
            sentences: Iterator[str] = iter(())
            if isinstance(pattern, Circle | Polygon | PathShape):
                sentences = self._filled(pattern)
            elif isinstance(pattern, Image) and not pattern.outside:
                sentences = self._image(pattern)
            for sentence in sentences:
                yield pattern, sentence

    def _image(self, image: Image) -> Iterator[str]:
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

    def _filled(self, shape: Circle | Polygon | PathShape) -> Iterator[str]:
        fill = shape.fill
        if fill is None:
            return
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
                if not first.box.grown(_TOGETHER_MM).common(second.box).is_empty:
                    layers = {first.pattern.factor, second.pattern.factor}
                    if len(layers) == 2 and all(layers):
                        continue  # they may never be there together
                    common = int(here[second.where][second.felt].sum())
                    if common:
                        yield from self._on(first, second, common)
                    elif told < _MOST_SAID:
                        for sentence in self._near(first, second):
                            told += 1
                            yield self._said(first.number, first.pattern, sentence)

    def _on(self, first: _Part, second: _Part, common: int) -> Iterator[str]:
        """Sentence about a label that has places in common with what it does not cover."""
        label, other = (first, second) if isinstance(first.pattern, Label) else (second, first)
        is_over = label is second and label.covers and common == label.felt.size
        if isinstance(label.pattern, Label) and not is_over:
            what = f"lies on {self._called(other)}; move it to where nothing else is felt"
            yield self._said(label.number, label.pattern, what)

    def _near(self, first: _Part, second: _Part) -> Iterator[str]:
        """Sentence about two parts that are too close together."""
        if first.number == second.number and all(
            isinstance(one.pattern, Dots) for one in (first, second)
        ):
            return  # such as the dots of an image
        vibrating = [one for one in (first, second) if frequencies(one.pattern)]
        other, blank_mm = self._called(second), self._blank_mm(first, second)
        # Nearer, they touch; and where a stroke begins is felt no finer.
        if len(vibrating) == 2 and LEAST_BLANK_MM <= blank_mm < _TOGETHER_MM:
            yield (
                f"vibrates {blank_mm:.0f} mm from {other}, which vibrates, too; both are under "
                "one finger, and each drowns the other: let one be still, or set them "
                f"{_TOGETHER_MM:g} mm apart"
            )
        elif self._step_mm < blank_mm < LEAST_BLANK_MM - 1.01 * self._step_mm:
            more = ", which a vibration fills" if vibrating else ""
            yield (
                f"stands less than {LEAST_BLANK_MM:g} mm from {other}, with {blank_mm:.1f} mm "
                f"of blank{more}"
            )

    def _called(self, part: _Part) -> str:
        name = self._element(part.number)
        is_whole = part.pattern is self._scene.elements[part.number]
        return (
            name if is_whole else f"the {label_of(part.pattern) or kind_of(part.pattern)} of {name}"
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
