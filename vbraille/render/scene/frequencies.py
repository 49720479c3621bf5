"""How fast patterns move by themselves: vibrations, and gratings that travel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.scene.patterns import Circle, Dots, Line, Path, Polygon
from vbraille.scene.textures import AxialGrating, LinearGrating, RadialGrating, UniformVibration
from vbraille.scene.walking import each

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.patterns import AnyPattern
    from vbraille.scene.strokes import Vibration


def frequency_hz(pattern: AnyPattern) -> float:
    """Highest frequency of what moves in a pattern by itself; 0 if nothing does."""
    return max((hz for part in each(pattern) for hz in _frequencies(part)), default=0.0)


def check_rate(pattern: AnyPattern, number: int, rate_hz: float) -> None:
    """Compare the frequencies of an element with the rate of the frames that show it.

    Raises
    ------
    ValueError
        If one is above half of the rate, so that it would be shown as another.
    """
    for part in each(pattern):
        for hz in _frequencies(part):
            if hz > rate_hz / 2:
                name = f'"{part.id or pattern.id}"' if part.id or pattern.id else f"number {number}"
                raise ValueError(
                    f"element {name} moves at {hz:g} Hz; it can be at most half of the rate, "
                    f"{rate_hz / 2:g} Hz"
                )


def _frequencies(pattern: AnyPattern) -> Iterator[float]:
    """Frequencies of a pattern itself, without those that stand in it."""
    yield from _of(pattern.vibration)
    if isinstance(pattern, UniformVibration):
        yield pattern.frequency_hz
    elif isinstance(pattern, LinearGrating | RadialGrating):
        if pattern.velocity_mm_s:
            yield abs(pattern.velocity_mm_s) / (pattern.ridge_mm + pattern.gap_mm)
    elif isinstance(pattern, AxialGrating):
        if pattern.velocity_deg_s:
            yield abs(pattern.velocity_deg_s) / (pattern.ridge_deg + pattern.gap_deg)
    elif isinstance(pattern, Dots):
        yield from _of(pattern.dot.vibration)
    elif isinstance(pattern, Line | Circle | Polygon | Path):
        if pattern.stroke is not None:
            yield from _of(pattern.stroke.vibration)
            along = pattern.stroke.along
            if along is not None and along.velocity_mm_s:
                yield abs(along.velocity_mm_s) / (along.ridge_mm + along.gap_mm)
        if pattern.dots is not None:
            yield from _of(pattern.dots.dot.vibration)
            yield from _of(pattern.dots.vertex_vibration)
        if isinstance(pattern, Polygon) and pattern.markers is not None:
            yield from _of(pattern.markers.vibration)


def _of(vibration: Vibration | None) -> Iterator[float]:
    if vibration is not None and vibration.amplitude > 0.0:
        yield vibration.frequency_hz
