"""A file of plain text as blocks, each knowing its place in the file.

The file is read a chunk at a time and only as far as a caller asks; a block
already passed is found again by seeking, so that a book need not fit in memory.
"""

from __future__ import annotations

import hashlib
import io
import re
import unicodedata
from bisect import bisect_right
from dataclasses import dataclass
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from vbraille.errors import InputError, VbrailleError
from vbraille.translate.documents.encodings import (
    BLANK,
    BREAK,
    CHUNK_BYTES,
    DROPPED,
    NEWLINE,
    SAMPLE_BYTES,
    TEXT,
    Encoding,
    Stretch,
    TextDecoder,
    Words,
    binary_kind,
    find_encoding,
    first_not_utf8,
    keep_stream,
    kinds_of,
    named_encoding,
    open_file,
    shorten_blanks,
)
from vbraille.translate.source import (
    NO_BREAK_SPACE,
    SPACE,
    Block,
    BlockKind,
    Index,
    Text,
    to_codes,
    to_text,
)
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from numpy.typing import NDArray


# What a line of a list begins with: a bullet, a dash, a number or a letter, and then a blank.
_MARKER = re.compile(
    r"(?:(?P<bullet>[•‣◦⁃●○■▪*-])|(?P<dash>[–—+])|\(?(?P<number>\d{1,3})[.)]|\(?(?P<letter>[a-z])\))"
    r"[ \t\u00a0\u2000-\u200a\u3000]"
)
LONGEST_MARKER = 6
_LEADS = np.zeros(0x2600, np.bool_)  # the last entry stands for all code points above
_LEADS[[ord(lead) for lead in "•‣◦⁃●○■▪*-–—+(0123456789"]] = True
BULLET, DASH = -1, -2


def end_before_items(
    ends: NDArray[np.bool_],
    codes: NDArray[np.uint32],
    words: Words,
    newlines: NDArray[np.intp],
    item: int | None,
) -> int:
    """Mark that paragraphs end where the next line begins an item of a list.

    A bullet always begins an item. A dash does so in a list of dashes, and a number if it is the
    next of its list. The first dash or number of a list stands at a paragraph's start or after a
    colon; a number 1 may stand anywhere. Otherwise a line of prose can begin with a dash, or with
    a number that ends a sentence.

    Parameters
    ----------
    ends : bool[n]
        Whether a paragraph ends in each gap between words; changed here.
    codes
        Code points.
    words
        Where the words among them are.
    newlines : intp[n]
        Number of line ends in each gap.
    item
        Number of the list item that the first paragraph is in; None if it begins here.

    Returns
    -------
    int
        Number of the list item that the last paragraph is, -2 in a list of dashes, otherwise 0.
    """
    starts = np.concatenate(([-1], np.flatnonzero((newlines > 0) | ends)))
    at = np.concatenate(([words.first], words.begins))[starts + 1]
    following = codes[np.minimum(at + 1, codes.size - 1)]
    leads = np.take(_LEADS, codes[at], mode="clip") | (following == ord(")"))
    blank_lines = np.flatnonzero(ends)
    starts, at = starts[leads], at[leads]
    blank_before = np.searchsorted(blank_lines, starts, "right")
    text = to_text(codes) if at.size else ""
    passed, item_now = 0, item or 0
    for start, first, here in zip(starts.tolist(), at.tolist(), blank_before.tolist(), strict=True):
        begins = bool(ends[start]) if start >= 0 else item is None
        if here != passed:
            passed, item_now = here, 0
        found = _MARKER.match(text, first, first + LONGEST_MARKER)
        if found is None or (start < 0 and item is not None):
            continue
        if found["number"]:
            number = int(found["number"])
        elif found["letter"]:
            number = ord(found["letter"]) - ord("a") + 1
        else:
            number = BULLET if found["bullet"] else DASH
        expected = number in (BULLET, 1, item_now + 1 if item_now >= 0 else item_now)
        if begins or expected or codes[words.stops[start]] == ord(":"):
            item_now = number
            if start >= 0:
                ends[start] = True
    return item_now if passed == blank_lines.size else 0


# A longer paragraph is passed on in pieces: no text may grow with the file.
PIECE_CHARACTERS = 8_192

_NO_BREAK_SPACES = (0x2007, 0x202F)
_BYTE_ORDER_MARK = 0xFEFF
_BACKSPACE, _UNDERLINE = 0x08, 0x5F
# Accents for which Unicode has whole letters: Latin, Greek, Cyrillic, Arabic and kana accents.
_COMBINING = frozenset((*range(0x300, 0x370), *range(0x653, 0x656), 0x3099, 0x309A))
# Words before which a hyphen stands for the rest of the word before the hyphen.
_SUSPENDED = {"and", "or", "to", "und", "oder", "bis", "et", "ou"}
# Number of characters after a line break that decide on a space: such a word and one more.
_WORD = 5
# Number of characters that must follow a place before it is known what belongs there.
_LOOK_AHEAD = max(_WORD, LONGEST_MARKER) + 1


