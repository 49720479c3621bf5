"""Commands for bookmarks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.commands import command
from vbraille.reading.outputs import Cue
from vbraille.reading.places import around

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader


@command("set a bookmark with a name", "m", first=True)
def bookmark(reader: Reader) -> None:
    reader.ask("name of the bookmark", lambda name: _set(reader, name.strip()))


@command("set a bookmark with a number", "M", also="pins:SETMARK")
def number_bookmark(reader: Reader) -> None:
    _set(reader, "")


def _set(reader: Reader, name: str) -> None:
    names = reader.kept.bookmarks
    name = name or str(next(n for n in range(1, len(names) + 2) if str(n) not in names))
    reader.kept.set_bookmark(name, reader.place, around(reader.line))
    reader.say(f"bookmark {name}: set at {reader.named()}")


@command("go to a bookmark", "o", also="pins:GOTOMARK")
def go_to_bookmark(reader: Reader) -> None:
    _choose(reader, "go to bookmark", lambda name, place: reader.jump(place, f"bookmark {name}"))


@command("delete a bookmark", "delete X", "X")
def delete_bookmark(reader: Reader) -> None:
    def remove(name: str, _place: int) -> None:
        reader.kept.remove_bookmark(name)
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
