"""Commands that go along lines, and from one line to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.search.questions import FindShare

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader
    from vbraille.cli.old.reading.viewport import Window


def go_by_line(reader: Reader, step: int, *, at_end: bool = False) -> None:
    """Go to the line after the present one, or to the one before if the step is -1.

    Parameters
    ----------
    at_end
        Whether to show the last part of the line.
    """
    if reader.go_by(step, at_end=at_end):
        reader.announce()
    else:
        reader.say_limit("last line" if step > 0 else "first line")


def pan(reader: Reader, step: int) -> None:
    """Go on along the line, or back if the step is -1; at its ends, on to another line."""
    if reader.pan(step):
        _say_part(reader)
    else:
        go_by_line(reader, step, at_end=step < 0)


def line_start(reader: Reader) -> None:
    """Go to the beginning of the line."""
    _show(reader, reader.window.showing(0), "start of line")


def line_end(reader: Reader) -> None:
    """Go to the end of the line."""
    window = reader.window
    _show(reader, window if window.right is None else window.last, "end of line")


def top(reader: Reader) -> None:
    """Go to the first of the lines that are read."""
    first = reader.range.first
    before = reader.character
    if first > 1:
        gone = reader.go(first)
        reader.keep_way_back(before)
    else:
        gone = reader.jump(0)
    if gone:
        reader.announce_jump()


def bottom(reader: Reader) -> None:
    """Go to the last of the lines that are read."""
    last = reader.range.last
    before = reader.character
    if last is not None and reader.go(last):
        reader.keep_way_back(before)
        reader.announce_jump()
        return

    def arrive(place: int | None) -> None:
        found = None if place is None else reader.layout.place(place)
        if found is None:
            reader.say("end: not found")
            return
        number = found[0].number
        while reader.layout.line(number + 1) is not None:
            number += 1
        reader.go(number)
        reader.keep_way_back(before)
        reader.announce_jump()

    reader.find(FindShare(1.0), arrive)


def back(reader: Reader) -> None:
    """Go back to where the reader was before the last jump."""
    if reader.jump_back():
        reader.announce_jump()
    else:
        reader.say_limit("back: there was no jump")


def _show(reader: Reader, window: Window, end: str) -> None:
    """Show another part of the line; where it is shown already, say which end this is."""
    if window.offset == reader.window.offset:
        reader.say(end)
    else:
        reader.put(window)
        _say_part(reader)


def _say_part(reader: Reader) -> None:
    window = reader.window
    reader.say(f"cells: {max(window.offset, 0) + 1} to {window.offset + len(window)}")
