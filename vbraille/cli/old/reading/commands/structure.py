"""Commands that go by what the text is made of: paragraphs, headings, lists, links, figures."""

from __future__ import annotations

import re
from bisect import bisect_right
from typing import TYPE_CHECKING

from vbraille.cli.old.reading.keys import Context
from vbraille.cli.old.reading.lineviews import figure_of_block
from vbraille.cli.old.reading.position import LINES_PER_PAGE, block_of, has_pages
from vbraille.cli.old.reading.search.questions import (
    FindKind,
    FindLine,
    FindPage,
    FindShare,
    ListHeadings,
)
from vbraille.cli.old.reading.search.structure import (
    EACH_ITEM,
    IMAGE,
    LINK,
    START,
    first_place,
    marks_of,
    within,
)
from vbraille.errors import InputError
from vbraille.translate import BlockKind, MarkKind
from vbraille.wording import count, spelled

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader
    from vbraille.cli.old.reading.search.questions import ListedHeading
    from vbraille.layout import Line
    from vbraille.translate import Block, Mark, Source

    Numbered = dict[int, ListedHeading]

HEADING, LIST, TABLE = (kind.value for kind in (BlockKind.HEADING, BlockKind.ITEM, BlockKind.ROW))
QUOTE = BlockKind.QUOTE.value
_NAMES = {
    LIST: "list",
    TABLE: "table",
    EACH_ITEM: "item",
    IMAGE: "figure",
    START: "paragraph",
    QUOTE: "quotation",
}
_TOGETHER = (LIST, TABLE, QUOTE)  # which are gone to as a whole
_NEAR_LINES = 500  # that are laid out while the reader waits; farther ones are looked for meanwhile
_PAGE_OR_SHARE = re.compile(r"(\d{1,3})(?:[.,](\d))? ?%")


def go_to(reader: Reader, kind: str, *, backward: bool = False, level: int = 0) -> None:
    """Go to the next block of a kind, or to the one before.

    Parameters
    ----------
    kind
        Value of a `BlockKind`, "each item", or "start" for the beginning of a paragraph.
    backward
        Whether the one before is wanted.
    level
        Greatest level of a heading that is wanted; 0 for any.
    """
    name = _NAMES.get(kind, kind) + (f" of level {level}" if level else "")
    source, line = reader.layout.book.source, reader.line
    number = block_of(source, line)
    if backward and kind not in _TOGETHER and not _begins_here(line, source.block(number)):
        number += 1  # in the middle of a heading, the one before is that heading itself
    query = FindKind(kind, number, backward, level)
    what = name if kind in (*_TOGETHER, EACH_ITEM) else ""
    reader.find(query, lambda place: arrive(reader, place, name, what, backward=backward))


def go_to_mark(reader: Reader, kind: str, *, backward: bool = False) -> None:
    """Go to the next link or reference to a note, or picture, or to the one before.

    Parameters
    ----------
    kind
        "link", which references to notes are, too, or "image".
    backward
        Whether the one before is wanted.
    """
    name = _NAMES.get(kind, kind)
    source, line, hit = reader.layout.book.source, reader.line, reader.hit
    number = block_of(source, line)
    block = source.block(number)
    marks = [] if block is None else marks_of(block, kind)
    if backward:
        near = [mark for mark in marks if mark.start < (line.place if hit is None else hit)]
    else:
        near = [mark for mark in marks if mark.start >= (line.place if hit is None else hit + 1)]
    if near:
        mark = near[-1 if backward else 0]
        if reader.bring_under(mark.start):
            reader.say(_named(line.block, mark))
        else:
            arrive(reader, mark.start, name, backward=backward, kind=kind)
        return
    query = FindKind(kind, number, backward)
    reader.find(query, lambda place: arrive(reader, place, name, backward=backward, kind=kind))


def go_to_page(reader: Reader, *, backward: bool = False) -> None:
    """Go to the next page of print, or of braille where the book has none of print; or back."""
    source, line = reader.layout.book.source, reader.line
    if has_pages(source, line):
        number = block_of(source, line)
        if backward and _begins_here(line, source.block(number)):
            number = _before_unnumbered(source, number)
        query = FindKind(BlockKind.PAGE.value, number, backward)
        reader.find(query, lambda place: arrive(reader, place, "page", backward=backward))
        return
    page, above = divmod(reader.layout.number_of(line) - 1, LINES_PER_PAGE)  # both from 0
    wanted = (page if above else page - 1) if backward else page + 1
    missing = f"page: none {'before' if backward else 'after'} this"
    _go_to_braille_page(reader, wanted + 1, missing)


def ask_place(reader: Reader) -> None:
    """Ask for a page or a percentage, and go there."""
    reader.ask("go to", "type a page, or percent as in 40%, then Enter", "go to", _go_to_typed)


