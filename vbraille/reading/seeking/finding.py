"""Where a text stands next in a book."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.reading.seeking.blocks import SPAN_CHARACTERS, Sought, backward, forward, within
from vbraille.reading.seeking.extent import extend
from vbraille.reading.seeking.folding import needle_of
from vbraille.reading.seeking.sieve import Sieve, ahead, behind
from vbraille.translate.documents.document import Document

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from vbraille.reading.queries import FindText
    from vbraille.reading.seeking.sieve import Suspect
    from vbraille.translate.source import Source

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
