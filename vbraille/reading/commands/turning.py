"""Commands that change how the braille feels, while the hand moves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.errors import VbrailleError
from vbraille.reading.cues import Cue
from vbraille.render.braille.knobs import (
    KNOBS,
    fixed,
    next_mapping,
    obstacle,
    say_mapping,
)
from vbraille.wording import spelled

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader
    from vbraille.render.braille.knobs import StyleKnob
    from vbraille.render.braille.style import BrailleStyle


def turn(name: str, steps: int) -> Callable[[Reader], None]:
    """Make a command that turns a knob up or down, as far as it goes.

    Parameters
    ----------
    name
        Name of the knob, such as "texture" or "dot_width_mm"; see `knobs.KNOBS`.
    steps
        Number of the knob's steps; negative turns it down.
    """
    knob = KNOBS[name]

    def handler(reader: Reader) -> None:
        after = knob.turned(knob.value(reader.style), steps)
        _turn_knob(reader, knob, after, "most" if steps > 0 else "least")

    return handler


def turn_to(reader: Reader, name: str, value: float) -> None:
    """Turn a knob to a value, as far as it goes; what it has already is not told again.

    Parameters
    ----------
    reader
        Reader whose style it is.
    name
        Name of the knob, as for `turn`.
    value
        Value that is wanted, a finite number.
    """
    knob = KNOBS[name]
    before = knob.value(reader.style)
    if value != before:
        _turn_knob(reader, knob, knob.nearest(value), "most" if value > before else "least")


def change_mapping(reader: Reader) -> None:
    """Take the next way in which actuators show dots, of those that the display can show."""
    style, display = reader.style, reader.engine.display
    mapping = next_mapping(style, display)
    if mapping == style.mapping:
        _stop(reader, f"{say_mapping(mapping)}, the only one for this display")
    else:
        _turn(reader, "mapping", mapping, say_mapping(mapping))


def undo_turn(reader: Reader) -> None:
    """Take back the last turn that was not taken back yet."""
    if not reader.styles_before:
        _stop(reader, "undo: nothing was turned")
        return
    style = reader.styles_before.pop()
    said = _differences(reader.style, style)
    reader.tune(**_fields(style))
    reader.say(f"undo: {said}")


def save_settings(reader: Reader) -> None:
    """Save the present tuning in the profile in use."""
    if reader.save_style is None:
        _stop(reader, "saved: nothing, since no settings file is in use")
    else:
        try:
            reader.say(reader.save_style(reader.style))
        except VbrailleError as error:  # reading goes on
            reader.say(f"not saved: {spelled(str(error))}")


def _turn_knob(reader: Reader, knob: StyleKnob, after: float, end: str) -> None:
    """Give a knob a value, or say that it is at its end in that direction, and why."""
    style = reader.style
    value = knob.value(style)
    why = fixed(knob, style) or obstacle(knob, style.geometry, reader.engine.display, after)
    if why or after == value:
        _stop(reader, f"{knob.said(value)}, the {end}{why and f': {why}'}")
    else:
        _turn(reader, knob.field, after, knob.said(after))


def _turn(reader: Reader, field: str, value: object, said: str) -> None:
    """Show another style, and say what has changed."""
    before = reader.style
    reader.tune(**{field: value})
    reader.styles_before.append(before)
    reader.say(said)


def _fields(style: BrailleStyle) -> dict[str, Any]:
    """All that commands of this module change in a style."""
    names = ("geometry", "tuning", "mapping", "straying")
    return {name: getattr(style, name) for name in names}


def _stop(reader: Reader, said: str) -> None:
    reader.cue(Cue.LIMIT)
    reader.say(said)


def _differences(one: BrailleStyle, other: BrailleStyle) -> str:
    """Words for the values of a style that differ from another's."""
    said = [
        knob.said(knob.value(other))
        for knob in KNOBS.values()
        if knob.value(one) != knob.value(other)
    ]
    if one.mapping != other.mapping:
        said.append(say_mapping(other.mapping))
    return ", ".join(said).replace(": ", " ")
