"""Texts of many blocks as one, for another process to translate, and the cells that come back."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.translate.languages import table_note
from vbraille.translate.library import EndlessError, call, limit_s
from vbraille.translate.source import Block
from vbraille.translate.text import Text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.translate.source import Mark
    from vbraille.translate.switching import Translator


@dataclass(frozen=True, slots=True)
class Batch:
    """Texts for another process, joined, in which places are indices into each text.

    Parameters
    ----------
    codes : uint32[n]
        Code points of all texts.
    bounds
        Where each text ends.
    alphabets, which
        The alphabets that there are, and the index of each text's own.
    marked
        Language and marks of those texts that have any, by their indices.
    """

    codes: NDArray[np.uint32]
    bounds: list[int]
    alphabets: list[frozenset[int]]
    which: list[int]
    marked: dict[int, tuple[str, tuple[Mark, ...]]]

    @classmethod
    def of(cls, blocks: list[Block]) -> Batch:
        """Join the texts of blocks, of which there is one at least."""
        alphabets = {id(block.text.alphabet): block.text.alphabet for block in blocks}
        order = {key: n for n, key in enumerate(alphabets)}
        marked = {}
        for n, block in enumerate(blocks):
            if block.marks or block.language:
                index = block.text.index
                marks = (replace(m, start=index(m.start), end=index(m.end)) for m in block.marks)
                marked[n] = block.language, tuple(marks)
        return cls(
            np.concatenate([block.text.codes for block in blocks]),
            np.cumsum([len(block.text) for block in blocks]).tolist(),
            list(alphabets.values()),
            [order[id(block.text.alphabet)] for block in blocks],
            marked,
        )

    def blocks(self) -> Iterator[Block]:
        """Blocks as they are to be translated."""
        start = 0
        for n, (stop, which) in enumerate(zip(self.bounds, self.which, strict=True)):
            codes = self.codes[start:stop]
            text = Text(codes, np.arange(codes.size), codes.size, self.alphabets[which])
            language, marks = self.marked.get(n, ("", ()))
            yield Block(text, language=language, marks=marks)
            start = stop


@dataclass(frozen=True, slots=True)
class Translated:
    """Cells of a batch, and what its tables did not know.

    Parameters
    ----------
    masks : uint8[n]
        Cells of all texts.
    indices : uint16[n] or int32[n]
        Index of each cell's character in its text.
    bounds
        Where the cells of each text end.
    undefined
        Characters that the book's own table has been found not to know so far.
    notes
        Notes on the tables that became due.
    """

    masks: NDArray[np.uint8]
    indices: NDArray[np.integer]
    bounds: list[int]
    undefined: set[int]
    notes: list[str]

    def cells(self, blocks: list[Block]) -> Iterator[Cells]:
        """Cells of each of the blocks that were translated."""
        start = 0
        for block, stop in zip(blocks, self.bounds, strict=True):
            starts = block.text.places[self.indices[start:stop]]
            yield Cells(self.masks[start:stop], starts, block.text.end)
            start = stop


def translated(batch: Batch, translator: Translator) -> Translated:
    """Translate a batch."""
    blocks = list(batch.blocks())
    try:
        limit = sum(limit_s(len(block.text)) for block in blocks)
        cells = call(lambda: list(map(translator.translate, blocks)), limit)
    except EndlessError:
        cells = list(map(translator.translate, blocks))
    indices = np.concatenate([part.starts for part in cells])
    small = max(part.end for part in cells) <= 0x10000
    notes = [note for table in translator.tables if (note := table_note(table)) is not None]
    return Translated(
        np.concatenate([part.masks for part in cells]),
        indices.astype(np.uint16 if small else np.int32),
        np.cumsum([len(part) for part in cells]).tolist(),
        set(translator.table.undefined),
        notes,
    )
