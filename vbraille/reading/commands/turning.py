"""Commands that change how the braille feels, while the hand moves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.cues import Cue
from vbraille.render.braille.knobs import (
    KNOBS,
    Knob,
    fixed,
    mappings_for,
    next_mapping,
    obstacle,
    say_mapping,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader
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
        style = reader.style
        value = knob.value(style)
        after = knob.turned(value, steps)
        end = "most" if steps > 0 else "least"
        why = fixed(knob, style) or _obstacle(knob, reader, after)
        if why or after == value:
            _stop(reader, f"{knob.said(value)}, the {end}{why and f': {why}'}")
        else:
            _turn(reader, style.replace(**{knob.field: after}), knob.said(after))

    return handler


def change_mapping(reader: Reader) -> None:
    """Take the next way in which actuators show dots, of those that the display can show."""
    style, display = reader.style, reader.model.display
    if len(mappings_for(style, display)) == 1:
        _stop(reader, f"{say_mapping(style.mapping)}, the only one for this display")
        return
    mapping = next_mapping(style, display)
    _turn(reader, style.replace(mapping=mapping), say_mapping(mapping))


def undo_turn(reader: Reader) -> None:
    """Take back the last turn that was not taken back yet."""
    if not reader.styles:
        _stop(reader, "undo: nothing was turned")
        return
    style = reader.styles.pop()
    said = _differences(reader.style, style)
    reader.restyle(style)
    reader.say(f"undo: {said}")


def save_settings(reader: Reader) -> None:
    """Save the present tuning in the profile in use."""
    if reader.keep is None:
        _stop(reader, "saved: nothing, since no settings file is in use")
    else:
        reader.say(reader.keep(reader.style))


def _obstacle(knob: Knob, reader: Reader, value: float) -> str:
    """Reason why a knob cannot have a value beside the others; empty if it can."""
    if knob.unit != "mm":
        return ""
    return obstacle(reader.style.geometry, reader.model.display, knob.field, value)


def _turn(reader: Reader, style: BrailleStyle, said: str) -> None:
    """Show another style, and say what has changed."""
    before = reader.style
    reader.restyle(style)
    reader.styles.append(before)
    reader.say(said)


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
