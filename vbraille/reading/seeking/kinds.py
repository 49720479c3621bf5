"""Blocks of a kind, found as they follow each other: headings, lists, links, pages of print."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.documents.document import Document
from vbraille.translate.source import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.reading.queries import FindKind
    from vbraille.translate.source import Block, Mark, Source

# Kinds that `FindKind` is asked for beside those of blocks.
LINK = MarkKind.LINK.value
START = "start"
_LINKS = (MarkKind.LINK, MarkKind.NOTE)
_GROUPED = (BlockKind.ITEM.value, BlockKind.ROW.value)
_NOT_PLAIN = frozenset(kind.value for kind in BlockKind) - {"paragraph", "line"} | {LINK}


def first_place(block: Block) -> int:
    """Place of the first character of a block; of an empty one, a place that finds it."""
    return int(block.text.places[0]) if len(block.text) else max(block.text.end - 1, 0)


def links_of(block: Block) -> list[Mark]:
    """Links and references to notes in a block, by where they begin."""
    return sorted((m for m in block.marks if m.kind in _LINKS), key=lambda mark: mark.start)


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
        return  # nobody waits for the end of a long text that has none
    if query.kind in _GROUPED:
        yield from _find_group(source, query)
        return
    step = -1 if query.backward else 1
    for number, block in blocks_from(source, query.block + step, backward=query.backward):
        if query.kind == LINK:
            links = links_of(block)
            if links:
                yield links[-1 if query.backward else 0].start
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


def _is_wanted(block: Block, query: FindKind) -> bool:
    return (
        block.kind.value == query.kind
        and not block.continues
        and (not query.level or block.level <= query.level)
    )


def _is_start(source: Source, number: int, block: Block) -> bool:
    """Whether a paragraph begins; lines that the source keeps are one until an empty one."""
    if block.continues or not str(block.text).strip():
        return False
    before = source.block(number - 1) if number and block.kind is BlockKind.LINE else None
    return before is None or before.kind is not BlockKind.LINE or not str(before.text).strip()


def _find_group(source: Source, query: FindKind) -> Iterator[int | float]:
    """Look for the beginning of a list or a table other than the one that the reader is in."""
    step = -1 if query.backward else 1
    kind, here = query.kind, source.block(query.block)
    inside = here is not None and here.kind.value == kind
    group = query.group or (here.group if inside and here is not None else 0)
    found: Block | None = None
    for number, block in blocks_from(source, query.block + step, backward=query.backward):
        yield source.progress(number)
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
    if found is not None:
        yield first_place(found)
