"""A source in braille, translated block by block as it is read."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from functools import lru_cache
from itertools import groupby
from typing import TYPE_CHECKING

from vbraille.braille.cells import Cells
from vbraille.errors import InputError
from vbraille.translate.blocks import MarkKind, cut_marks
from vbraille.translate.languages import find_table
from vbraille.translate.spellings import Kind, Undefined
from vbraille.translate.tables import BrailleTable, six_dot_table, to_cells
from vbraille.translate.undefined import Written
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_REMEMBERED = 64  # blocks
# Unified English Braille's indicators for code switching (Rules of UEB, 14.3): of a word and of its
# end, and of a passage, whose opening has the language's letters between its cells.
_UEB_WORD, _UEB_WORD_END, _UEB_OPENING, _UEB_OPENED, _UEB_CLOSING = (
    Cells.from_unicode(sign).masks.tobytes() for sign in ("⠘⠷", "⠘⠾", "⠐⠷", "⠄", "⠠⠐⠾")
)
_UEB_WORDS = 2  # at most, each with its own


class Book:
    """Blocks of a source with their cells.

    Passages in other languages are written by the tables of these, between signs that say so:
    the indicators for code switching of Unified English Braille, or brackets with the language's
    tag. A language that liblouis has no table for, or none of six dots where the book's own has
    six, is written by the book's.

    Parameters
    ----------
    source
        Source of the blocks. Blocks with cells are shown as they are; others are translated.
    table
        Table to translate with; None for a source of ready cells.
    language
        Tag of the language that the reader chose; empty if the source says which is the book's own.
    grade
        Grade that the reader chose, which holds for passages in other languages too.
    switch
        Whether passages in other languages are translated by the tables of those languages.

    Attributes
    ----------
    otherwise : dict
        For each block that was translated, what was written otherwise than it stands.
    """

    def __init__(
        self,
        source: Source,
        table: BrailleTable | None = None,
        *,
        language: str = "",
        grade: int | None = None,
        switch: bool = True,
    ) -> None:
        self.source, self.table = source, table
        self.language, self.grade, self.switch = language, grade, switch
        self.otherwise: dict[int, Counter[tuple[Kind, str]]] = {}
        self._cells = lru_cache(_REMEMBERED)(self._make)
        self._tables: dict[str, BrailleTable] = {}
        self._scripts: set[str] = set()  # scripts that a note was made on

    def cells(self, block: Block) -> Cells:
        """Cells of a block of the source; they know the places that they stand for.

        Raises
        ------
        ValueError
            If the block has to be translated and there is no table.
        """
        return self._cells(block)

    def notes(self) -> list[str]:
        """Sentences on the source and the table that are due now; each is given once."""
        return self.source.notes()

    def _make(self, block: Block) -> Cells:
        if block.cells is not None:
            own = block.cells
            return Cells(own.masks, own.starts - int(own.starts[:1].sum()) + block.start, block.end)
        if self.table is None:
            raise ValueError(f"{self.source.name} has text in it; give its book a braille table")
        written = Written()
        for table, start, text, language in self._passages(block):
            part = table.write(text, cut_marks(block.marks, start, start + len(text)))
            if table is not self.table:
                part = self._between_signs(part, language, block.text[start + len(text) :][:1])
            written.add(part, start)
        if written.otherwise:
            self.otherwise[block.number] = written.otherwise
            self._note_script(block, written.otherwise)
        return to_cells(written, len(block.text), block.start)

    def _passages(self, block: Block) -> Iterator[tuple[BrailleTable, int, str, str]]:
        """Passages of a block by their tables: the table, where they begin, the text, the tag."""
        tags = [block.language] * len(block.text)
        for mark in block.marks:  # inner ones come after those around them
            if mark.kind is MarkKind.LANGUAGE:
                tags[mark.start : mark.end] = [mark.target] * (mark.end - mark.start)
        start = 0
        for table, run in groupby(tags, self._table_for):
            these = list(run)
            stop = start + len(these)
            yield table, start, block.text[start:stop], these[0]
            start = stop

    def _table_for(self, language: str) -> BrailleTable:
        """Table of a language; the book's own if that is its language, or there is none."""
        assert self.table is not None
        if not language or not self.switch:
            return self.table
        if language not in self._tables:
            self._tables[language] = self._find_table(language)
        return self._tables[language]

    def _find_table(self, language: str) -> BrailleTable:
        own = self.table
        assert own is not None
        named = own.info.language or own.name.partition("-")[0]
        known = [tag for tag in (self.language, self.source.language) if tag] or [named]
        try:
            usual = find_table(language)
            if usual in (own.name, *map(_named, known)):
                return own
            found = BrailleTable(_named(language, self.grade, usual), own.undefined)
            if found.eight_dots and not own.eight_dots:
                six = six_dot_table(language)
                found = own if six is None else BrailleTable(six, own.undefined)
        except InputError:
            return own
        return found

    def _between_signs(self, part: Written, tag: str, following: str) -> Written:
        """A passage in another language between the signs that say so."""
        own = self.table
        assert own is not None
        words = [found.span() for found in re.finditer(rb"[^\0]+", part.masks)]
        if not words:
            return part
        first, end = words[0][0], words[-1][1]
        language = tag.replace("_", "-").partition("-")[0].strip().lower()
        if not own.is_ueb:
            opening, closing = own.brackets
            signs = {
                first: own.write(f"{opening}{language}:").masks,
                end: own.write(closing).masks,
            }
        elif len(words) <= _UEB_WORDS:
            signs = dict.fromkeys((start for start, _ in words), _UEB_WORD)
            if following.strip() and part.masks[-1]:
                signs[end] = _UEB_WORD_END
        else:
            letters = Cells.from_brf(language).masks.tobytes()
            signs = {first: _UEB_OPENING + letters + _UEB_OPENED, end: _UEB_CLOSING}
        for cell, sign in sorted(signs.items(), reverse=True):
            part.masks = part.masks[:cell] + sign + part.masks[cell:]
            place = part.places[min(cell, len(part.places) - 1)]
            part.places[cell:cell] = [place] * len(sign)
        return part

    def _note_script(self, block: Block, otherwise: Counter[tuple[Kind, str]]) -> None:
        """Note once that most of a block is in a script that its table does not know."""
        signs = [part[0] for kind, part in otherwise.elements() if kind is Kind.MARKED]
        marked = list(filter(str.isalpha, signs))
        if self.table is None or len(marked) * 2 <= sum(map(str.isalpha, block.text)):
            return
        script = unicodedata.name(marked[0], "unknown").partition(" ")[0].capitalize()
        if script not in self._scripts:
            self._scripts.add(script)
            self.source.note(
                f"most of this passage is in {script} letters, which the table {self.table.name} "
                f"does not know; give its {setting('language')}"
            )


