"""Look through the text around a place: what is found there is under the hand at once."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.reading.queries import (
    CountLines,
    FindKind,
    FindLine,
    FindPage,
    FindShare,
    FindText,
    ListHeadings,
    Query,
)
from vbraille.reading.seeking.kinds import blocks_from
from vbraille.reading.seeking.steps import Found, steps
from vbraille.translate.text import to_text

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.source import Block, Source


@dataclass(frozen=True, slots=True)
class Reach:
    """How far to look.

    Parameters
    ----------
    most
        Largest number of blocks, or of steps.
    seconds
        Longest time.
    least
        Number of blocks or steps that are looked at whatever time that takes.
    """

    most: int = 2_000
    seconds: float = 0.010
    least: int = 100

    def ends(self, seen: int, taken_s: float) -> bool:
        """Tell if so much was seen, in such a time, that it is enough."""
        return seen >= self.most or (seen >= self.least and taken_s > self.seconds)


# A step of a search for a text is a page or two of it, and of one for a share what is read at once.
_REACHES = {
    FindText: Reach(most=16, least=4),
    FindKind: Reach(),
    FindShare: Reach(least=2),
    FindPage: Reach(),
    ListHeadings: Reach(),
}


def look(
    source: Source, query: Query, clock: Callable[[], float] = time.perf_counter
) -> Found | Query | None:
    """Look for something for as long as a hand does not notice, by a clock in seconds.

    Returns
    -------
    int, tuple, Query or None
        Place of the source where it is, or the headings; None if it is nowhere; or the question,
        if that is not known yet.
    """
    if isinstance(query, CountLines | FindLine):
        return query
    reach, since_s = _REACHES[type(query)], clock()
    for seen, step in enumerate(steps(source, query, near=True), 1):
        if not isinstance(step, float):
            return step
        if reach.ends(seen, clock() - since_s):
            return query
    return None


def look_everywhere(source: Source, query: Query) -> Found | None:
    """Look for something, however long that takes.

    Returns
    -------
    int, tuple or None
        Place of the source where it is, or the headings; None if it is nowhere.
    """
    if isinstance(query, CountLines | FindLine):
        return None
    found = (step for step in steps(source, query) if not isinstance(step, float))
    return next(found, None)


def within(
    source: Source, number: int, *, backward: bool = False, reach: Reach | None = None
) -> Iterator[tuple[int, Block]]:
    """Blocks from one on, with their numbers, until the end or as far as the reach goes."""
    reach, since_s = Reach() if reach is None else reach, time.perf_counter()
    for seen, found in enumerate(blocks_from(source, number, backward=backward)):
        if reach.ends(seen, time.perf_counter() - since_s):
            return
        yield found


def words_in(block: Block) -> int:
    """Count the words of a block."""
    return len(to_text(block.text.codes).split())
