"""Text as it is compared in a search: without case, with one kind of quotes, dashes and blanks."""

from __future__ import annotations

import itertools
import re
import unicodedata
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.levels import TYPED
from vbraille.translate.text import to_codes, to_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

# Accents that stand for themselves after a letter, in all scripts whose readers may leave them out.
_ACCENTS = (
    "\u0300-\u036f\u0591-\u05bd\u05bf\u05c1\u05c2\u05c4\u05c5\u05c7\u064b-\u0655\u0670"
    "\u1ab0-\u1aff\u1dc0-\u1dff\u20d0-\u20ff\u3099\u309a"
)
_ACCENT = re.compile(f"[{_ACCENTS}]+")
_QUOTES = "'\"`´‘’‚‛“”„‟′″‹›«»ʼ＇＂"
_DASHES = "-‐‑‒–—―−⁃﹘﹣－"
_SIGNS = {ord(c): sign for sign, same in (("'", _QUOTES), ("-", _DASHES)) for c in same}
_BLANKS = re.compile(r"\s+")
_SMALL = re.compile(f"[{''.join(map(chr, TYPED))}]")
_TABLED = 0x3100  # all letters with accents, and none of the many signs of East Asia
# Where there are characters that are folded to others.
_FOLDED = tuple(
    range(first, last)
    for first, last in (
        (0x80, 0x3400),
        (0xA640, 0xAC00),
        (0xF900, 0x1_0000),
        (0x1_0400, 0x1_1000),
        (0x1_1090, 0x1_1A00),
        (0x1_6E40, 0x1_6E80),
        (0x1_D15E, 0x1_D1C1),
        (0x1_E900, 0x1_E944),
        (0x2_F800, 0x2_FA1E),
    )
)
_NOTHING, _SEVERAL = 0xFFFF_FFFF, 0xFFFF_FFFE
# What is folded before an ASCII letter that follows another has nothing to do with what is after.
_WITHIN_WORD = re.compile("[A-Za-z](?=[A-Za-z])")
_PIECE = 4_096  # characters that are folded together on the way to a place
_NOT_READ = re.compile("[\u00ad\ufeff]+")


def fold(text: str, *, accents: bool) -> str:
    """Text without what makes no difference in a search; a longer text's is never shorter.

    Parameters
    ----------
    text
        Text as it is read.
    accents
        Whether accents make no difference, either.
    """
    text = fold_letters(text, accents=accents)
    return _BLANKS.sub(" ", text)


def fold_letters(text: str, *, accents: bool) -> str:
    """Text without differences of case, signs and perhaps accents; its blanks are as they were."""
    if text.isascii():
        return text.lower().replace('"', "'").replace("`", "'")
    if not unicodedata.is_normalized("NFC", text):
        text = unicodedata.normalize("NFC", text)
    return _without_accents(text) if accents else _caseless(text).translate(_SIGNS)


def _caseless(text: str) -> str:
    """Text without differences of case, and with the numbers of H₂O and 10⁶ as they are typed."""
    folded = text.casefold()
    return folded.translate(TYPED) if _SMALL.search(folded) else folded


def is_plain(text: str) -> bool:
    """Tell if each character of a text is folded alone and to one or more."""
    return _ACCENT.search(text) is None and unicodedata.is_normalized("NFC", text)


def _without_accents(text: str) -> str:
    """Text with small letters without accents, by a table as long as each remains one letter."""
    codes = to_codes(text)
    if int(codes.max()) < _TABLED:
        letters = _letters()[codes]
        if not (letters == _SEVERAL).any():
            return to_text(letters[letters != _NOTHING])
    return _stripped(text)


def _stripped(text: str) -> str:
    left = _ACCENT.sub("", unicodedata.normalize("NFD", _caseless(text)))
    return unicodedata.normalize("NFC", left).translate(_SIGNS)


@cache
def _letters() -> NDArray[np.uint32]:
    """For each code point that has a place in the table: what remains of it."""
    table = np.empty(_TABLED, np.uint32)
    for code in range(_TABLED):
        left = _stripped(chr(code))
        table[code] = _NOTHING if not left else _SEVERAL if len(left) > 1 else ord(left)
    return table


def needle_of(text: str, *, accents: bool) -> str:
    """What is looked for, folded; empty if nothing is left of it."""
    return fold(_NOT_READ.sub("", text).strip(), accents=accents).strip()


def unfolded(text: str, at: int, *, accents: bool) -> int:
    """Index of the character of a text of which `fold` made the one at an index."""
    start, end = 0, len(text)
    while (cut := _WITHIN_WORD.search(text, start + _PIECE)) is not None:
        folded = len(fold(text[start : cut.end()], accents=accents))
        if folded > at:
            end = cut.end()
            break
        start, at = cut.end(), at - folded
    low, high = start, end - 1
    while low < high:
        middle = (low + high) // 2
        if len(fold(text[start : middle + 1], accents=accents)) > at:
            high = middle
        else:
            low = middle + 1
    return low


def alike(letter: str, *, accents: bool) -> str:
    """All characters that fold to a letter or a sign; of letters of ASCII only small ones."""
    return letter + _alike(accents)[0].get(letter, "")


def unlike(needle: str, *, accents: bool) -> Iterable[str]:
    """Characters that are folded to several, which may be in what is sought or around its ends."""
    for character, folded in _alike(accents)[1]:
        ends = range(1, len(folded))
        if (
            folded in needle
            or needle in folded
            or any(needle.startswith(folded[n:]) or needle.endswith(folded[:n]) for n in ends)
        ):
            yield character


@cache
def _alike(accents: bool) -> tuple[dict[str, str], list[tuple[str, str]]]:
    """For each character that others fold to: those; and what folds to several."""
    alone: dict[str, str] = {}
    several: list[tuple[str, str]] = []
    for character in map(chr, itertools.chain((0x22, 0x60), *_FOLDED)):
        if accents:
            folded = _stripped(character)
        else:
            folded = _caseless(unicodedata.normalize("NFC", character)).translate(_SIGNS)
        if len(folded) > 1:
            several.append((character, folded))
        elif folded and folded != character:
            alone[folded] = alone.get(folded, "") + character
    return alone, several
