"""Commands that put another line under the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.echo import Echo

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader


def next_line(reader: Reader) -> None:
    """Go to the line after the present one."""
    _go(reader, reader.line_number + 1, "last line")


def previous_line(reader: Reader) -> None:
    """Go to the line before the present one."""
    _go(reader, reader.line_number - 1, "first line")


def _go(reader: Reader, number: int, none: str) -> None:
    """Go to a line and say its number, unless its echo does; if there is none, say so."""
    if not reader.go(number):
        reader.say(none)
    elif reader.echo is Echo.NONE:
        reader.say(f"line: {number}")
