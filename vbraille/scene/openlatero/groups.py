"""Groups of patterns of OpenLatero's files, and toggles."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, Literal

from msgspec.structs import replace

from vbraille.scene.openlatero.context import Kinds
from vbraille.scene.openlatero.elements import ANGLE, OFF, NumberField, WordField
from vbraille.scene.openlatero.shapes import operation_of
from vbraille.scene.patterns import Dots, Group, Image, Moving, Shape, Tile
from vbraille.scene.signals import Direction, Speed, Switch
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    Uniform,
    UniformVibration,
)
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern, Operation

ROWS = Kinds()

OPERATIONS: dict[str, Operation] = {
    "multiply": "multiply",
    "add": "add",
    "max": "maximum",
    "blend": "blend",
    "overwrite": "overwrite",
}
_MODULATORS: Final = ("Directional", "Velocity")
_AT_REST: Final[dict[str, Literal["high", "low", "keep"]]] = {
    "high": "high",
    "low": "low",
    "toggle": "keep",
}
_TEXTURES = (
    Uniform, UniformVibration, LinearGrating, RadialGrating, AxialGrating, Tile, Moving
)  # fmt: skip


_SPEED = NumberField(5.0, 0.1, 1000.0, "mm/s")
VELOCITY = {
    "limit": NumberField(5.0, 0.0, 1000.0, "mm/s"),
    "transition": _SPEED,
    "delay": NumberField(500.0, 0.0, 20_000.0, "ms"),
}
DIRECTION = {
    "low_velocity_mode": WordField("toggle", tuple(_AT_REST)),
    "direction": ANGLE,
    "symmetric": OFF,
    "direction_tolerance": NumberField(30.0, 0.0, 180.0, "°"),
    "direction_transition": NumberField(20.0, 0.1, 180.0, "°"),
    "velocity_tolerance": NumberField(0.0, 0.0, 1000.0, "mm/s"),
    "velocity_transition": _SPEED,
}


@ROWS.row("Group")
def read_group(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Group of an element; None if there is nothing to show."""
    return joined(element, [context.pattern(part) for part in element.every("Pattern")], context)


def reacting(
    first: AnyPattern | None, second: AnyPattern | None, modulator: GenElement, context: GenContext
) -> AnyPattern:
    """Blend of two patterns by the hand's movement; it is the first where the modulator is 1.

    Raises
    ------
    ValueError
        If the scene has too many signals.
    """
    kind = modulator.chosen(modulator.attribute("type"), _MODULATORS, "Directional")
    signal = (_velocity if kind == "Velocity" else _direction)(modulator)
    by = SignalLevel(name=context.signal("slow" if kind == "Velocity" else "way", signal))
    nothing = Uniform(level=0.0)
    parts = (nothing if second is None else second, nothing if first is None else first)
    return Group(operation="blend", parts=parts, by=by)


def _velocity(modulator: GenElement) -> Speed:
    modulator.fields = VELOCITY
    return Speed(
        below_mm_s=modulator["limit"],
        transition_mm_s=modulator["transition"],
        # Theirs is the time until it has risen: half of it waits.
        delay_s=modulator["delay"] / 2000.0,
    )


def _direction(modulator: GenElement) -> Direction:
    modulator.fields = DIRECTION
    return Direction(
        angle_deg=math.fmod(modulator["direction"], 360.0),
        axis=modulator["symmetric"],
        tolerance_deg=modulator["direction_tolerance"],
        transition_deg=modulator["direction_transition"],
        at_rest=_AT_REST[modulator["low_velocity_mode"]],
        below_mm_s=modulator["velocity_tolerance"],
        slow_transition_mm_s=modulator["velocity_transition"],
    )


