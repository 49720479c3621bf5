"""Textures of OpenLatero's files: what covers the whole surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.scene.measures import LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, MOST_MM
from vbraille.scene.openlatero.context import changed, timed, vibration
from vbraille.scene.openlatero.gratings import (
    read_axial,
    read_double,
    read_linear,
    read_radial,
    travelling,
)
from vbraille.scene.openlatero.groups import joined
from vbraille.scene.patterns import Circle, Tile
from vbraille.scene.strokes import Stroke
from vbraille.scene.textures import LinearGrating, Uniform, UniformVibration
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.scene.openlatero.context import GenContext
    from vbraille.scene.openlatero.elements import GenElement
    from vbraille.scene.patterns import AnyPattern

_CUES = (
    "none",
    "vibration bands",
    "superposed bands",
    "superposed vibration bands",
    "disabling bands",
    "blending bands",
)


def read_texture(element: GenElement, context: GenContext) -> AnyPattern | None:
    """Texture of an element; None if there is nothing to show.

    Raises
    ------
    ValueError
        If there can be no such texture.
    """
    kind = element.attribute("subtype")
    reader = _READERS.get(kind)
    if reader is None:
        what = f'"{kind}"' if kind else "missing"
        near = nearest(kind, _READERS)
        element.forget()
        element.say(f"the subtype of this texture is {what}, which is not known{near}; left out")
        return None
    element.skip("icon")
    if element.one("td_centric") is not None:
        element.say("it stands still under the display there (td_centric), which is not shown")
    pattern = reader(element, context)
    if pattern is None:
        element.forget()
    return pattern


def _null(element: GenElement, context: GenContext) -> AnyPattern:
    """Nothing, which has no changes either."""
    del context
    element.forget()
    return Uniform(level=0.0)


def _plain(element: GenElement, context: GenContext) -> AnyPattern:
    element.skip("motion")  # the same everywhere
    return _changed(Uniform(), element, context)


def _vibration(element: GenElement, context: GenContext) -> AnyPattern:
    element.skip("motion")
    hertz = element.number("freq", MOST_FREQUENCY_HZ, LEAST_FREQUENCY_HZ, MOST_FREQUENCY_HZ, "Hz")
    return _changed(UniformVibration(frequency_hz=timed(hertz, context)), element, context)


def _linear(element: GenElement, context: GenContext) -> AnyPattern | None:
    return _graded(read_linear, element, context)


def _radial(element: GenElement, context: GenContext) -> AnyPattern | None:
    return _graded(read_radial, element, context)


def _axial(element: GenElement, context: GenContext) -> AnyPattern | None:
    return _graded(read_axial, element, context)


def _graded(
    reader: Callable[[GenElement], AnyPattern | None], element: GenElement, context: GenContext
) -> AnyPattern | None:
    pattern = reader(element)
    if pattern is None:
        return None
    moved = travelling(pattern, element) if isinstance(pattern, LinearGrating) else None
    if isinstance(pattern, Uniform):
        element.skip("motion")  # the same everywhere
    elif moved is None:
        say_motion(element)
    return _changed(moved or pattern, element, context)


def _double(element: GenElement, context: GenContext) -> AnyPattern | None:
    gratings = read_double(element)
    if gratings is None:
        return None
    pattern = joined(element, list(gratings))
    return None if pattern is None else _unread(pattern, element, context)


def _combo(element: GenElement, context: GenContext) -> AnyPattern | None:
    parts = [context.pattern(part) for part in element.every("Pattern")]
    say_motion(element)
    pattern = joined(element, parts)
    return None if pattern is None else _changed(pattern, element, context)


def _blend(element: GenElement, context: GenContext) -> AnyPattern | None:
    """A texture by the hand's movement, of which the first is shown."""
    parts = element.every("Pattern")
    element.say("it depends on the hand's movement there; its first texture is shown")
    element.part("Modulator").forget()
    element.skip("Modulator")
    say_motion(element)
    if len(parts) == 2:
        parts[1].forget()
        pattern = context.pattern(parts[0])
    else:
        for part in parts:
            part.forget()
        element.say(f"it has {len(parts)} textures instead of 2; OpenLatero's own are taken")
        pattern = LinearGrating(ridge_mm=8.0, wave_angle_deg=90.0)
    return None if pattern is None else _changed(pattern, element, context)


def _motion(element: GenElement, context: GenContext) -> AnyPattern | None:
    cue = element.word("cue_type", _CUES, "none")
    element.skip("direction", "velocity")
    if cue != "none":
        element.say(f'the moving bands of its cue "{cue}" are not shown')
    part = element.one("Pattern")
    pattern = LinearGrating(ridge_mm=8.0) if part is None else context.pattern(part)
    return None if pattern is None else _unread(pattern, element, context)


def _tile(element: GenElement, context: GenContext) -> AnyPattern | None:
    width = element.number("grid_width", 20.0, 0.1, MOST_MM)
    height = element.number("grid_height", 20.0, 0.1, MOST_MM)
    found = element.one("Pattern")
    part: AnyPattern | None
    if found is None:
        part = Circle(center_mm=(10.0, 10.0), radius_mm=5.0, stroke=Stroke(width_mm=1.0))
    else:
        part = context.pattern(found)
    if part is None:
        return None
    tile = Tile(width_mm=width, height_mm=height, part=part)
    if context.as_shown and found is not None:
        # It reads the changes of its pattern as its own.
        tile = _changed(tile, found, context)
    return _unread(tile, element, context)


def _changed(pattern: AnyPattern, element: GenElement, context: GenContext) -> AnyPattern:
    """Pattern with the changes that an element names."""
    amplitude = element.number("amplitude", 1.0, 0.0, 1.0, "share")
    inverted = element.switch("invert", False)
    return changed(pattern, amplitude, inverted, vibration(element, context))


def _unread(pattern: AnyPattern, element: GenElement, context: GenContext) -> AnyPattern:
    """Pattern with changes that an element names, although OpenLatero does not read them there."""
    moves = isinstance(pattern, Tile)
    made = _changed(pattern, element, context)
    if made is not pattern:
        names = "its amplitude, invert and vibration"
        if context.as_shown:
            element.say(f"{names} are ignored, as OpenLatero does")
            made = pattern
        else:
            element.say(f"{names} are as the file says; OpenLatero does not read them here")
    if moves:
        say_motion(element)
    return made


def say_motion(element: GenElement) -> None:
    """Say that a texture's motion is not shown, if it has one."""
    motion = element.one("motion")
    if motion is not None:
        if motion.switch("enable", False):
            motion.say("its motion is not shown")
        motion.forget()


_READERS: dict[str, Callable[[GenElement, GenContext], AnyPattern | None]] = {
    "Null": _null,
    "Plain": _plain,
    "Vibration": _vibration,
    "LinearGrating": _linear,
    "RadialGrating": _radial,
    "AxialGrating": _axial,
    "DoubleLinearGrating": _double,
    "Combo": _combo,
    "Blend": _blend,
    "Motion": _motion,
    "Pattern": _tile,
}
SUBTYPES = tuple(_READERS)
