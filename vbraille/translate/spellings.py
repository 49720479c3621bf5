"""Texts that may stand for a letter or a sign that a braille table leaves undefined, best first."""

from __future__ import annotations

import unicodedata
from enum import StrEnum
from functools import cache
from itertools import chain, permutations, repeat
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import LETTERS

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
MARKERS = ("[?]", "(?)", "?", FULL_CELLS)

# Spellings of signs, for all languages alike: the signs, and what may stand for each, best first.
# Patterns of dots are the last resort for signs that nearly all literary codes write so.
SIGNS = {
    sign: texts
    for signs, *texts in map(
        str.split, Path(__file__).with_name("signs.txt").read_text("utf-8").splitlines()
    )
    for sign in signs
}

SHADDA = "\u0651"
# NUL, at which liblouis stops; soft hyphens, which part contractions; marks of the byte order.
LEFT_OUT = "\0\u00ad\ufeff"
# Letters in squares and circles; Unicode gives no spelling of these.
_ALPHABETS = (0x1F150, 0x1F170)
_FLAG_LETTERS = 0x1F1E6
# Zeros of the scripts whose digits tables have, where they do not have all.
_ZEROS = "0٠۰०০੦૦୦௦౦೦൦๐໐༠၀០"
_SKIN_TONES = range(0x1F3FB, 0x1F400)
# What normal forms replace, but tables have: Greek ; and ·, letters of India, Hebrew ones.
_COMPOSED = (range(0x037E, 0x0388), range(0x0900, 0x1000), range(0xFB1D, 0xFB50))
# Small signs above and below the line, by those on the line.
_ON_LINE = "0123456789+-=()ni"
_RAISED = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ⁿⁱ", _ON_LINE, strict=True))
_LOWERED = dict(zip("₀₁₂₃₄₅₆₇₈₉₊₋₌₍₎ₙᵢ", _ON_LINE, strict=True))
_UEB_LOWERED = "⠰⠢"  # which its tables lack
_UEB_RAISED = "⠰⠔"
_LOWER_DOTS = {1: 2, 2: 4, 8: 16, 16: 32}  # bits of dots 1, 2, 4, 5, and of those below them


def raised(text: str) -> str:
    """Text in Unicode's small characters above the line, if it is a number; else as it is."""
    return _small(text, _RAISED)


def lowered(text: str) -> str:
    """Text in Unicode's small characters below the line, if it is a number; else as it is.

    >>> lowered("2"), raised("th")
    ('₂', 'th')
    """
    return _small(text, _LOWERED)


def _small(text: str, forms: dict[str, str]) -> str:
    small = {sign: form for form, sign in forms.items()} | {"\u2212": "⁻" if "⁻" in forms else "₋"}
    if (text.isalpha() and len(text) > 1) or not all(sign in small for sign in text):
        return text
    return "".join(small[sign] for sign in text)


def joins(part: str, sign: str) -> bool:
    """Tell whether a sign belongs to the part before it: a mark, a small digit, half a flag."""
    if unicodedata.category(sign)[0] == "M":
        return True
    if any(sign in forms and part[0] in forms for forms in (_RAISED, _LOWERED)):
        return True
    return len(part) == 1 and _flag_letter(part) != "" and _flag_letter(sign) != ""


def in_order(part: str) -> str:
    """The part as tables expect it: shadda before the vowel, Hebrew letters composed."""
    if part in LEFT_OUT:
        return ""
    if SHADDA in part[2:]:
        return part[0] + SHADDA + part[1:].replace(SHADDA, "")
    if "א" <= part[0] <= "ת" and len(part) > 1:
        return next(_compositions(part), part)
    return part


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
    name = unicodedata.name(part[0], code).lower()
    if how is Undefined.DROP:
        yield Kind.MARKED, ""
    elif how is Undefined.CODE:
        yield Kind.MARKED, f"[{code}]"
        yield Kind.MARKED, f"({ord(part[0])})"
    elif how is Undefined.NAME or is_emoji(part):
        kind = Kind.NAME if is_emoji(part) else Kind.MARKED
        yield kind, f"[{name}]"
        yield kind, f"({name})"
    for marker in MARKERS:
        yield Kind.MARKED, "".join(marker if sign in undefined else sign for sign in part)
    yield Kind.MARKED, FULL_CELLS


def is_emoji(part: str) -> bool:
    """Tell whether a part is a picture or a symbol that has a name people know."""
    category = unicodedata.category(part[0])
    return (
        category in ("So", "Sk") and ord(part[0]) >= 0x2300 and unicodedata.name(part[0], "") != ""
    )


def _equivalents(part: str) -> Iterator[str]:
    """Canonically equal texts: composed, taken apart, with the marks in another order."""
    yield unicodedata.normalize("NFC", part)
    apart = unicodedata.normalize("NFD", part)
    yield apart
    yield from _compositions(part)
    if len(apart) <= 4:
        for marks in permutations(apart[1:]):
            text = apart[0] + "".join(marks)
            if unicodedata.normalize("NFD", text) == apart:
                yield text