def follow(reader: Reader) -> None:
    """Go to what the link under the finger speaks of; from a note, back to its reference."""
    mark, source = _link_here(reader), reader.layout.book.source
    leads_to = None
    if mark is not None and mark.target.startswith("#"):
        leads_to = source.anchor(mark.target[1:])
    names = _names_of_note(reader)
    if names and (mark is None or _refers(source, leads_to, names)):
        _go_back_from_note(reader, names)
    elif mark is None:
        reader.say_not_found("link: none here")
    elif not mark.target.startswith("#"):
        reader.say(f"link: {mark.target}")
    else:
        reader.followed = mark
        arrive(reader, leads_to, mark.kind.value, backward=False)


def arrive(
    reader: Reader,
    place: int | None,
    name: str,
    what: str = "",
    *,
    backward: bool,
    kind: str = "",
) -> None:
    """Go to a place that was looked for, and say so; or that it was not found.

    Parameters
    ----------
    place
        The place; None if there is none.
    name
        What was looked for.
    what
        Words for what stands at the place, which are said with the line.
    backward
        Whether it was looked for backward.
    kind
        "link" or "image" if the place is one's, whose words are said.
    """
    if not reader.arrive(place, _mark_at(reader, place, kind) if kind else what):
        reader.say_not_found(f"{name}: none {'before' if backward else 'after'} this")


def _mark_at(reader: Reader, place: int | None, kind: str) -> str:
    """Words for the link or picture that begins at a place; empty for a figure, as it is said."""
    source = reader.layout.book.source
    number = None if place is None else source.block_at(place)
    block = None if number is None else source.block(number)
    marks = [] if block is None else [m for m in marks_of(block, kind) if m.start == place]
    if block is None or not marks:
        return ""
    is_felt = kind == IMAGE and marks[0].target and reader.under.figured.all is not None
    return "" if is_felt else _named(block, marks[0])


def _names_of_note(reader: Reader) -> tuple[str, ...]:
    """Targets of references to the note that the reader is in; none if it is no note."""
    source = reader.layout.book.source
    for _, block in within(source, block_of(source, reader.line), backward=True):
        if block.kind is not BlockKind.NOTE:
            break
        if block.anchors:  # of a note in several blocks the first has them
            return tuple(f"#{name}" for name in block.anchors)
    return ()


def _refers(source: Source, place: int | None, names: tuple[str, ...]) -> bool:
    """Tell if the block at a place has a reference to a note with one of some names."""
    number = None if place is None else source.block_at(place)
    block = None if number is None else source.block(number)
    return block is not None and any(
        mark.kind is MarkKind.NOTE and mark.target in names for mark in block.marks
    )


def _go_back_from_note(reader: Reader, names: tuple[str, ...]) -> None:
    """Go to where a note was followed from, or else to the last reference to it before it."""
    source, followed = reader.layout.book.source, reader.followed
    if followed is not None and followed.target in names:
        arrive(reader, followed.start, "reference", backward=True, kind=LINK)
    else:
        query = FindKind(LINK, block_of(source, reader.line), backward=True, targets=names)
        reader.find(
            query, lambda place: arrive(reader, place, "reference", backward=True, kind=LINK)
        )


def _named(block: Block, mark: Mark) -> str:
    """Words for a link, a note or a picture: which of these it is, and its text."""
    text = block.text
    words = " ".join(str(text)[text.index(mark.start) : text.index(mark.end)].split())
    if mark.kind is MarkKind.IMAGE:
        return words if mark.target else f"picture: {words}"
    if mark.kind is MarkKind.NOTE:
        words = words.strip("[]")  # which stand around the number in the text
    return f"{mark.kind.value}: {words}"


def _begins_here(line: Line, block: Block | None) -> bool:
    return block is not None and line.place <= first_place(block)


def _before_unnumbered(source: Source, number: int) -> int:
    """Number of the first page without a line right before a block; of the block if none is."""
    while (page := source.block(number - 1)) is not None and page.kind is BlockKind.PAGE:
        if len(page.text):
            break
        number -= 1
    return number


def _go_to_braille_page(reader: Reader, page: int, missing: str) -> None:
    """Go to a page of 25 lines, or say that it is missing."""
    before, number, layout = reader.character, (page - 1) * LINES_PER_PAGE + 1, reader.layout
    if page >= 1 and reader.search.seeker is not None and layout.lines_to(number) > _NEAR_LINES:
        table = "" if layout.book.table is None else layout.book.table.name
        query = FindLine(number, layout.width, table)
        reader.find(query, lambda place: _arrive_at_page(reader, place, str(page)))
    elif page >= 1 and reader.go(number):
        reader.keep_way_back(before)
        reader.announce_jump()
    else:
        reader.say_not_found(missing)


