"""A place of a source with the text around it, and the same text found in a changed source."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from vbraille.reading.places.values import KeptPlace, storable
from vbraille.reading.queries import FindShare, FindText, Found
from vbraille.reading.seeking.answering import answer
from vbraille.translate.source import share_before

if TYPE_CHECKING:
    from vbraille.reading.queries import Query
    from vbraille.translate.source import Source

AROUND = 200  # characters
# How much text before and after a place is looked for, the most telling first.
_TRIED = ((200, 200), (60, 60), (0, 100), (100, 0), (20, 20), (0, 30))
_LEAST = 12  # a shorter text stands anywhere


def place_in(source: Source, character: int) -> KeptPlace:
    """Place of a source, with the text around it."""
    number = source.block_at(character)
    block = None if number is None else source.block(number)
    if number is None or block is None:
        return KeptPlace(character, share=1.0)
    text, index = str(block.text), block.text.index(character)
    before, after = text[:index], text[index:]
    begins = int(block.text.places[max(0, index - AROUND)]) if index else character
    earlier = source.block(number - 1) if number else None
    if len(before) < AROUND and earlier is not None and len(earlier.text):
        more = AROUND - len(before)
        before = str(earlier.text)[-more:] + ("" if block.continues else " ") + before
        begins = int(earlier.text.places[max(0, len(earlier.text) - more)])
    later = source.block(number + 1) if len(after) < AROUND else None
    if later is not None:
        after += ("" if later.continues else " ") + str(later.text)
    return KeptPlace(
        character,
        number,
        share_before(source, character),
        storable(before[-AROUND:]),
        storable(after[:AROUND]),
        max(0, character - begins),
        about=not source.complete,
    )


def anchored(source: Source, place: KeptPlace) -> tuple[KeptPlace, bool]:
    """Place in a source that has changed since it was kept, and whether the text was found again.

    The nearest to the old place is taken of all where the same text stands. If it stands nowhere,
    the place is the one with the same share of the book before it.
    """
    for before, after in _TRIED:
        head = place.before[len(place.before) - min(before, len(place.before)) :]
        tail = place.after[:after]
        if len((head + tail).strip()) < _LEAST:
            continue
        found = _nearest(source, head + tail, place.character - len(head))
        if found is None:
            continue
        character = found
        if head.strip():
            reach = place.reach if before >= len(place.before) else len(head)
            character = found + reach
            if tail.strip():
                nearer = _found(source, FindText(tail, found + reach // 2))
                character = character if nearer is None else nearer
        return _again(source, place, character), True
    character = _found(source, FindShare(place.share)) or 0
    return _again(source, place, character), False


def _again(source: Source, place: KeptPlace, character: int) -> KeptPlace:
    """A new place, with what is still so of the old one; lines are counted anew."""
    return msgspec.structs.replace(place_in(source, character), page=place.page)


def _nearest(source: Source, text: str, character: int) -> int | None:
    character = max(0, character)
    after = _found(source, FindText(text, character))
    before = _found(source, FindText(text, character, backward=True))
    near = [at for at in (after, before) if at is not None]
    return min(near, key=lambda at: abs(at - character), default=None)


def _found(source: Source, query: Query) -> int | None:
    *_, last = answer(source, query)
    return last.character if isinstance(last, Found) else None
