"""Words for scenes: what each pattern is, when signals are 1, and what vibrates."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import msgspec

from vbraille.pictures.words import plain
from vbraille.scene.patterns import Pattern
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch
from vbraille.scene.traversal import vibrations

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.scene import Scene
    from vbraille.scene.signals import AnySignal

_TOGETHER = {
    "overwrite": "one on top of the other",
    "multiply": "each masking the others",
    "add": "added",
    "weighted": "added by weights",
    "maximum": "the largest of them",
    "blend": "blended by a third",
}
# Directions on the canvas, an eighth of a turn after each other, from +x towards +y.
WAYS = (
    *("right", "right and down", "down", "left and down"),
    *("left", "left and up", "up", "right and up"),
)
_AT_REST = {"high": "1 at rest", "low": "0 at rest", "keep": "at rest what it was before"}
# Fields that are said before all others, or are no part of what is felt.
_UNSAID = ("id", "title", "description", "words", "sound")
_UNITS = {"_mm_s": " mm/s", "_deg_s": "°/s", "_mm": " mm", "_deg": "°", "_hz": " Hz", "_s": " s"}
_MOST_VALUES = 8  # of a list


def scene_lines(scene: Scene) -> list[str]:
    """Tell what a scene holds, a line for each thing: "label: value".

    The lines are title and description if it has them, its size, how many elements it has and what
    each is, its signals, and what vibrates.
    """
    told = [("title", scene.title), ("description", scene.description)]
    lines = [f"{label}: {plain(text)}" for label, text in told if text.strip()]
    lines.append(f"size: {scene.canvas.width_mm:g} × {scene.canvas.height_mm:g} mm")
    lines.append(f"elements: {len(scene.elements)}, {_TOGETHER[scene.operation]}")
    for number, element in enumerate(scene.elements, 1):
        lines.append(f"element {number}: {pattern_words(element)}")
    lines += [f"signal {plain(name)}: {signal_words(one)}" for name, one in scene.signals.items()]
    shaking = [
        f"{plain(element.title or element.id) or number}, {', '.join(dict.fromkeys(swings))}"
        for number, element in enumerate(scene.elements, 1)
        if (swings := [f"{one.frequency_hz:g} Hz" for one in vibrations(element)])
    ]
    lines += [f"vibrates: element {said}" for said in shaking] or ["vibrates: nothing"]
    return lines


def signal_words(signal: AnySignal) -> str:
    """Tell in a line when a signal is 1 and when it is 0."""
    match signal:
        case Speed():
            end = signal.below_mm_s + signal.transition_mm_s
            words = f"1 under a hand slower than {signal.below_mm_s:g} mm/s, 0 from {end:g} mm/s on"
            if not signal.delay_s:
                return words
            return f"{words}; it waits {signal.delay_s:g} s and rises as long"
        case Direction():
            end = signal.tolerance_deg + signal.transition_deg
            way = _way(signal.angle_deg)
            back = _way(signal.angle_deg + 180.0)
            return (
                f"1 under a hand that goes {f'{way} or {back}' if signal.axis else way} within "
                f"{signal.tolerance_deg:g}°, 0 from {end:g}° on, {_AT_REST[signal.at_rest]}"
            )
        case Switch():
            levels = zip(signal.states or map(str, range(1, 9)), signal.levels, strict=False)
            states = ", ".join(f"{plain(state)} {level:g}" for state, level in levels)
            title = f"{plain(signal.title)}, " if signal.title else ""
            return f"{title}key {signal.key}: {states}"
        case Pulse():
            return f"{signal.shape}, again every {signal.period_s:g} s"
        case Product():
            return " × ".join(map(plain, signal.of))
        case Inverse():
            return f"1 - {plain(signal.of)}"


def _way(angle_deg: float) -> str:
    """Tell a direction by the nearest eighth of a turn, and by its angle if it is between two."""
    turned = angle_deg % 360.0
    eighth, beside = divmod(turned + 22.5, 45.0)
    way = WAYS[int(eighth) % len(WAYS)]
    return way if math.isclose(beside, 22.5) else f"at {turned:g}° ({way})"


def pattern_words(pattern: Pattern) -> str:
    """Tell in a line what a pattern is: its name, its kind, and what is not usual of it.

    >>> from vbraille.scene.patterns import Circle
    >>> from vbraille.scene.patterns import Stroke
    >>> pattern_words(Circle(center_mm=(5, 9), radius_mm=4, stroke=Stroke(), title="sun"))
    'sun, circle, stroke (width 4 mm), center 5, 9 mm, radius 4 mm'
    """
    kind = str(pattern.__struct_config__.tag).replace("-", " ")
    name = plain(pattern.title or pattern.id)
    return ", ".join([*([name] if name else []), kind, *_fields(pattern)])


def _fields(value: msgspec.Struct) -> Iterator[str]:
    """Words for the first field of a pattern or of a part of one, and for all that are unusual."""
    common = Pattern.__struct_fields__
    fields = sorted(msgspec.structs.fields(value), key=lambda field: field.name in common)
    for number, field in enumerate(fields):
        one = getattr(value, field.name)
        if one is None or field.name in _UNSAID or (number and one == field.default):
            continue
        yield _value_words(field.name, one)


def _value_words(name: str, value: Any) -> str:
    """Words for a value by the name of its field, which ends in its unit."""
    end = next((end for end in _UNITS if name.endswith(end)), "")
    label, unit = name.removesuffix(end).replace("_", " "), _UNITS.get(end, "")
    if isinstance(value, bool):
        return label if value else f"not {label}"
    if isinstance(value, int | float):
        return f"{label} {value:g}{unit}"
    if isinstance(value, Pattern):
        return f"{label} ({pattern_words(value)})"
    if isinstance(value, msgspec.Struct):
        return f"{label} ({', '.join(_fields(value))})"
    if isinstance(value, tuple):
        if all(isinstance(one, int | float) for one in value):
            return f"{label} {', '.join(f'{one:g}' for one in value)}{unit}"
        more = "; …" if len(value) > _MOST_VALUES else ""
        inner = "; ".join(_value_words("", one).strip("() ") for one in value[:_MOST_VALUES])
        return f"{len(value)} {label} ({inner}{more}){unit}"
    return f"{label} {plain(str(value))}"
