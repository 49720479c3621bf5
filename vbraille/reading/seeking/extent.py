"""How far a source is known, and knowing more of it a step at a time."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

from vbraille.translate.documents.document import Document

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Source


def known_blocks(source: Source) -> int:
    """Number of blocks that can be reached without reading up to them.

    A row of an index begins with the number of the block at which its part of the source begins.
    """
    rows = source.index().rows
    first = rows[-1][0] if rows and rows[-1] else 0
    return first if isinstance(first, int) else 0


def extend(source: Source) -> bool:
    """Read the next part of a source that is not known yet; False if all of it is."""
    if source.complete:
        return False
    if isinstance(source, Document):
        return source.extend()
    source.block(known_blocks(source))
    return True


def extended(source: Source) -> Iterator[float]:
    """Read a source till all of it is known, and tell after each step how much is, 0 to 1."""
    while extend(source):
        yield share_known(source)


def share_known(source: Source) -> float:
    """About how much of the source is known, 0 to 1."""
    return 1.0 if source.complete else source.progress(max(known_blocks(source) - 1, 0))


def find_share(source: Source, share: float) -> Iterator[int | float]:
    """Look for the text before which so much of the source stands.

    Yields
    ------
    int or float
        How much of the source is known, 0 to 1, as floats; then the place of the first character,
        or of the last if there is none after.
    """
    yield from extended(source)
    character = round(share * source.end)
    at = source.block_at(character)
    at = known_blocks(source) if at is None else at
    for numbers in (count(at), range(at - 1, -1, -1)):
        for number in numbers:
            block = source.block(number)
            if block is None:
                break
            if len(block.text):
                index = min(block.text.index(character), len(block.text) - 1)
                yield int(block.text.places[index])
                return
