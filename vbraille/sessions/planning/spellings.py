"""Conversion of cells, as a protocol's file spells them, to dot masks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from vbraille.braille.spelling import UNREAD, spell, spell_string
from vbraille.toml.tomlfile import quote

if TYPE_CHECKING:
    from collections.abc import Callable


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
