"""Commands for bookmarks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.keptplace import Bookmark, place_in
from vbraille.wording import nearest

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader

_WORDS = 5  # of the text that are kept with a bookmark
_LONGEST_WORD = 30  # characters


def ask_mark(reader: Reader) -> None:
    """Ask for a name and set a bookmark here."""
    reader.ask("bookmark", "type a name, Enter", "name", _set, again=_free_number(reader))


def quick_mark(reader: Reader) -> None:
    """Set a bookmark here under the next free number."""
    _set(reader, _free_number(reader))


def ask_way(reader: Reader) -> None:
    """Ask for the name of a bookmark and go there."""
    if _any(reader):
        reader.ask("go to bookmark", "type its name, Enter", "name", _go)


def say_marks(reader: Reader) -> None:
    """Say the bookmarks, with the words that each stands at."""
    if _any(reader):
        for mark in reader.kept.bookmarks():
            reader.say(f"bookmark {mark.name}: {mark.text}")


def ask_deletion(reader: Reader) -> None:
    """Ask for the name of a bookmark and delete it."""
    if _any(reader):
        reader.ask("delete bookmark", "type its name, Enter", "name", _delete)


def _set(reader: Reader, name: str) -> None:
    place, block = reader.character, reader.line.block
    text, at = str(block.text), block.text.index(place)
    # The finger may be within a word, which is told whole.
    back = range(at, max(at - _LONGEST_WORD, -1), -1)
    at = next((n for n in back if n == 0 or text[n - 1].isspace()), at)
    words = " ".join(text[at : at + 200].split()[:_WORDS])
    # What the reader is told of it are some words; to find it again in a changed book takes more.
    kept = place_in(reader.layout.book.source, place)
    reader.kept.set_bookmark(Bookmark(name, place, words, kept.share, kept.after))
    _say_kept(reader, f"bookmark {name}: set")


def _go(reader: Reader, name: str) -> None:
    mark = _named(reader, name)
    if mark is None:
        return
    if not reader.arrive(mark.character):
        reader.say_not_found(f"bookmark {name}: not in the lines that are read")


def _delete(reader: Reader, name: str) -> None:
    mark = _named(reader, name)
    if mark is not None:
        reader.kept.delete_bookmark(mark.name)
        _say_kept(reader, f"bookmark {mark.name}: deleted")


def _say_kept(reader: Reader, done: str) -> None:
    """Say that something was done, and what is in the way of its being kept."""
    fault = reader.kept.fault
    later = "it is tried again as long as you read"
    reader.say(done if fault is None else f"{done}, but not kept: {fault}; {later}")


def _named(reader: Reader, name: str) -> Bookmark | None:
    """Bookmark of a name, whose case need not be right where that leaves one."""
    marks = {mark.name: mark for mark in reader.kept.bookmarks()}
    alike = [mark for mark in marks.values() if mark.name.casefold() == name.casefold()]
    found = marks.get(name) or (alike[0] if len(alike) == 1 else None)
    if found is None:
        reader.say_not_found(f"bookmark {name}: there is none{nearest(name, marks)}")
    return found


def _any(reader: Reader) -> bool:
    if reader.kept.bookmarks():
        return True
    reader.say(f"bookmarks: none; {reader.key('SETMARK', 'm')} sets one")
    return False


def _free_number(reader: Reader) -> str:
    taken = {mark.name for mark in reader.kept.bookmarks()}
    return next(str(n) for n in range(1, len(taken) + 2) if str(n) not in taken)
