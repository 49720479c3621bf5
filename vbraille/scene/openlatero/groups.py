"""Groups of patterns of OpenLatero's files, toggles and sounds."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.scene.openlatero.shapes import operation_of
from vbraille.scene.patterns import Group, Tile
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    Uniform,
    UniformVibration,
)
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.scene.openlatero.context import Context
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern, Operation

OPERATIONS: dict[str, Operation] = {
    "multiply": "multiply",
    "add": "add",
    "max": "maximum",
    "blend": "blend",
    "overwrite": "overwrite",
}
_TEXTURES = (Uniform, UniformVibration, LinearGrating, RadialGrating, AxialGrating, Tile)


def read_group(element: GenElement, context: Context) -> AnyPattern | None:
    """Group of an element; None if there is nothing to show."""
    return joined(element, [context.pattern(part) for part in element.every("Pattern")])


def joined(element: GenElement, parts: list[AnyPattern | None]) -> AnyPattern | None:
    """Parts put together as an element says; None if there is nothing to show.

    Parameters
    ----------
    element
        The group, with its operation.
    parts
        Its parts, of which None are left out.
    """
    name = operation_of(element, "max")
    if not parts:
        element.say("it has no patterns; left out")
        return None
    if name == "reactive":
        element.part("operation").forget()
        element.say("it depends on the hand's movement there; its first pattern is shown")
        return parts[0]
    if name == "blend":
        return _blended(element, parts)
    if name == "multiply" and None in parts:
        element.say("a part of a product is left out, so there is nothing of it to show; left out")
        return None
    found = [part for part in parts if part is not None]
    if name == "overwrite":
        _say_layers(element, found)
    if len(found) < 2:
        return found[0] if found else None
    return Group(operation=OPERATIONS[name], parts=tuple(found))


def _blended(element: GenElement, parts: list[AnyPattern | None]) -> AnyPattern | None:
    """Blend of two patterns by a third: theirs weighs the first, and ours the second."""
    if len(parts) < 3:
        element.say(f"a blend is of 3 patterns, and this has {len(parts)}; left out")
        return None
    if len(parts) > 3:
        element.say(f"a blend is of 3 patterns; {count(len(parts) - 3, 'more')} left out")
    first, second, by = (Uniform(level=0.0) if part is None else part for part in parts[:3])
    return Group(operation="blend", parts=(second, first), by=by)


def _say_layers(element: GenElement, parts: list[AnyPattern]) -> None:
    """Say so if a texture covers what is below it, which it does in part only there."""
    if any(isinstance(part, _TEXTURES) for part in parts[1:]):
        element.say("a texture hides all below it here, and only where it is up there")


def read_toggle(element: GenElement, context: Context) -> AnyPattern | None:
    """First pattern of two that a button swaps."""
    parts = element.every("Pattern")
    if len(parts) < 2:
        element.forget()
        element.say(f"a toggle is of 2 patterns, and this has {len(parts)}; left out")
        return None
    for part in parts[1:]:
        part.forget()
    element.say("a button swaps two patterns there; the first is shown")
    return context.pattern(parts[0])


def read_audio(element: GenElement, context: Context) -> None:
    """Sounds, which are not played."""
    del context
    sounds = count(len(element.every("sound")), "sound")
    element.forget()
    element.say(f"its {sounds} are not played; left out" if sounds[0] != "1" else
                "its sound is not played; left out")  # fmt: skip