def _go_to_typed(reader: Reader, typed: str) -> None:
    share = _PAGE_OR_SHARE.fullmatch(typed)
    if share is not None:
        percent = float(f"{share[1]}.{share[2] or 0}")
        if percent > 100:
            reader.say(f"go to: {typed} is more than the book; type 0% to 100%")
            return
        query = FindShare(percent / 100)
        reader.find(query, lambda place: _arrive_at_share(reader, place, typed))
    elif has_pages(reader.layout.book.source, reader.line):
        query = FindPage(typed)
        reader.find(query, lambda place: _arrive_at_page(reader, place, typed))
    elif not typed.isdecimal():
        reader.say(f"go to: {typed!r} is no page; type a number, or percent as in 40%")
    elif reader.search.seeker is None and not reader.layout.counted:
        reader.say("go to: pages of this book are not counted yet; type percent as in 40%")
    else:
        _go_to_braille_page(reader, int(typed), f"page {typed}: there is no such page")


def _arrive_at_share(reader: Reader, place: int | None, typed: str) -> None:
    """Go to the line that begins nearest to a place."""
    found = None if place is None else reader.layout.place(place)
    if place is not None and found is not None:
        line, after = found[0], reader.layout.line(found[0].number + 1)
        if after is not None and after.place - place < place - line.place:
            line = after
        place = line.place
    arrive(reader, place, typed, backward=False)


def _arrive_at_page(reader: Reader, place: int | None, typed: str) -> None:
    if not reader.arrive(place):
        reader.say_not_found(f"page {typed}: there is no such page")


def _link_here(reader: Reader) -> Mark | None:
    """Link under the finger; or the one that was gone to, or that is alone on the line."""
    line, cell = reader.line, reader.cell
    links = marks_of(line.block)
    span = None if cell is None else line.source(cell)
    if span is not None:
        under = [mark for mark in links if mark.start < span[1] and span[0] < mark.end]
        if under:
            return under[-1]
    first, after = line.place, line.cells.end
    on_line = [mark for mark in links if mark.start < after and first < mark.end]
    gone_to = [mark for mark in on_line if mark.start == reader.hit]
    return gone_to[-1] if gone_to else on_line[0] if len(on_line) == 1 else None


_MOST = 100  # headings that are said at once
_NUMBER = re.compile(r"(\d+)(?::.*)?")


def ask_heading(reader: Reader) -> None:
    """List the headings, ask for one, and go there."""

    def ask(found: tuple[ListedHeading, ...] | None) -> None:
        if reader.context is not Context.READING:
            reader.say("contents: not now; answer first")
        elif found:
            _ask(reader, dict(enumerate(found, 1)))
        else:
            reader.say_not_found("contents: the book has no headings")

    reader.find(ListHeadings(), ask)


def _ask(reader: Reader, headings: Numbered) -> None:
    """Say headings with their numbers, and ask which one is meant."""
    levels = sorted({heading.level for heading in headings.values()})
    deepest = levels[0]
    for level in levels:
        if sum(heading.level <= level for heading in headings.values()) <= _MOST:
            deepest = level
    for number, heading in headings.items():
        if heading.level <= deepest:
            reader.say(_line(number, heading))
    if deepest < levels[-1]:
        reader.say(f"contents: {count(len(headings), 'heading')}; these are to level {deepest}")
    here = bisect_right([heading.character for heading in headings.values()], reader.character)
    reader.ask(
        "contents",
        "type a number or words, Enter; up and down go through the headings",
        "contents",
        lambda reader, typed: _go(reader, headings, typed),
        others=[_line(number, heading) for number, heading in headings.items()],
        at=here - 1,
    )


def _line(number: int, heading: ListedHeading) -> str:
    return f"{number}: {heading.title}, level {heading.level}"


def _go(reader: Reader, headings: Numbered, typed: str) -> None:
    """Go to the heading that is typed, by its number or by words of it; of several, ask again."""
    number = _NUMBER.fullmatch(typed)
    if number is not None and int(number[1]) in headings:
        found = {int(number[1]): headings[int(number[1])]}
    else:
        words = typed.casefold()
        found = {n: one for n, one in headings.items() if words in one.title.casefold()}
    if len(found) > 1:
        _ask(reader, found)
    elif not found or not reader.arrive(next(iter(found.values())).character):
        reader.say_not_found(
            f"contents: {'not in the lines that are read' if found else 'no such heading'}"
        )


def feel(reader: Reader) -> None:
    """Put the figure that the line stands for alone under the hand, until a key leads back."""
    under, address = reader.under, figure_of_block(reader.line)
    figures = under.figured.all if address else None
    if figures is None:
        reader.say_not_found("figure: none on this line")
        return
    try:
        under.alone = figures.feel(address, reader.say, reader.cue)
    except InputError as error:
        reader.say_not_found(f"figure not felt: {spelled(str(error))}")
        return
    reader.say(f"{under.alone.key('BACK', 'G')} or escape goes back to the text")