_WAYS = {
    Undefined.MARK: "marked in the text",
    Undefined.NAME: "named in brackets",
    Undefined.CODE: "numbered in brackets",
    Undefined.DROP: "left out",
}


class Remarks:
    """Counts what cannot be shown on lines, and what the table cannot write.

    Parameters
    ----------
    book
        Book that the lines are of.
    """

    def __init__(self, book: Book) -> None:
        self._book = book
        self._blocks: set[int] = set()
        self._unshown: Counter[str] = Counter()
        self._written: Counter[tuple[Kind, str]] = Counter()

    def see(self, block: Block) -> None:
        """Count what is in a block, once."""
        if block.number not in self._blocks:
            self._blocks.add(block.number)
            things = [mark.target for mark in block.marks if mark.kind is MarkKind.UNSHOWN]
            self._unshown.update(thing or "other thing" for thing in things)
            self._written.update(self._book.otherwise.get(block.number, {}))

    def sentences(self) -> list[str]:
        """Sentences on all that was seen; none if all is shown as it stands."""
        table, said = self._book.table, []
        unknown, plain = self._named(Kind.MARKED, Kind.NAME), self._named(Kind.PLAIN)
        if unknown and table is not None:
            said.append(
                f"the table {table.name} does not know {unknown}, {_WAYS[table.undefined]}; "
                f"{setting('undefined')} chooses mark, name, code or drop"
            )
        if plain and table is not None:
            said.append(
                f"the table {table.name} has no sign for {plain}, written as what is nearest"
            )
        words = [part for kind, part in self._written if kind is Kind.UNENDING]
        if words:
            said.append(
                f"liblouis does not come to an end with {count(len(words), 'word')} "
                f"({', '.join(map(repr, words[:3]))}), marked in the text"
            )
        if self._unshown:
            most = _most(self._unshown, 5, count, "{} others")
            said.append(
                f"not shown: {count(self._unshown.total(), 'thing')} ({most}); "
                f"each is marked where it stands"
            )
        return said

    def _named(self, *kinds: Kind) -> str:
        """Number and names of the characters that were written in some ways; empty for none."""
        found: Counter[str] = Counter()
        for (kind, part), number in self._written.items():
            if kind in kinds:
                found[part] += number
        if not found:
            return ""
        most = _most(found, 3, lambda n, part: f"{n} of {describe(part)}", "{} of others")
        return f"{count(found.total(), 'character')} ({most})"


def _most(found: Counter[str], most: int, say: Callable[[int, str], str], others: str) -> str:
    """The most frequent of what was counted, in words, and how many others there are."""
    named = found.most_common(most)
    more = found.total() - sum(number for _, number in named)
    return ", ".join(
        [*(say(n, what) for what, n in named), *([others.format(more)] if more else [])]
    )


def describe(part: str) -> str:
    """Code and name of a character, as in "U+2022 bullet"."""
    name = unicodedata.name(part[0], "").lower()
    return f"U+{ord(part[0]):04X} {name}".strip()


def _named(language: str, grade: int | None = None, otherwise: str = "") -> str:
    """Name of the table of a language and grade, or another if there is none."""
    try:
        return find_table(language, grade)
    except InputError:
        return otherwise
