"""The text of a book, whatever file it comes from: blocks, read as far as they are asked for."""

from __future__ import annotations

import hashlib
import re
from bisect import bisect_left, bisect_right
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, BinaryIO, NamedTuple
from weakref import finalize

from vbraille.errors import InputError
from vbraille.translate.blocks import Block, cut_marks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    Reader = Callable[["Source"], Iterator[Block]]

PIECE = 8_192  # characters of a block; a longer one comes in pieces
# The rest, or as many characters as may be, up to the end of a sentence in their second half, or of
# a word.
_PIECE = re.compile(
    rf"(?s).{{1,{PIECE}}}\Z|.{{{PIECE // 2},{PIECE}}}(?<=[.!?…] )"
    rf"|.{{1,{PIECE}}}(?<= )|.{{1,{PIECE}}}"
)


class Heading(NamedTuple):
    """A heading, or an entry of the book's own table of contents.

    Parameters
    ----------
    level
        Depth of its part, 1 for the largest parts.
    title
        Text of the heading.
    place
        Place where its part begins.
    page
        Number of the print page that it is on; empty if the book does not say.
    """

    level: int
    title: str
    place: int
    page: str


class Source:
    """A book as blocks of text, or of ready cells.

    A **place** is an index into `text`, where the blocks stand one after the other with a line
    feed between.

    Parameters
    ----------
    name
        Name of the book in messages.
    form
        Name of its format.
    stream
        Bytes of the book.
    reader
        Function that reads its blocks, and sets what else is known of it.

    Attributes
    ----------
    title, language : str
        Title, and tag of the language that most of it is in; empty if the book does not say.
    in_cells : bool
        Whether all blocks have ready cells, so that no table is needed.
    expected : int
        Number of characters that the book has by its size.
    complete : bool
        Whether all blocks have been read.

    Raises
    ------
    InputError
        If the book cannot be read, or has nothing in it.
    """

    def __init__(self, name: str, form: str, stream: BinaryIO, reader: Reader) -> None:
        self.name, self.form, self.stream = name, form, stream
        self.title = self.language = ""
        self.in_cells = self.complete = False
        self.expected = 0
        self.members: Callable[[str], bytes] | None = None  # files within the book
        self._blocks: list[Block] = []
        self._anchors: dict[str, int] = {}
        self._notes: list[str] = []
        self._given = 0  # notes
        finalize(self, stream.close)
        self._reading = (piece for block in reader(self) for piece in _pieces(block))
        self.gather(1)
        if not self._blocks:
            raise InputError(f"{name} has no text in it; give another file")

    def gather(self, blocks: int | None = None) -> bool:
        """Read some more blocks, or all; tell whether all are read."""
        before = len(self._blocks)
        for block in islice(self._reading, blocks):
            start = self.end + 1
            for name in block.anchors:
                self._anchors.setdefault(name, start)
            self._blocks.append(block.replace(number=len(self._blocks), start=start))
        self.complete |= blocks is None or len(self._blocks) - before < blocks
        return self.complete

    @property
    def end(self) -> int:
        """Place one past the last character that has been read."""
        return self._blocks[-1].end if self._blocks else -1

    @cached_property
    def text(self) -> str:
        """All of the text; what is not read yet is read now."""
        self.gather()
        return "\n".join(block.text for block in self._blocks)

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past either end."""
        self.gather(max(number + 1 - len(self._blocks), 0))
        return self._blocks[number] if 0 <= number < len(self._blocks) else None

    def blocks(self, number: int = 0, step: int = 1) -> Iterator[Block]:
        """Blocks from one of a number on, or back from it with a step of -1."""
        while (block := self.block(number)) is not None:
            yield block
            number += step

    def block_at(self, place: int) -> Block | None:
        """Block that holds a place; None past the end."""
        while place > self.end and not self.gather(100):
            pass
        at = bisect_right(self._blocks, place, key=lambda block: block.start) - 1
        return self._blocks[max(at, 0)] if place <= self.end else None

    def anchor(self, name: str) -> int | None:
        """Place of the block with an anchor; None if there is none."""
        while name not in self._anchors and not self.gather(100):
            pass
        return self._anchors.get(name)

    def progress(self, place: int) -> float:
        """Share of the book before a place, 0 to 1; about, as long as it is not all read."""
        whole = self.end if self.complete else max(self.expected, self.end)
        return min(place / max(whole, 1), 1.0)

    def headings(self) -> list[Heading]:
        """Headings, and entries of the table of contents where the text has none; reads all."""
        found, page = [], ""
        for block in self.blocks():
            page = block.page_number or page
            if block.heading is not None:
                found.append(Heading(*block.heading, block.start, page))
        return found

    def note(self, sentence: str) -> None:
        """Keep a sentence on what was read otherwise than the file says, for `notes`."""
        if sentence not in self._notes:
            self._notes.append(sentence)

    def notes(self) -> list[str]:
        """Sentences on what was read otherwise than the file says; each is given once."""
        given, self._given = self._given, len(self._notes)
        return self._notes[given:]

    def file(self, address: str) -> bytes:
        """Bytes of a file within the book, such as a figure.

        Raises
        ------
        InputError
            If there is none, or the book is no container of files.
        """
        if self.members is None:
            raise InputError(f"{self.name} has no files in it")
        return self.members(address)

    def sha256(self) -> str:
        """SHA-256 of the bytes of the book, in hexadecimal."""
        self.stream.seek(0)
        return hashlib.file_digest(self.stream, "sha256").hexdigest()  # type: ignore[arg-type]

    def close(self) -> None:
        """Let go of the file; blocks that were read stay."""
        self.stream.close()


def _pieces(block: Block) -> Iterator[Block]:
    """A block, or its pieces, each of which goes on where the one before broke off."""
    if len(block.text) <= PIECE:
        yield block
        return
    marks = block.marks
    for found in _PIECE.finditer(block.text):
        start, stop = found.span()
        known = bisect_left(marks, stop, key=lambda mark: mark.start)  # a book may have many
        begun, marks = marks[:known], marks[known:]
        marks = (*(mark for mark in begun if mark.end > stop), *marks)
        piece = block.replace(
            text=found[0],
            marks=cut_marks(begun, start, stop),
            cells=None if block.cells is None else block.cells[start:stop],
        )
        yield piece.replace(continues=True, anchors=(), entry=None) if start else piece
