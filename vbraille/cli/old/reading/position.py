"""The place in a book: line, page, share, heading, and the words that are left."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.reading.search.structure import Reach, within, words_in
from vbraille.translate import BlockKind

share_before = None
to_text = None

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.layout import Layout, Line
    from vbraille.translate import Block, Source

LINES_PER_PAGE = 25  # of a braille page, where the book has no pages of print
_SEARCH_S = 0.005
_LEAST_SHARE = 1e-4  # of a book, from which the rest is estimated


def block_of(source: Source, line: Line) -> int:
    """Number of the block that a line is of; 0 if the source does not find it."""
    return source.block_at(line.place) or 0


def before(source: Source, line: Line, kind: BlockKind) -> Block | None:
    """Nearest block of a kind at a line or before it; None if there is none near."""
    reach = Reach(seconds=_SEARCH_S)
    for _, block in within(source, block_of(source, line), backward=True, reach=reach):
        if block.kind is kind and not block.continues:
            return block
    return None


def has_pages(source: Source, line: Line) -> bool:
    """Tell whether the book says around a line where its pages begin."""
    if before(source, line, BlockKind.PAGE) is not None:
        return True
    reach = Reach(seconds=_SEARCH_S)
    blocks = within(source, block_of(source, line), reach=reach)
    return any(block.kind is BlockKind.PAGE for _, block in blocks)


def page_label(source: Source, line: Line) -> str:
    """Number of the page that a line is on, as the book writes or counts it; empty if none."""
    page = before(source, line, BlockKind.PAGE)
    return "" if page is None else page.page_number


def percent(layout: Layout, line: Line) -> str:
    """Say the hundredths of the book before a line: "40", or "about 40" if not counted."""
    share = layout.progress(line)
    about = "" if layout.book.source.complete or not share else "about "
    return f"{about}{100 * share:.0f}"


def line_name(layout: Layout, line: Line) -> str:
    """Name a line for a sentence; one whose number is not known is "the line"."""
    return f"line {layout.number_of(line)}" if layout.counted else "the line"


def place_sentence(layout: Layout, line: Line, what: str = "") -> str:
    """Say the place of a line: its number, or its share and page while lines are not counted.

    Parameters
    ----------
    layout, line
        The line.
    what
        Words for what stands there, which come first; empty for none.
    """
    if layout.counted:
        number = layout.number_of(line)
        return f"{what}, line {number}" if what else f"line: {number}"
    label = page_label(layout.book.source, line)
    place = f"{percent(layout, line)} %" + (f", page {label}" if label else "")
    return f"{what}, {place}" if what else f"place: {place}"


def heading_name(line: Line) -> str:
    """Words for the heading that a line is of, with its level; empty if it is of none."""
    block = line.block
    if block.kind is not BlockKind.HEADING:
        return ""
    return f"heading {block.level}: {' '.join(str(block.text).split())}"


def whereabouts(layout: Layout, line: Line) -> Iterator[str]:
    """Sentences on where a line is, one thing each."""
    source = layout.book.source
    counted = layout.counted
    if counted:
        yield f"line: {layout.number_of(line)}"
    label = page_label(source, line)
    if label:
        yield f"page: {label}"
    elif counted and not has_pages(source, line):
        yield f"page: {(layout.number_of(line) - 1) // LINES_PER_PAGE + 1} in braille"
    yield f"percent: {percent(layout, line)}"
    heading = before(source, line, BlockKind.HEADING)
    if heading is not None:
        yield f"heading: {str(heading.text).strip()}"
    words, exact = words_left(source, line)
    yield f"words left: {words}" if exact else f"words left: about {words}"


def words_left(source: Source, line: Line) -> tuple[int, bool]:
    """Number of words from a line to the end of the book, and whether they were counted.

    Where the end is far, the number is that of the words near by, multiplied by the share of the
    book that is left.
    """
    number = block_of(source, line)
    words = 0
    last, after = number, line.place
    for last, block in within(source, number):  # noqa: B007 - how far it came
        words += words_in(block)
        after = block.text.end
    here = source.block(number)
    if here is not None:  # what stands in the block before the line
        words -= len(to_text(here.text.codes[: here.text.index(line.place)]).split())
    if source.block(last + 1) is None:
        return max(words, 0), True
    before_it, after_it = (share_before(source, place) for place in (line.place, after))
    share = max(after_it - before_it, _LEAST_SHARE)
    estimate = int(words / share * (1 - before_it))
    return round(estimate, 2 - max(len(str(estimate)), 2)), False
