"""What a scene holds, and what may be hard to feel: the report for its author."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.scene import advising, vibrating
from vbraille.scene.bounds import Box, bounds
from vbraille.scene.labels import Label
from vbraille.scene.walking import each
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from vbraille.scene.opened import OpenedScene
    from vbraille.scene.patterns import AnyPattern, Image
    from vbraille.scene.scene import Scene

_MOST_PAIRS_SAID = 20


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
    """What a scene holds, and what is to be said about it.

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
            vibration_hz=tuple(sorted(vibrating.frequencies(shown))),
        )
        for number, (wrote, shown) in enumerate(
            zip(written.elements, scene.elements, strict=True), 1
        )
    )
    return SceneReport(
        kinds=dict(sorted(counts.items(), key=lambda item: (-item[1], item[0]))),
        elements=elements,
        textures=advising.textures_of(scene),
        vibrations=tuple(_vibrations(scene, elements, known)),
        advice=tuple(_advice(scene, elements)),
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
        for sentence in vibrating.meetings(element, known)
    ]
    yield from _grouped(told, elements)
    for sentence in vibrating.between(scene.operation, scene.elements, known):
        yield f"the scene {sentence}"
    yield from vibrating.alike(found)


def _advice(scene: Scene, elements: Sequence[ElementReport]) -> Iterator[str]:
    yield from advising.of_canvas(scene.canvas)
    if not elements:
        yield "the scene has no elements, so nothing can be felt; write some under [[elements]]"
    told = [
        (number, sentence)
        for number, element in enumerate(scene.elements)
        for sentence in dict.fromkeys(
            advising.of_element(element, elements[number].box, scene.canvas)
        )
    ]
    told += advising.hiding(scene, [element.box for element in elements])
    yield from _grouped(told, elements)
    textures = advising.textures_of(scene)
    if textures > advising.MOST_TEXTURES:
        yield (
            f"there are {textures} different textures; more than {advising.MOST_TEXTURES} are "
            "hard to tell apart"
        )
    pairs, is_all = advising.too_close([element.box for element in elements])
    close = [
        (
            first,
            f"stands less than {advising.LEAST_BLANK_MM:g} mm from element {second + 1}, with "
            f"{blank:.1f} mm of blank"
            + (", which a vibration fills" if _vibrates(elements, first, second) else ""),
        )
        for first, second, blank in pairs[:_MOST_PAIRS_SAID]
    ]
    yield from _grouped(close, elements)
    if len(pairs) > _MOST_PAIRS_SAID:
        yield f"so do {len(pairs) - _MOST_PAIRS_SAID} pairs of elements more"
    if not is_all:
        yield "there are too many elements side by side to look at the blank between all of them"


def _vibrates(elements: Sequence[ElementReport], *numbers: int) -> bool:
    return any(elements[number].vibration_hz for number in numbers)


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
