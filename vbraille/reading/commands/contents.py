"""The command that lists the headings of a book, to go to one of them."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from vbraille.reading.bindings import Context
from vbraille.reading.cues import Cue
from vbraille.reading.search.queries import ListHeadings
from vbraille.wording import count

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader
    from vbraille.reading.search.queries import ListedHeading

    Numbered = dict[int, ListedHeading]

_MOST = 100  # headings that are said at once
_NUMBER = re.compile(r"(\d+)(?::.*)?")


def ask_heading(reader: Reader) -> None:
    """List the headings, ask for one, and go there."""

    def ask(found: tuple[ListedHeading, ...] | None) -> None:
        if reader.context is not Context.READING:
            reader.say("contents: not now; answer first")
        elif found:
            _ask(reader, dict(enumerate(found, 1)))
        else:
            reader.cue(Cue.NOT_FOUND)
            reader.say("contents: the book has no headings")

    reader.find(ListHeadings(), ask)


def _ask(reader: Reader, headings: Numbered) -> None:
    """Say headings with their numbers, and ask which one is meant."""
    levels = sorted({heading.level for heading in headings.values()})
    deepest = levels[0]
    for level in levels:
        if sum(heading.level <= level for heading in headings.values()) <= _MOST:
            deepest = level
    for number, heading in headings.items():
        if heading.level <= deepest:
            reader.say(_line(number, heading))
    if deepest < levels[-1]:
        reader.say(f"contents: {count(len(headings), 'heading')}; these are to level {deepest}")
    here = bisect_right([heading.character for heading in headings.values()], reader.character)
    reader.ask(
        "contents",
        "type a number or words, Enter; up and down go through the headings",
        "heading",
        lambda reader, typed: _go(reader, headings, typed),
        others=[_line(number, heading) for number, heading in headings.items()],
        at=here - 1,
    )


def _line(number: int, heading: ListedHeading) -> str:
    return f"{number}: {heading.title}, level {heading.level}"


def _go(reader: Reader, headings: Numbered, typed: str) -> None:
    """Go to the heading that is typed, by its number or by words of it; of several, ask again."""
    number = _NUMBER.fullmatch(typed)
    if number is not None and int(number[1]) in headings:
        found = {int(number[1]): headings[int(number[1])]}
    else:
        words = typed.casefold()
        found = {n: one for n, one in headings.items() if words in one.title.casefold()}
    if len(found) > 1:
        _ask(reader, found)
    elif not found or not reader.arrive(next(iter(found.values())).character):
        reader.cue(Cue.NOT_FOUND)
        reader.say(f"contents: {'not in the lines that are read' if found else 'no such heading'}")
