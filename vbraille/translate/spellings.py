"""Texts that may stand for a letter or a sign that a braille table leaves undefined, best first."""

from __future__ import annotations

from enum import StrEnum
from itertools import chain, permutations, repeat
from pathlib import Path
from typing import TYPE_CHECKING
from unicodedata import category, combining, decimal, name, normalize

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import LETTERS, to_braille

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class Undefined(StrEnum):
    """Text for a character that neither the table nor a plain spelling can write."""

    MARK = "mark"
    """A sign for an unknown character; emoji by their names."""
    NAME = "name"
    """Its name in brackets."""
    CODE = "code"
    """Its number in brackets."""
    DROP = "drop"
    """Nothing."""


class Kind(StrEnum):
    """Way in which a part of a text is written that the table leaves undefined."""

    EQUIVALENT = "the same, composed or ordered otherwise"
    PLAIN = "a plain spelling, or without accents"
    NAME = "by its name"
    MARKED = "a marker"
    UNENDING = "a marker, for liblouis does not come to an end"


FULL_CELLS = "⠿⠿⠿"
# Spellings of signs, for all languages alike: the signs, and what may stand for each, best first.
# Patterns of dots are the last resort for signs that nearly all literary codes write so.
_SIGNS = {
    sign: texts
    for signs, *texts in map(
        str.split, Path(__file__).with_name("signs.txt").read_text("utf-8").splitlines()
    )
    for sign in signs
}
_SHADDA = "\u0651"
# NUL, at which liblouis stops; soft hyphens, which part contractions; marks of the byte order.
_LEFT_OUT = "\0\u00ad\ufeff"
# First letters of alphabets in squares and circles, and of flags; Unicode has no spelling of these.
_ALPHABETS = (0x1F150, 0x1F170)
_FLAGS = 0x1F1E6
_SKIN_TONES = range(0x1F3FB, 0x1F400)
# Zeros of the scripts whose digits tables have, where they do not have all.
_ZEROS = "0٠۰०০੦૦୦௦౦೦൦๐໐༠၀០"
# What no normal form has, but tables have, and the letters that it is equal to: Greek ; and ·,
# letters of India such as क़, Hebrew ones.
_COMPOSED = {
    sign: normalize("NFD", sign)
    for sign in map(chr, (*range(0x37E, 0x388), *range(0x900, 0x1000), *range(0xFB1D, 0xFB50)))
    if normalize("NFD", sign) != sign != normalize("NFC", sign)
}
# Small signs above and below the line, by those on the line.
_ON_LINE = "0123456789+-=()ni"
_RAISED, _LOWERED = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ⁿⁱ", "₀₁₂₃₄₅₆₇₈₉₊₋₌₍₎ₙᵢ"
# Before them in Unified English Braille, whose tables lack the second.
_UEB_RAISED, _UEB_LOWERED = b"\x30\x14", b"\x30\x22"


def raised(text: str) -> str:
    """Text in Unicode's small characters above the line, if it is a number; else as it is."""
    return _small(text, _RAISED)


def lowered(text: str) -> str:
    """Text in Unicode's small characters below the line, if it is a number; else as it is.

    >>> lowered("2"), raised("th")
    ('₂', 'th')
    """
    return _small(text, _LOWERED)


def _small(text: str, forms: str) -> str:
    small = text.translate(str.maketrans(f"{_ON_LINE}\u2212", forms + forms[_ON_LINE.index("-")]))
    is_word = text.isalpha() and len(text) > 1
    return text if is_word or not all(sign in forms for sign in small) else small


def joins(part: str, sign: str) -> bool:
    """Tell whether a sign belongs to the part before it: a mark, a small digit, half a flag."""
    if category(sign)[0] == "M":
        return True
    if any(sign in forms and part[0] in forms for forms in (_RAISED, _LOWERED)):
        return True
    return len(part) == 1 and _letter(part, _FLAGS) != "" and _letter(sign, _FLAGS) != ""


def in_order(part: str) -> str:
    """The part as tables expect it: shadda before the vowel, Hebrew letters composed."""
    if part in _LEFT_OUT:
        return ""
    if _SHADDA in part[2:]:
        return part[0] + _SHADDA + part[1:].replace(_SHADDA, "")
    return next(_compositions(part), part) if "א" <= part[0] <= "ת" else part


def spellings(
    part: str, undefined: set[str], how: Undefined, cells_of: Callable[[str], bytes]
) -> Iterator[tuple[Kind | None, str]]:
    """Texts that may stand for a letter with its marks; the last is always written.

    Parameters
    ----------
    part
        The letter or sign, with its marks.
    undefined
        Characters of it that the table leaves undefined.
    how
        What is written where nothing else can be.
    cells_of
        Function that gives the dot masks of a text by the table; none for what it cannot write.
    """
    yield None, part
    if part.isspace():
        yield None, " "
        yield None, "⠀"
    if _is_invisible(part):
        yield None, ""
    seen = {part}
    for kind, text in chain(
        zip(repeat(Kind.EQUIVALENT), _equivalents(part)),
        _small_forms(part, cells_of),
        zip(repeat(Kind.PLAIN), chain(_plain_spellings(part), _bare_letters(part, undefined))),
    ):
        if text not in seen:
            seen.add(text)
            yield kind, text
    code = f"U+{ord(part[0]):04X}"
    named = name(part[0], code).lower()
    # A picture or a symbol that has a name people know.
    is_emoji = category(part[0]) in ("So", "Sk") and part[0] >= "\u2300" and named != code.lower()
    if how is Undefined.DROP:
        yield Kind.MARKED, ""
    elif how is Undefined.CODE:
        yield from _bracketed(Kind.MARKED, code)
    elif how is Undefined.NAME or is_emoji:
        yield from _bracketed(Kind.NAME if is_emoji else Kind.MARKED, named)
    for marker in ("[?]", "(?)", "?", FULL_CELLS):
        yield Kind.MARKED, "".join(marker if sign in undefined else sign for sign in part)
    yield Kind.MARKED, FULL_CELLS


