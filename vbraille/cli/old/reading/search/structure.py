"""Blocks found as they follow each other: of a kind, near a place, or after a share of the book."""

from __future__ import annotations

import time
from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING

from vbraille.cli.old.reading.search.questions import ListedHeading

Document = None
from vbraille.translate import BlockKind, MarkKind

to_text = None

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.cli.old.reading.search.questions import FindKind
    from vbraille.translate import Block, Mark, Source

# Kinds that `FindKind` is asked for beside those of blocks.
LINK, IMAGE = MarkKind.LINK.value, MarkKind.IMAGE.value
START = "start"
EACH_ITEM = "each item"
_MARKS = {LINK: (MarkKind.LINK, MarkKind.NOTE), IMAGE: (MarkKind.IMAGE,)}
_TOGETHER = (BlockKind.ITEM.value, BlockKind.ROW.value, BlockKind.QUOTE.value)
_STRUCTURE = frozenset(kind.value for kind in BlockKind) - {"paragraph", "line"}
_NOT_PLAIN = _STRUCTURE | {LINK, IMAGE, EACH_ITEM}


def first_place(block: Block) -> int:
    """Place of the first character of a block; of an empty one, a place that finds it."""
    return int(block.text.places[0]) if len(block.text) else max(block.text.end - 1, 0)


def marks_of(block: Block, kind: str = LINK) -> list[Mark]:
    """Links and references to notes in a block, or its pictures, by where they begin."""
    return sorted((m for m in block.marks if m.kind in _MARKS[kind]), key=lambda mark: mark.start)


def blocks_from(
    source: Source, number: int, *, backward: bool = False
) -> Iterator[tuple[int, Block]]:
    """Blocks from one on until the end or the beginning, with their numbers."""
    while number >= 0 and (block := source.block(number)) is not None:
        yield number, block
        number += -1 if backward else 1


def find_kind(source: Source, query: FindKind) -> Iterator[int | float]:
    """Look for the next block of a kind, or the one before.

    Yields
    ------
    int or float
        After each block how much of the source stands before it, 0 to 1, as floats; then the
        place of what was found, if anything.
    """
    if isinstance(source, Document) and query.kind in _NOT_PLAIN:
        return  # a reader does not wait for the end of a long text that has none
    if query.kind in _TOGETHER:
        yield from _find_group(source, query)
        return
    step = -1 if query.backward else 1
    for number, block in blocks_from(source, query.block + step, backward=query.backward):
        if query.kind in _MARKS:
            marks = marks_of(block, query.kind)
            if query.targets:
                marks = [mark for mark in marks if mark.target in query.targets]
            if marks:
                yield marks[-1 if query.backward else 0].start
                return
        elif query.kind == START:
            if _is_start(source, number, block):
                yield first_place(block)
                return
        elif _is_wanted(block, query):
            yield first_place(block)
            return
        yield source.progress(number)


def find_page(source: Source, label: str) -> Iterator[int | float]:
    """Look for a page from the beginning on, by its number; yields as `find_kind` does."""
    if isinstance(source, Document):
        return
    wanted = label.strip().casefold()
    for number, block in blocks_from(source, 0):
        if block.kind is BlockKind.PAGE and block.page_number.casefold() == wanted:
            yield first_place(block)
            return
        yield source.progress(number)


def list_headings(source: Source) -> Iterator[float | tuple[ListedHeading, ...]]:
    """List the headings; yields as `find_kind` does, at the end all of them."""
    found: list[ListedHeading] = []
    if not isinstance(source, Document):
        for number, block in blocks_from(source, 0):
            if block.kind is BlockKind.HEADING and not block.continues:
                title = " ".join(str(block.text).split())
                found.append(ListedHeading(block.level, title, first_place(block)))
            yield source.progress(number)
    yield tuple(found)


def _is_wanted(block: Block, query: FindKind) -> bool:
    kind = BlockKind.ITEM.value if query.kind == EACH_ITEM else query.kind
    return (
        block.kind.value == kind
        and not block.continues
        and (not query.level or block.level <= query.level)
    )


def _is_start(source: Source, number: int, block: Block) -> bool:
    """Tell whether a paragraph begins; lines that the source keeps are one until an empty one."""
    if block.continues or not str(block.text).strip():
        return False
    before = source.block(number - 1) if number and block.kind is BlockKind.LINE else None
    return before is None or before.kind is not BlockKind.LINE or not str(before.text).strip()


def _find_group(source: Source, query: FindKind) -> Iterator[int | float]:
    """Look for the beginning of a list, a table or a quotation that the reader is not in.

    Lists and tables are numbered as they begin, and whatever stands in an item has the number of
    its list. Quotations have no numbers: neighbours are one, as are items of an unnumbered list.
    """
    step = -1 if query.backward else 1
    kind, numbered = query.kind, query.kind != BlockKind.QUOTE.value
    number = query.block
    while (here := source.block(number)) is not None and here.kind is BlockKind.PAGE and number:
        number -= 1  # a page may begin within a list
    inside = here is not None and here.kind.value == kind
    group = here.group if here is not None and numbered else 0
    if kind == BlockKind.ROW.value and not inside and not query.backward:
        group = max(group - 1, 0)  # the caption of a table has its number and stands before it
    found: Block | None = None
    for at, block in blocks_from(source, query.block + step, backward=query.backward):
        yield source.progress(at)
        if block.kind is BlockKind.PAGE:
            continue
        its, its_group = block.kind.value == kind, block.group if numbered else 0
        if found is not None:  # on the way back to the beginning of what was found
            wanted = found.group if numbered else 0
            if its_group < wanted or not (wanted or (its and not its_group)):
                break
            found = block if its and its_group == wanted else found
        elif not its:
            inside = False
        elif _is_another(its_group, group, backward=query.backward) if group else not inside:
            found = block
            if not query.backward:
                break
    if found is not None:
        yield first_place(found)


def _is_another(group: int, here: int, *, backward: bool) -> bool:
    """Tell if a list or table is not the one that the reader is in, nor around that, going on."""
    return group != here if backward or not group else group > here


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


@dataclass(frozen=True, slots=True)
class Reach:
    """Bounds of a look around.

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
