"""Commands that say where the finger is, and what is there."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

from vbraille.reading.commands import command
from vbraille.reading.reader import letter_said
from vbraille.reading.structure import LINES_PER_PAGE

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader

_LOOKED_BACK = 5000  # blocks, for the page and the heading


@command("say line, page, percent and heading", "i", "delete", first=True, also="pins:INFO")
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
        reader.say(reader.cell_said(reader.cell))


@command("say the word under the finger", "w", also="pins:SPEAK_CURR_WORD")
def say_word(reader: Reader) -> None:
    reader.say(_word(reader) or "no word under the finger")


@command("spell the word under the finger", "W", also="pins:SPELL_CURR_WORD")
def spell_word(reader: Reader) -> None:
    word = unicodedata.normalize("NFC", _word(reader))
    reader.say(", ".join(map(letter_said, word)) or "no word under the finger")


def _word(reader: Reader) -> str:
    return "" if reader.cell is None else reader.line.word(reader.cell)


@command("say the line again", "V f5", also="pins:SAY_LINE")
def say_line(reader: Reader) -> None:
    reader.say(reader.text or "blank line")
