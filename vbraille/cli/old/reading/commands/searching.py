"""Commands that look for a text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.search.questions import FindText

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader


def ask_text(reader: Reader, *, backward: bool = False) -> None:
    """Ask for a text, and look for it from here on, or before this place."""

    def take(reader: Reader, text: str) -> None:
        reader.sought, reader.backward = text, backward
        _search(reader)

    what = "search backward" if backward else "search"
    reader.ask(what, "type the text, Enter", "text", take, again=reader.sought)


def search_again(reader: Reader) -> None:
    """Look for the last text once more, in the same direction."""
    if reader.sought:
        _search(reader)
    else:
        reader.say(f"search: nothing was searched yet; {reader.key('NXSEARCH', '/')} asks what")


def fold_accents(reader: Reader) -> None:
    """Take letters with accents and without for the same in searches, or no longer."""
    reader.fold_accents = not reader.fold_accents
    reader.say(f"accents: {'do not matter' if reader.fold_accents else 'matter'}")


def cancel(reader: Reader) -> None:
    """Give up what is being looked for."""
    given_up = reader.search.cancel()
    reader.say(f"search: {'given up' if given_up else 'nothing is looked for'}")


def _search(reader: Reader) -> None:
    text, backward = reader.sought, reader.backward
    start = reader.hit
    if start is None:
        start = reader.line.place
    elif not backward:
        start += 1

    def arrive(place: int | None) -> None:
        if not reader.arrive(place):
            reader.say_not_found(f"not found {'before' if backward else 'after'} this: {text}")

    reader.find(FindText(text, start, backward, reader.fold_accents), arrive)
