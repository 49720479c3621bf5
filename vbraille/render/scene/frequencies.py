"""How fast patterns move by themselves: vibrations, and gratings that travel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.scene.dots import Dots
from vbraille.scene.patterns import Polygon
from vbraille.scene.shapes import Shape
from vbraille.scene.textures import AxialGrating, LinearGrating, RadialGrating, UniformVibration
from vbraille.scene.walking import each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.strokes import Vibration


def highest_hz(pattern: AnyPattern, number: int, rate_hz: float) -> float:
    """Find the highest frequency of what moves in an element by itself; 0 if nothing does.

    Parameters
    ----------
    pattern, number
        The element, and its number in the scene, from 1.
    rate_hz
        Frames a second that show it.

    Raises
    ------
    ValueError
        If a frequency is above half of the rate, so that it would be shown as another.
    """
    highest = 0.0
    for part in each(pattern):
        for hz in _frequencies(part):
            if hz > rate_hz / 2:
                name = part.id or pattern.id
                named = f'"{name}"' if name else f"number {number}"
                raise ValueError(
                    f"element {named} moves at {hz:g} Hz; it can be at most half of the rate, "
                    f"{rate_hz / 2:g} Hz"
                )
            highest = max(highest, hz)
    return highest


def _frequencies(pattern: AnyPattern) -> Iterator[float]:
    """Frequencies of a pattern itself, without those that stand in it."""
    yield from _of(pattern.vibration)
    if isinstance(pattern, Shape):
        if pattern.stroke is not None:
            yield from _of(pattern.stroke.vibration)
            along = pattern.stroke.along
            if along is not None and along.velocity_mm_s:
                yield abs(along.velocity_mm_s) / (along.ridge_mm + along.gap_mm)
        if pattern.dots is not None:
            yield from _of(pattern.dots.dot.vibration)
            yield from _of(pattern.dots.vertex_vibration)
        if isinstance(pattern, Polygon) and pattern.markers is not None:
            yield from _of(pattern.markers.swing)
    elif isinstance(pattern, UniformVibration):
        yield pattern.frequency_hz
    elif isinstance(pattern, LinearGrating | RadialGrating):
        if pattern.velocity_mm_s:
            yield abs(pattern.velocity_mm_s) / (pattern.ridge_mm + pattern.gap_mm)
    elif isinstance(pattern, AxialGrating):
        if pattern.velocity_deg_s:
            yield abs(pattern.velocity_deg_s) / (pattern.ridge_deg + pattern.gap_deg)
    elif isinstance(pattern, Dots):
        yield from _of(pattern.dot.vibration)


def _of(vibration: Vibration | None) -> Iterator[float]:
    if vibration is not None and vibration.amplitude > 0.0:
        yield vibration.frequency_hz