@dataclass(frozen=True, slots=True)
class Split:
    """Blocks that `split_paragraphs` made of a stretch of characters.

    Parameters
    ----------
    blocks
        Paragraphs that are complete; none if they were only to be counted.
    used
        Number of characters up to the first that belongs to none of these, or may begin another.
    continues
        Whether that character continues the last paragraph.
    item
        Number of the list item that it is part of in that case; 0 for none.
    count
        Number of paragraphs that are complete.
    end
        Place after the last of them, in the document; 0 if there is none.
    """

    blocks: list[Block]
    used: int
    continues: bool
    item: int = 0
    count: int = 0
    end: int = 0


def split_paragraphs(
    stretch: Stretch,
    *,
    continues: bool = False,
    item: int = 0,
    final: bool = True,
    keep_lines: bool = False,
    count: bool = False,
) -> Split:
    """Cut a stretch of characters into paragraphs.

    Parameters
    ----------
    stretch
        Characters that are cut.
    continues
        Whether the stretch continues an earlier piece of a paragraph.
    item
        Number of the list item that this paragraph is; 0 for none.
    final
        Whether the text ends here; otherwise the last paragraph is left for later.
    keep_lines
        Whether every line is a paragraph.
    count
        Whether paragraphs are only to be counted, which is several times as fast.
    """
    codes = stretch.codes
    kinds = kinds_of(codes)
    kinds[codes == _BYTE_ORDER_MARK] = DROPPED
    kinds[_overstruck(codes, kinds)] = DROPPED
    words = Words(codes, kinds)
    if words.first < 0:
        used = int((words.newlines[-1:] + 1).sum()) if keep_lines else codes.size
        return Split([], used, continues, item)
    codes = codes.copy()
    for space in _NO_BREAK_SPACES:
        codes[codes == space] = NO_BREAK_SPACE
    newlines = words.counted(words.newlines)
    ended = final
    if keep_lines:
        ends, empty = newlines > 0, newlines > 1
    else:
        breaks = words.places(BREAK)
        ends = (newlines > 1) | (words.counted(breaks) > 0)
        item = end_before_items(ends, codes, words, newlines, None if not continues else item)
        ended = final or (words.newlines > words.last).sum() > 1 or (breaks > words.last).any()
        empty = np.zeros(ends.size, bool)
    last = np.flatnonzero(ends)
    begin = np.concatenate(([words.first], words.begins[last]))
    stop = np.concatenate((words.stops[last] + 1, [words.last + 1]))
    if keep_lines:
        begin = words.line_starts(begin)
    is_empty = [*empty[last].tolist(), False]
    if count and int((stop - begin).max()) <= PIECE_CHARACTERS:  # none is cut
        complete = begin.size if ended else begin.size - 1
        continues = continues and not complete and not ended
        used = codes.size if ended else int(begin[-1])
        end = int(stretch.place(int(stop[complete - 1]) - 1)) + 1 if complete else 0
        more = sum(is_empty[:complete])
        return Split([], used, continues, item if continues else 0, complete + more, end)
    codes, keep = _blanks_folded(codes, kinds, words, newlines, ends, keep_lines=keep_lines)
    kept = np.flatnonzero(keep)
    own, places = codes[kept], stretch.place(kept)
    seen = np.zeros(int(own.max()) + 1, np.bool_)
    seen[own] = True
    alphabet = frozenset(np.flatnonzero(seen).tolist())
    accents = not alphabet.isdisjoint(_COMBINING)
    kind = BlockKind.LINE if keep_lines else BlockKind.PARAGRAPH

    def block(start: int, end: int, continues: bool) -> Block:
        part = slice(start, end)
        text = Text(own[part], places[part], int(places[end - 1]) + 1, alphabet)
        return Block(_compose(text) if accents else text, kind, continues=continues)

    bounds = np.searchsorted(kept, [begin, stop]).T.tolist()
    blocks: list[Block] = []
    for n, (start, end) in enumerate(bounds):
        complete = ended or n < len(bounds) - 1
        rest = start
        for cut in _cuts(codes, kept, start, end if complete else end - _LOOK_AHEAD):
            blocks.append(block(rest, cut, continues))
            rest, continues = cut, True
        if not complete:
            used = int(begin[-1]) if rest == start else int(kept[rest])
            return _split(blocks, used, continues=continues, item=item if continues else 0)
        blocks.append(block(rest, end, continues))
        continues = False
        if is_empty[n]:
            blocks.append(Block(Text.empty(int(stretch.place(stop[n] - 1)) + 1), kind))
    return _split(blocks, codes.size, continues=False)


def _split(blocks: list[Block], used: int, *, continues: bool, item: int = 0) -> Split:
    end = blocks[-1].text.end if blocks else 0
    return Split(blocks, used, continues, item, len(blocks), end)


