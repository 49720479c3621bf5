"""Search in a book's text by one regular expression, whatever the case, accents and quotes."""

from __future__ import annotations

import re
import unicodedata
from functools import cache
from itertools import takewhile

_QUOTES = "'\"`´‘’‚‛“”„‟′″‹›«»ʼ＇＂"
_DASHES = "-‐‑‒–—―−⁃﹘﹣－"
_MARKS = "[\u0300-\u036f\u00ad]*"
_FIRST_BACK = 4096  # characters that are looked at first, backward


def pattern_for(wanted: str) -> re.Pattern[str]:
    """Regular expression for a text as it is typed.

    Each letter stands for those like it, such as e for É, and a blank for any white space.
    """
    parts = [
        r"\s+" if character == " " else _class(character) + _MARKS
        for character in _plain(" ".join(wanted.split()))
    ]
    return re.compile("".join(parts))


def find_after(pattern: re.Pattern[str], text: str, at: int) -> int | None:
    """Index of the first hit from an index on; None without one."""
    match = pattern.search(text, max(at, 0))
    return None if match is None else match.start()


def find_before(pattern: re.Pattern[str], text: str, at: int) -> int | None:
    """Index of the last hit that begins before an index; None without one."""
    end, size = at, _FIRST_BACK
    while end > 0:  # in larger and larger pieces
        start = max(0, end - size)
        last = None
        for match in pattern.finditer(text, start):
            if match.start() >= end:
                break
            last = match.start()
        if last is not None:
            return last
        end, size = start, size * 4
    return None


def hits_between(pattern: re.Pattern[str], text: str, start: int, end: int) -> list[int]:
    """Indices of all hits that begin from an index on, before another."""
    hits = (match.start() for match in pattern.finditer(text, start))
    return list(takewhile(lambda hit: hit < end, hits))


def _class(character: str) -> str:
    for alike in (_QUOTES, _DASHES):
        if character in alike:
            return f"[{re.escape(alike)}]"
    letters = sorted({character, character.upper()[:1], *_alike().get(character, ())})
    return f"[{re.escape(''.join(letters))}]" if letters[1:] else re.escape(character)


def _plain(text: str) -> str:
    """Text in small letters without accents."""
    return re.sub("[\u0300-\u036f]", "", unicodedata.normalize("NFD", text.casefold()))


@cache
def _alike() -> dict[str, list[str]]:
    """Letters that differ from a plain one by case or accents."""
    found: dict[str, list[str]] = {}
    for code in (*range(0x80, 0x590), *range(0x1E00, 0x2000)):
        character = chr(code)
        plain = _plain(character)
        if len(plain) == 1 and plain != character:
            found.setdefault(plain, []).append(character)
    return found
