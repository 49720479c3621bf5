"""Commands that go to headings, lists, tables, quotations, links, notes, figures and pages."""

from __future__ import annotations

from functools import partial
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


def heading_said(block: Block, level: int | None = None) -> str:
    """Sentence on a heading; empty for other blocks, and for another level than the one wanted."""
    if block.heading is None or (level is not None and block.heading[0] != level):
        return ""
    return f"heading level {block.heading[0]}: {block.heading[1]}"


def _paragraph_said(block: Block) -> str:
    return heading_said(block) or block.kind.value if block.words else ""


def _item_said(block: Block) -> str:
    return f"item: {_plain(block)}" if block.kind is BlockKind.ITEM else ""


def _plain(block: Block) -> str:
    """Words of a block, without the bullet of an item."""
    return block.words.removeprefix("• ")


def _go(reader: Reader, step: int, thing: str, said: Callable[[Block], str]) -> None:
    """Go to the next block of which something can be said, or to the one before."""
    here = reader.line.block
    number = here.number
    if step < 0 and reader.line.place > here.start and not here.continues:
        number += 1  # in the middle of a heading, the one before is that heading itself
    for block in reader.book.source.blocks(number + step, step):
        words = "" if block.continues else said(block)
        if words:
            reader.jump(block.start, words)
            return
    reader.refuse_step(step, thing)


def _group(reader: Reader, step: int, thing: str, kind: BlockKind) -> None:
    """Go to a list, a table or a quotation."""

    def said(block: Block) -> str:
        before = reader.book.source.block(block.number - 1) if block.number else None
        goes_on = before is not None and (
            before.group == block.group if block.group else before.kind is kind
        )
        return "" if block.kind is not kind or goes_on else f"{thing}: {_plain(block)}"

    _go(reader, step, thing, said)


def _mark(reader: Reader, step: int, thing: str, kinds: tuple[MarkKind, ...]) -> None:
    """Go to a link, a note or a figure."""
    line, place = reader.line, reader.found_here
    if place is None:
        place = line.place - 1 if step > 0 else line.place
    for block in reader.book.source.blocks(line.block.number, step):
        for mark in block.marks[::step]:
            if mark.kind in kinds and (block.start + mark.start - place) * step > 0:
                reader.jump(block.start + mark.start, _mark_said(reader, block, mark))
                return
    reader.refuse_step(step, thing)


def _mark_said(reader: Reader, block: Block, mark: Mark) -> str:
    words = " ".join(block.text[mark.start : mark.end].split())
    if mark.kind is MarkKind.NOTE:
        return f"note: {words.strip('[]')}"  # which stand around the number in the text
    if mark.kind is MarkKind.IMAGE:
        felt = mark.target and reader.figures is not None
        return words if felt else f"picture: {words}"
    return f"link: {words}"


both_ways(
    "paragraph", "a ctrl-down A ctrl-up", "p ctrl-down P ctrl-up", "pins:NXPGRPH pins:PRPGRPH",
    name="paragraph",
)(partial(_go, thing="paragraph", said=_paragraph_said))  # fmt: skip
both_ways("heading", "e E", "h H", name="heading", first=True)(
    partial(_go, thing="heading", said=heading_said)
)
for level in range(1, 7):
    thing = f"heading of level {level}"
    command(f"next {thing}", str(level), name=f"next-heading-{level}")(
        partial(_go, step=1, thing=thing, said=partial(heading_said, level=level))
    )
for name, thing, keys, nvda, run in (
    ("list", "list", "l L", "", partial(_group, kind=BlockKind.ITEM)),
    ("table", "table", "r R", "t T", partial(_group, kind=BlockKind.ROW)),
    ("quotation", "quotation", "Q alt-q", "q Q", partial(_group, kind=BlockKind.QUOTE)),
    ("item", "item of a list", "I alt-i", "i I", partial(_go, said=_item_said)),
    ("link", "link or note", "k K", "k tab K shift-tab", partial(_mark, kinds=_LINKS)),
    ("figure", "figure or picture", ", ;", "g G", partial(_mark, kinds=(MarkKind.IMAGE,))),
):
    both_ways(thing, keys, nvda, name=name)(partial(run, thing=thing))


@command("follow the link or note under the finger; from a note, go back", "enter")
def follow(reader: Reader) -> None:
    line, source, here = reader.line, reader.book.source, reader.found_here
    block, place = line.block, reader.place if here is None else here
    marks = (mark for mark in block.marks if mark.kind in _LINKS)
    ahead = next((mark for mark in marks if block.start + mark.end > place), None)
    if ahead is not None and block.start + ahead.start >= line.end:
        ahead = None
    target = "" if ahead is None else ahead.target
    to = source.anchor(target[1:]) if target.startswith("#") else None
    there = None if to is None else source.block_at(to)
    leads_back = there is not None and there.kind is not BlockKind.NOTE
    if block.kind is BlockKind.NOTE and (ahead is None or leads_back):
        _go_back(reader, block)
    elif ahead is None:
        reader.refuse("no link or note here")
    elif not target.startswith("#"):
        reader.say(f"link: {target}")
    elif to is None or there is None:
        reader.refuse("the link leads nowhere")
    else:
        reader.note_from = block.start + ahead.start
        words = there.words.strip("[] ")
        named = f"note {words}" if there.kind is BlockKind.NOTE else heading_said(there) or words
        reader.jump(to, named)


