"""A source in braille, translated block by block as it is read."""

from __future__ import annotations

import re
import unicodedata
from collections import Counter, defaultdict
from functools import cache, lru_cache
from itertools import groupby
from typing import TYPE_CHECKING

from vbraille.braille.cells import Cells
from vbraille.translate.blocks import MarkKind, cut_marks
from vbraille.translate.spellings import Kind
from vbraille.translate.tables import BrailleTable, table_of
from vbraille.translate.undefined import Written
from vbraille.wording import count, setting

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.translate.blocks import Block
    from vbraille.translate.source import Source

_REMEMBERED = 64  # blocks
_UEB_WORDS = 2  # at most, each with its own sign


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
    cells : function
        Gives the cells of a block of the source; they know the places that they stand for.
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
        self.cells = lru_cache(_REMEMBERED)(self._translate)
        self._table_for = cache(self._find_table)

    def _translate(self, block: Block) -> Cells:
        if block.cells is not None:
            own = block.cells
            return Cells(own.masks, own.starts - int(own.starts[:1].sum()) + block.start, block.end)
        tags = [block.language] * len(block.text)
        for mark in block.marks:  # inner ones come after those around them
            if mark.kind is MarkKind.LANGUAGE:
                tags[mark.start : mark.end] = [mark.target] * (mark.end - mark.start)
        own = self.table
        assert own is not None
        written, start = Written(), 0
        for table, run in groupby(tags, self._table_for):
            tag, *more = run
            stop = start + 1 + len(more)
            part = table.write(block.text[start:stop], cut_marks(block.marks, start, stop))
            if table is not own:
                part = _between_signs(own, part, tag, block.text[stop : stop + 1])
            written.add(part, start)
            start = stop
        if written.otherwise:
            self.otherwise[block.number] = written.otherwise
            self._note_script(block, own)
        return written.cells(len(block.text), block.start)

    def _find_table(self, language: str) -> BrailleTable:
        """Table of a passage's language; the book's own if that is its language, or it has none."""
        own, found = self.table, None
        assert own is not None
        tags = (self.language, self.source.language, own.info.language or own.name)
        if self.switch and _primary(language) not in ("", *map(_primary, tags)):
            found = table_of(language, self.grade) or table_of(language)
        if found is None or found.name == own.name or found.eight_dots > own.eight_dots:
            return own
        found.undefined = own.undefined
        return found

    def _note_script(self, block: Block, table: BrailleTable) -> None:
        """Note that most of a block is in a script that its table does not know."""
        parts = self.otherwise[block.number].elements()
        marked = [part[0] for kind, part in parts if kind is Kind.MARKED and part[0].isalpha()]
        if len(marked) * 2 > sum(map(str.isalpha, block.text)):
            script = unicodedata.name(marked[0], "unknown").partition(" ")[0].capitalize()
            self.source.note(
                f"most of this passage is in {script} letters, which the table {table.name} "
                f"does not know; give its {setting('language')}"
            )


def _between_signs(own: BrailleTable, part: Written, tag: str, following: str) -> Written:
    """A passage in another language between the signs of a book's own table that say so."""
    words = [found.span() for found in re.finditer(rb"[^\0]+", part.masks)]
    if not words:
        return part
    first, end = words[0][0], words[-1][1]
    language = _primary(tag)
    if not own.is_ueb:
        opening, closing = next(filter(own.cells_of, ("[]", "()")), "⠿⠿")
        signs = [(first, f"{opening}{language}:"), (end, closing)]
    # Unified English Braille's indicators for code switching (Rules of UEB, 14.3): of a passage,
    # whose opening has the language's letters between its cells; of a word and of its end.
    elif len(words) > _UEB_WORDS:
        letters = Cells.from_brf(language).to_unicode()
        signs = [(first, f"⠐⠷{letters}⠄"), (end, "⠠⠐⠾")]
    else:
        signs = [(start, "⠘⠷") for start, _ in words]
        if following.strip() and part.masks[-1]:
            signs.append((end, "⠘⠾"))
    for cell, sign in reversed(signs):
        masks = own.write(sign).masks
        part.masks = part.masks[:cell] + masks + part.masks[cell:]
        place = part.places[min(cell, len(part.places) - 1)]
        part.places[cell:cell] = [place] * len(masks)
    return part


def remarks(book: Book, blocks: Iterable[Block]) -> list[str]:
    """Sentences on content that cannot be shown, and on characters that the table lacks."""
    unshown: Counter[str] = Counter()
    written: defaultdict[Kind, Counter[str]] = defaultdict(Counter)
    for block in blocks:
        unshown.update(mark.target for mark in block.marks if mark.kind is MarkKind.UNSHOWN)
        for (kind, part), number in book.otherwise.get(block.number, {}).items():
            written[kind][part] += number
    table = book.table.name if book.table else ""
    said = [
        f"the table {table} {kind.format(_parts(kind, written[kind]))}"
        for kind in Kind
        if kind in written
    ]
    if unshown:
        things = [count(number, thing) for thing, number in unshown.most_common()]
        said.append(
            f"not shown: {count(unshown.total(), 'thing')} ({', '.join(things)}); "
            f"each is marked where it stands"
        )
    return said


def _parts(kind: Kind, found: Counter[str]) -> str:
    """Number of words or characters, and the most frequent of them."""
    named, others = [], found.total()
    for part, number in found.most_common(3):
        letter = f"U+{ord(part[0]):04X} {unicodedata.name(part[0], '').lower()}".strip()
        named.append(f"{number} of {repr(part) if kind is Kind.UNENDING else letter}")
        others -= number
    if others:
        named.append(f"{others} of others")
    thing = "word" if kind is Kind.UNENDING else "character"
    return f"{count(found.total(), thing)} ({', '.join(named)})"


def _primary(tag: str) -> str:
    """Language of a tag, without its region."""
    return re.split("[-_]", tag.strip().lower())[0]
