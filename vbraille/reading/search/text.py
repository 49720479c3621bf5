"""A text found in the blocks of any source, exactly as they are read, and where it stands next."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.reading.search.folding import fold, needle_of, unfolded
from vbraille.reading.search.sieve import Sieve, ahead, behind
from vbraille.reading.search.structure import extend
from vbraille.translate.documents.document import Document

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from numpy.typing import NDArray

    from vbraille.reading.search.queries import FindText
    from vbraille.reading.search.sieve import Suspect
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


def within(
    source: Source, characters: tuple[int, int], sought: Sought, *, backward: bool
) -> int | None:
    """Place of the first or last hit that begins in a range of the source's characters."""
    start, end = characters
    first, last = source.block_at(start), source.block_at(end)
    if first is None:
        return None
    span, _ = _span(source, first, None if last is None else last + 1, sought, end)
    return last_hit(span, sought) if backward else first_hit(span, sought)


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
    upto: int | None = None,
    characters: int = SPAN_CHARACTERS,
) -> tuple[_Span, int]:
    """Blocks from a number on, and the number of the first that is not in the span.

    They go up to the number `after`; if that is None, up to the place `upto`; if that is None,
    too, they are as many as have so many characters.
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
            if after is not None:
                inside = number < after
            elif upto is not None:
                inside = block.text.end <= upto
            else:
                inside = size < characters
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
        Whether only what is near matters: the steps are then small, and far more are needed for
        a long plain text. The answer is the same.

    Yields
    ------
    int or float
        How much of the source was seen, 0 to 1, as floats; then the place of the text, if any.
    """
    needle = needle_of(query.text, accents=query.fold_accents)
    if not needle:
        return
    sought = Sought(needle, query.fold_accents, query.start)
    if isinstance(source, Document) and not near:
        yield from (_back_in if query.backward else _on_in)(source, sought)
        return
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


def _on_in(document: Document, sought: Sought) -> Iterator[int | float]:
    """Look for a text from its start on in a plain text."""
    sieve = Sieve(sought.needle, accents=sought.accents)
    rows = document.index().rows
    row = rows[_row_before(rows, sought.start)]
    for suspect in ahead(document, row, sieve):
        if suspect.hit and suspect.end > sought.start:
            found = yield from _hit(document, suspect, sought, backward=False)
            if found is not None:
                yield found
                return
        yield suspect.offset / document.size


def _back_in(document: Document, sought: Sought) -> Iterator[int | float]:
    """Look for a text backwards from its start in a plain text."""
    while sought.start >= _known_character(document) and extend(document):
        yield 0.0
    sieve = Sieve(sought.needle, accents=sought.accents)
    rows = document.index().rows
    for suspect in behind(document, rows, _row_before(rows, sought.start), sieve):
        if suspect.hit:
            found = yield from _hit(document, suspect, sought, backward=True)
            if found is not None:
                yield found
                return
        yield 1.0 - suspect.offset / document.size


def _hit(
    document: Document, suspect: Suspect, sought: Sought, *, backward: bool
) -> Generator[float, None, int | None]:
    """Have the blocks say whether there is a hit; they are read as far as that."""
    while suspect.end >= _known_character(document) and extend(document):
        yield _known_character(document) / max(suspect.end, 1) * suspect.offset / document.size
    start = suspect.start if backward else max(suspect.start, sought.start)
    return within(document, (start, suspect.end), sought, backward=backward)


def _row_before(rows: tuple[tuple[int | str, ...], ...], character: int) -> int:
    """Number of the last row whose chunk begins at a character or before it."""
    low, high = 0, len(rows)
    while high - low > 1:
        middle = (low + high) // 2
        at = rows[middle][1]
        low, high = (middle, high) if isinstance(at, int) and at <= character else (low, middle)
    return low
