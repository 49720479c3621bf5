"""Words about a part of a text, written into the text itself.

What reads a word processor's file tells neither languages nor pages; it passes on each character.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

# Noncharacters of Unicode, which no text has: begin, end of the words about it, end.
_BEGIN, _ABOUT, _END = "\ufdd0", "\ufdd1", "\ufdd2"
_ANY = f"[^{_BEGIN}{_ABOUT}{_END}]*"
ANNOTATED = re.compile(f"{_BEGIN}({_ANY}){_ABOUT}({_ANY}){_END}")
"""An annotated part of a text: its groups are the words, separated by bars, and the part."""
STRAY = str.maketrans("", "", _BEGIN + _ABOUT + _END)
_NO_WORD = re.compile(r"[^\w= -]")
_NO_LANGUAGE = frozenset(("", "none", "zxx", "und", "x-none", "mul"))


def annotation(words: Iterable[str], text: str = "") -> str:
    """Text with words about it.

    Parameters
    ----------
    words
        "sup", "sub", "u", "lang=" and a tag, "page=" and its number, or "object=" and a name.
    text
        Text that the words are about; empty where they stand for a thing in its place.
    """
    said = "|".join(_NO_WORD.sub("", word) for word in words)
    return f"{_BEGIN}{said}{_ABOUT}{text.translate(STRAY)}{_END}"


def tag_of(language: str | None, country: str | None = None) -> str:
    """Tag of a language as a word processor has it; empty if that is no language."""
    language = (language or "").strip()
    if language.lower() in _NO_LANGUAGE:
        return ""
    country = (country or "").strip()
    return f"{language}-{country}" if country.lower() not in _NO_LANGUAGE else language


def primary(tag: str) -> str:
    """First part of a tag: the language without its country."""
    return tag.replace("_", "-").partition("-")[0].lower()


@dataclass(slots=True)
class Languages:
    """How much of a text is in which language."""

    _characters: Counter[str] = field(default_factory=Counter)

    def count(self, tag: str, characters: int) -> None:
        """Count characters of a language, or of none that is known."""
        self._characters[tag] += characters

    def most(self, otherwise: str) -> str:
        """Tag of the language that most of the text is in; the other tag if none was counted."""
        counted = self._characters.most_common(1)
        return counted[0][0] if counted and counted[0][1] else otherwise
