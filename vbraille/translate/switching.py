"""Blocks in several languages: each passage by the table of its language."""

from __future__ import annotations

from itertools import pairwise
from pathlib import PurePath
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.errors import InputError
from vbraille.translate.languages import find_table, six_dot_table
from vbraille.translate.liblouis import BrailleTable
from vbraille.translate.source import MarkKind
from vbraille.translate.text import SPACE, Text

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.translate.source import Block, Mark


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
