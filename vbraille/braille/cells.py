"""Braille cells, their dots by number and mask, and the way back to the text they stand for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray


# Column (0 is the left one) and row of each dot in its cell.
PLACES = {1: (0, 0), 2: (0, 1), 3: (0, 2), 4: (1, 0), 5: (1, 1), 6: (1, 2), 7: (0, 3), 8: (1, 3)}
DOT_ROWS = 4  # dots 7 and 8 make a fourth row


def mask_of(dots: Iterable[int]) -> int:
    """Mask of some dots, of which each may be named more than once; bit 0 is dot 1.

    >>> mask_of([1, 4])
    9
    """
    return sum({1 << dot - 1 for dot in dots})


def dots_of(mask: int) -> list[int]:
    """Numbers of the dots that are raised.

    >>> dots_of(9)
    [1, 4]
    """
    return [dot for dot in PLACES if mask & 1 << dot - 1]


UNICODE_BLANK = 0x2800

# North American ASCII braille: the character of each six-dot cell, in the order of U+2800-283F.
_BRF = " A1B'K2L@CIF/MSP\"E3H9O6R^DJG>NTQ,*5<-U8V.%[$+X!&;:4\\0Z7(_?W]#Y)="
# Files in the wild use 0x60-0x7E for 0x40-0x5E, letters in lower case among them.
_PATTERN_OF = {
    code + lower: UNICODE_BLANK + mask
    for mask, code in enumerate(_BRF.encode("ascii"))
    for lower in ((0, 0x20) if 0x40 <= code < 0x5F else (0,))
}

_PATTERNS = 0x100  # patterns in Unicode, from `UNICODE_BLANK` on
_DOTS = ["-".join(map(str, dots_of(mask))) or "0" for mask in range(256)]


@dataclass(frozen=True, slots=True, eq=False)
class Cells:
    """A run of braille cells.

    Parameters
    ----------
    masks : uint8[n]
        The raised dots of each cell; bit 0 is dot 1, bit 7 is dot 8.
    starts : int64[n]
        The first source character that each cell stands for, counted from the
        document's first; never decreasing. Several cells may stand for one
        character, and one cell for several.
    end : int
        One past the last source character of the run.
    """

    masks: NDArray[np.uint8]
    starts: NDArray[np.int64]
    end: int

    @classmethod
    def bare(cls, masks: NDArray[np.uint8]) -> Cells:
        """Cells that stand for themselves: the source of cell i is character i."""
        masks = np.asarray(masks, np.uint8)
        return cls(masks, np.arange(masks.size, dtype=np.int64), masks.size)

    def __len__(self) -> int:
        return self.masks.size

    def __getitem__(self, part: slice) -> Cells:
        start, stop, step = part.indices(self.masks.size)
        if step != 1:
            raise ValueError("cells are cut in runs: the step of a slice must be 1")
        # The last cell's character is part of the run, even if it goes on after.
        end = self.source(stop - 1)[1] if start < stop else self.end
        return Cells(self.masks[start:stop], self.starts[start:stop], end)

    def source(self, cell: int) -> tuple[int, int]:
        """Source characters that a cell stands for, as [first, one past the last)."""
        start = int(self.starts[cell])
        after = int(np.searchsorted(self.starts, start, side="right"))
        return start, int(self.starts[after]) if after < self.masks.size else self.end

    def of_source(self, character: int) -> tuple[int, int]:
        """Cells that stand for a source character, as [first, one past the last).

        Raises
        ------
        IndexError
            If the character is not in the run.
        """
        after = int(np.searchsorted(self.starts, character, side="right"))
        if after == 0 or character >= self.end:
            raise IndexError(f"source character {character} is not in these cells")
        first = int(np.searchsorted(self.starts, self.starts[after - 1], side="left"))
        return first, after

    def to_unicode(self) -> str:
        """Give the cells as Unicode braille patterns, U+2800-28FF."""
        return (self.masks.astype("<u4") + UNICODE_BLANK).tobytes().decode("utf-32-le")

    @classmethod
    def from_unicode(cls, text: str) -> Cells:
        """Make cells of Unicode braille patterns.

        Raises
        ------
        ValueError
            If a character is not in U+2800-28FF.
        """
        wrong = [sign for sign in text if not 0 <= ord(sign) - UNICODE_BLANK < _PATTERNS]
        if wrong:
            raise ValueError(f"{wrong[0]!r} is not a braille pattern (U+2800 to U+28FF)")
        return cls.bare(np.array([ord(sign) - UNICODE_BLANK for sign in text], np.uint8))

    def to_brf(self) -> str:
        """North American ASCII braille, one upper-case character a cell.

        Raises
        ------
        ValueError
            If a cell has dot 7 or 8, which BRF cannot write.
        """
        masks = self.masks.tolist()
        wrong = [mask for mask in masks if mask >= len(_BRF)]
        if wrong:
            dots = _DOTS[wrong[0]]
            raise ValueError(f"BRF has six dots and cannot write the cell with dots {dots}")
        return "".join(map(_BRF.__getitem__, masks))

    @classmethod
    def from_brf(cls, text: str) -> Cells:
        """Cells of braille as files have it: ASCII braille in either case, and Unicode patterns.

        Raises
        ------
        ValueError
            If a character is neither; the message names it.
        """
        return cls.from_unicode(text.translate(_PATTERN_OF))

    def to_dots(self) -> str:
        """Dot numbers, ``1-2-4`` a cell and ``0`` for a blank one, with a space between cells."""
        return " ".join(map(_DOTS.__getitem__, self.masks.tolist()))
