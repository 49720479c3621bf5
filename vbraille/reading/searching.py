"""Search in a book's text by one regular expression, whatever the case, accents and quotes."""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from itertools import takewhile
from typing import TYPE_CHECKING

from vbraille.reading.commands import command
from vbraille.reading.outputs import Cue

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_QUOTES = "'\"`´‘’‚‛“”„‟′″‹›«»ʼ＇＂"
_DASHES = "-‐‑‒–—―−⁃﹘﹣－"
_MARKS = "[\u0300-\u036f\u00ad]*"
_FIRST_BACK = 4096  # characters that are looked at first, backward


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


def find_after(pattern: re.Pattern[str], text: str, at: int) -> int | None:
    """Index of the first hit from an index on; None without one."""
    match = pattern.search(text, max(at, 0))
    return None if match is None else match.start()


def find_before(pattern: re.Pattern[str], text: str, at: int) -> int | None:
    """Index of the last hit that begins before an index; None without one."""
    end, size = at, _FIRST_BACK
    while end > 0:  # in larger and larger pieces
        start = max(0, end - size)
        found = hits(pattern, text, start, end)
        if found:
            return found[-1]
        end, size = start, size * 4
    return None


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


@command("search forward", "/ f3", "ctrl-f /", first=True, also="pins:NXSEARCH")
def search_forward(reader: Reader) -> None:
    _ask(reader, forward=True)


@command("search backward", "\\ f4", also="pins:PRSEARCH")
def search_backward(reader: Reader) -> None:
    _ask(reader, forward=False)


def _ask(reader: Reader, *, forward: bool) -> None:
    typed = reader.typed.setdefault("search", [])

    def answer(text: str) -> None:
        if text.strip():
            typed.append(text.strip())
        if not typed:
            reader.say("cancelled")
            return
        reader.pattern, reader.forward = pattern_for(typed[-1]), forward
        _find(reader, reader.line.place - 1 if forward and text.strip() else reader.place)

    reader.ask("search for" if forward else "search backward for", answer, typed)


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
    hit = find_after(pattern, text, at + 1) if reader.forward else find_before(pattern, text, at)
    if hit is None:
        way = "after" if reader.forward else "before"
        reader.say(f"{said}: not found {way} here", Cue.NOT_FOUND)
        return
    found = reader.layout.place(hit)
    if found is not None:
        line, cell = found
        said += f": cell {cell + 1}"
        beside = hits(pattern, text, line.place, line.end)
        if beside[1:] and hit in beside:
            said += f", {beside.index(hit) + 1} of {len(beside)} in this line"
    reader.jump(hit, said)
