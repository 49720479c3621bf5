"""Commands that say where the finger is, and what is there."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from vbraille.braille.cells import dots_of
from vbraille.reading.commands import command
from vbraille.reading.structure import LINES_PER_PAGE

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_LOOKED_BACK = 5000  # blocks, for the page and the heading


@command("say line, page, percent and heading", "i", "i delete", first=True, also="pins:INFO")
def info(reader: Reader) -> None:
    here = reader.figure_here
    said = [f"figure: {here[0]}"] if here else []
    said.append(reader.named())
    page = heading = ""
    block = reader.line.block
    for number, each in enumerate(reader.book.source.blocks(block.number, -1)):
        page = page or each.page_number
        heading = heading or (each.heading[1] if each.heading else "")
        if (page and heading) or number > _LOOKED_BACK:
            break
    if not page and reader.has_pages is False:
        page = f"{(reader.layout.number(reader.line) - 1) // LINES_PER_PAGE + 1} in braille"
    said += [f"page {page}"] if page else []
    said.append(f"{100 * reader.layout.progress(reader.line):.0f} percent")
    said += [f"heading: {heading}"] if heading else []
    reader.say(", ".join(said))


@command("say what is under the finger", "u", also="pins:DESCCHAR")
def under_finger(reader: Reader) -> None:
    here = reader.figure_here
    if here is not None:
        reader.say(f"figure: {here[0]}, here: {here[1] or 'nothing with a name'}")
    else:
        reader.say(cell_said(reader, reader.cell))


def cell_said(reader: Reader, cell: int | None) -> str:
    """Sentence on a cell of the line: its dots, what it stands for, and its word."""
    line = reader.line
    if cell is None or not 0 <= cell < len(line):
        return "nothing under the finger"
    numbers = "-".join(map(str, dots_of(int(line.masks[cell]))))
    said = [f"dots {numbers}" if numbers else "no dots"]
    span = line.source(cell)
    if span is not None:
        print_ = line.block.text[span[0] - line.block.start : span[1] - line.block.start].strip()
        said += [_letter(print_)] if print_ else []
        word = line.word(cell)
        said += [f"in {word}"] if word and word != print_ else []
    return ", ".join(said)


def _letter(text: str) -> str:
    """Letters as they are; another character by its name."""
    if len(text) != 1 or text.isalnum():
        return text
    return unicodedata.name(text, f"U+{ord(text):04X}").lower()


@command("say the word under the finger", "w", also="pins:SPEAK_CURR_WORD")
def say_word(reader: Reader) -> None:
    reader.say(_word(reader) or "no word under the finger")


@command("spell the word under the finger", "W", also="pins:SPELL_CURR_WORD")
def spell_word(reader: Reader) -> None:
    word = unicodedata.normalize("NFC", _word(reader))
    reader.say(", ".join(map(_letter, word)) or "no word under the finger")


def _word(reader: Reader) -> str:
    return "" if reader.cell is None else reader.line.word(reader.cell)


@command("say the line again", "V f5", also="pins:SAY_LINE")
def say_line(reader: Reader) -> None:
    reader.say(reader.text or "blank line")
