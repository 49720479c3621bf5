"""Texts that may stand for a letter or a sign that a braille table leaves undefined, best first."""

from __future__ import annotations

from enum import StrEnum
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING
from unicodedata import category, combining, decimal, name, normalize

from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import LETTERS, to_braille
from vbraille.translate.liblouis import cells_of
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator


class Undefined(StrEnum):
    """Text for a character that neither the table nor a plain spelling can write.

    Attributes
    ----------
    MARK
        A sign for an unknown character; emoji by their names.
    DROP
        Nothing.
    """

    MARK = "mark"
    DROP = "drop"


class Kind(StrEnum):
    """Way in which a part of a text was respelled; the value completes a sentence on the table."""

    MARKED = f"does not know {{}}, marked in the text; {setting('undefined')} drop leaves them out"
    DROPPED = "does not know {}, left out"
    NAME = "does not know {}, named in the text"
    UNENDING = "does not come to an end with {}, marked in the text"
    PLAIN = "has no sign for {}, written as what is nearest"


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
_SKIN_TONES = "🏻🏼🏽🏾🏿"
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
RAISED, LOWERED = "⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻⁼⁽⁾ⁿⁱ", "₀₁₂₃₄₅₆₇₈₉₊₋₌₍₎ₙᵢ"
# Before them in Unified English Braille, whose tables lack the second.
_UEB_RAISED, _UEB_LOWERED = b"\x30\x14", b"\x30\x22"


def small(text: str, forms: str) -> str:
    """Text in small characters, those of `RAISED` or `LOWERED`, if it is a number.

    >>> small("2", LOWERED), small("th", RAISED)
    ('₂', 'th')
    """
    made = text.replace("\u2212", "-").translate(str.maketrans(_ON_LINE, forms))
    is_word = text.isalpha() and len(text) > 1
    return text if is_word or set(made) - set(forms) else made


def joins(part: str, sign: str) -> bool:
    """Tell whether a sign belongs to the part before it: a mark, a small digit, half a flag."""
    if category(sign)[0] == "M":
        return True
    if any(sign in forms and part[0] in forms for forms in (RAISED, LOWERED)):
        return True
    return len(part) == 1 and all("🇦" <= half <= "🇿" for half in (part, sign))


def in_order(part: str) -> str:
    """The part as tables expect it: shadda before the vowel, Hebrew letters composed."""
    if part in _LEFT_OUT:
        return ""
    if _SHADDA in part[2:]:
        return part[0] + _SHADDA + part[1:].replace(_SHADDA, "")
    return next(_compositions(part), part) if "א" <= part[0] <= "ת" else part


@cache
def spellings(part: str, table: str, how: Undefined) -> list[tuple[Kind | None, str]]:
    """Texts that may stand for a letter with its marks, best first; the last is always written.

    None of them is a text that the table writes as a blank, but for a blank.

    Parameters
    ----------
    part
        The letter or sign, with its marks.
    table
        File name or path of the table that leaves it undefined, or a part of it.
    how
        What is written where nothing else can be.
    """
    # A picture or a symbol, which has a name that people know.
    is_emoji = category(part[0]) in ("So", "Sk") and part[0] >= "\u2300"
    named = name(part[0], "").lower() if is_emoji else ""
    as_it_is = [
        in_order(part),
        part,
        *([" ", "⠀"] if part.isspace() else []),
        *[""][: _is_invisible(part)],
    ]
    equal = (normalize("NFC", part), normalize("NFD", part))
    dots, plain = _small_forms(part, table)
    markers = [
        text
        for marker in ("[?]", "(?)", "?", FULL_CELLS)
        for text in (part[0] + marker, marker + part[1:], marker)
    ]
    found: dict[str, Kind | None] = {}
    for kind, texts in (
        (None, [*as_it_is, *equal, *_compositions(part), *dots]),
        (Kind.PLAIN, [*plain, *_plain_spellings(part), *_bare_letters(part)]),
        (Kind.DROPPED, [""] if how is Undefined.DROP else []),
        (Kind.NAME, _bracketed(named) if named else []),
        (Kind.MARKED, markers),
    ):
        for text in texts:
            cells = cells_of(table, text)
            if part.isspace() or not (text.isspace() or (cells and not any(cells))):
                found.setdefault(text, kind)
    # Even full cells can be eaten by a rule; they are counted all the same.
    return [*((kind, text) for text, kind in found.items()), (Kind.MARKED, "")]


