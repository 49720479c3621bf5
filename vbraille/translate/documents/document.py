"""A file of plain text as blocks, each knowing its place in the file.

The file is read a chunk at a time and only as far as somebody asks; a block
already passed is found again by seeking, so that a book need not fit in memory.
"""

from __future__ import annotations

import hashlib
import io
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, BinaryIO

from vbraille.errors import InputError, VbrailleError
from vbraille.translate.documents.codepoints import Stretch, shorten_blanks
from vbraille.translate.documents.encodings import (
    CHUNK_BYTES,
    SAMPLE_BYTES,
    Encoding,
    TextDecoder,
    binary_kind,
    find_encoding,
    first_not_utf8,
    keep_stream,
    named_encoding,
    open_file,
)
from vbraille.translate.documents.paragraphs import split_paragraphs
from vbraille.translate.source import Index
from vbraille.translate.text import to_codes
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from vbraille.translate.documents.paragraphs import Split
    from vbraille.translate.source import Block

_SAMPLES, _SAMPLE_BYTES = 16, 1_024


@dataclass(frozen=True, slots=True)
class ChunkMark:
    """Place at which reading can go on, before a block's first character.

    Parameters
    ----------
    block
        Number of the next block, from 0.
    character
        Place of the block's first character in the document.
    offset, state
        A place in the file at or before that character, and the decoder's state there.
    skip
        Number of characters between that place and the block.
    continues
        Whether the block is a further piece of the block before.
    item
        Number of the list item that the block is a piece of; 0 for none.
    """

    block: int
    character: int
    offset: int
    state: tuple[bytes, int]
    skip: int
    continues: bool
    item: int = 0

    @property
    def bytes(self) -> int:
        """Estimated number of bytes before the place: a character takes at least one."""
        return self.offset + self.skip

    @property
    def row(self) -> tuple[int | str, ...]:
        """Values of the mark, as an index keeps them; bytes are in hexadecimal."""
        held, flag = self.state
        numbers = self.block, self.character, self.offset
        return (*numbers, held.hex(), flag, self.skip, int(self.continues), self.item)

    @classmethod
    def of_row(cls, row: Sequence[int | str]) -> ChunkMark:
        """Make the mark of an index's row."""
        block, character, offset, held, flag, skip, continues, item = row
        state = bytes.fromhex(str(held)), int(flag)
        block, character, offset, skip, item = map(int, (block, character, offset, skip, item))
        return cls(block, character, offset, state, skip, bool(continues), item)


