"""How files write cells: a mask for each byte of a BRF file, or for each code point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells

if TYPE_CHECKING:
    from numpy.typing import NDArray

UNKNOWN = -1
_TAB, _NO_BREAK_SPACE = 0x09, 0xA0
# What ends a line or a page; it has a mask so that it is never taken for a wrong character.
_ENDS = (0x0A, 0x0C, 0x0D)
_LOW = range(0x20, 0x60)
_HIGH = range(0x60, 0x7F)  # written for 0x40 to 0x5E by many programs


def north_american() -> NDArray[np.int16]:
    """Mask of each byte in North American ASCII braille, int16[256]; -1 for no braille."""
    masks = np.full(256, UNKNOWN, np.int16)
    masks[_LOW.start : _LOW.stop] = Cells.from_brf("".join(map(chr, _LOW))).masks
    masks[_HIGH.start : _HIGH.stop] = masks[0x40:0x5F]
    return _with_blanks(masks)


def by_display_table(table: str) -> NDArray[np.int16]:
    """Mask of each byte as a display table of liblouis has it, int16[256]; -1 for no braille.

    Bytes are Latin-1. A letter stands for the cell of its small letter, or of its capital where
    the table knows no small one, and never for dots 7 and 8, which tell the two apart; a to z are
    the same in all dialects, and some tables leave them out. What the table does not know of the
    bytes 0x60 to 0x7E is written for 0x40 to 0x5E, and the reverse.

    Raises
    ------
    InputError
        If there is no such table.
    """
    # liblouis and all its tables are read only where a dialect is asked for.
    from vbraille.translate.liblouis import display_dots

    printed = [chr(code) for code in (*range(0x20, 0x7F), *range(0xA1, 0x100))]
    known = dict(zip(printed, display_dots(table, "".join(printed)), strict=True))
    masks = np.full(256, UNKNOWN, np.int16)
    for character in printed:
        code = ord(character)
        folded = chr(code ^ 0x20) if 0x40 <= code < 0x7F else ""
        small = character.lower() if len(character.lower()) == 1 else character
        dots = known.get(small) or known[character] or known.get(folded, 0)
        if 0x40 <= code < 0x7F:
            dots &= 0x3F
        if character.isascii() and character.isalpha() and not dots:
            dots = int(Cells.from_brf(character).masks[0])
        if dots:
            masks[code] = dots
    masks[0x20] = 0
    return _with_blanks(masks)


def _with_blanks(masks: NDArray[np.int16]) -> NDArray[np.int16]:
    masks[[_TAB, *_ENDS]] = 0
    return masks


def unicode_masks(codes: NDArray[np.uint32]) -> NDArray[np.int16]:
    """Masks of code points, int16[n]: braille patterns, ASCII braille, blanks; -1 for no braille.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    """
    ascii_masks = north_american()
    ascii_masks[_NO_BREAK_SPACE] = 0
    masks = ascii_masks[np.minimum(codes, 0xFF)]
    masks[codes > 0xFF] = UNKNOWN
    pattern = (codes >= 0x2800) & (codes < 0x2900)
    masks[pattern] = codes[pattern] - 0x2800
    return masks
