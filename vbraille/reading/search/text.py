"""A text found in the blocks of any source, exactly as they are read, and where it stands next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.reading.search.folding import fold, needle_of, unfolded
from vbraille.reading.search.structure import extend

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.reading.search.queries import FindText
    from vbraille.translate.source import Block, Source

SPAN_CHARACTERS = 32_768


@dataclass(frozen=True, slots=True)
class Sought:
    """What is looked for.

    Parameters
    ----------
    needle
        Folded text; not empty.
    accents
        Whether accents make no difference.
    start
        Place of the source from which on it is looked for, or before which.
    """

    needle: str
    accents: bool
    start: int


@dataclass(frozen=True, slots=True)
class _Span:
    """Text of some blocks that follow each other, and as much after it as a hit may need.

    Parameters
    ----------
    text, places
        Characters, with a blank between two blocks, and the place of each in the source.
    length
        Number of characters before those of the blocks that come after the span.
    """

    text: str
    places: NDArray[np.int64]
    length: int


def forward(
    source: Source, first: int, sought: Sought, characters: int = SPAN_CHARACTERS
) -> Iterator[int | float]:
    """Look for the first hit from a block on, in spans of at least so many characters.

    Yields
    ------
    int or float
        How much of the source was seen, 0 to 1, as floats; then the place of a hit, if any.
    """
    number = first
    while source.block(number) is not None:
        span, after = _span(source, number, None, sought, characters=characters)
        found = first_hit(span, sought)
        if found is not None:
            yield found
            return
        number = after
        yield source.progress(number)


def backward(
    source: Source, last: int, sought: Sought, characters: int = SPAN_CHARACTERS
) -> Iterator[int | float]:
    """Look for the last hit that begins in a block or before it, as `forward` does."""
    after = last + 1
    while after > 0:
        first = after
        size = 0
        while first > 0 and size < characters:
            first -= 1
            block = source.block(first)
            size += 1 if block is None else len(block.text) + 1
        span, _ = _span(source, first, after, sought)
        found = last_hit(span, sought)
        if found is not None:
            yield found
            return
        after = first
        yield 1.0 - source.progress(first)


def first_hit(span: _Span, sought: Sought) -> int | None:
    """Place of the first hit that begins in a span at the start or after it."""
    folded = fold(span.text, accents=sought.accents)
    before = span.text[: int(np.searchsorted(span.places, sought.start))]
    # What is folded may grow together with what comes next.
    at = max(0, len(fold(before, accents=sought.accents)) - 4) if before else 0
    while (at := folded.find(sought.needle, at)) >= 0:
        index = unfolded(span.text, at, accents=sought.accents)
        if index >= span.length:
            return None
        if span.places[index] >= sought.start:
            return int(span.places[index])
        at += 1
    return None


def last_hit(span: _Span, sought: Sought) -> int | None:
    """Place of the last hit that begins in a span before the start."""
    folded = fold(span.text, accents=sought.accents)
    limit = min(span.length, int(np.searchsorted(span.places, sought.start)))
    if limit <= 0:
        return None
    upto = len(fold(span.text[:limit], accents=sought.accents)) + 4 + len(sought.needle)
    while (at := folded.rfind(sought.needle, 0, upto)) >= 0:
        index = unfolded(span.text, at, accents=sought.accents)
        if index < limit:
            return int(span.places[index])
        upto = at + len(sought.needle) - 1
    return None


def _span(
    source: Source,
    first: int,
    after: int | None,
    sought: Sought,
    characters: int = SPAN_CHARACTERS,
) -> tuple[_Span, int]:
    """Blocks from a number on, and the number of the first that is not in the span.

    They go up to the number `after`; if that is None, they are as many as have so many characters.
    """
    texts: list[str] = []
    places: list[NDArray[np.int64]] = []
    size = length = 0
    number = following = first
    more = 0
    block = source.block(first)
    inside = True
    while block is not None and (inside or more <= 4 * len(sought.needle)):
        if texts and not block.continues:
            texts.append(" ")
            places.append(_blank(block))
            size += 1
        texts.append(str(block.text))
        places.append(block.text.places)
        size += len(block.text)
        if inside:
            number += 1
            length = size
            inside = size < characters if after is None else number < after
            following = number
        else:
            more += len(fold(texts[-1], accents=sought.accents))
            following += 1
        block = source.block(following)
    joined = np.concatenate(places) if places else np.empty(0, np.int64)
    return _Span("".join(texts), joined, length), number


def _blank(block: Block) -> NDArray[np.int64]:
    """Place of the blank before a block: that of its first character."""
    first = int(block.text.places[0]) if len(block.text) else block.text.end
    return np.full(1, first, np.int64)


_NEAR_CHARACTERS = 4_096  # that are looked through before the time is looked at


def find_text(source: Source, query: FindText, *, near: bool = False) -> Iterator[int | float]:
    """Look for a text.

    Parameters
    ----------
    near
        Whether only what is near matters: the steps are then small.

    Yields
    ------
    int or float
        How much of the source was seen, 0 to 1, as floats; then the place of the text, if any.
    """
    needle = needle_of(query.text, accents=query.fold_accents)
    if not needle:
        return
    sought = Sought(needle, query.fold_accents, query.start)
    characters = _NEAR_CHARACTERS if near else SPAN_CHARACTERS
    if query.backward:
        yield from _before(source, sought, characters)
    elif (first := source.block_at(query.start)) is not None:
        yield from forward(source, first, sought, characters)


def _before(source: Source, sought: Sought, characters: int) -> Iterator[int | float]:
    while sought.start >= _known_character(source) and extend(source):
        yield 0.0
    last = source.block_at(sought.start)
    if last is None:
        last = _last(source)
    yield from backward(source, last, sought, characters)


def _last(source: Source) -> int:
    """Number of the last block; the source must be complete."""
    number = 1
    while source.block(number) is not None:
        number *= 2
    low, high = number // 2, number
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if source.block(middle) is None else (middle, high)
    return low


def _known_character(source: Source) -> int:
    """Place up to which the source is known; the rows of its index have it second."""
    rows = source.index().rows
    character = rows[-1][1] if rows else 0
    return character if isinstance(character, int) else 0