def _bracketed(text: str) -> list[str]:
    return [f"[{text}]", f"({text})"]


def _compositions(part: str) -> Iterator[str]:
    """The part with a letter that no normal form has, such as क़, for two or three of its own."""
    letter, *marks = normalize("NFD", part)
    for composed, (own, *needed) in _COMPOSED.items():
        if letter == own and all(mark in marks for mark in needed):
            yield composed + "".join(mark for mark in marks if mark not in needed)


def _small_forms(part: str, table: str) -> tuple[list[str], list[str]]:
    """Spellings of a small number by the table's own sign for such, and as in 10^6 and H_2O."""
    forms, sign = (RAISED, "^") if part[0] in RAISED else (LOWERED, "_")
    if part[0] not in forms:
        return [], []
    text = part.translate(str.maketrans(forms, _ON_LINE))
    is_one = text.isdigit() or len(text) == 1
    own, two = cells_of(table, forms[2]), cells_of(table, "2")
    if not own and cells_of(table, "²").startswith(_UEB_RAISED):
        own = _UEB_LOWERED + two
    below, dots = bytes(map(_lower, two[-1:])), []
    if two and own != two and own.endswith(two):
        dots = [to_braille(own.removesuffix(two)) + (text if is_one else f"⠣{text}⠜")]
    elif below and own.endswith(below) and text.isdigit():
        digits = bytes(_lower(cells_of(table, digit)[-1]) for digit in text)
        dots = [to_braille(own.removesuffix(below) + digits)]
    return dots, [sign + (text if is_one else f"({text})"), f"({text})", f" {text} "]


def _lower(mask: int) -> int:
    """Mask of a cell of dots 1, 2, 4 and 5 moved down by a row."""
    return (mask & 0x1B) << 1


def _plain_spellings(part: str) -> Iterator[str]:
    """Spellings of a sign, of a compatibility character, of a foreign digit, of a capital."""
    yield from _SIGNS.get(part, ())
    # Letters in squares and circles, and of flags, by their names.
    named = [name(sign, "").partition(" LETTER ")[2] for sign in part if "🅐" <= sign <= "🇿"]
    if any(named):
        yield from named if len(named) == 1 else _bracketed("".join(named))
    if part in _SKIN_TONES:
        yield ""
    plain = normalize("NFKC", part)
    if plain[:1].isdigit() and "⁄" in plain:
        plain = f" {plain}"  # ½ after a number is not the number's next digit
    if plain.lstrip() != plain and not plain[1:2].isdigit():
        return  # an accent alone, which is not a blank with an accent
    yield plain
    for which in (0, -1):
        yield "".join(_SIGNS.get(sign, sign)[which] for sign in plain)
    digits = "".join(str(decimal(sign, _SIGNS.get(sign, sign)[-1])) for sign in plain)
    for zero in map(ord, _ZEROS):
        yield digits.translate({ord("0") + digit: zero + digit for digit in range(10)})
    yield part.lower()


def _bare_letters(part: str) -> Iterator[str]:
    """The letter without one of its accents, then without any, then small."""
    yield from (part.replace(accent, "") for accent in filter(_is_accent, part))
    bare = "".join(sign for sign in normalize("NFKD", part) if not _is_accent(sign))
    yield bare
    yield from _SIGNS.get(bare, ())
    yield bare.lower()
    if bare.lower() in LETTERS:  # which are the same cells wherever there are Latin letters
        yield chr(UNICODE_BLANK + LETTERS[bare.lower()])


def _is_accent(sign: str) -> bool:
    """Tell whether a letter can be read without a mark: an accent or a point, no vowel of India."""
    return category(sign) == "Me" or combining(sign) > 0 or _is_invisible(sign)


def _is_invisible(part: str) -> bool:
    """Tell whether a part has nothing to read: joiners, directions, controls, selectors."""
    return all(category(sign) in ("Cf", "Cc") or "\ufe00" <= sign <= "\ufe0f" for sign in part)