def fingerprint(read: Callable[[int, int], bytes], size: int) -> str:
    """SHA-256 of samples from all of a file, in hexadecimal; a file of any size is done at once.

    Parameters
    ----------
    read
        Function that gives the bytes at an offset, and at most so many.
    size
        Number of bytes in the file.
    """
    digest = hashlib.sha256()
    last = max(size - _SAMPLE_BYTES, 0)
    for n in range(_SAMPLES):
        digest.update(read(n * last // (_SAMPLES - 1), _SAMPLE_BYTES))
    return digest.hexdigest()


_NEXT = 64  # blocks; what is no farther is likely to be in the next chunk


class Document:
    """A plain text as a `Source` of paragraphs, or of its lines.

    Parameters
    ----------
    stream
        Bytes of the file; the stream must be able to seek.
    name
        Name of the document in messages.
    encoding
        Encoding that overrides what the bytes say: its name.
    keep_lines
        Whether to keep the line breaks of the source (verse, code): each line is then a block
        with its blanks, and a run of empty lines is an empty block.

    Attributes
    ----------
    encoding : Encoding
        How the bytes are read.
    size : int
        Number of bytes in all.

    Raises
    ------
    InputError
        If the text is empty, binary, or of an unknown encoding.
    """

    def __init__(
        self,
        stream: BinaryIO,
        name: str = "text",
        encoding: str | Encoding | None = None,
        *,
        keep_lines: bool = False,
    ) -> None:
        self.name = name
        self.keep_lines = keep_lines
        self._stream = stream
        sample = self._read(0, SAMPLE_BYTES)
        self.size = self._end()
        if not sample:
            raise InputError(f"{name} is empty; give a text file")
        if isinstance(encoding, Encoding):
            self.encoding = encoding
        elif encoding is not None:
            self.encoding = _named_encoding(encoding, sample)
        else:
            kind = binary_kind(sample)
            if kind:
                raise InputError(
                    f"{name} is {kind}, not text; give a text file, or {setting('encoding')}"
                )
            self.encoding = find_encoding(sample)
            if len(sample) == self.encoding.skip:
                raise InputError(f"{name} is empty; give a text file")
        self._decoder = TextDecoder(self.encoding.name)
        self._found = encoding is None
        self._noted = self._grown = False
        start = ChunkMark(0, 0, self.encoding.skip, self._decoder.state(), 0, continues=False)
        self._marks: list[ChunkMark] = [start]  # of each chunk, and of the next to read
        self._complete = False
        self._recent: dict[int, list[Block]] = {}
        self.title = self.language = ""
        self.in_cells = False

    @property
    def complete(self) -> bool:
        """Tell whether all blocks are known, so that the end of the text is."""
        return self._complete

    @property
    def end(self) -> int:
        """One past the last character of the chunks that are known."""
        return self._marks[-1].character

    def anchor(self, name: str) -> int | None:  # noqa: ARG002
        """Tell that plain text has no anchors."""
        return None

    def index(self) -> Index:
        """Tell where the chunks that were read begin."""
        return Index(*self._fits(), tuple(mark.row for mark in self._marks), self._complete)

    def adopt(self, index: Index) -> None:
        """Take over where chunks begin, if the index is of this file and knows more."""
        if len(index.rows) > len(self._marks) and (index.form, index.fits) == self._fits():
            self._marks = [ChunkMark.of_row(row) for row in index.rows]
            self._complete = index.complete

    def _fits(self) -> tuple[str, tuple[str | int, ...]]:
        how = self.encoding.name, self.encoding.skip, int(self.keep_lines)
        return "Document 2", (fingerprint(self._read, self.size), self.size, *how)

    @classmethod
    def open(
        cls, path: Path | str, encoding: str | None = None, *, keep_lines: bool = False
    ) -> Document:
        """Open a text file.

        Raises
        ------
        InputError
            If it is missing, unreadable, a directory, empty, binary, or of an unknown encoding.
        """
        stream = open_file(path)
        try:
            return cls(stream, str(path), encoding, keep_lines=keep_lines)
        except InputError:
            stream.close()
            raise

    @classmethod
    def take(
        cls,
        stream: BinaryIO,
        name: str,
        encoding: str | None = None,
        *,
        keep_lines: bool = False,
    ) -> Document:
        """Read all that a stream gives, such as standard input, which may be longer than memory.

        Raises
        ------
        InputError
            If the stream cannot be read or kept, or is empty, binary, or of an unknown encoding.
        """
        kept = keep_stream(stream, name)
        try:
            return cls(kept, name, encoding, keep_lines=keep_lines)
        except InputError:
            kept.close()
            raise

    @classmethod
    def from_text(cls, text: str, *, keep_lines: bool = False) -> Document:
        """Document of a string."""
        stream = io.BytesIO(text.encode("utf-32-le", "surrogatepass"))
        return cls(stream, "text", Encoding("utf-32-le"), keep_lines=keep_lines)

    def note(self) -> str | None:
        """Note on the file, given once after its cause is found; None if there is none.

        Notes say that the text is not UTF-8, and where, or that the file has grown since it was
        opened.
        """
        if self._grown:
            self._grown = False
            return (
                f"{self.name} has grown since it was opened; open it again to read what was added"
            )
        if self._noted:
            return None
        if self._found and self.encoding.name != "utf-8" and not self.encoding.skip:
            self._noted = True
            bad = first_not_utf8(self._read(0, SAMPLE_BYTES))
            return (
                f"{self.name} is not UTF-8 (byte {bad}); it is read as {self.encoding.name}, "
                f"{setting('encoding')} NAME says otherwise"
            )
        if self._decoder.first_bad is not None:
            self._noted = True
            return (
                f"{self.name} is not {self.encoding.name} at byte {self._decoder.first_bad}; such "
                f"bytes are read as windows-1252, {setting('encoding')} NAME says otherwise"
            )
        return None

    def block(self, number: int) -> Block | None:
        """Block of a number, from 0; None past the end.

        Raises
        ------
        InputError
            If the file cannot be read any more.
        VbrailleError
            If the file has changed since it was opened.
        """
        while number >= self._marks[-1].block and not self._complete:
            if number - self._marks[-1].block < _NEXT:
                self._read_chunk(len(self._marks) - 1)
            else:
                self._pass_chunk()
        if number >= self._marks[-1].block or number < 0:
            return None
        chunk = bisect_right(self._marks, number, key=lambda mark: mark.block) - 1
        blocks = self._recent.get(chunk)
        if blocks is None:
            blocks = self._read_chunk(chunk)
        index = number - self._marks[chunk].block
        if index >= len(blocks):
            raise VbrailleError(f"{self.name} has changed since it was opened; open it again")
        return blocks[index]

    def block_at(self, character: int) -> int | None:
        """Number of the block that holds a character, or of the next block; None past the end."""
        while character >= self._marks[-1].character and not self._complete:
            self._pass_chunk()
        chunk = bisect_right(self._marks, character, key=lambda mark: mark.character) - 1
        chunk = min(max(chunk, 0), len(self._marks) - 2)
        number = self._marks[chunk].block
        while (block := self.block(number)) is not None:
            if character < block.text.end:
                return number
            number += 1
        return None

    def extend(self) -> bool:
        """Find where the next chunk ends, without making its blocks; False if all are known."""
        if not self._complete:
            self._pass_chunk()
            return True
        return False

    def progress(self, number: int) -> float:
        """About how much of the file stands before a block that was read, 0 to 1."""
        chunk = bisect_right(self._marks, number, key=lambda mark: mark.block) - 1
        here, after = self._marks[chunk], self._marks[min(chunk + 1, len(self._marks) - 1)]
        share = (number - here.block) / max(after.block - here.block, 1)
        return min(1.0, (here.bytes + share * (after.bytes - here.bytes)) / self.size)

    def sha256(self) -> str:
        """SHA-256 of the bytes, in hexadecimal."""
        digest = hashlib.sha256()
        self._stream.seek(0)
        while chunk := self._stream.read(CHUNK_BYTES):
            digest.update(chunk)
        return digest.hexdigest()

    @property
    def descriptor(self) -> int | None:
        """Number of the open file, for another process; None if the text is in memory."""
        try:
            return self._stream.fileno()
        except OSError:
            return None

    def read(self, offset: int, size: int) -> bytes:
        """Bytes of the file from an offset on, as they are; fewer at its end.

        Raises
        ------
        InputError
            If the file cannot be read any more.
        """
        return self._read(offset, size)

    def close(self) -> None:
        """Close the file; it is closed in any case when the document is forgotten."""
        self._stream.close()

    def __del__(self) -> None:
        self.close()

    def _read(self, offset: int, size: int) -> bytes:
        try:
            self._stream.seek(offset)
            return self._stream.read(size)
        except OSError as error:
            raise InputError(f"{self.name} cannot be read: {error.strerror or error}") from None

    def _end(self) -> int:
        """Number of bytes that the file has now."""
        try:
            return self._stream.seek(0, io.SEEK_END)
        except OSError as error:
            raise InputError(f"{self.name} cannot be read: {error.strerror or error}") from None

    def _read_chunk(self, chunk: int) -> list[Block]:
        """Read the blocks of a chunk, and mark where the next begins if that is not known yet."""
        split, after = self._parse(self._marks[chunk])
        if chunk == len(self._marks) - 1:
            self._take_mark(split, after)
        blocks = split.blocks
        if len(self._recent) >= 3:
            self._recent.pop(next(iter(self._recent)))
        self._recent[chunk] = blocks
        return blocks

    def _pass_chunk(self) -> None:
        """Mark where the chunk after the last one that is known begins."""
        self._take_mark(*self._parse(self._marks[-1], count=True))

    def _take_mark(self, split: Split, after: ChunkMark | None) -> None:
        """Mark where the next chunk begins, given what the last one was split into."""
        mark = self._marks[-1]
        if after is None:
            self._complete = True
            self._grown = self._end() > self.size
            after = ChunkMark(
                mark.block + split.count,
                split.end or mark.character,
                self.size,
                (b"", 0),
                0,
                continues=False,
            )
        self._marks.append(after)

    def _parse(self, mark: ChunkMark, *, count: bool = False) -> tuple[Split, ChunkMark | None]:
        """Blocks from a mark on, none only if a stretch is blank; and the mark after them.

        Parameters
        ----------
        count
            Whether blocks are only to be counted.
        """
        self._decoder.restore(mark.state)
        parts: list[Stretch] = []
        pieces: list[tuple[int, int, tuple[bytes, int]]] = []  # characters before, offset, state
        offset, place = mark.offset, mark.character - mark.skip
        kept = wanted = blanks = 0
        final = False
        while True:
            while not final and (kept < wanted or not parts):
                pieces.append((place, offset, self._decoder.state()))
                read = self._read(offset, min(CHUNK_BYTES, self.size - offset))
                if not read and offset < self.size:
                    raise VbrailleError(
                        f"{self.name} has become shorter since it was opened; open it again"
                    )
                final = offset + len(read) >= self.size
                codes = to_codes(self._decoder.decode(read, offset, final=final))
                offset += len(read)
                skipped = min(max(0, mark.character - place), codes.size)
                part, blanks = shorten_blanks(codes[skipped:], place + skipped, blanks)
                place += codes.size
                parts.append(part)
                kept += len(part)
            parts = [Stretch.joined(parts)]
            split = split_paragraphs(
                parts[0],
                continues=mark.continues,
                item=mark.item,
                final=final,
                keep_lines=self.keep_lines,
                count=count,
            )
            if final:
                return split, None
            if split.count or split.used:
                break
            # Each time twice as much is read, since an unfinished block is parsed again.
            wanted = 2 * kept + 1
        used = int(parts[0].place(split.used)) if split.used < kept else place
        before, offset, state = pieces[bisect_right(pieces, used, key=lambda piece: piece[0]) - 1]
        after = ChunkMark(
            mark.block + split.count,
            used,
            offset,
            state,
            used - before,
            split.continues,
            split.item,
        )
        return split, after


def _named_encoding(name: str, sample: bytes) -> Encoding:
    encoding = named_encoding(name, sample)
    if encoding is None:
        raise InputError(f"there is no text encoding {name!r}; try windows-1252, latin-1 or utf-16")
    return encoding
