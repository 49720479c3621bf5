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


def spelled(keys: SpellingKeys, *, planned: bool) -> Callable[[type, Any], Any]:
    """Make the function by which `msgspec.convert` fills the types of this module.

    Parameters
    ----------
    keys
        Dot masks of the characters beside a to z.
    planned
        Whether strings may have blanks and dot numbers, as version 0.1 allowed.
    """

    def read(kind: type, value: Any) -> Any:
        if kind is SpellingKeys:
            return keys
        if not isinstance(value, str):
            raise TypeError("Expected `str`, got another")
        if kind is Masks:
            return Masks(spell(value, keys) if planned else spell_string(value, keys))
        masks = spell(value, keys)
        if len(masks) != 1:
            raise ValueError(f"{quote(value)} is {len(masks)} cells; give one")
        return Mask(masks[0])

    return read


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
