"""A source in braille, translated only as far as somebody reads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.languages import foreign_note
from vbraille.translate.switching import Translator

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vbraille.braille.cells import Cells
    from vbraille.translate.liblouis import BrailleTable
    from vbraille.translate.source import Block, Source


class Book:
    """Blocks of a source with their cells.

    Parameters
    ----------
    source
        Source of the blocks. Blocks with cells are shown as they are; others are translated.
    table
        Table to translate with; None for a source of ready cells.
    language
        Tag of the language that the reader chose; empty if the reader chose none, so that the
        source says which language is the book's own.
    grade
        Grade that the reader chose, which holds for passages in other languages too.
    switch
        Whether passages in other languages are translated by the tables of those languages.

    Attributes
    ----------
    language, grade, switch
        As given.
    """

    _REMEMBERED = 16

    def __init__(
        self,
        source: Source,
        table: BrailleTable | None = None,
        *,
        language: str = "",
        grade: int | None = None,
        switch: bool = True,
    ) -> None:
        self.source = source
        self.table = table
        self.language = language
        self.grade = grade
        self.switch = switch
        self.translator = None
        if table is not None:
            own = (language, source.language)
            self.translator = Translator(table, own, grade, switch=switch)
        self._recent: dict[int, tuple[Block, Cells]] = {}

    def block(self, number: int) -> tuple[Block, Cells] | None:
        """Block of a number, from 0, with its cells; None past the end.

        Raises
        ------
        ValueError
            If the block has to be translated and there is no table.
        """
        found = self._recent.get(number)
        if found is None:
            block = self.source.block(number)
            if block is None:
                return None
            found = block, block.cells if block.cells is not None else self._translate(block)
            if len(self._recent) >= self._REMEMBERED:
                del self._recent[next(iter(self._recent))]
            self._recent[number] = found
        return found

    def continues(self, number: int) -> bool:
        """Whether a block goes on where the one before broke off; False past the end."""
        block = self.source.block(number)
        return block is not None and block.continues

    def notes(self) -> Iterator[str]:
        """Notes on the source and the table that are due now; each is given once."""
        tables = () if self.translator is None else self.translator.tables
        for note in (self.source.note(), *map(foreign_note, tables)):
            if note is not None:
                yield note

    def _translate(self, block: Block) -> Cells:
        if self.translator is None:
            raise ValueError(f"{self.source.name} has text in it; give its book a braille table")
        return self.translator.translate(block)
