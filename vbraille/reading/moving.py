"""Commands that move by lines, parts of a line and pages of the surface, or by time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.commands import both_ways, command
from vbraille.reading.reader import USUAL_CELLS_S
from vbraille.reading.surface import Part

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_SPEEDS = (1.0, 30.0)  # cells a second
_FASTER = 1.2


@command("next line", "n down", "down", also="button:1 pins:LNDN", first=True, steers=True)
def next_line(reader: Reader) -> None:
    _go(reader, 1)


@command("previous line", "p up", "up", also="button:2 pins:LNUP", first=True, steers=True)
def previous_line(reader: Reader) -> None:
    _go(reader, -1)


def _go(reader: Reader, step: int, *, at_end: bool = False) -> None:
    line = reader.beside(step)
    if line is None:
        reader.refuse("no next line" if step > 0 else "no previous line")
        return
    reader.show(line, len(line) - 1 if at_end else 0)
    reader.announce()


@command("on along the line, then the next line", "right", also="pins:FWINRT")
def pan_right(reader: Reader) -> None:
    _pan(reader, 1)


@command("back along the line, then the line before", "left", also="pins:FWINLT")
def pan_left(reader: Reader) -> None:
    _pan(reader, -1)


def _pan(reader: Reader, step: int) -> None:
    if reader.pan(step):
        reader.say(f"from cell {reader.surface.part.first + 1}")
    else:
        _go(reader, step, at_end=step < 0)


@command("start of the line", "home", also="pins:LNBEG")
def line_start(reader: Reader) -> None:
    reader.show(reader.line)
    reader.say("start of the line")


@command("end of the line", "end", also="pins:LNEND")
def line_end(reader: Reader) -> None:
    reader.show(reader.line, Part(reader.line, reader.surface.width).last().first)
    reader.say("end of the line")


@command("first line of the text", "< ctrl-home", also="pins:TOP")
def top(reader: Reader) -> None:
    first = reader.layout.first() if reader.first == 1 else reader.layout.line(reader.first)
    if first is not None:
        reader.jump(first.place)


@command("last line of the text", "> ctrl-end", also="pins:BOT")
def bottom(reader: Reader) -> None:
    last = None if reader.last is None else reader.layout.line(reader.last)
    last = last or reader.layout.last()
    if last is not None:
        reader.jump(last.place)


@command("back to the place before the last jump", "b alt-left", also="pins:BACK")
def back(reader: Reader) -> None:
    if reader.back:
        reader.jump(reader.back.pop(), "back", remember=False)
    else:
        reader.refuse("no place to go back to")


@command("skip blank lines, or read them", "z")
def skip_blank(reader: Reader) -> None:
    reader.skip_blank = not reader.skip_blank
    reader.say(f"blank lines: {'skipped' if reader.skip_blank else 'read'}")


@both_ways(
    "page of lines on the surface", "] ctrl-pagedown [ ctrl-pageup", also="pins:WINDN pins:WINUP"
)
def surface_page(reader: Reader, step: int) -> None:
    if not reader.turn_page(step):
        reader.refuse("no next page" if step > 0 else "no previous page")
    elif not reader.surface.rows:
        reader.announce()


@command("autoscroll on or off", "v f6")
def autoscroll(reader: Reader) -> None:
    reader.scroll(0.0 if reader.scroll_cells_s else USUAL_CELLS_S)
    reader.say(_speed(reader))


@command("faster autoscroll", "+ f8")
def faster(reader: Reader) -> None:
    _scroll(reader, _FASTER)


@command("slower autoscroll", "- f7", "-")
def slower(reader: Reader) -> None:
    _scroll(reader, 1 / _FASTER)


def _scroll(reader: Reader, factor: float) -> None:
    low, high = _SPEEDS
    speed = min(max((reader.scroll_cells_s or USUAL_CELLS_S) * factor, low), high)
    if speed == reader.scroll_cells_s:
        reader.refuse(f"{_speed(reader)} is the {'most' if factor > 1 else 'least'}")
        return
    reader.scroll(speed)
    reader.say(_speed(reader))


def _speed(reader: Reader) -> str:
    speed = reader.scroll_cells_s
    return f"autoscroll: {speed:.1f} cells a second" if speed else "autoscroll: off"
