"""A source in braille, translated only as far as somebody reads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import VbrailleError
from vbraille.translate.languages import has_tables, table_note
from vbraille.translate.library import EndlessError, call, limit_s
from vbraille.translate.scripts import guess_language
from vbraille.translate.switching import Translator
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.braille.cells import Cells
    from vbraille.translate.liblouis import BrailleTable
    from vbraille.translate.source import Block, Source


_TABLES_S = 1.0  # more than tables of other languages take to be compiled meanwhile


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
    unnamed
        Whether neither the reader nor the source named a language or a table, so that a text
        that looks like another than the table's is worth a note.

    Attributes
    ----------
    language, grade, switch
        As given.
    """

    _REMEMBERED = 16
    # What is translated at once for who reads on: blocks, and characters.
    _AHEAD, _AHEAD_CHARACTERS = 8, 4_096

    def __init__(
        self,
        source: Source,
        table: BrailleTable | None = None,
        *,
        language: str = "",
        grade: int | None = None,
        switch: bool = True,
        unnamed: bool = False,
    ) -> None:
        self.source = source
        self.table = table
        self.language = language
        self.grade = grade
        self.switch = switch
        self.unnamed = unnamed
        self.translator = None
        if table is not None:
            own = (language, source.language)
            self.translator = Translator(table, own, grade, switch=switch)
        self._recent: dict[int, tuple[Block, Cells]] = {}
        self._after = -1  # number of the block after those that were translated last

    def block(self, number: int) -> tuple[Block, Cells] | None:
        """Block of a number, from 0, with its cells; None past the end.

        Raises
        ------
        ValueError
            If the block has to be translated and there is no table.
        """
        if number not in self._recent:
            blocks = self._gather_from(number)
            pairs = zip(blocks, self._cells_of(blocks), strict=True)
            self._recent |= enumerate(pairs, number)
            self._after = number + len(blocks)
            for old in list(self._recent)[: -self._REMEMBERED]:
                del self._recent[old]
        return self._recent.get(number)

    def continues(self, number: int) -> bool:
        """Tell whether a block goes on where the one before broke off; False past the end."""
        block = self.source.block(number)
        return block is not None and block.continues

    def notes(self) -> Iterator[str]:
        """Notes on the source and the table that are due now; each is given once."""
        tables = () if self.translator is None else self.translator.tables
        hint = None
        if self.unnamed:
            self.unnamed = False
            hint = self._language_hint()
        for note in (self.source.note(), hint, *map(table_note, tables)):
            if note is not None:
                yield note

    def _language_hint(self) -> str | None:
        """Note on a beginning that looks like another language than the table's."""
        texts: list[str] = []
        while sum(map(len, texts)) < self._AHEAD_CHARACTERS and len(texts) < self._REMEMBERED:
            block = self.source.block(len(texts))
            if block is None:
                break
            texts.append(str(block.text))
        tag, name = guess_language(" ".join(texts))
        info = None if self.table is None else self.table.info
        if not tag or info is None or info.speaks(tag) or not has_tables(tag):
            return None
        return (
            f"this text looks like {name}, and is translated by the table {info.name}; "
            f"{setting('language')} {tag} has it translated as {name}"
        )

    def _gather_from(self, number: int) -> list[Block]:
        """The block of a number, and some more if the one before it was read last."""
        blocks: list[Block] = []
        characters = 0
        most = self._AHEAD if number == self._after else 1
        while len(blocks) < most and characters < self._AHEAD_CHARACTERS:
            try:
                block = self.source.block(number + len(blocks))
            except VbrailleError:
                if blocks:  # who reads so far is told
                    break
                raise
            if block is None:
                break
            blocks.append(block)
            characters += len(block.text)
        return blocks

    def _cells_of(self, blocks: Sequence[Block]) -> list[Cells]:
        if all(block.cells is not None for block in blocks):
            return [self._cells(block) for block in blocks]
        try:
            characters = sum(len(block.text) for block in blocks)
            return call(
                lambda: [self._cells(block) for block in blocks],
                _TABLES_S + limit_s(characters),
            )
        except EndlessError:
            return [self._cells(block) for block in blocks]

    def _cells(self, block: Block) -> Cells:
        return self._translate(block) if block.cells is None else block.cells

    def _translate(self, block: Block) -> Cells:
        if self.translator is None:
            raise ValueError(f"{self.source.name} has text in it; give its book a braille table")
        return self.translator.translate(block)
