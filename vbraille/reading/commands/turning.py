"""Commands that change how the braille feels."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader

STEP = 0.1


def turn(name: str, step: float) -> Callable[[Reader], None]:
    """Make a command that turns a value of the tuning up or down by a step, between 0 and 1.

    Parameters
    ----------
    name
        Name of the value: "texture" or "contrast".
    step
        Number that is added to the value.
    """

    def handler(reader: Reader) -> None:
        before = getattr(reader.style.tuning, name)
        value = round(min(max(before + step, 0.0), 1.0), 6)
        if value == before:
            reader.say(f"{name}: {value:g}, the {'most' if step > 0 else 'least'}")
            return
        reader.say(f"{name}: {value:g}")
        reader.tune(**{name: value})

    return handler
