"""Cells of texts, by the braille tables that conditions name."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.spelling import UNREAD, spell, to_answer, to_braille
from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.translate.liblouis import BrailleTable


def made_by() -> dict[str, str]:
    """Version of the library whose tables make cells, by its name."""
    from vbraille.translate.liblouis import library_version

    return {"liblouis": library_version()}


def problem_of(table: str) -> str:
    """Say why liblouis cannot use a braille table; empty if it can."""
    try:
        _table(table)
    except InputError as error:
        return str(error)
    return ""


@cache
def cells_of(text: str, table: str) -> tuple[int, ...]:
    """Dot masks of a text's cells.

    Parameters
    ----------
    text
        Text of one line.
    table
        File name of a braille table of liblouis.

    Raises
    ------
    ValueError
        If the table lacks a character of the text, or writes no dots.
    InputError
        If there is no such table.
    """
    masks, unknown = _translated(text, table)
    if unknown:
        raise ValueError(
            f"{text!r} has {unknown!r}, which the table {table} does not know; choose another "
            f"text or table"
        )
    if not any(masks):
        raise ValueError(f"{text!r} has no dots by the table {table}; choose another text")
    return masks


def parse_text(line: str, text: str, cells: tuple[int, ...], table: str) -> str:
    """Read an answer to a text: Unicode braille of its cells, ``?`` for one not read.

    Parameters
    ----------
    line
        What was typed: the text that was read, in print; or cells in Unicode braille. A ``?``
        is a cell that was not read, unless the text that was shown has one there; a lone one
        means that nothing was read.
    text, cells
        Text that was shown, and dot masks of its cells.
    table
        Braille table that made them, and makes those of the answer.

    Raises
    ------
    ValueError
        If nothing was typed, or the table does not know a character.
    """
    typed = " ".join(line.split())
    if not typed:
        raise ValueError("nothing was typed; type what was read, or ? if nothing was")
    if typed.casefold() == " ".join(text.split()).casefold():
        return to_braille(cells)
    if typed == UNREAD:
        return UNREAD * len(cells)
    if all("⠀" <= character <= "⣿" or character in f"{UNREAD} " for character in typed):
        return "".join(typed.split())
    return UNREAD.join(_read(part, table) for part in typed.split(UNREAD))


def _read(part: str, table: str) -> str:
    """Unicode braille of a part of an answer, between cells that were not read."""
    if not part.strip():
        return ""
    masks, unknown = _translated(part.strip(), table)
    if unknown:
        raise ValueError(
            f"{part.strip()!r} has {unknown!r}, which the table {table} does not know; type "
            f"something else, or ? for a cell that was not read"
        )
    return to_answer(masks)


@cache
def _translated(text: str, table: str) -> tuple[tuple[int, ...], str]:
    """Dot masks of a text, and the first character of it that the table does not know."""
    if all("⠀" <= character <= "⣿" for character in text):
        return spell(text, {}), ""
    # These imports stand here because liblouis takes a while to load, and few protocols need it.
    from vbraille.translate.text import Text, to_codes

    braille = _table(table)
    codes = to_codes(text)
    alphabet = frozenset(codes.tolist())
    cells = braille.translate(Text(codes, np.arange(codes.size), codes.size, alphabet))
    unknown = next((character for character in text if ord(character) in braille.undefined), "")
    return tuple(cells.masks.tolist()), unknown


@cache
def _table(name: str) -> BrailleTable:
    """Table of a name; InputError if liblouis has none."""
    from vbraille.translate.liblouis import BrailleTable

    return BrailleTable(name)
