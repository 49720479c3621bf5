"""Characters that a braille table does not know, and what stands in their place."""

from __future__ import annotations

import unicodedata
from enum import StrEnum
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

# In order of preference: the marker is the first text that the table can write in full.
# Three full cells are how typists of braille cross out; few tables know no question mark.
MARKERS = ("[?]", "(?)", "?", "⠿⠿⠿")
_BRACKETS = ("[]", "()")
# Characters that typewriters put in place of the marks of typesetters.
_PLAIN = str.maketrans(
    {
        "\u2010": "-", "\u2011": "-", "\u2012": "-", "\u2013": "-", "\u2014": "--", "\u2015": "--",
        "\u2018": "'", "\u2019": "'", "\u201a": "'", "\u02bc": "'", "\u2212": "-", "\u2044": "/",
        "\u201c": '"', "\u201d": '"', "\u201e": '"', "\u00ab": '"', "\u00bb": '"',
    }
)  # fmt: skip


# Blocks of Unicode: clocks and keys, symbols and dingbats, arrows and stars, pictures.
_EMOJI = ((0x231A, 0x23FF), (0x2600, 0x27BF), (0x2B00, 0x2BFF), (0x1F000, 0x1FAFF))


class Undefined(StrEnum):
    """What is written for a character that the table does not know."""

    MARK = "mark"
    """The same short marker, such as ``[?]``, for each run of them; but an emoji's name."""
    NAME = "name"
    """The character's name in Unicode, such as ``[grinning face]``."""
    CODE = "code"
    """The character's number in Unicode, such as ``[U+1F600]``."""
    DROP = "drop"
    """Nothing."""


def spellings(character: str, how: Undefined) -> Iterator[str]:
    """Texts that may stand for a character, best first; a table takes the first it can write."""
    if how is Undefined.DROP:
        yield ""
    named = how is Undefined.NAME or (how is Undefined.MARK and is_emoji(character))
    if named and (name := unicodedata.name(character, "")):
        yield from (f"{opening}{name.lower()}{closing}" for opening, closing in _BRACKETS)
    if how is Undefined.NAME or how is Undefined.CODE:
        number = number_of(character)
        for text in (number, number.lower()):  # the capitals of some tables have eight dots
            yield from (f"{opening}{text}{closing}" for opening, closing in _BRACKETS)
    yield from MARKERS


def is_emoji(character: str) -> bool:
    """Tell if a character is a little picture that people write between words."""
    code = ord(character)
    pictures = any(first <= code <= last for first, last in _EMOJI)
    return pictures and unicodedata.category(character) in ("So", "Sk")


def likenesses(character: str) -> Iterator[str]:
    """Other spellings of the same: a ligature's letters, plain quotes, a small letter, accents."""
    seen = {character}
    plain = unicodedata.normalize("NFKC", character)
    if plain[:1].isdigit() and not character.isdecimal():
        plain = f" {plain}"  # ½ after a number is not the number's next digit
    apart = unicodedata.normalize("NFD", plain)
    for text in (plain, plain.translate(_PLAIN), plain.lower(), apart):
        if text not in seen:
            seen.add(text)
            yield text


def number_of(character: str) -> str:
    """Number of a character as Unicode writes it, such as U+1F600."""
    return f"U+{ord(character):04X}"


def describe(character: str) -> str:
    """Number of a character, with its name if it has one."""
    return f"{number_of(character)} {unicodedata.name(character, '').lower()}".rstrip()
