"""Search in a book's text by one regular expression, whatever the case, accents and quotes."""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from itertools import takewhile
from typing import TYPE_CHECKING

from vbraille.reading.commands import both_ways, command
from vbraille.reading.outputs import Cue

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_QUOTES = "'\"`´‘’‚‛“”„‟′″‹›«»ʼ＇＂"
_DASHES = "-‐‑‒–—―−⁃﹘﹣－"
_MARKS = "[\u0300-\u036f\u00ad]*"


def pattern_for(wanted: str) -> re.Pattern[str]:
    """Regular expression for a text as it is typed.

    Each letter stands for those like it, such as e for É, and a blank for any white space.
    """
    parts = [
        r"\s+" if character == " " else _class(character) + _MARKS
        for character in _plain(" ".join(wanted.split()))
    ]
    return re.compile("".join(parts))


def hits(pattern: re.Pattern[str], text: str, start: int, end: int) -> list[int]:
    """Indices of all hits that begin from an index on, before another."""
    found = (match.start() for match in pattern.finditer(text, start))
    return list(takewhile(lambda hit: hit < end, found))


def _class(character: str) -> str:
    for alike in (_QUOTES, _DASHES):
        if character in alike:
            return f"[{re.escape(alike)}]"
    letters = sorted({character, character.upper()[:1], *_alike().get(character, ())})
    return f"[{re.escape(''.join(letters))}]"


def _plain(text: str) -> str:
    """Text in small letters without accents."""
    return re.sub("[\u0300-\u036f]", "", unicodedata.normalize("NFD", text.casefold()))


@cache
def _alike() -> dict[str, list[str]]:
    """Letters that differ from a plain one by case or accents."""
    found: dict[str, list[str]] = {}
    for character in map(chr, (*range(0x80, 0x590), *range(0x1E00, 0x2000))):
        found.setdefault(_plain(character), []).append(character)
    return found


@both_ways(
    ("search forward", "search backward"), "/ f3 | \\ f4", "ctrl-f / | \\ f4",
    also="pins:NXSEARCH | pins:PRSEARCH", name="search-forward search-backward", first=True,
)  # fmt: skip
def search(reader: Reader, step: int) -> None:
    typed = reader.typed.setdefault("search", [])

    def answer(text: str) -> None:
        if text:
            typed.append(text)
        if not typed:
            reader.say("cancelled")
            return
        reader.pattern, reader.forward = pattern_for(typed[-1]), step > 0
        _find(reader, reader.line.place - 1 if step > 0 and text else reader.place)

    question = "search for" if step > 0 else "search backward for"
    reader.ask(question, answer, typed, may_be_empty=True)


@command("search again", ".", "f3 .")
def search_again(reader: Reader) -> None:
    if reader.pattern is None:
        reader.refuse("no search is running; press slash to search")
    else:
        here = reader.found_here
        _find(reader, reader.place if here is None else here)


def _find(reader: Reader, at: int) -> None:
    """Go to the next hit after a place, or the last before it, and tell it from its neighbours."""
    pattern, text, said = reader.pattern, reader.book.source.text, repr(reader.typed["search"][-1])
    assert pattern is not None, "a search is running"
    if reader.forward:
        match = pattern.search(text, max(at + 1, 0))
        found = [] if match is None else [match.start()]
    else:
        found = hits(pattern, text, 0, at)
    if not found:
        way = "after" if reader.forward else "before"
        reader.say(f"{said}: not found {way} here", Cue.NOT_FOUND)
        return
    hit = found[-1]
    if there := reader.layout.place(hit):
        line, cell = there
        said += f": cell {cell + 1}"
        beside = hits(pattern, text, line.place, line.end)
        if beside[1:] and hit in beside:
            said += f", {beside.index(hit) + 1} of {len(beside)} in this line"
    reader.jump(hit, said)
