"""Text that is braille already, such as a BRF file's: blocks of ready cells."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from vbraille.braille.cells import Cells, masks_of
from vbraille.errors import InputError

if TYPE_CHECKING:
    from vbraille.translate.source import Block, Index, Source


class CellsSource:
    """A source whose characters are cells, in ASCII braille (BRF) or Unicode braille patterns.

    Each character is the source of one cell, and each printed cell is its own text.

    Parameters
    ----------
    source
        Source of the characters. A `Document` of a braille file keeps the lines of the file.
    """

    def __init__(self, source: Source) -> None:
        self._source = source
        self.in_cells = True

    @property
    def name(self) -> str:
        """Name of the source in messages."""
        return self._source.name

    @property
    def title(self) -> str:
        """Title of the book, as the source has it; empty if it has none."""
        return self._source.title

    @property
    def language(self) -> str:
        """Tag of the source's language; empty if it does not say."""
        return self._source.language

    @property
    def complete(self) -> bool:
        """Whether all blocks are known."""
        return self._source.complete

    def anchor(self, name: str) -> int | None:
        """Place of the first character of the block with an anchor; None if there is none."""
        return self._source.anchor(name)

    def index(self) -> Index:
        """Tell what is known so far of where blocks are."""
        return self._source.index()

    def adopt(self, index: Index) -> None:
        """Take over what was known of the same file at another time."""
        self._source.adopt(index)

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0, with its cells; None past the end.

        Raises
        ------
        InputError
            If a character is no braille, or the source cannot be read any more.
        """
        block = self._source.block(number)
        if block is None:
            return None
        text = block.text
        try:
            cells = Cells(masks_of(text.codes), text.places, text.end)
        except ValueError as error:
            raise InputError(
                f"{self.name} is not all braille: {error}; give a file of braille, or have a text "
                f"translated by a table"
            ) from None
        return replace(block, cells=cells)

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        return self._source.block_at(character)

    def progress(self, number: int) -> float:
        """About how much of the source stands before a block that was read, 0 to 1."""
        return self._source.progress(number)

    def note(self) -> str | None:
        """Note on the source, given once after its cause is found; None if there is none."""
        return self._source.note()

    def sha256(self) -> str:
        """SHA-256 of the bytes that the source was read from, in hexadecimal."""
        return self._source.sha256()
