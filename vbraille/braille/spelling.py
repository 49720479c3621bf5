"""Spellings of cells: in a protocol, typed as an answer, and said."""

from __future__ import annotations

import re
import string
from typing import TYPE_CHECKING

from vbraille.braille.cells import UNICODE_BLANK, Cells, dots_of, mask_of
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable

# Letters of literary braille are one cell each, the same in English and French, and ASCII braille
# writes those cells as the letters.
LETTERS = dict(
    zip(
        string.ascii_lowercase,
        Cells.from_brf(string.ascii_lowercase).masks.tolist(),
        strict=True,
    )
)
UNREAD = "?"  # a cell that was not read, as it is typed and kept

_DOT_NUMBERS = re.compile(r"[0-9-]+")
_LONGEST_QUOTE = 20


def to_braille(masks: Iterable[int | None]) -> str:
    """Unicode braille of cells; ``?`` for one that is None, which was not read."""
    return "".join(UNREAD if mask is None else chr(UNICODE_BLANK + mask) for mask in masks)


def name_dots(mask: int) -> str:
    """Dots of a mask as in a sentence: "dot 1", "dots 1 and 4", "no dots"."""
    dots = list(map(str, dots_of(mask)))
    if len(dots) < 2:
        return f"dot {dots[0]}" if dots else "no dots"
    return f"dots {', '.join(dots[:-1])} and {dots[-1]}"


def spell(text: str, keys: dict[str, int]) -> tuple[int, ...]:
    """Cells of a spelling, as protocols have it; empty for an empty one.

    Parameters
    ----------
    text
        Words with white space between. One of digits and hyphens is a cell by
        its dot numbers ("1-4", "14", "0"). In another each character is a cell:
        a key, a letter a to z or a Unicode braille character.
    keys
        Dot mask of each key of the protocol; they win over letters.

    Returns
    -------
    tuple of int
        Dot masks; bit 0 is dot 1.

    Raises
    ------
    ValueError
        If something in it is no cell.
    """
    return tuple(mask for _, mask in _cells(text, LETTERS | keys))


def spell_string(text: str, keys: dict[str, int]) -> tuple[int, ...]:
    """Cells of a string of a protocol, one for each character; empty for an empty one.

    Nothing in it is guessed: a blank may be meant as a cell or as a space between two, and
    a number as dots or as a number.

    Parameters
    ----------
    text
        Keys, letters a to z and Unicode braille.
    keys
        Dot mask of each key of the protocol; they win over letters.

    Raises
    ------
    ValueError
        If a character is something else.
    """
    for character in text:
        if character.isspace() or _DOT_NUMBERS.fullmatch(character):
            raise ValueError(
                f"{_shorten(text)} has {character!r}, which may be meant as a cell, as dots or as "
                f"nothing; write each cell as a letter, a key of [keys] or Unicode braille (U+2800 "
                f"for a blank one)"
            )
    return spell(text, keys)


def parse_answer(text: str, *, places: int, keys: dict[str, int], shown_dots: int) -> str:
    """Answer as it is kept: Unicode braille for each place, ``?`` for a place not read.

    Parameters
    ----------
    text
        Text as typed: spelled as for `spell`, with letters and keys in either case and ``?`` for a
        place not read. A lone ``?`` means that no place was read.
    places
        Number of cells asked for.
    keys
        Dot mask of each key of the protocol.
    shown_dots
        Mask of the dots that the display shows.

    Raises
    ------
    ValueError
        If something is no cell, or no cell of the display, or places are
        missing or too many.
    """
    if not text.strip():
        raise ValueError(f"nothing was typed; type {count(places, 'place')}, or ? if none was read")
    if text.strip() == UNREAD:
        return UNREAD * places
    known = LETTERS | keys
    capitals = {key.upper(): mask for key, mask in known.items() if len(key.upper()) == 1}
    typed = _cells(text, capitals | known | {UNREAD: 0})
    for spelling, mask in typed:
        if mask & ~shown_dots:
            raise ValueError(
                f"{spelling!r} has {name_dots(mask)}, and the display shows "
                f"{name_dots(shown_dots)} only; type a cell of those, or ? for one not read"
            )
    if len(typed) < places:
        raise ValueError(
            f"only {len(typed)} of {count(places, 'place')} typed; "
            f"type all, with ? for what was not read"
        )
    if len(typed) > places:
        raise ValueError(
            f"{count(len(typed), 'place')} typed, and {places} asked for; type no more"
        )
    return to_braille(None if spelling == UNREAD else mask for spelling, mask in typed)


ORDINALS = ("first", "second", "third", "fourth", "fifth")


def ordinal(place: int) -> str:
    """Word for a place, from 0.

    >>> ordinal(1), ordinal(11)
    ('second', 'number 12')
    """
    return ORDINALS[place] if place < len(ORDINALS) else f"number {place + 1}"


def say_cells(answer: str, keys: dict[str, int]) -> str:
    """Words for speech: one for each place, with a space between.

    Parameters
    ----------
    answer
        Answer in Unicode braille, with ``?`` for a place not read.
    keys
        Dot mask of each key of the protocol. A cell that has a key is said by its first.
    """
    # A letter that is the key of another cell would be taken for that one.
    letters = {mask: letter for letter, mask in LETTERS.items() if letter not in keys}
    names = {0: "blank"} | letters | {keys[key]: key for key in reversed(keys)}
    said = {chr(UNICODE_BLANK + mask): name for mask, name in names.items()} | {UNREAD: UNREAD}
    return " ".join(said.get(place) or Cells.from_unicode(place).to_dots() for place in answer)


def _cells(text: str, known: dict[str, int]) -> list[tuple[str, int]]:
    """Spelling and dot mask of each cell, by dot numbers or by the masks of known characters."""
    cells: list[tuple[str, int]] = []
    for word in text.split():
        if _DOT_NUMBERS.fullmatch(word):
            cells.append((word, _by_dots(word)))
            continue
        for character in word:
            mask = known.get(character, ord(character) - UNICODE_BLANK)
            if not 0 <= mask <= 0xFF:
                raise ValueError(
                    f"{character!r} is no cell; a cell is a letter a to z, a key of the protocol, "
                    f"a Unicode braille character or dot numbers such as 1-4 between spaces"
                )
            cells.append((character, mask))
    return cells


def _by_dots(word: str) -> int:
    dots = word.replace("-", "")
    if not re.fullmatch(r"0|[1-8](-?[1-8])*", word):
        raise ValueError(f"{word!r} is not the dots of a cell, such as 1-4, or 0 for none")
    if len(set(dots)) < len(dots):  # two cells without the space between them
        raise ValueError(
            f"{_shorten(word)} has a dot twice; put a space between the dot numbers of two cells"
        )
    return mask_of(map(int, dots.strip("0")))


def _shorten(text: str) -> str:
    """Typed text, as it can be said in a sentence."""
    return repr(text if len(text) <= _LONGEST_QUOTE else f"{text[:_LONGEST_QUOTE]}…")
