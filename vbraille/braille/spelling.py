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
# A cell that was not read: how it is typed and kept, and its number among dot masks.
UNREAD = "?"
UNREAD_MASK = 0x100

_LETTER_OF = {mask: letter for letter, mask in LETTERS.items()}
_DOT_NUMBERS = re.compile(r"[0-9-]+")
_LONGEST_QUOTE = 20


def to_braille(masks: Iterable[int]) -> str:
    """Unicode braille of cells."""
    return "".join(chr(UNICODE_BLANK + mask) for mask in masks)


def to_answer(masks: Iterable[int | None]) -> str:
    """Answer as it is kept: Unicode braille, ``?`` for a place that is `UNREAD_MASK` or None."""
    unread = (None, UNREAD_MASK)
    return "".join(UNREAD if mask in unread else chr(UNICODE_BLANK + mask) for mask in masks)


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
    return tuple(mask for _, mask in _cells(text, keys))


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
        Text as typed: spelled as for `spell`, with letters in either case and ``?`` for a place
        not read. A lone ``?`` means that no place was read.
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
    typed = _cells(text, {UNREAD: UNREAD_MASK, **_either_case(keys)})
    for spelling, mask in typed:
        if mask != UNREAD_MASK and mask & ~shown_dots:
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
    return to_answer(mask for _, mask in typed)


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
        Dot mask of each key of the protocol. A cell that has a key is said by it.
    """
    return " ".join(_say(place, keys) for place in answer)


def _say(place: str, keys: dict[str, int]) -> str:
    if place == UNREAD:
        return UNREAD
    mask = ord(place) - UNICODE_BLANK
    for key, cell in keys.items():
        if cell == mask:
            return key
    letter = _LETTER_OF.get(mask)
    # A letter that is the key of another cell would be taken for that one.
    if letter is not None and letter not in keys:
        return letter
    return Cells.from_unicode(place).to_dots() if mask else "blank"


def _either_case(keys: dict[str, int]) -> dict[str, int]:
    """Spellings in which answers may be typed: letters and keys in either case; keys win."""
    cells = LETTERS | keys
    return {key.upper(): mask for key, mask in cells.items() if len(key.upper()) == 1} | cells


def _cells(text: str, keys: dict[str, int]) -> list[tuple[str, int]]:
    """Spelling and dot mask of each cell."""
    cells: list[tuple[str, int]] = []
    for word in text.split():
        if _DOT_NUMBERS.fullmatch(word):
            cells.append((word, _by_dots(word)))
        else:
            cells += [(character, _by_character(character, keys)) for character in word]
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


def _by_character(character: str, keys: dict[str, int]) -> int:
    mask = keys.get(character, LETTERS.get(character))
    if mask is not None:
        return mask
    if UNICODE_BLANK <= ord(character) <= UNICODE_BLANK + 0xFF:
        return ord(character) - UNICODE_BLANK
    raise ValueError(
        f"{character!r} is no cell; a cell is a letter a to z, a key of the protocol, a Unicode "
        f"braille character or dot numbers such as 1-4 between spaces"
    )


def _shorten(text: str) -> str:
    """Typed text, as it can be said in a sentence."""
    return repr(text if len(text) <= _LONGEST_QUOTE else f"{text[:_LONGEST_QUOTE]}…")
