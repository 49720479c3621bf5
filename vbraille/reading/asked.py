"""What a program asks for, seen before anything is done with it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.display import Display
from vbraille.errors import InputError
from vbraille.render.braille.models import MODELS, Model
from vbraille.render.braille.style import BrailleStyle

if TYPE_CHECKING:
    from vbraille.layout.pages import Layout


def check_asked(display: object, style: object) -> None:
    """Raise InputError if what is given for a display or a style, where it is given, is none."""
    if not isinstance(display, Model | Display | None):
        known = MODELS.get(display.lower()) if isinstance(display, str) else None
        hint = f"vbraille.{known.name.upper()}" if known else "vbraille.VBD, vbraille.STRESS2"
        raise InputError(
            f"display is {display!r}; give {hint}{'' if known else ' or a vbraille.Display'}"
        )
    if not isinstance(style, BrailleStyle | None):
        raise InputError(
            f"style is {style!r}; give a vbraille.BrailleStyle, such as vbraille.VBD.style"
        )


def check_lines(layout: Layout, first: int, last: int | None) -> None:
    """Raise InputError if a text has no such lines; of a last one past its end it has all."""
    if first < 1:
        raise InputError(f"first is {first}; it must be 1 or more")
    if last is not None and last < first:
        raise InputError(f"last is {last} and first is {first}; last must not be before first")
    if layout.line(first) is None:
        raise InputError(f"the text ends at line {layout.count()}; line {first} is past that")