def joined(
    element: GenElement, parts: list[AnyPattern | None], context: GenContext
) -> AnyPattern | None:
    """Parts put together as an element says; None if there is nothing to show.

    Parameters
    ----------
    element
        The group, with its operation.
    parts
        Parts of it, of which None are left out.
    context
        How the file is read.

    Raises
    ------
    ValueError
        If the scene has too many signals.
    """
    sounds = [one for part in parts for one in _sounds(part)]
    if sounds:  # which are heard, and change nothing of what is felt
        felt = joined(element, [None if _sounds(part) else part for part in parts], context)
        shown = [] if felt is None else [felt]
        if isinstance(felt, Group) and felt.operation in ("maximum", "add"):
            return replace(felt, parts=(*felt.parts, *sounds))
        return Group(operation="maximum", parts=(*shown, *sounds))
    name = operation_of(element, "max")
    if not parts:
        element.say("it has no patterns; left out")
        return None
    if name == "reactive":
        modulator = element.part("operation").part("Modulator")
        if len(parts) != 2:
            element.say(f"a reactive group is of 2 patterns, and this has {len(parts)}")
        first, second = (*parts, None)[:2]
        return reacting(first, second, modulator, context)
    if name == "blend":
        return _blended(element, parts)
    if name == "multiply" and None in parts:
        element.say("a part of a product is left out, so there is nothing of it to show; left out")
        return None
    found = [part for part in parts if part is not None]
    if name == "overwrite":
        _say_layers(element, found, context)
    if len(found) < 2:
        return found[0] if found else None
    return Group(operation=OPERATIONS[name], parts=tuple(found))


def _sounds(part: AnyPattern | None) -> tuple[AnyPattern, ...]:
    """Masks of sounds, if a part is of these alone."""
    found = part.parts if isinstance(part, Group) else () if part is None else (part,)
    return found if all(one.sound for one in found) else ()


def _blended(element: GenElement, parts: list[AnyPattern | None]) -> AnyPattern | None:
    """Blend of two patterns by a third: theirs weighs the first, and ours the second."""
    if len(parts) < 3:
        element.say(f"a blend is of 3 patterns, and this has {len(parts)}; left out")
        return None
    if len(parts) > 3:
        element.say(f"a blend is of 3 patterns; {count(len(parts) - 3, 'more')} left out")
    first, second, by = (Uniform(level=0.0) if part is None else part for part in parts[:3])
    return Group(operation="blend", parts=(second, first), by=by)


def _say_layers(element: GenElement, parts: list[AnyPattern], context: GenContext) -> None:
    """Say so where a part hides something else of what is below it than it does there."""
    for part in parts[1:]:
        own = context.element_of(part) or element
        for sentence in dict.fromkeys(_hides_otherwise(part)):
            own.say(sentence)


def _hides_otherwise(part: AnyPattern) -> Iterator[str]:
    """Sentences about what a part hides here and there."""
    if isinstance(part, _TEXTURES) or (isinstance(part, Group) and part.by is not None):
        yield "a texture hides all below it here, and only where it is up there"
    elif isinstance(part, Group):
        if part.operation == "overwrite" and len(part.parts) > 1:
            yield "where its parts overlap it hides more of what is below here than there"
        for inner in part.parts:
            yield from _hides_otherwise(inner)
    elif isinstance(part, Image):
        if not part.nearest:
            yield "it hides what is around it by other pixels here than there"
    elif isinstance(part, Dots):
        if part.dot.across is not None:
            yield _RIPPLED
    elif isinstance(part, Shape):
        if part.dots is not None:
            yield "its dots hide what is below them here, and all of their stroke does there"
        elif part.stroke is None:
            yield "its stroke, of which there is nothing, hides nothing here"
        elif part.stroke.across is not None:
            yield _RIPPLED
        if part.is_cued_over:
            yield "its cue hides a little more of what is below here, where its edge is"


_RIPPLED = "its ripples hide as much as they are up here, and its profile without them does there"


@ROWS.row("Toggle")
def _toggle(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Two patterns that a key swaps, as a button does there."""
    parts = element.every("Pattern")
    if len(parts) != 2:
        element.forget()
        element.say(f"a toggle is of 2 patterns, and this has {len(parts)}; left out")
        return None
    first, second = (context.pattern(part) for part in parts)
    shown = context.signal("first", Switch(title="button", levels=(1.0, 0.0)))
    other = context.signal("second", Switch(title="button", levels=(0.0, 1.0)))
    named = ((first, shown), (second, other))
    layers = tuple(_layer(part, factor) for part, factor in named if part is not None)
    return Group(operation="maximum", parts=layers) if layers else None


def _layer(pattern: AnyPattern, factor: str) -> AnyPattern:
    if pattern.factor:
        pattern = Group(operation="maximum", parts=(pattern,))
    return replace(pattern, factor=factor)