def _compositions(part: str) -> Iterator[str]:
    """The part with a letter that no normal form has, such as क़, for two or three of its own."""
    letter, *marks = unicodedata.normalize("NFD", part)
    for composed, (own, *needed) in _excluded_compositions().items():
        if letter == own and all(mark in marks for mark in needed):
            yield composed + "".join(mark for mark in marks if mark not in needed)


def _small_forms(part: str, cells_of: Callable[[str], bytes]) -> Iterator[tuple[Kind, str]]:
    """Spellings of small numbers: by the table's own sign for such, or as in 10^6 and H_2O."""
    for forms, two, sign in ((_RAISED, "²", "^"), (_LOWERED, "₂", "_")):
        if part[0] not in forms:
            continue
        text = "".join(forms[small] for small in part)
        alone = text.isdigit() or len(text) == 1
        indicator, low = _indicator(two, cells_of)
        if sign == "_" and not indicator and _indicator("²", cells_of)[0] == _UEB_RAISED:
            indicator = _UEB_LOWERED
        if indicator and low and text.isdigit():
            text_below = (chr(0x2800 | low_dots(cells_of(digit)[-1])) for digit in text)
            yield Kind.EQUIVALENT, indicator + "".join(text_below)
        elif indicator:
            yield Kind.EQUIVALENT, indicator + (text if alone else f"⠣{text}⠜")
        for plain in (sign + (text if alone else f"({text})"), f"({text})", f" {text} "):
            yield Kind.PLAIN, plain


def _indicator(two: str, cells_of: Callable[[str], bytes]) -> tuple[str, bool]:
    """Dots before a small number that a table's own ² tells, and whether its digits are lowered."""
    own, on_line = cells_of(two), cells_of("2")
    for cells, low in ((on_line, False), (bytes(map(low_dots, on_line[-1:])), True)):
        if cells and own != cells and own.endswith(cells):
            return "".join(chr(0x2800 | mask) for mask in own[: -len(cells)]), low
    return "", False


def low_dots(mask: int) -> int:
    """Mask of a cell of dots 1, 2, 4 and 5 moved down by a row."""
    return sum(below for dot, below in _LOWER_DOTS.items() if mask & dot)


def _plain_spellings(part: str) -> Iterator[str]:
    """Spellings of a sign, of a compatibility character, of a foreign digit, of a capital."""
    yield from SIGNS.get(part, ())
    if _flag_letter(part[0]):
        letters = "".join(map(_flag_letter, part))
        yield f"[{letters}]"
        yield f"({letters})"
    code = ord(part[0])
    if code in _SKIN_TONES:
        yield ""
    for first in _ALPHABETS:
        if first <= code < first + 26:
            yield chr(ord("A") + code - first) + part[1:]
    plain = unicodedata.normalize("NFKC", part)
    if plain[:1].isdigit() and "⁄" in plain:
        plain = f" {plain}"  # ½ after a number is not the number's next digit
    if plain.lstrip() != plain and not plain[1].isdigit():
        return  # an accent alone, which is not a blank with an accent
    yield plain
    for which in (0, -1):
        yield "".join(SIGNS.get(sign, sign)[which] for sign in plain)
    if any(map(str.isdecimal, plain)):
        for zero in _ZEROS:
            yield "".join(_digit(zero, sign) for sign in plain)
    yield part.lower()


def _digit(zero: str, sign: str) -> str:
    """A digit in the script of a zero; of other signs the last spelling."""
    if sign.isdecimal():
        return chr(ord(zero) + unicodedata.decimal(sign))
    return SIGNS.get(sign, sign)[-1]


def _bare_letters(part: str, undefined: set[str]) -> Iterator[str]:
    """The letter without the accents that are undefined, then without any, then small."""
    yield "".join(sign for sign in part if not (_is_accent(sign) and sign in undefined))
    apart = unicodedata.normalize("NFKD", part)
    bare = "".join(sign for sign in apart if not _is_accent(sign))
    yield bare
    yield from SIGNS.get(bare, ())
    yield bare.lower()
    if bare.lower() in LETTERS:  # which are the same cells wherever there are Latin letters
        yield chr(UNICODE_BLANK + LETTERS[bare.lower()])


def _flag_letter(sign: str) -> str:
    """Letter of a flag's half; empty for other characters."""
    number = ord(sign[0]) - _FLAG_LETTERS
    return chr(ord("A") + number) if 0 <= number < 26 else ""


def _is_accent(sign: str) -> bool:
    """Tell whether a letter can be read without a mark: an accent or a point, no vowel of India."""
    enclosing = unicodedata.category(sign) == "Me"
    return enclosing or unicodedata.combining(sign) > 0 or _is_invisible(sign)


def _is_invisible(part: str) -> bool:
    """Tell whether a part has nothing to read: joiners, directions, controls, selectors."""
    return all(
        unicodedata.category(sign) in ("Cf", "Cc") or "\ufe00" <= sign <= "\ufe0f" for sign in part
    )


@cache
def _excluded_compositions() -> dict[str, str]:
    """Characters that no normal form has, such as क़, and the letters that they are equal to."""
    found = {}
    for codes in _COMPOSED:
        for sign in map(chr, codes):
            letters = unicodedata.normalize("NFD", sign)
            if letters != sign and unicodedata.normalize("NFC", sign) != sign:
                found[sign] = letters
    return found
