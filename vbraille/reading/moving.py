"""Commands that move by lines and pages of the surface, or by time; say where one is; bookmarks."""

from __future__ import annotations

import unicodedata
from functools import partial
from typing import TYPE_CHECKING

from vbraille.reading.commands import both_ways, command
from vbraille.reading.outputs import Cue
from vbraille.reading.places import around
from vbraille.reading.reader import letter_said

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader

_USUAL, _SLOWEST, _FASTEST, _FASTER = 8.0, 1.0, 30.0, 1.2  # cells a second
_LOOKED_BACK = 5000  # blocks, for the page and the heading
LINES_PER_PAGE = 25  # of a braille page, where the book has no pages of print


@both_ways(
    "line", "n down | p up", "down | up", "button:1 pins:LNDN | button:2 pins:LNUP",
    first=True, steers=True,
)  # fmt: skip
def line(reader: Reader, step: int, *, at_end: bool = False) -> None:
    other = reader.beside(step)
    if other is None:
        reader.refuse_step(step, "line")
        return
    reader.show(other, len(other) - 1 if at_end else 0)
    reader.announce()


@both_ways(
    ("pan right, then to the next line", "pan left, then to the previous line"),
    "right | left", also="pins:FWINRT | pins:FWINLT", name="pan-right pan-left",
)  # fmt: skip
def pan(reader: Reader, step: int) -> None:
    if reader.pan(step):
        reader.say(f"from cell {reader.part.first + 1}")
    else:
        line(reader, step, at_end=step < 0)


@both_ways(
    ("end of the line", "start of the line"), "end | home", also="pins:LNEND | pins:LNBEG",
    name="line-end line-start",
)  # fmt: skip
def line_end(reader: Reader, step: int) -> None:
    reader.show(reader.line, len(reader.line) - 1 if step > 0 else 0)
    reader.say(f"{'end' if step > 0 else 'start'} of the line")


@command("first line of the text", "< ctrl-home", also="pins:TOP")
def top(reader: Reader) -> None:
    reader.jump(reader.first)


@command("last line of the text", "> ctrl-end", also="pins:BOT")
def bottom(reader: Reader) -> None:
    last = reader.layout.last()
    reader.jump(reader.last if last is None else min(reader.last, last.place))


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
    "page of lines on the surface", "] ctrl-pagedown | [ ctrl-pageup",
    also="pins:WINDN | pins:WINUP",
)  # fmt: skip
def surface_page(reader: Reader, step: int) -> None:
    if not reader.turn_page(step):
        reader.refuse_step(step, "page")
    elif not reader.rows:
        reader.announce()


# By time


@command("autoscroll on or off", "v f6")
def autoscroll(reader: Reader) -> None:
    _scroll(reader, 0.0 if reader.scroll_cells_s else _USUAL)


@both_ways(
    ("faster autoscroll", "slower autoscroll"), "+ f8 | - f7", "+ f8 | -", name="faster slower"
)
def faster(reader: Reader, step: int) -> None:
    cells_s = (reader.scroll_cells_s or _USUAL) * _FASTER**step
    _scroll(reader, min(max(cells_s, _SLOWEST), _FASTEST))


def _scroll(reader: Reader, cells_s: float) -> None:
    said = f"autoscroll: {cells_s:.1f} cells a second" if cells_s else "autoscroll: off"
    if cells_s == reader.scroll_cells_s:
        reader.refuse_beyond(said, up=cells_s == _FASTEST)
    else:
        reader.scroll_cells_s = cells_s
        reader.say(said)


# Where one is


@command("say line, page, percent and heading", "i", "delete", first=True, also="pins:INFO")
def info(reader: Reader) -> None:
    page = heading = ""
    for number, block in enumerate(reader.book.source.blocks(reader.line.block.number, -1)):
        page = page or block.page_number
        heading = heading or (block.heading[1] if block.heading else "")
        if (page and heading) or number > _LOOKED_BACK:
            break
    if not page and reader.has_pages is False and reader.is_counted(reader.line):
        page = f"{(reader.layout.number(reader.line) - 1) // LINES_PER_PAGE + 1} in braille"
    said = (
        reader.named,
        page and f"page {page}",
        f"{100 * reader.book.source.progress(reader.line.place):.0f} percent",
        heading and f"heading: {heading}",
    )
    reader.say(", ".join(filter(None, said)))


@command("say what is under the finger", "u", also="pins:DESCCHAR")
def under_finger(reader: Reader) -> None:
    reader.say(reader.cell_said(reader.cell))


@command("say the word under the finger", "w", also="pins:SPEAK_CURR_WORD")
def say_word(reader: Reader, *, spelled: bool = False) -> None:
    word = "" if reader.cell is None else reader.line.word(reader.cell)
    if spelled:
        word = ", ".join(map(letter_said, unicodedata.normalize("NFC", word)))
    reader.say(word or "no word under the finger")


command(
    "spell the word under the finger", "W", also="pins:SPELL_CURR_WORD", name="spell-word"
)(partial(say_word, spelled=True))  # fmt: skip


@command("say the line again", "V f5", also="pins:SAY_LINE")
def say_line(reader: Reader) -> None:
    reader.say(reader.text or "blank line")


# Bookmarks


@command("set a bookmark with a name", "m", first=True)
def bookmark(reader: Reader) -> None:
    def answer(name: str) -> None:
        number_bookmark(reader, name)

    reader.ask("name of the bookmark", answer, may_be_empty=True)


@command("set a bookmark with a number", "M", also="pins:SETMARK")
def number_bookmark(reader: Reader, name: str = "") -> None:
    names = reader.kept.bookmarks
    name = name or str(next(n for n in range(1, len(names) + 2) if str(n) not in names))
    reader.kept.mark(name, reader.place, around(reader.line))
    reader.say(f"bookmark {name}: set at {reader.named}")


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

    def answer(name: str) -> None:
        if name in marks:
            use(name, marks[name])
        else:
            reader.say(f"no bookmark {name!r}; {_listed(reader)}", Cue.NOT_FOUND)

    reader.ask(question, answer, list(marks)[::-1])


@command("say the bookmarks", "B")
def say_bookmarks(reader: Reader) -> None:
    reader.say(_listed(reader))


def _listed(reader: Reader) -> str:
    names = reader.kept.bookmarks
    return f"bookmarks: {', '.join(names)}" if names else "no bookmarks"
