"""Texts in cells: those of a protocol, and those that are typed as answers."""

from __future__ import annotations

import unicodedata
from functools import cache

from vbraille.braille.spelling import UNREAD, to_braille


def cells_of(text: str, table: str) -> str:
    """Return the cells that a braille table of liblouis makes of a text, in Unicode braille.

    Raises
    ------
    InputError
        If there is no such table.
    ValueError
        If the table lacks a character of the text, or writes no dots.
    """
    masks = _masks(text, table)
    if not any(masks):
        raise ValueError(f"{text!r} has no dots in the table {table}")
    return to_braille(masks)


def parse_text(line: str, text: str, cells: str, table: str) -> str:
    """Return an answer to a text, in Unicode braille; ``?`` is a cell that was not read.

    Parameters
    ----------
    line
        What was typed: the text in print, or cells in Unicode braille. A lone ``?`` means that
        nothing was read.
    text, cells, table
        What was shown, its cells, and the table that made them and makes those of the answer.

    Raises
    ------
    ValueError
        If nothing was typed, or the table does not know a character.
    """
    typed = unicodedata.normalize("NFC", " ".join(line.split()))
    if not typed:
        raise ValueError("nothing was typed; type what was read, or ? if nothing was")
    if typed.casefold() == " ".join(text.split()).casefold():
        return cells
    if typed == UNREAD:
        return UNREAD * len(cells)
    if all("⠀" <= character <= "⣿" or character in f"{UNREAD} " for character in typed):
        return "".join(typed.split())
    parts = map(str.strip, typed.split(UNREAD))
    return UNREAD.join(to_braille(_masks(part, table)) if part else "" for part in parts)


@cache
def _masks(text: str, table: str) -> tuple[int, ...]:
    """Return the dot masks of a text; ValueError if the table does not know a character of it."""
    # liblouis takes a while to load, and few protocols need it.
    from vbraille.translate import BrailleTable

    braille = BrailleTable(table)
    if unknown := braille.unknown(text):
        raise ValueError(f"{text!r} has {unknown[0]!r}, which the table {table} does not know")
    return tuple(braille.translate(text).masks.tolist())
