"""Text as code points, each with its place in the source."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SPACE = 0x20
NO_BREAK_SPACE = 0xA0


@dataclass(frozen=True, slots=True, eq=False)
class Text:
    """A run of characters that know where they stand in the source.

    Parameters
    ----------
    codes : uint32[n]
        The characters as code points, as they are to be read: white space folded, lines joined.
    places : int64[n]
        Place of each character in the source, counted in characters from the first.
    end : int
        One past the last character of the source that belongs to the run.
    alphabet : frozenset of int
        Code points among which all of its own are. They are gathered once for
        many texts: array scans between calls of liblouis slow it by a
        fifth on processors that lower their clock for wide vectors.
    """

    codes: NDArray[np.uint32]
    places: NDArray[np.int64]
    end: int
    alphabet: frozenset[int]

    @classmethod
    def empty(cls, end: int = 0) -> Text:
        """A run of no characters, at a place of the source."""
        return cls(np.empty(0, np.uint32), np.empty(0, np.int64), end, frozenset())

    @classmethod
    def of(cls, text: str) -> Text:
        """A string that stands for itself: character i is at place i."""
        codes = to_codes(text)
        return cls(codes, np.arange(codes.size), codes.size, frozenset(codes.tolist()))

    def __str__(self) -> str:
        return to_text(self.codes)

    def __len__(self) -> int:
        return self.codes.size

    def __add__(self, other: Text) -> Text:
        return Text(
            np.concatenate((self.codes, other.codes)),
            np.concatenate((self.places, other.places)),
            other.end,
            self.alphabet | other.alphabet,
        )

    def index(self, character: int) -> int:
        """Index of the first character that stands at a place of the source or after it."""
        return int(np.searchsorted(self.places, character))

    def since(self, character: int) -> Text:
        """Part from a source character on; nothing of the rest is kept in memory."""
        at = self.index(character)
        return Text(self.codes[at:].copy(), self.places[at:].copy(), self.end, self.alphabet)


def to_codes(text: str) -> NDArray[np.uint32]:
    """Code points of a string, lone surrogates included."""
    return np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32)


def to_text(codes: NDArray[np.uint32]) -> str:
    """String of code points, lone surrogates included."""
    return codes.astype("<u4").tobytes().decode("utf-32-le", "surrogatepass")