def _blanks_folded(
    codes: NDArray[np.uint32],
    kinds: NDArray[np.uint8],
    words: Words,
    newlines: NDArray[np.intp],
    ends: NDArray[np.bool_],
    *,
    keep_lines: bool,
) -> tuple[NDArray[np.uint32], NDArray[np.bool_]]:
    """Code points with one kind of blank, and whether each belongs to a paragraph.

    Parameters
    ----------
    newlines, ends
        Number of line ends in each gap, and whether a paragraph ends there.
    """
    codes = codes.copy()
    if keep_lines:
        keep = _keep_blanks(kinds)
        codes[keep & (kinds == BLANK)] = SPACE
        return codes, keep
    blank = ~ends
    dropped = words.places(DROPPED)
    if dropped.size:
        blank &= words.begins - words.stops - 1 > words.counted(dropped)
    gaps = np.flatnonzero(blank)
    spaces = words.stops[gaps] + 1
    spaces = spaces[~_joins_words(codes, words, gaps, newlines)]
    codes[spaces] = SPACE
    keep = kinds == TEXT
    keep[spaces] = True
    return codes, keep


def _overstruck(codes: NDArray[np.uint32], kinds: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Indices of what told old printers to underline or to strike twice, which is no text.

    An underline stands before or after a backspace and a character; a character that is struck
    twice stands on both sides of the backspace.
    """
    backspaces = np.flatnonzero(codes[1:-1] == _BACKSPACE) + 1
    if not backspaces.size:
        return backspaces
    struck = (kinds[backspaces - 1] == TEXT) & (kinds[backspaces + 1] == TEXT)
    backspaces = backspaces[struck & (codes[backspaces - 1] != _BACKSPACE)]
    before, after = codes[backspaces - 1], codes[backspaces + 1]
    first = (before == _UNDERLINE) | (before == after)
    second = ~first & (after == _UNDERLINE)
    return np.concatenate(
        (backspaces[first | second], backspaces[first] - 1, backspaces[second] + 1)
    )


def _keep_blanks(kinds: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Tell whether each character is text, or a blank that has text after it on its line."""
    places = np.arange(kinds.size)
    text = np.where(kinds == TEXT, places, kinds.size)
    newline = np.where((kinds == NEWLINE) | (kinds == BREAK), places, kinds.size)
    next_text = np.minimum.accumulate(text[::-1])[::-1]
    next_newline = np.minimum.accumulate(newline[::-1])[::-1]
    return (kinds == TEXT) | ((kinds == BLANK) & (next_text < next_newline))


def _joins_words(
    codes: NDArray[np.uint32],
    words: Words,
    gaps: NDArray[np.intp],
    newlines: NDArray[np.intp],
) -> NDArray[np.bool_]:
    """Tell whether a line break stands within a word, after a hyphen: no space belongs there.

    This holds after every soft hyphen. It holds after a hyphen between letters, unless the
    hyphen stands for the rest of a word ("pre- and post-war").
    """
    joins = (codes[words.stops[gaps] + 1] == 0xAD) & (newlines[gaps] == 1)
    hyphens = np.isin(codes[words.stops[gaps]], (0x2D, 0x2010)) & (newlines[gaps] == 1)
    for n in np.flatnonzero(hyphens):
        at, after = words.stops[gaps[n]], words.begins[gaps[n]]
        word = to_text(codes[after : after + _WORD])
        within = at > 0 and chr(codes[at - 1]).isalnum() and word[0].isalnum()
        joins[n] |= within and word.split(maxsplit=1)[0] not in _SUSPENDED
    return joins


def _cuts(codes: NDArray[np.uint32], kept: NDArray[np.intp], start: int, end: int) -> Iterator[int]:
    """Places to cut a paragraph that is too long: after a sentence, else a space, else anywhere."""
    while end - start > PIECE_CHARACTERS:
        window = to_text(codes[kept[start : start + PIECE_CHARACTERS + 1]])
        sentence = max(window.rfind(mark) for mark in (". ", "! ", "? ", "\u2026 "))
        if sentence > PIECE_CHARACTERS // 2:
            start += sentence + 2
        elif (space := window.rfind(" ")) > 0:
            start += space + 1
        else:
            length = PIECE_CHARACTERS
            while length > PIECE_CHARACTERS // 2 and unicodedata.combining(window[length]):
                length -= 1  # an accent stays with its letter
            start += length
        if start >= end:
            return
        yield start


def _compose(text: Text) -> Text:
    """Compose letters and combining accents to one character where Unicode has one.

    Many tables know é and not e followed by U+0301.
    """
    if _COMBINING.isdisjoint(text.codes.tolist()):
        return text
    composed: list[str] = []
    places: list[int] = []
    for character, place in zip(str(text), text.places.tolist(), strict=True):
        together = ""
        if composed and ord(character) in _COMBINING:
            together = unicodedata.normalize("NFC", composed[-1] + character)
        if len(together) == 1:
            composed[-1] = together
        else:
            composed.append(character)
            places.append(place)
    codes = to_codes("".join(composed))
    return Text(codes, np.array(places, np.int64), text.end, frozenset(codes.tolist()))


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
