"""Commands that go to headings, lists, tables, quotations, links, notes, figures and pages."""

from __future__ import annotations

import re
from functools import partial
from itertools import takewhile
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.reading.commands import Where, both_ways, command
from vbraille.reading.moving import LINES_PER_PAGE
from vbraille.reading.outputs import Cue
from vbraille.translate import BlockKind, MarkKind

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.reader import Reader
    from vbraille.translate import Block, Mark

_LINKS = (MarkKind.LINK, MarkKind.NOTE)
_PERCENT = re.compile(r"(\d+\.?\d*) *%")
_MOST_LISTED = 100  # headings; of more, those of the upper levels are listed


def _go(reader: Reader, step: int, thing: str, said: Callable[[Block], str]) -> None:
    """Go to the next or previous block for which ``said`` has words, and say them."""
    place = reader.line.place
    for block in reader.book.source.blocks(reader.line.block.number, step):
        words = "" if block.continues else said(block)
        if words and (block.start - place) * step > 0:
            reader.jump(block.start, words)
            return
    reader.refuse_step(step, thing)


def _heading_said(block: Block, level: int | None = None) -> str:
    """Sentence on a heading; empty for other blocks, and for another level than the one wanted."""
    if block.heading is None or level not in (None, block.heading[0]):
        return ""
    return f"heading level {block.heading[0]}: {block.heading[1]}"


def _paragraph_said(block: Block) -> str:
    return _heading_said(block) or block.kind.value if block.words else ""


def _item_said(block: Block) -> str:
    return f"item: {_plain(block)}" if block.kind is BlockKind.ITEM else ""


def _plain(block: Block) -> str:
    """Words of a block, without the bullet of an item."""
    return block.words.removeprefix("• ")


def _group(reader: Reader, step: int, thing: str, kind: BlockKind) -> None:
    """Go to a list, a table or a quotation."""

    def said(block: Block) -> str:
        before = reader.book.source.block(block.number - 1)
        goes_on = before is not None and (
            before.group == block.group if block.group else before.kind is kind
        )
        return "" if block.kind is not kind or goes_on else f"{thing}: {_plain(block)}"

    _go(reader, step, thing, said)


def _mark(reader: Reader, step: int, thing: str, kinds: tuple[MarkKind, ...]) -> None:
    """Go to a link, a note or a figure."""
    here = reader.found_here
    place = reader.line.place - (step > 0) if here is None else here
    for block in reader.book.source.blocks(reader.line.block.number, step):
        for mark in block.marks[::step]:
            at = block.start + mark.start
            if mark.kind in kinds and (at - place) * step > 0:
                reader.jump(at, _mark_said(reader, block, mark))
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
    "paragraph", "a ctrl-down | A ctrl-up", "p ctrl-down | P ctrl-up",
    "pins:NXPGRPH | pins:PRPGRPH", name="paragraph",
)(partial(_go, thing="paragraph", said=_paragraph_said))  # fmt: skip
both_ways("heading", "e | E", "h | H", name="heading", first=True)(
    partial(_go, thing="heading", said=_heading_said)
)
for level in range(1, 7):
    thing = f"heading of level {level}"
    command(f"next {thing}", str(level), name=f"next-heading-{level}")(
        partial(_go, step=1, thing=thing, said=partial(_heading_said, level=level))
    )
for name, thing, keys, nvda, run in (
    ("list", "list", "l | L", "", partial(_group, kind=BlockKind.ITEM)),
    ("table", "table", "r | R", "t | T", partial(_group, kind=BlockKind.ROW)),
    ("quotation", "quotation", "Q | alt-q", "q | Q", partial(_group, kind=BlockKind.QUOTE)),
    ("item", "item of a list", "I | alt-i", "i | I", partial(_go, said=_item_said)),
    ("link", "link or note", "k | K", "k tab | K shift-tab", partial(_mark, kinds=_LINKS)),
    ("figure", "figure or picture", ", | ;", "g | G", partial(_mark, kinds=(MarkKind.IMAGE,))),
):
    both_ways(thing, keys, nvda, name=name)(partial(run, thing=thing))


@command("follow the link or note under the finger; from a note, go back", "enter")
def follow(reader: Reader) -> None:
    line, source, here = reader.line, reader.book.source, reader.found_here
    block, place = line.block, reader.place if here is None else here
    begin, links = block.start, (mark for mark in block.marks if mark.kind in _LINKS)
    ahead = next((one for one in links if one.end > place - begin and one.start < line.after), None)
    target = "" if ahead is None else ahead.target
    to = source.anchor(target[1:]) if target.startswith("#") else None
    there = None if to is None else source.block_at(to)
    leads_back = there is not None and there.kind is not BlockKind.NOTE
    if block.kind is BlockKind.NOTE and (ahead is None or leads_back):
        _go_back(reader, block)
    elif ahead is None:
        reader.refuse("no link or note here")
    elif there is not None:
        reader.note_from = begin + ahead.start
        words = there.words.strip("[] ")
        noted = there.kind is BlockKind.NOTE
        reader.jump(there.start, f"note {words}" if noted else _heading_said(there) or words)
    elif target.startswith("#"):
        reader.refuse("the link leads nowhere")
    else:
        reader.say(f"link: {target}")


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
        references = (
            block.start + mark.start
            for block in source.blocks(note.number - 1, -1)
            for mark in block.marks
            if mark.kind is MarkKind.NOTE and mark.target in names
        )
        place = next(references, None)
    if place is None:
        reader.refuse("no reference to this note")
    else:
        reader.jump(place, "back at the text")