def _go_back(reader: Reader, note: Block) -> None:
    """Go from a note to where it was followed from, or else to a reference to it before it."""
    source = reader.book.source
    place, reader.note_from = reader.note_from, None
    while not note.anchors and note.number and (before := source.block(note.number - 1)):
        if before.kind is not BlockKind.NOTE:
            break
        note = before
    names = {f"#{name}" for name in note.anchors}
    if place is None:
        place = next(
            (
                block.start + mark.start
                for block in source.blocks(note.number - 1, -1)
                for mark in block.marks
                if mark.kind is MarkKind.NOTE and mark.target in names
            ),
            None,
        )
    if place is None:
        reader.refuse("no reference to this note")
    else:
        reader.jump(place, "back at the text")


@both_ways("page", "f pagedown F pageup")
def page(reader: Reader, step: int) -> None:
    if has_pages(reader):
        _go(reader, step, "page", lambda b: f"page {b.page_number}" if b.page_number else "")
        return
    at, above = divmod(reader.layout.number(reader.line) - 1, LINES_PER_PAGE)  # both from 0
    wanted = at + 1 if step > 0 else at - (not above)
    if not _go_to_braille_page(reader, wanted):
        reader.refuse_step(step, "page")


def has_pages(reader: Reader) -> bool:
    """Tell whether the book says where its pages begin."""
    if reader.has_pages is None:
        reader.has_pages = any(block.page_number for block in reader.book.source.blocks())
    return reader.has_pages


def _go_to_braille_page(reader: Reader, number: int) -> bool:
    line = reader.layout.line(number * LINES_PER_PAGE + 1)
    if line is not None:
        reader.jump(line.place, f"page {number + 1} in braille")
    return line is not None


@command("go to a page, or to a percentage of the text", "g ctrl-g", "ctrl-g", first=True)
def go_to(reader: Reader) -> None:
    typed = reader.typed.setdefault("go to", [])

    def answer(text: str) -> None:
        text = text.strip()
        if not text:
            reader.say("cancelled")
            return
        typed.append(text)
        if text.endswith("%"):
            _go_to_share(reader, text)
        elif not _go_to_page(reader, text):
            reader.refuse(f"no page {text}" if text.isalnum() else f"{text!r} is not a page number")

    reader.ask("page, or percent such as 40%", answer, typed)


def _go_to_share(reader: Reader, typed: str) -> None:
    try:
        percent = float(typed[:-1].replace(",", "."))
    except ValueError:
        percent = -1.0
    if 0 <= percent <= 100:
        length = len(reader.book.source.text)
        place = min(int(percent * length / 100), max(length - 2, 0))
        reader.jump(place, f"{percent:g} percent")
    else:
        reader.refuse(f"{typed!r} is not 0 to 100 percent")


def _go_to_page(reader: Reader, typed: str) -> bool:
    if not has_pages(reader):
        return typed.isdecimal() and _go_to_braille_page(reader, int(typed) - 1)
    for block in reader.book.source.blocks():
        if block.page_number.lower() == typed.lower():
            reader.jump(block.start, f"page {block.page_number}")
            return True
    return False


@command("list the headings, and go to one", "O", "f7", first=True)
def contents(reader: Reader) -> None:
    headings = reader.book.source.headings()
    if not headings:
        reader.refuse("no headings")
        return
    titles = [f"{n}: {each.title}, level {each.level}" for n, each in enumerate(headings, 1)]
    top = min(each.level for each in headings)
    for title, each in zip(titles, headings, strict=True):
        if len(headings) <= _MOST_LISTED or each.level == top:
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
    for row in reader.book.source.blocks(block.number):
        if row.kind is BlockKind.ROW and row.group != block.group:
            break
        if row.kind is BlockKind.ROW and any(row.headers):
            named = "headers" if row is block else "header row"
            reader.say(f"{named}: {', '.join(row.headers)}")
            return
    reader.refuse("the table has no headers")


@command("feel the figure of this line, alone", "G", "E")
def feel_figure(reader: Reader) -> None:
    try:
        inside = None if reader.figures is None else reader.figures.feel(reader)
    except InputError as error:
        reader.say(f"figure not felt: {error}", Cue.NOT_FOUND)
        return
    if inside is None:
        reader.refuse("no figure here")
    else:
        reader.inside = inside
        inside.begin()
