"""Words about a part of a text, written into the text itself.

What reads a word processor's file tells neither languages nor pages; it passes on each character.
"""

from __future__ import annotations

import re
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