@both_ways("page", "f pagedown | F pageup")
def page(reader: Reader, step: int) -> None:
    if _has_pages(reader):
        _go(reader, step, "page", lambda b: f"page {b.page_number}" if b.page_number else "")
        return
    at, above = divmod(reader.layout.number(reader.line) - 1, LINES_PER_PAGE)  # both from 0
    if not _go_to_braille_page(reader, at + 2 if step > 0 else at + 1 - (not above)):
        reader.refuse_step(step, "page")


def _has_pages(reader: Reader) -> bool:
    """Tell whether the book says where its pages begin."""
    if reader.has_pages is None:
        reader.has_pages = any(block.page_number for block in reader.book.source.blocks())
    return reader.has_pages


def _go_to_braille_page(reader: Reader, number: int) -> bool:
    line = reader.layout.line((number - 1) * LINES_PER_PAGE + 1)
    if line is not None:
        reader.jump(line.place, f"page {number} in braille")
    return line is not None


@command("go to a page, or to a percentage of the text", "g ctrl-g", "ctrl-g", first=True)
def go_to(reader: Reader) -> None:
    typed = reader.typed.setdefault("go to", [])

    def answer(text: str) -> None:
        typed.append(text)
        source = reader.book.source
        if text.endswith("%"):
            percent = _PERCENT.fullmatch(text.replace(",", "."))
            if percent is None or float(percent[1]) > 100:
                reader.refuse(f"{text!r} is not 0 to 100 percent")
                return
            length, share = len(source.text), float(percent[1])
            place = min(int(share * length / 100), max(length - 2, 0))
            reader.jump(place, f"{share:g} percent")
            return
        if _has_pages(reader):
            pages = (one for one in source.blocks() if one.page_number.lower() == text.lower())
            if (found := next(pages, None)) is not None:
                reader.jump(found.start, f"page {found.page_number}")
                return
        elif text.isdecimal() and _go_to_braille_page(reader, int(text)):
            return
        reader.refuse(f"no page {text}" if text.isalnum() else f"{text!r} is not a page number")

    reader.ask("page, or percent such as 40%", answer, typed)


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
        number, words = typed.partition(":")[0], typed.casefold()
        numbered = [each for n, each in enumerate(headings, 1) if str(n) == number]
        found = numbered or [each for each in headings if words in each.title.casefold()]
        if len(found) == 1:
            reader.jump(found[0].place, f"heading level {found[0].level}: {found[0].title}")
        elif found:
            reader.say(f"{len(found)} headings: {'; '.join(each.title for each in found)}")
        else:
            reader.say(f"no heading {typed!r}", Cue.NOT_FOUND)

    # Up and down go through the headings from the place of the reader on.
    before = sum(each.place <= reader.place for each in headings)
    reader.ask("number or words of a heading", answer, [*titles[before:], *titles[:before]])


@command("say the headers of the table", "H", "e")
def say_headers(reader: Reader) -> None:
    block = reader.line.block
    if block.kind is not BlockKind.ROW:
        reader.refuse("this is not a row of a table")
        return
    rows = (row for row in reader.book.source.blocks(block.number) if row.kind is BlockKind.ROW)
    of_table = takewhile(lambda row: row.group == block.group, rows)
    headed = next((row for row in of_table if any(row.headers)), None)
    if headed is None:
        reader.refuse("the table has no headers")
    else:
        named = "headers" if headed is block else "header row"
        reader.say(f"{named}: {', '.join(headed.headers)}")


@command("feel the figure of this line, alone", "G", "E")
def feel_figure(reader: Reader) -> None:
    try:
        figure = None if reader.figures is None else reader.figures.of(reader.line)
        if figure is None:
            reader.refuse("no figure here")
            return
        from vbraille.pictures.loading import check_fits
        from vbraille.reading.picture import Picture  # loads numba

        check_fits(figure.scene, reader.display)
    except InputError as error:
        reader.say(f"figure not felt: {error}", Cue.NOT_FOUND)
        return
    how = reader.device, reader.outputs, reader.key_set
    reader.inside = Picture(figure, *how, where=Where.FIGURE)
    reader.inside.begin()
    for note in figure.notes:
        reader.say(f"note: {note}")
