"""Commands that go to headings, lists, tables, quotations, links, notes, figures and pages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.commands import both_ways, command
from vbraille.reading.moving import LINES_PER_PAGE
from vbraille.reading.outputs import Cue
from vbraille.translate import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader
    from vbraille.translate import Block, Mark

_LINKS = (MarkKind.LINK, MarkKind.NOTE)
_MOST_LISTED = 100  # headings; of more, those of the upper levels are listed


def _go(reader: Reader, step: int, thing: str, said: Callable[[Block], str]) -> None:
    """Go to the next block of which something can be said, or to the one before."""
    here = reader.line.block
    number = here.number
    if step < 0 and reader.line.place > here.start and not here.continues:
        number += 1  # in the middle of a heading, the one before is that heading itself
    for block in reader.book.source.blocks(number + step, step):
        words = said(block)
        if words:
            reader.jump(block.start, words)
            return
    reader.refuse(f"no {'next' if step > 0 else 'previous'} {thing}")


def _begins(reader: Reader, block: Block, kind: BlockKind) -> bool:
    """Tell whether a list, a table or a quotation begins with a block."""
    if block.kind is not kind or block.continues:
        return False
    before = reader.book.source.block(block.number - 1) if block.number else None
    if before is not None and block.group:
        return before.group != block.group
    return before is None or before.kind is not kind


@both_ways(
    "paragraph", "a ctrl-down A ctrl-up", "p ctrl-down P ctrl-up", also="pins:NXPGRPH pins:PRPGRPH"
)
def paragraph(reader: Reader, step: int) -> None:
    _go(reader, step, "paragraph", lambda block: _named(block) if block.words else "")


def _named(block: Block) -> str:
    if block.continues:
        return ""
    if block.kind is BlockKind.HEADING:
        return heading_said(block)
    return block.kind.value


@both_ways("heading", "e E", "h H", first=True)
def heading(reader: Reader, step: int) -> None:
    _go(reader, step, "heading", heading_said)


def heading_said(block: Block, level: int | None = None) -> str:
    """Sentence on a heading; empty for other blocks, and for another level than the one wanted."""
    if block.heading is None or (level is not None and block.heading[0] != level):
        return ""
    return f"heading level {block.heading[0]}: {block.heading[1]}"


def _add_levels() -> None:
    for level in range(1, 7):

        @command(f"next heading of level {level}", str(level), name=f"next-heading-{level}")
        def next_of_level(reader: Reader, level: int = level) -> None:
            _go(reader, 1, f"heading of level {level}", lambda block: heading_said(block, level))


_add_levels()


@both_ways("list", "l L")
def list_(reader: Reader, step: int) -> None:
    _go_to_group(reader, step, "list", BlockKind.ITEM)


@both_ways("table", "r R", "t T")
def table(reader: Reader, step: int) -> None:
    _go_to_group(reader, step, "table", BlockKind.ROW)


@both_ways("quotation", "Q alt-q", "q Q")
def quotation(reader: Reader, step: int) -> None:
    _go_to_group(reader, step, "quotation", BlockKind.QUOTE)


def _go_to_group(reader: Reader, step: int, thing: str, kind: BlockKind) -> None:
    def said(block: Block) -> str:
        return f"{thing}: {_plain(block)}" if _begins(reader, block, kind) else ""

    _go(reader, step, thing, said)


def _plain(block: Block) -> str:
    """Words of a block, without the bullet of an item."""
    return block.words.removeprefix("• ")


@both_ways("item of a list", "I alt-i", "i I")
def item(reader: Reader, step: int) -> None:
    def said(block: Block) -> str:
        is_item = block.kind is BlockKind.ITEM and not block.continues
        return f"item: {_plain(block)}" if is_item else ""

    _go(reader, step, "item", said)


@both_ways("link or note", "k K", "k tab K shift-tab")
def link(reader: Reader, step: int) -> None:
    _go_to_mark(reader, step, _LINKS, "link or note")


@both_ways("figure or picture", ", ;", "g G")
def figure(reader: Reader, step: int) -> None:
    _go_to_mark(reader, step, (MarkKind.IMAGE,), "figure or picture")


def _go_to_mark(reader: Reader, step: int, kinds: tuple[MarkKind, ...], thing: str) -> None:
    line, place = reader.line, reader.found_here
    if place is None:
        place = line.place - 1 if step > 0 else line.place
    for block in reader.book.source.blocks(line.block.number, step):
        for mark in block.marks[::step]:
            if mark.kind in kinds and (block.start + mark.start - place) * step > 0:
                reader.jump(block.start + mark.start, _mark_said(reader, block, mark))
                return
    reader.refuse(f"no {'next' if step > 0 else 'previous'} {thing}")


def _mark_said(reader: Reader, block: Block, mark: Mark) -> str:
    words = " ".join(block.text[mark.start : mark.end].split())
    if mark.kind is MarkKind.NOTE:
        return f"note: {words.strip('[]')}"  # which stand around the number in the text
    if mark.kind is MarkKind.IMAGE:
        felt = mark.target and reader.figures is not None
        return words if felt else f"picture: {words}"
    return f"link: {words}"


@command("follow the link or note under the finger; from a note, go back", "enter")
def follow(reader: Reader) -> None:
    line, source = reader.line, reader.book.source
    block, place = line.block, reader.found_here
    if place is None:
        place = reader.place
    ahead = [
        mark
        for mark in block.marks
        if mark.kind in _LINKS
        and block.start + mark.end > place
        and block.start + mark.start < line.end
    ]
    if block.kind is BlockKind.NOTE and not (ahead and not _refers(reader, ahead[0])):
        _go_back(reader, block)
    elif not ahead:
        reader.refuse("no link or note here")
    elif not ahead[0].target.startswith("#"):
        reader.say(f"link: {ahead[0].target}")
    else:
        to = source.anchor(ahead[0].target[1:])
        there = None if to is None else source.block_at(to)
        if to is None or there is None:
            reader.refuse("the link leads nowhere")
            return
        reader.note_from = block.start + ahead[0].start
        words = there.words.strip("[] ")
        named = f"note {words}" if there.kind is BlockKind.NOTE else heading_said(there) or words
        reader.jump(to, named)


def _refers(reader: Reader, mark: Mark) -> bool:
    """Tell whether a mark leads back to a reference to the note that is read."""
    to = reader.book.source.anchor(mark.target[1:]) if mark.target.startswith("#") else None
    there = None if to is None else reader.book.source.block_at(to)
    return there is not None and there.kind is not BlockKind.NOTE


def _go_back(reader: Reader, note: Block) -> None:
    """Go from a note to where it was followed from, or else to a reference to it before it."""
    source = reader.book.source
    while not note.anchors and note.number and (before := source.block(note.number - 1)):
        if before.kind is not BlockKind.NOTE:
            break
        note = before
    names = {f"#{name}" for name in note.anchors}
    from_place, reader.note_from = reader.note_from, None
    if from_place is not None:
        reader.jump(from_place, "back at the text")
        return
    for block in source.blocks(note.number - 1, -1):
        for mark in block.marks:
            if mark.kind is MarkKind.NOTE and mark.target in names:
                reader.jump(block.start + mark.start, "back at the text")
                return
    reader.refuse("no reference to this note")


@both_ways("page", "f pagedown F pageup")
def page(reader: Reader, step: int) -> None:
    if has_pages(reader):
        _go(reader, step, "page", lambda b: f"page {b.page_number}" if b.page_number else "")
        return
    at, above = divmod(reader.layout.number(reader.line) - 1, LINES_PER_PAGE)  # both from 0
    wanted = at + 1 if step > 0 else at - (not above)
    _go_to_braille_page(reader, wanted, f"no {'next' if step > 0 else 'previous'} page")


def has_pages(reader: Reader) -> bool:
    """Tell whether the book says where its pages begin."""
    if reader.has_pages is None:
        reader.has_pages = any(block.page_number for block in reader.book.source.blocks())
    return reader.has_pages


def _go_to_braille_page(reader: Reader, number: int, missing: str) -> None:
    line = reader.layout.line(number * LINES_PER_PAGE + 1) if number >= 0 else None
    if line is None:
        reader.refuse(missing)
    else:
        reader.jump(line.place, f"page {number + 1} in braille")


@command("go to a page, or to a percentage of the text", "g ctrl-g", "ctrl-g", first=True)
def go_to(reader: Reader) -> None:
    typed = reader.typed.setdefault("go to", [])

    def answer(text: str) -> None:
        text = text.strip()
        if not text:
            reader.say("cancelled")
            return
        typed.append(text)
        _go_to(reader, text)

    reader.ask("page, or percent such as 40%", answer, typed)


def _go_to(reader: Reader, typed: str) -> None:
    source = reader.book.source
    if typed.endswith("%"):
        try:
            share = float(typed[:-1].replace(",", ".")) / 100
        except ValueError:
            share = -1.0
        if not 0 <= share <= 1:
            reader.refuse(f"{typed!r} is not 0 to 100 percent")
        else:
            length = len(source.text)
            reader.jump(min(int(share * length), max(length - 2, 0)), f"{100 * share:g} percent")
        return
    if has_pages(reader):
        for block in source.blocks():
            if block.page_number.lower() == typed.lower():
                reader.jump(block.start, f"page {block.page_number}")
                return
    elif typed.isdecimal():
        _go_to_braille_page(reader, int(typed) - 1, f"no page {typed}")
        return
    reader.refuse(f"no page {typed}" if typed.isalnum() else f"{typed!r} is not a page number")


@command("list the headings, and go to one", "O", "f7", first=True)
def contents(reader: Reader) -> None:
    headings = reader.book.source.headings()
    if not headings:
        reader.refuse("no headings")
        return
    titles = [f"{n}: {each.title}, level {each.level}" for n, each in enumerate(headings, 1)]
    top = min(each.level for each in headings)
    few = len(headings) <= _MOST_LISTED
    for title, each in zip(titles, headings, strict=True):
        if few or each.level == top:
            reader.say(title)

    def answer(typed: str) -> None:
        number, words = typed.partition(":")[0].strip(), typed.strip().casefold()
        if number.isdecimal():
            found = headings[int(number) - 1 : int(number)]
        else:
            found = [each for each in headings if words and words in each.title.casefold()]
        if len(found) == 1:
            reader.jump(found[0].place, f"heading level {found[0].level}: {found[0].title}")
        elif found:
            reader.say(f"{len(found)} headings: {'; '.join(each.title for each in found)}")
        else:
            reader.say(f"no heading {typed.strip()!r}", Cue.NOT_FOUND)

    # Up and down go through the headings from the place of the reader on.
    before = sum(each.place <= reader.place for each in headings)
    reader.ask("number or words of a heading", answer, [*titles[before:], *titles[:before]])


@command("say the headers of the table", "H", "e")
def say_headers(reader: Reader) -> None:
    block = reader.line.block
    if block.kind is not BlockKind.ROW:
        reader.refuse("this is not a row of a table")
        return
    rows = (each for each in reader.book.source.blocks(block.number) if each.kind is BlockKind.ROW)
    for row in rows:
        if row.group != block.group:
            break
        if any(row.headers):
            named = "header row: " if row is not block else "headers: "
            reader.say(f"{named}{', '.join(row.headers)}")
            return
    reader.refuse("the table has no headers")


@command("feel the figure of this line, alone", "G", "E")
def feel_figure(reader: Reader) -> None:
    if reader.figures is None:
        reader.refuse("no figure here")
        return
    try:
        inside = reader.figures.feel(reader)
    except InputError as error:
        reader.say(f"figure not felt: {error}", Cue.NOT_FOUND)
        return
    if inside is None:
        reader.refuse("no figure here")
    else:
        reader.inside = inside
        inside.begin()