def _bracketed(kind: Kind, text: str) -> Iterator[tuple[Kind, str]]:
    yield kind, f"[{text}]"
    yield kind, f"({text})"


def _equivalents(part: str) -> Iterator[str]:
    """Canonically equal texts: composed, taken apart, with the marks in another order."""
    yield normalize("NFC", part)
    apart = normalize("NFD", part)
    yield apart
    yield from _compositions(part)
    if len(apart) <= 4:
        for marks in permutations(apart[1:]):
            text = apart[0] + "".join(marks)
            if normalize("NFD", text) == apart:
                yield text


def _compositions(part: str) -> Iterator[str]:
    """The part with a letter that no normal form has, such as क़, for two or three of its own."""
    letter, *marks = normalize("NFD", part)
    for composed, (own, *needed) in _COMPOSED.items():
        if letter == own and all(mark in marks for mark in needed):
            yield composed + "".join(mark for mark in marks if mark not in needed)


def _small_forms(part: str, cells_of: Callable[[str], bytes]) -> Iterator[tuple[Kind, str]]:
    """Spellings of small numbers: by the table's own sign for such, or as in 10^6 and H_2O."""
    for forms, sign in ((_RAISED, "^"), (_LOWERED, "_")):
        if part[0] not in forms:
            continue
        text = part.translate(str.maketrans(forms, _ON_LINE))
        is_one = text.isdigit() or len(text) == 1
        own, two = cells_of(forms[2]), cells_of("2")
        if not own and cells_of("²").startswith(_UEB_RAISED):
            own = _UEB_LOWERED + two
        below = bytes(map(_lower, two[-1:]))
        if two and own != two and own.endswith(two):
            before = to_braille(own.removesuffix(two))
            yield Kind.EQUIVALENT, before + (text if is_one else f"⠣{text}⠜")
        elif below and own.endswith(below) and text.isdigit():
            digits = to_braille(_lower(cells_of(digit)[-1]) for digit in text)
            yield Kind.EQUIVALENT, to_braille(own.removesuffix(below)) + digits
        for plain in (sign + (text if is_one else f"({text})"), f"({text})", f" {text} "):
            yield Kind.PLAIN, plain


def _lower(mask: int) -> int:
    """Mask of a cell of dots 1, 2, 4 and 5 moved down by a row."""
    return (mask & 0x1B) << 1


def _plain_spellings(part: str) -> Iterator[str]:
    """Spellings of a sign, of a compatibility character, of a foreign digit, of a capital."""
    yield from _SIGNS.get(part, ())
    letters = "".join(_letter(sign, _FLAGS) for sign in part)
    if letters:
        yield f"[{letters}]"
        yield f"({letters})"
    if ord(part[0]) in _SKIN_TONES:
        yield ""
    for first in _ALPHABETS:
        if letter := _letter(part, first):
            yield letter + part[1:]
    plain = normalize("NFKC", part)
    if plain[:1].isdigit() and "⁄" in plain:
        plain = f" {plain}"  # ½ after a number is not the number's next digit
    if plain.lstrip() != plain and not plain[1].isdigit():
        return  # an accent alone, which is not a blank with an accent
    yield plain
    for which in (0, -1):
        yield "".join(_SIGNS.get(sign, sign)[which] for sign in plain)
    if any(map(str.isdecimal, plain)):
        for zero in map(ord, _ZEROS):
            yield "".join(
                chr(zero + decimal(sign)) if sign.isdecimal() else _SIGNS.get(sign, sign)[-1]
                for sign in plain
            )
    yield part.lower()


def _bare_letters(part: str, undefined: set[str]) -> Iterator[str]:
    """The letter without the accents that are undefined, then without any, then small."""
    yield "".join(sign for sign in part if not (_is_accent(sign) and sign in undefined))
    bare = "".join(sign for sign in normalize("NFKD", part) if not _is_accent(sign))
    yield bare
    yield from _SIGNS.get(bare, ())
    yield bare.lower()
    if bare.lower() in LETTERS:  # which are the same cells wherever there are Latin letters
        yield chr(UNICODE_BLANK + LETTERS[bare.lower()])


def _letter(sign: str, first: int) -> str:
    """Capital letter that a sign of an alphabet stands for; empty for other signs."""
    number = ord(sign[0]) - first
    return chr(ord("A") + number) if 0 <= number < 26 else ""


def _is_accent(sign: str) -> bool:
    """Tell whether a letter can be read without a mark: an accent or a point, no vowel of India."""
    return category(sign) == "Me" or combining(sign) > 0 or _is_invisible(sign)


def _is_invisible(part: str) -> bool:
    """Tell whether a part has nothing to read: joiners, directions, controls, selectors."""
    return all(category(sign) in ("Cf", "Cc") or "\ufe00" <= sign <= "\ufe0f" for sign in part)
