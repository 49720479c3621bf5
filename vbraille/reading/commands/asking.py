"""Commands that say what is under the hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.reading.reader import Reader


def say_word(reader: Reader) -> None:
    """Say the word under the middle of the array."""
    line, cell = reader.line, reader.cell
    word = line.word(cell) if line is not None and cell is not None else ""
    reader.say(f"word: {word}" if word else "word: none here")
