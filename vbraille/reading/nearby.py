"""Look through the text around a place: what is found there is under the hand at once."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import msgspec

from vbraille.reading.matching import TextMatcher
from vbraille.reading.queries import CountLines, FindKind, FindPage, FindShare, FindText, Query
from vbraille.translate.source import BlockKind, MarkKind
from vbraille.translate.text import Text, to_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.translate.source import Block, Mark, Source

LINK = MarkKind.LINK.value  # a kind that `FindKind` is asked for beside those of blocks
_LINKS = (MarkKind.LINK, MarkKind.NOTE)
_GROUPED = (BlockKind.ITEM.value, BlockKind.ROW.value)


@dataclass(frozen=True, slots=True)
class Reach:
    """How far to look.

    Parameters
    ----------
    blocks
        Largest number of blocks.
    seconds
        Longest time.
    least
        Number of blocks that are looked at whatever time that takes.
    """

    blocks: float = 2_000
    seconds: float = 0.010
    least: int = 100


EVERYTHING = Reach(float("inf"), float("inf"))


class _OutOfReachError(Exception):
    """The look was broken off at a block."""

    def __init__(self, block: int) -> None:
        super().__init__(block)
        self.block = block


def look(source: Source, query: Query, reach: Reach | None = None) -> int | Query | None:
    """Look for something from a place on, as far as the reach goes.

    Returns
    -------
    int, Query or None
        Place of the source where it is; None if it is nowhere; or what is left to be asked.
    """
    reach = Reach() if reach is None else reach
    match query:
        case FindText():
            return _look_for_text(source, query, reach)
        case FindKind(kind=kind) if kind in _GROUPED:
            return _look_for_group(source, query, reach)
        case FindKind():
            return _look_for_kind(source, query, reach)
        case FindShare() | FindPage():
            return _look_through(source, query, reach)
        case CountLines():
            return query


def blocks_from(
    source: Source, number: int, *, backward: bool, reach: Reach
) -> Iterator[tuple[int, Block]]:
    """Blocks from one on, with their numbers.

    Raises
    ------
    _OutOfReachError
        If there are more of them than the reach allows.
    """
    end_s = time.perf_counter() + reach.seconds
    seen = 0
    while number >= 0 and (block := source.block(number)) is not None:
        if seen >= reach.blocks or (seen >= reach.least and time.perf_counter() > end_s):
            raise _OutOfReachError(number)
        yield number, block
        seen += 1
        number += -1 if backward else 1


def within(
    source: Source, number: int, *, backward: bool = False, reach: Reach | None = None
) -> Iterator[tuple[int, Block]]:
    """Blocks from one on, with their numbers, until the end or as far as the reach goes."""
    try:
        yield from blocks_from(source, number, backward=backward, reach=reach or Reach())
    except _OutOfReachError:
        return


def first_place(block: Block) -> int:
    """Place of the first character of a block; of an empty one, a place that finds it."""
    return int(block.text.places[0]) if len(block.text) else max(block.text.end - 1, 0)


def links_of(block: Block) -> list[Mark]:
    """Links and references to notes in a block, by where they begin."""
    return sorted((m for m in block.marks if m.kind in _LINKS), key=lambda mark: mark.start)


def _look_for_text(source: Source, query: FindText, reach: Reach) -> int | Query | None:
    sought = TextMatcher(query.text, accents=query.fold_accents)
    start = query.start
    number = source.block_at(max(start - query.backward, 0))
    if number is None:
        if not query.backward:
            return None
        number = _last_block(source)
    following = source.block(number + 1) if query.backward else None
    if following is not None and following.continues:  # what begins here may end there
        number += 1
    beside = Text.empty()  # the end of the piece before, or the beginning of the piece after
    goes_on = False  # whether the block belongs to the one beside it
    try:
        for _, block in blocks_from(source, number, backward=query.backward, reach=reach):
            text = block.text
            if not query.backward:
                goes_on = block.continues
            if goes_on and len(beside):
                text = text + beside if query.backward else beside + text
            found = [int(text.places[index]) for index in sought.find(str(text))]
            hits = [p for p in found if (p < start if query.backward else p >= start)]
            if hits:
                return hits[-1] if query.backward else hits[0]
            if query.backward:
                goes_on = block.continues
                beside = _cut(block.text, slice(None, sought.reach))
            else:
                beside = _cut(block.text, slice(-sought.reach, None))
    except _OutOfReachError as out:
        block = source.block(out.block)
        assert block is not None, "the look was broken off at it"
        edge = block.text.end + sought.reach if query.backward else first_place(block)
        edge = min(edge, start) if query.backward else max(edge - sought.reach, start)
        return msgspec.structs.replace(query, start=edge)
    return None


def _look_for_kind(source: Source, query: FindKind, reach: Reach) -> int | Query | None:
    step = -1 if query.backward else 1
    try:
        for _, block in blocks_from(
            source, query.block + step, backward=query.backward, reach=reach
        ):
            if query.kind == LINK:
                links = links_of(block)
                if links:
                    return links[-1 if query.backward else 0].start
            elif _is_wanted(block, query):
                return first_place(block)
    except _OutOfReachError as out:
        return msgspec.structs.replace(query, block=out.block - step)
    return None


def _is_wanted(block: Block, query: FindKind) -> bool:
    return (
        block.kind.value == query.kind
        and not block.continues
        and (not query.level or block.level <= query.level)
    )


def _look_for_group(source: Source, query: FindKind, reach: Reach) -> int | Query | None:
    """Look for a list or a table other than the one that the reader is in."""
    step = -1 if query.backward else 1
    kind, here = query.kind, source.block(query.block)
    inside = here is not None and here.kind.value == kind
    group = query.group or (here.group if inside and here is not None else 0)
    found: Block | None = None
    try:
        for _, block in blocks_from(
            source, query.block + step, backward=query.backward, reach=reach
        ):
            if block.kind is BlockKind.PAGE:
                continue
            its = block.kind.value == kind
            if found is not None:  # on the way back to the beginning of what was found
                if not its or block.group != found.group:
                    break
                found = block
            elif not its:
                inside = False
            elif not (block.group == group if group else inside):
                found = block
                if not query.backward:
                    break
    except _OutOfReachError as out:
        if found is None:
            return msgspec.structs.replace(query, block=out.block - step, group=group)
    return None if found is None else first_place(found)


def _look_through(source: Source, query: FindShare | FindPage, reach: Reach) -> int | Query | None:
    """Look through the source from its beginning."""
    last: Block | None = None
    try:
        for number, block in blocks_from(source, 0, backward=False, reach=reach):
            if isinstance(query, FindPage):
                if block.kind is BlockKind.PAGE and _same_page(str(block.text), query.label):
                    return first_place(block)
                continue
            if len(block.text):
                if last is not None and source.progress(number) > query.share:
                    return first_place(last)
                last = block
    except _OutOfReachError:
        return query
    return None if last is None else first_place(last)


def _same_page(label: str, wanted: str) -> bool:
    return label.strip().casefold() == wanted.strip().casefold()


def _last_block(source: Source) -> int:
    """Number of the last block of a source whose end was passed."""
    number = 0
    while source.block(2 * number + 1) is not None:
        number = 2 * number + 1
    step = number + 1
    while step:
        if source.block(number + step) is not None:
            number += step
        else:
            step //= 2
    return number


def _cut(text: Text, part: slice) -> Text:
    return Text(text.codes[part].copy(), text.places[part].copy(), text.end, text.alphabet)


def words_in(block: Block) -> int:
    """Count the words of a block."""
    return len(to_text(block.text.codes).split())
