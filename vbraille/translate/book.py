"""A source in braille, translated only as far as it is read."""

from __future__ import annotations

from itertools import pairwise
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.errors import InputError, VbrailleError
from vbraille.translate.languages import find_table, has_tables, six_dot_table, table_note
from vbraille.translate.liblouis import BrailleTable
from vbraille.translate.library import EndlessError, call, limit_s
from vbraille.translate.scripts import guess_language
from vbraille.translate.source import SPACE, MarkKind, Text
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.translate.source import Block, Mark, Source


# Unified English Braille's indicators for code switching (Rules of UEB, 14.3): of a word and of its
# end, and of a passage, whose opening has the language's letters between its cells.
_UEB_WORDS = 2  # at most, each with its own
_UEB_WORD, _UEB_WORD_END = Cells.from_unicode("⠘⠷").masks, Cells.from_unicode("⠘⠾").masks
_UEB_OPENING, _DOT_3 = Cells.from_unicode("⠐⠷").masks, Cells.from_unicode("⠄").masks
_UEB_CLOSING, _NOTHING = Cells.from_unicode("⠠⠐⠾").masks, np.empty(0, np.uint8)


class Translator:
    """A braille table for a book, and the tables of other languages that the book says it has.

    Those are made when the first passage in their language is translated. A language that liblouis
    has no table for, or none of six dots where the book's own has six, is written by the book's.
    Where another table begins and ends is marked: by the indicators for code switching of Unified
    English Braille, or in brackets with the language's tag.

    Parameters
    ----------
    table
        Table of the book's own language.
    own
        Tags of the languages that are the book's own. If there are none, the language of the
        table is.
    grade
        Grade that is wanted of the other languages too, where they have it; None for what is
        usual in each.
    switch
        Whether other languages are translated by other tables.
    """

    def __init__(
        self,
        table: BrailleTable,
        own: Iterable[str] = (),
        grade: int | None = None,
        *,
        switch: bool = True,
    ) -> None:
        self.table = table
        self._own = {tag.lower() for tag in own if tag}
        self._grade = grade
        self._switch = switch
        self._chosen: dict[str, BrailleTable] = {}  # by the tags as blocks have them
        self._named = {table.name: table}

    @property
    def tables(self) -> tuple[BrailleTable, ...]:
        """Tables that were used so far, the book's own first."""
        return tuple(self._named.values())

    def translate(self, block: Block) -> Cells:
        """Cells of a block's text, with emphasis and languages as its marks say."""
        if not self._switch or not (block.language or block.marks):
            return self.table.translate(block.text, block.marks)
        whole = self._table_for(block.language)
        if all(mark.kind is not MarkKind.LANGUAGE for mark in block.marks):
            return self._translated(whole, block.text, block.marks, block.language)
        parts = [
            self._translated(table, text, block.marks, tag, glued=glued)
            for table, text, tag, glued in self._passages(block, whole)
        ]
        if not parts:
            return whole.translate(block.text)
        return Cells(
            np.concatenate([part.masks for part in parts]),
            np.concatenate([part.starts for part in parts]),
            block.text.end,
        )

    def _translated(
        self,
        table: BrailleTable,
        text: Text,
        marks: tuple[Mark, ...],
        tag: str,
        *,
        glued: bool = False,
    ) -> Cells:
        """Cells of a passage by a table, marked if it is not the book's own.

        Parameters
        ----------
        tag
            Tag of the passage's language.
        glued
            Whether other text follows without a blank.
        """
        cells = table.translate(text, marks)
        words = np.flatnonzero(np.diff(np.r_[False, cells.masks != 0].astype(np.int8)) == 1)
        if table is self.table or not words.size:
            return cells
        at = [int(words[0]), int(np.flatnonzero(cells.masks)[-1]) + 1]
        language = tag.replace("_", "-").partition("-")[0].strip().lower()
        own = self.table
        if not own.is_ueb:
            opening, closing = own.brackets
            closed = own.translate(Text.of(closing)).masks
            signs = [own.spelled(f"{opening}{language}:"), closed]
        elif words.size <= _UEB_WORDS:
            at = [*words.tolist(), at[1]]
            signs = [_UEB_WORD] * words.size
            signs.append(_UEB_WORD_END if glued and cells.masks[-1] else _NOTHING)
        else:
            letters = Cells.from_brf(language).masks
            signs = [np.concatenate([_UEB_OPENING, letters, _DOT_3]), _UEB_CLOSING]
        where = np.repeat(at, [sign.size for sign in signs])
        beside = np.minimum(where, len(cells) - 1)
        return Cells(
            np.insert(cells.masks, where, np.concatenate(signs)),
            np.insert(cells.starts, where, cells.starts[beside]),
            cells.end,
        )

    def _passages(
        self, block: Block, whole: BrailleTable
    ) -> Iterator[tuple[BrailleTable, Text, str, bool]]:
        """Passages of a block, each with its table, language, and whether the next is glued to it.

        Neighbours have different tables.
        """
        text = block.text
        tables, tags = [whole], [block.language]
        owners = np.zeros(len(text), np.intp)  # which of the tables, for each character
        for mark in block.marks:  # inner ones come after those around them
            if mark.kind is not MarkKind.LANGUAGE:
                continue
            table = self._table_for(mark.target)
            if table not in tables:
                tables.append(table)
                tags.append(mark.target)
            owners[text.index(mark.start) : text.index(mark.end)] = tables.index(table)
        edges = [0, *(np.flatnonzero(np.diff(owners)) + 1).tolist(), len(text)]
        if len(edges) == 2 and len(text):
            yield tables[int(owners[0])], text, tags[int(owners[0])], False
            return
        for start, stop in pairwise(edges):
            if start < stop:
                end = int(text.places[stop]) if stop < len(text) else text.end
                codes = text.codes[start:stop]
                alphabet = frozenset(codes.tolist())
                part = Text(codes, text.places[start:stop], end, alphabet)
                glued = stop < len(text) and text.codes[stop] != SPACE
                yield tables[int(owners[start])], part, tags[int(owners[start])], bool(glued)

    def _table_for(self, language: str) -> BrailleTable:
        """Table of a language; the book's own if that is its language, or there is none."""
        if not language:
            return self.table
        table = self._chosen.get(language)
        if table is None:
            name = self._name_for(language)
            table = self._named.get(name)
            if table is None:
                table = self._named[name] = BrailleTable(name, self.table.how)
            self._chosen[language] = table
        return table

    def _name_for(self, language: str) -> str:
        """Name of the table for a language."""
        own = self._own
        if not own:  # a table without metadata is named by its language, as en-us-g2.ctb
            info, (name, _, _) = self.table.info, PurePath(self.table.name).name.partition("-")
            own = {name.lower() if info is None else info.language.lower()}
        if language.lower() in own:
            return self.table.name
        try:
            usual = find_table(language)
            if usual in map(_usual, own):  # the same language, said otherwise
                return self.table.name
            name = usual if self._grade is None else _graded(language, self._grade, usual)
            if self.table.eight_dots or not BrailleTable(name).eight_dots:
                return name
            return six_dot_table(language) or self.table.name
        except InputError:
            return self.table.name


def _usual(language: str) -> str | None:
    """Name of the usual table of a language; None if there is none."""
    try:
        return find_table(language)
    except InputError:
        return None


def _graded(language: str, grade: int, usual: str) -> str:
    """Name of the table for a grade of a language, or the usual one."""
    try:
        return find_table(language, grade)
    except InputError:
        return usual


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
