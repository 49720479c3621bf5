"""Commands that move by lines and pages of the surface, or by time; say where one is; bookmarks."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from vbraille.reading.commands import both_ways, command
from vbraille.reading.outputs import Cue
from vbraille.reading.places import around
from vbraille.reading.reader import letter_said

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.layout import Line
    from vbraille.reading.reader import Reader

_USUAL, _SPEEDS, _FASTER = 8.0, (1.0, 30.0), 1.2  # cells a second
_LOOKED_BACK = 5000  # blocks, for the page and the heading
LINES_PER_PAGE = 25  # of a braille page, where the book has no pages of print


@both_ways(
    "line", "n down p up", "down up", "button:1 pins:LNDN button:2 pins:LNUP",
    first=True, steers=True,
)  # fmt: skip
def line(reader: Reader, step: int) -> None:
    _go(reader, step)


def _go(reader: Reader, step: int, *, at_end: bool = False) -> None:
    other = reader.beside(step)
    if other is None:
        reader.refuse_step(step, "line")
        return
    reader.show(other, len(other) - 1 if at_end else 0)
    reader.announce()


@command("pan right, then to the next line", "right", also="pins:FWINRT")
def pan_right(reader: Reader) -> None:
    _pan(reader, 1)


@command("pan left, then to the previous line", "left", also="pins:FWINLT")
def pan_left(reader: Reader) -> None:
    _pan(reader, -1)


def _pan(reader: Reader, step: int) -> None:
    if reader.pan(step):
        reader.say(f"from cell {reader.part.first + 1}")
    else:
        _go(reader, step, at_end=step < 0)


@command("start of the line", "home", also="pins:LNBEG")
def line_start(reader: Reader) -> None:
    reader.show(reader.line)
    reader.say("start of the line")


@command("end of the line", "end", also="pins:LNEND")
def line_end(reader: Reader) -> None:
    reader.show(reader.line, len(reader.line) - 1)
    reader.say("end of the line")


@command("first line of the text", "< ctrl-home", also="pins:TOP")
def top(reader: Reader) -> None:
    _jump_to(reader, reader.first_line())


@command("last line of the text", "> ctrl-end", also="pins:BOT")
def bottom(reader: Reader) -> None:
    last = None if reader.last is None else reader.layout.line(reader.last)
    _jump_to(reader, last or reader.layout.last())


def _jump_to(reader: Reader, line: Line | None) -> None:
    if line is not None:
        reader.jump(line.place)


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
        reader.refuse_step(step, "page")
    elif not reader.rows:
        reader.announce()


# By time


@command("autoscroll on or off", "v f6")
def autoscroll(reader: Reader) -> None:
    _scroll(reader, 0.0 if reader.scroll_cells_s else _USUAL)


@command("faster autoscroll", "+ f8")
def faster(reader: Reader) -> None:
    _scroll(reader, min((reader.scroll_cells_s or _USUAL) * _FASTER, max(_SPEEDS)))


@command("slower autoscroll", "- f7", "-")
def slower(reader: Reader) -> None:
    _scroll(reader, max((reader.scroll_cells_s or _USUAL) / _FASTER, min(_SPEEDS)))


def _scroll(reader: Reader, cells_s: float) -> None:
    said = f"autoscroll: {cells_s:.1f} cells a second" if cells_s else "autoscroll: off"
    if cells_s == reader.scroll_cells_s:
        reader.refuse_beyond(said, up=cells_s == max(_SPEEDS))
    else:
        reader.scroll(cells_s)
        reader.say(said)


# Where one is


@command("say line, page, percent and heading", "i", "delete", first=True, also="pins:INFO")
def info(reader: Reader) -> None:
    here = reader.figure_here
    page = heading = ""
    for number, block in enumerate(reader.book.source.blocks(reader.line.block.number, -1)):
        page = page or block.page_number
        heading = heading or (block.heading[1] if block.heading else "")
        if (page and heading) or number > _LOOKED_BACK:
            break
    if not page and reader.has_pages is False:
        page = f"{(reader.layout.number(reader.line) - 1) // LINES_PER_PAGE + 1} in braille"
    said = (
        here and f"figure: {here[0]}",
        reader.named(),
        page and f"page {page}",
        f"{100 * reader.layout.progress(reader.line):.0f} percent",
        heading and f"heading: {heading}",
    )
    reader.say(", ".join(filter(None, said)))


@command("say what is under the finger", "u", also="pins:DESCCHAR")
def under_finger(reader: Reader) -> None:
    here = reader.figure_here
    if here is not None:
        reader.say(f"figure: {here[0]}, here: {here[1] or 'nothing with a name'}")
    else:
        reader.say(reader.cell_said(reader.cell))


@command("say the word under the finger", "w", also="pins:SPEAK_CURR_WORD")
def say_word(reader: Reader) -> None:
    reader.say(_word(reader) or "no word under the finger")


@command("spell the word under the finger", "W", also="pins:SPELL_CURR_WORD")
def spell_word(reader: Reader) -> None:
    word = unicodedata.normalize("NFC", _word(reader))
    reader.say(", ".join(map(letter_said, word)) or "no word under the finger")


def _word(reader: Reader) -> str:
    return "" if reader.cell is None else reader.line.word(reader.cell)


@command("say the line again", "V f5", also="pins:SAY_LINE")
def say_line(reader: Reader) -> None:
    reader.say(reader.text or "blank line")


# Bookmarks


@command("set a bookmark with a name", "m", first=True)
def bookmark(reader: Reader) -> None:
    reader.ask("name of the bookmark", lambda name: _set(reader, name.strip()))


@command("set a bookmark with a number", "M", also="pins:SETMARK")
def number_bookmark(reader: Reader) -> None:
    _set(reader, "")


def _set(reader: Reader, name: str) -> None:
    names = reader.kept.bookmarks
    name = name or str(next(n for n in range(1, len(names) + 2) if str(n) not in names))
    reader.kept.mark(name, reader.place, around(reader.line))
    reader.say(f"bookmark {name}: set at {reader.named()}")


@command("go to a bookmark", "o", also="pins:GOTOMARK")
def go_to_bookmark(reader: Reader) -> None:
    _choose(reader, "go to bookmark", lambda name, place: reader.jump(place, f"bookmark {name}"))


@command("delete a bookmark", "delete X", "X")
def delete_bookmark(reader: Reader) -> None:
    def remove(name: str, _place: int) -> None:
        reader.kept.mark(name)
        reader.say(f"bookmark {name}: deleted")

    _choose(reader, "delete bookmark", remove)


def _choose(reader: Reader, question: str, use: Callable[[str, int], object]) -> None:
    marks = reader.kept.bookmarks
    if not marks:
        reader.refuse("no bookmarks")
        return

    def answer(typed: str) -> None:
        name = typed.strip()
        if name in marks:
            use(name, marks[name])
        elif not name:
            reader.say("cancelled")
        else:
            reader.say(f"no bookmark {name!r}; {_listed(reader)}", Cue.NOT_FOUND)

    reader.ask(question, answer, list(marks)[::-1])


@command("say the bookmarks", "B")
def say_bookmarks(reader: Reader) -> None:
    reader.say(_listed(reader))


def _listed(reader: Reader) -> str:
    names = reader.kept.bookmarks
    return f"bookmarks: {', '.join(names)}" if names else "no bookmarks"
