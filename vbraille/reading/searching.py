"""Commands that search the text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.commands import command
from vbraille.reading.outputs import Cue
from vbraille.reading.search import find_after, find_before, hits_between, pattern_for

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader


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
        return
    found, line = reader.found, reader.line
    here = found is not None and line.place <= found < line.end
    _find(reader, found if here else reader.place)


def _find(reader: Reader, place: int | None) -> None:
    """Go to the next hit after a place, or the last before it, and tell it from its neighbours."""
    pattern, text, wanted = reader.pattern, reader.book.source.text, reader.typed["search"][-1]
    assert pattern is not None, "a search is running"
    at = place or 0
    hit = find_after(pattern, text, at + 1) if reader.forward else find_before(pattern, text, at)
    if hit is None:
        way = "after" if reader.forward else "before"
        reader.say(f"{wanted!r}: not found {way} here", Cue.NOT_FOUND)
        return
    found = reader.layout.place(hit)
    said = repr(wanted)
    if found is not None:
        line, cell = found
        hits = hits_between(pattern, text, line.place, line.end)
        said += f": cell {cell + 1}"
        if hits[1:] and hit in hits:
            said += f", {hits.index(hit) + 1} of {len(hits)} in this line"
    reader.jump(hit, said)
