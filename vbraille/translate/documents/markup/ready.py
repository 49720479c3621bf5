"""Text of a book that is in braille already, made into cells as it stands."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells, masks_of
from vbraille.translate.text import NO_BREAK_SPACE, SPACE, to_codes, to_text

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.translate.documents.parted import Passage

_FULL = 0x28FF & ~0xC0  # dots 1 to 6, for what is no braille
_LETTERS = "abcdefghijklmnopqrstuvwxyz"
# Unified English Braille without contractions, for the few words that a reader of markup adds.
_SPELT = {
    **dict(zip(_LETTERS, Cells.from_brf(_LETTERS).to_unicode(), strict=True)),
    **dict(zip("1234567890", Cells.from_brf("ABCDEFGHIJ").to_unicode(), strict=True)),
    **dict(zip(".,:;?!-'", "⠲⠂⠒⠆⠦⠖⠤⠄", strict=True)),
    "(": "⠐⠣",
    ")": "⠐⠜",
    "[": "⠨⠣",
    "]": "⠨⠜",
    "•": "⠸⠲",
    "*": "⠐⠔",
    "/": "⠸⠌",
    "“": "⠘⠦",
    "”": "⠘⠴",
}
_NUMBER, _CAPITAL = "⠼", "⠠"


class Spelling:
    """Makes cells of the text of a book in braille.

    Attributes
    ----------
    wrong : int
        Number of characters so far that are no braille and are shown as full cells.
    """

    def __init__(self) -> None:
        self.wrong = 0

    def of_print(self, text: str) -> str:
        """Spell what is in print, in Unified English Braille; braille stays as it is."""
        cells, before = [], ""
        for character in text:
            if character.isdigit() and not before.isdigit():
                cells.append(_NUMBER)
            elif character.isascii() and character.isupper():
                cells.append(_CAPITAL)
            cells.append(_SPELT.get(character.lower(), character))
            before = character
        return "".join(cells)

    def ready(self, passages: Iterable[Passage]) -> list[Passage]:
        """Passages with their cells."""
        return [self._with_cells(passage) for passage in passages]

    def _with_cells(self, passage: Passage) -> Passage:
        codes = to_codes(passage.text).copy()
        spaces = np.isin(codes, (0x09, NO_BREAK_SPACE, 0x202F, 0x3000))
        codes[spaces | ((codes >= 0x2000) & (codes <= 0x200A))] = SPACE
        braille = (codes >= UNICODE_BLANK) & (codes < UNICODE_BLANK + 0x100)
        wrong = ~braille & ((codes < SPACE) | (codes > 0x7E))
        codes[wrong] = _FULL
        self.wrong += int(wrong.sum())
        cells = Cells(masks_of(codes), np.arange(codes.size), codes.size)
        return replace(passage, text=to_text(codes), cells=cells)
