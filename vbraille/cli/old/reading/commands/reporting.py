"""Commands that say where the reader is, and what is under the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.braille.cells import dots_of
from vbraille.cli.old.reading.outputs import Echo
from vbraille.cli.old.reading.position import block_of, whereabouts
from vbraille.cli.old.reading.search.structure import within

BETWEEN = None
from vbraille.translate import BlockKind, describe

if TYPE_CHECKING:
    from vbraille.cli.old.reading.reader import Reader
    from vbraille.layout import Line


def say_place(reader: Reader) -> None:
    """Say line, page, percentage, heading and the number of words that are left."""
    _say_figure(reader)
    for sentence in whereabouts(reader.layout, reader.line):
        reader.say(sentence)


def say_line(reader: Reader) -> None:
    """Say the line again."""
    echo = Echo.TEXT if reader.echo is Echo.NONE else reader.echo
    for sentence in echo.words(reader.line):
        reader.say(sentence)


def say_character(reader: Reader) -> None:
    """Say the cell under the middle of the array by its dots, its text and its word."""
    if not _say_figure(reader):
        say_cell(reader, reader.cell)


def say_cell(reader: Reader, cell: int | None) -> None:
    """Say a cell of the line by its dots, its text and its word; that there is none if it is not.

    Parameters
    ----------
    cell
        Number of the cell, from 0; None for none.
    """
    line = reader.line
    if cell is None or not 0 <= cell < len(line):
        reader.say("cell: none here")
        return
    reader.say(f"cell: {_dots(int(line.masks[cell]))}")
    span = line.source(cell)
    if span is None:
        return
    text = _text(line, *span)
    if len(text) == 1:
        named = text.isspace() or not (text.isascii() and text.isprintable())
        reader.say(f"character: {describe(text) if named else text}")
    elif text:
        reader.say(f"characters: {text}")
    word = line.word(cell)
    if word:
        reader.say(f"word: {word}")


def say_word(reader: Reader) -> None:
    """Say the word under the middle of the array."""
    word = _word(reader)
    reader.say(f"word: {word}" if word else "word: none here")


def spell_word(reader: Reader) -> None:
    """Say the letters of the word under the middle of the array."""
    word = _word(reader)
    reader.say(f"spelling: {' '.join(word)}" if word else "word: none here")


def say_headers(reader: Reader) -> None:
    """Say the headers of the table whose row is under the hand."""
    line = reader.line
    if line.block.kind is not BlockKind.ROW:
        reader.say("headers: this is no row of a table")
    elif any(line.block.headers):
        reader.say(f"headers: {'; '.join(line.block.headers)}")
    elif headers := _headers_below(reader, line):
        reader.say(f"headers: in this row: {'; '.join(headers)}")
    else:
        reader.say("headers: the table has none")


def _headers_below(reader: Reader, line: Line) -> tuple[str, ...]:
    """Headers of the rows below, if those of a row are among them; none if it has no headers."""
    cells = str(line.block.text).strip().split(BETWEEN)
    source = reader.layout.book.source
    for _, block in within(source, block_of(source, line)):
        if block.kind is BlockKind.PAGE:
            continue
        if block.kind is not BlockKind.ROW or block.group != line.block.group:
            break
        if any(block.headers):
            there = all(any(cell in header for header in block.headers) for cell in cells)
            return block.headers if there else ()
    return ()


def _say_figure(reader: Reader) -> bool:
    """Say the figure under the finger, and what of it is there; False if it is on none."""
    here = reader.under.here
    if here is None:
        return False
    reader.say(f"figure: {here.title}")
    reader.say(f"here: {here.name or 'nothing with a name'}")
    return True


def _dots(mask: int) -> str:
    """Dots of a cell: "dot 1", "dots 1-2-4", "no dots"."""
    dots = dots_of(mask)
    if not dots:
        return "no dots"
    return f"dot{'s' if len(dots) > 1 else ''} {'-'.join(map(str, dots))}"


def _word(reader: Reader) -> str:
    return "" if reader.cell is None else reader.line.word(reader.cell)


def _text(line: Line, first: int, after: int) -> str:
    """Text that stands at some places of the source."""
    text = line.block.text
    return str(text)[text.index(first) : text.index(after)]
