"""What vibrates in a scene, and what becomes of vibrations that meet: Lévesque 2009, 8.4.5."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from vbraille.scene.bounds import bounds
from vbraille.scene.dots import Dots
from vbraille.scene.patterns import Circle, Group, PathShape, Polygon
from vbraille.scene.shapes import Shape
from vbraille.scene.textures import UniformVibration
from vbraille.scene.walking import children

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from vbraille.scene.bounds import Box
    from vbraille.scene.labels import Label
    from vbraille.scene.patterns import AnyPattern, Image, Operation
    from vbraille.scene.strokes import Vibration

    Boxes = Mapping[Image | Label, Box]

# Frequencies that differ by less cannot be told apart (8.6).
LEAST_DIFFERENCE_HZ = 20.0
# A vibration drowns what is nearer than this (8.6); the distance is that between elements (8.2.1).
LEAST_GAP_MM = 2.5
# Parts of a group that are compared with each other.
_MOST_COMPARED = 200


def frequencies(pattern: AnyPattern) -> set[float]:
    """Frequencies in Hz at which something in a pattern vibrates."""
    found = _own(pattern) | _changed(pattern)
    for part in children(pattern):
        found |= frequencies(part)
    return found


def meetings(pattern: AnyPattern, known: Boxes) -> Iterator[str]:
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
        yield from between(pattern.operation, pattern.parts, known)
    for part in children(pattern):
        yield from meetings(part, known)


def between(operation: Operation, parts: Sequence[AnyPattern], known: Boxes) -> Iterator[str]:
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


def alike(found: set[float]) -> Iterator[str]:
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
    if isinstance(pattern, UniformVibration):
        return {pattern.frequency_hz}
    if isinstance(pattern, Dots):
        return _of(pattern.dot.vibration)
    if not isinstance(pattern, Shape):
        return set()
    found: set[float] = set()
    if pattern.stroke is not None:
        found |= _of(pattern.stroke.vibration)
        if isinstance(pattern, Polygon) and pattern.markers is not None:
            found |= _of(pattern.markers.swing)
    if pattern.dots is not None:
        found |= _of(pattern.dots.dot.vibration) | _of(pattern.dots.vertex_vibration)
    return found


def _changed(pattern: AnyPattern) -> set[float]:
    return _of(pattern.vibration)


def _of(vibration: Vibration | None) -> set[float]:
    return {vibration.frequency_hz} if vibration is not None and vibration.amplitude else set()


def _masked(one: set[float], other: set[float]) -> str:
    """What becomes of two vibrations of which one masks the other."""
    differences = {abs(a - b) for a in one for b in other}
    if differences == {0.0}:
        return "their swings are narrower and weaker than either's"
    if min(differences - {0.0}) < LEAST_DIFFERENCE_HZ:
        return "they make sharp peaks, which may harm the actuators"
    return "they beat"


def _hz(found: set[float]) -> str:
    return f"{' and '.join(f'{one:g}' for one in sorted(found))} Hz"
