"""Conversion to dot masks: of cells as a protocol's file spells them, and of texts by tables."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import UNREAD, spell, spell_string, to_answer, to_braille
from vbraille.errors import InputError
from vbraille.tomlfile import quote

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.translate import BrailleTable


class SpellingKeys(dict[str, int]):
    """Dot masks of the characters that ``[keys]`` adds to the letters a to z."""


class Mask(int):
    """Dot mask of a cell that stands alone in its file, where dot numbers may spell it."""


class Masks(tuple[int, ...]):
    """Dot masks of a string, each cell of which is spelled by one character."""

    __slots__ = ()


class WrittenText(Masks):
    """Code points of a text, whose cells are made by the braille table of each condition."""

    __slots__ = ()

    @classmethod
    def of(cls, text: str) -> WrittenText:
        """Make the text of a string of characters."""
        return cls(map(ord, text))

    def __str__(self) -> str:
        return "".join(map(chr, self))


def spelled(keys: SpellingKeys, *, written: bool = False) -> Callable[[type, Any], Any]:
    """Make the function by which `msgspec.convert` fills the types of this module.

    Parameters
    ----------
    keys
        Dot masks of the characters beside a to z.
    written
        Whether strings are texts, whose cells braille tables make.
    """

    def read(kind: type, value: Any) -> Any:
        if kind is SpellingKeys:
            return keys
        if not isinstance(value, str):
            raise TypeError("Expected `str`, got another")
        if kind is Masks and written:
            return read_written(value)
        if kind is Masks:
            return Masks(spell_string(value, keys))
        masks = spell(value, keys)
        if len(masks) != 1:
            raise ValueError(f"{quote(value)} is {len(masks)} cells; give one")
        return Mask(masks[0])

    return read


def read_written(text: str) -> WrittenText:
    """Read a text whose cells braille tables make.

    Raises
    ------
    ValueError
        If there is nothing in it but blanks.
    """
    if not text.strip():
        raise ValueError("a text is empty; give one with characters, or leave it out")
    return WrittenText.of(text.strip())


def read_keys(_kind: type, table: Any) -> SpellingKeys:
    """Read the table ``[keys]``, for `msgspec.convert`.

    Raises
    ------
    TypeError
        If the value is not a table.
    ValueError
        If a key cannot be used, or is not spelled as one cell.
    """
    if not isinstance(table, dict):
        raise TypeError("Expected `object`, got another")
    keys = SpellingKeys()
    for key, spelling in table.items():
        if len(key) != 1 or not key.isprintable() or key in f"{UNREAD} -0123456789":
            raise ValueError(
                f"{quote(key)} is no key; a key must be one character, "
                f"and no digit, hyphen, question mark or white space"
            )
        if not isinstance(spelling, str):
            raise ValueError(f"{key} is {quote(spelling)}; it must be a string, in quotation marks")
        try:
            masks = spell(spelling, {})
        except ValueError as error:
            raise ValueError(f"{key}: {error}") from None
        if len(masks) != 1:
            raise ValueError(
                f"{key} is {len(masks)} cells; it must be the dot numbers of one, such as 4"
            )
        keys[key] = masks[0]
    return keys


def made_by() -> dict[str, str]:
    """Version of the library whose tables make cells, by its name."""
    from vbraille.translate import liblouis_version

    return {"liblouis": liblouis_version()}


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
    braille = _table(table)
    masks = tuple(braille.translate(text).masks.tolist())
    return masks, braille.unknown(text)[:1]


@cache
def _table(name: str) -> BrailleTable:
    """Table of a name; InputError if liblouis has none."""
    # It stands here because liblouis takes a while to load, and few protocols need it.
    from vbraille.translate import BrailleTable

    return BrailleTable(name)
