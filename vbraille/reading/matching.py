"""Text in which letters that a search takes for the same are the same."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True, slots=True)
class Folded:
    """A text with one form of each letter.

    Parameters
    ----------
    text
        The text after folding.
    origins
        Index in the text before folding of each character; None if all stand where they stood.
    """

    text: str
    origins: list[int] | None

    def origin(self, index: int) -> int:
        """Index in the text before folding."""
        return index if self.origins is None else self.origins[index]


def fold(text: str, *, accents: bool) -> Folded:
    """Fold the case of a text, and its accents if that is asked for.

    >>> fold("Straße", accents=False).text, fold("Été", accents=True).text
    ('strasse', 'ete')
    """
    if text.isascii():
        return Folded(text.lower(), None)
    folded: list[str] = []
    origins: list[int] = []
    for at, character in enumerate(text):
        simple = character.casefold()
        if accents:
            simple = "".join(
                c for c in unicodedata.normalize("NFD", simple) if not unicodedata.combining(c)
            )
        folded.append(simple)
        origins.extend([at] * len(simple))
    return Folded("".join(folded), origins)


class TextMatcher:
    """A text that is looked for; the length of blanks does not matter.

    Parameters
    ----------
    text
        The text as somebody typed it, with something but blanks in it.
    accents
        Whether accents are folded.
    """

    def __init__(self, text: str, *, accents: bool) -> None:
        self._accents = accents
        words = fold(text, accents=accents).text.split()
        self._pattern = re.compile(r"\s+".join(map(re.escape, words)))
        # So much of one piece of a long text may belong to what begins in it or ends there.
        self.reach = 4 * len(text) + 16

    def find(self, text: str) -> Iterator[int]:
        """Index of each place in a text at which the sought text begins."""
        folded = fold(text, accents=self._accents)
        for found in self._pattern.finditer(folded.text):
            yield folded.origin(found.start())
