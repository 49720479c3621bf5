"""Files of braille in lines: BRF in any dialect, and Unicode braille patterns.

A part of the file is read by itself, wherever it begins, so that a book need not fit in memory.
"""

from __future__ import annotations

import hashlib
import io
import re
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.errors import InputError, VbrailleError
from vbraille.translate.documents.chapters import LONGEST_BLOCK, ChapterSource, Passage
from vbraille.translate.documents.encodings import binary_kind, find_encoding, named_encoding
from vbraille.translate.source import SPACE, Block, BlockKind, Text
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

UNKNOWN = -1
_TAB, _NO_BREAK_SPACE = 0x09, 0xA0
# What ends a line or a page; it has a mask so that it is never taken for a wrong character.
_ENDS = (0x0A, 0x0C, 0x0D)
_LOW = range(0x20, 0x60)
_HIGH = range(0x60, 0x7F)  # written for 0x40 to 0x5E by many programs


def north_american() -> NDArray[np.int16]:
    """Mask of each byte in North American ASCII braille, int16[256]; -1 for no braille."""
    masks = np.full(256, UNKNOWN, np.int16)
    masks[_LOW.start : _LOW.stop] = Cells.from_brf("".join(map(chr, _LOW))).masks
    masks[_HIGH.start : _HIGH.stop] = masks[0x40:0x5F]
    return _with_blanks(masks)


def by_display_table(table: str) -> NDArray[np.int16]:
    """Mask of each byte as a display table of liblouis has it, int16[256]; -1 for no braille.

    Bytes are Latin-1. A letter stands for the cell of its small letter, or of its capital where
    the table knows no small one, and never for dots 7 and 8, which tell the two apart; a to z are
    the same in all dialects, and some tables leave them out. What the table does not know of the
    bytes 0x60 to 0x7E is written for 0x40 to 0x5E, and the reverse.

    Raises
    ------
    InputError
        If there is no such table.
    """
    # liblouis and all its tables are read only where a dialect is asked for.
    from vbraille.translate.liblouis import display_dots

    printed = [chr(code) for code in (*range(0x20, 0x7F), *range(0xA1, 0x100))]
    known = dict(zip(printed, display_dots(table, "".join(printed)), strict=True))
    masks = np.full(256, UNKNOWN, np.int16)
    for character in printed:
        code = ord(character)
        folded = chr(code ^ 0x20) if 0x40 <= code < 0x7F else ""
        small = character.lower() if len(character.lower()) == 1 else character
        dots = known.get(small) or known[character] or known.get(folded, 0)
        if 0x40 <= code < 0x7F:
            dots &= 0x3F
        if character.isascii() and character.isalpha() and not dots:
            dots = int(Cells.from_brf(character).masks[0])
        if dots:
            masks[code] = dots
    masks[0x20] = 0
    return _with_blanks(masks)


def _with_blanks(masks: NDArray[np.int16]) -> NDArray[np.int16]:
    masks[[_TAB, *_ENDS]] = 0
    return masks


def unicode_masks(codes: NDArray[np.uint32]) -> NDArray[np.int16]:
    """Masks of code points, int16[n]: braille patterns, ASCII braille, blanks; -1 for no braille.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    """
    ascii_masks = north_american()
    ascii_masks[_NO_BREAK_SPACE] = 0
    masks = ascii_masks[np.minimum(codes, 0xFF)]
    masks[codes > 0xFF] = UNKNOWN
    pattern = (codes >= 0x2800) & (codes < 0x2900)
    masks[pattern] = codes[pattern] - 0x2800
    return masks


PART_BYTES = 65_536
_LINE_FEED, _FORM_FEED, _RETURN = 0x0A, 0x0C, 0x0D
_END_OF_FILE = b"\x1a"  # what programs of DOS put after a text
_END = re.compile(rb"\r\n|[\n\r\f]")
_LINE_END = re.compile(rb"\r\n|[\n\r]")
_WIDE_MARKS = (b"\xff\xfe", b"\xfe\xff")  # UTF-16, and UTF-32 with its low byte first
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_PATTERN_BYTES = re.compile(rb"\xe2[\xa0-\xa3][\x80-\xbf]")  # U+2800 to U+28FF in UTF-8


def open_brf(
    stream: BinaryIO, name: str, *, brf_table: str | None = None, encoding: str | None = None
) -> BrailleLines:
    """Open a file of ASCII braille (BRF); Unicode braille patterns in it are read, too.

    Parameters
    ----------
    stream
        Bytes of the file; the stream must be able to seek, and is closed with the source.
    name
        Name of the file in messages.
    brf_table
        Display table of liblouis that has the file's dialect, such as ``de-eurobrl6.dis``;
        None for North American ASCII braille.
    encoding
        Text encoding of a file whose braille is in Unicode; None to find out how it is.

    Raises
    ------
    InputError
        If the file is empty, no text, or cannot be read, or there is no such table.
    """
    if encoding is not None:
        return open_unicode_braille(stream, name, encoding)
    sample = _read(stream, name, 0, PART_BYTES)
    _check_text(sample, name)
    if brf_table is None and (_PATTERN_BYTES.search(sample) or sample.startswith(_WIDE_MARKS)):
        return open_unicode_braille(stream, name)
    masks = north_american() if brf_table is None else by_display_table(brf_table)
    return BrailleLines(stream, name, masks, dialect=brf_table or "")


def open_unicode_braille(stream: BinaryIO, name: str, encoding: str | None = None) -> BrailleLines:
    """Open a text file of Unicode braille patterns; ASCII braille among them is read, too.

    Parameters
    ----------
    stream
        Bytes of the file; the stream must be able to seek, and is closed with the source.
    name
        Name of the file in messages.
    encoding
        Text encoding that overrides what the bytes say; UTF-8 if they say nothing.

    Raises
    ------
    InputError
        If the file is empty, no text of the encoding, or cannot be read.
    """
    sample = _read(stream, name, 0, PART_BYTES)
    if encoding is None:
        _check_text(sample, name)
        wide = sample.startswith(_WIDE_MARKS) or sample[:4] == b"\0\0\xfe\xff"
        found = find_encoding(sample) if wide else None
    else:
        found = named_encoding(encoding, sample)
        if found is None:
            raise InputError(f"there is no text encoding {encoding!r}; try utf-8 or utf-16")
    if not sample:
        raise InputError(f"{name} is empty; give a file of braille")
    if found is None or found.name in ("utf-8", "ascii"):
        return BrailleLines(stream, name, None)
    try:
        text = _read(stream, name, found.skip, -1).decode(found.name)
    except UnicodeDecodeError as error:
        raise InputError(
            f"{name} is not {found.name} at byte {found.skip + error.start}; give its text "
            f"encoding with {setting('encoding')}"
        ) from None
    stream.close()
    return BrailleLines(io.BytesIO(text.encode()), name, None)


class BrailleLines(ChapterSource):
    """A file of braille as a source of its lines and pages, none of them ever translated.

    Each character is the source of one cell. A line is a block, and an empty one is, too. The
    first line of a page follows a block of the kind PAGE, which has no text but is counted, if the
    file has form feeds. Blanks at the end of a line are left out, and a tab is one blank.

    Parameters
    ----------
    stream
        Bytes of the file, ASCII or UTF-8; the stream must be able to seek.
    name
        Name of the file in messages.
    masks : int16[256] or None
        Dot mask of each byte, -1 for one that is no braille; None for a file in UTF-8.
    dialect
        Name of what the masks come from, which tells one reading of a file from another.
    """

    def __init__(
        self,
        stream: BinaryIO,
        name: str,
        masks: NDArray[np.int16] | None,
        *,
        dialect: str = "",
    ) -> None:
        self._stream = stream
        self._masks = masks
        sample = _read(stream, name, 0, PART_BYTES)
        self._first = len(_BYTE_ORDER_MARK) if sample.startswith(_BYTE_ORDER_MARK) else 0
        self._paged = b"\f" in sample
        size = self._size = _end(stream, name)
        if size and _read(stream, name, size - 1, 1) == _END_OF_FILE:
            size -= 1
        self._after = size  # one past the last byte that is read
        self._cuts: dict[int, int] = {}
        sizes = [min(PART_BYTES, size - start) for start in range(self._first, size, PART_BYTES)]
        self._form = ("utf-8" if masks is None else dialect or "brf", self._size)
        super().__init__(name, sizes, "", in_cells=True)

    def passages(self, chapter: int) -> Iterable[Passage]:
        """Give no passages: the blocks are made at once."""
        raise NotImplementedError

    def anchor(self, name: str) -> int | None:  # noqa: ARG002
        """Tell that such files have no anchors."""
        return None

    def sha256(self) -> str:
        """SHA-256 of the bytes, in hexadecimal."""
        digest = hashlib.sha256()
        start = 0
        while chunk := _read(self._stream, self.name, start, PART_BYTES):
            digest.update(chunk)
            start += len(chunk)
        return digest.hexdigest()

    def close(self) -> None:
        """Close the file; it is closed in any case when the source is forgotten."""
        self._stream.close()

    def __del__(self) -> None:
        self._stream.close()

    def _fits(self) -> tuple[str, tuple[str | int, ...]]:
        return f"{type(self).__name__} 2", self._form

    def piece(
        self,
        chapter: int,
        passage: int,  # noqa: ARG002
        character: int,
        groups: int,
    ) -> tuple[list[Block], None]:
        """Make the blocks of a chapter, which is a part of the file."""
        start, stop = self._cut(chapter), self._cut(chapter + 1)
        read = _read(self._stream, self.name, start, stop - start)
        if len(read) < stop - start:
            raise VbrailleError(
                f"{self.name} has become shorter since it was opened; open it again"
            )
        codes, masks = self._decode(read, start)
        begins = start == self._first or self._ends_before(start)
        blocks = [_page(character, 1)] if chapter == 0 and self._paged else []
        page = max(groups, 1)  # what stands before the first form feed is a page, too
        blocks += self._blocks(
            codes, masks, character, page, continues=not begins, final=stop == self._after
        )
        return blocks, None

    def _decode(self, read: bytes, start: int) -> tuple[NDArray[np.uint32], NDArray[np.uint8]]:
        """Code points and masks of bytes that stand at a place of the file."""
        if self._masks is not None:
            codes = np.frombuffer(read, np.uint8).astype(np.uint32)
            masks = self._masks[codes]
            widths = None
        else:
            try:
                text = read.decode()
            except UnicodeDecodeError as error:
                raise self._wrong(
                    start + error.start, f"byte 0x{read[error.start]:02X}", "is no UTF-8"
                ) from None
            codes = np.frombuffer(text.encode("utf-32-le"), np.uint32).copy()
            masks = unicode_masks(codes)
            widths = text
        wrong = np.flatnonzero(masks == UNKNOWN)
        if wrong.size:
            at = int(wrong[0])
            if widths is not None:
                what = repr(widths[at])
                at = len(widths[:at].encode())
                raise self._wrong(
                    start + at, what, "is neither ASCII braille nor a Unicode braille pattern"
                )
            raise self._wrong(start + at, f"byte 0x{read[at]:02X}", "is no ASCII braille")
        codes[codes == _TAB] = SPACE
        return codes, masks.astype(np.uint8)

    def _wrong(self, offset: int, what: str, wrong: str) -> InputError:
        """Make the error of a byte that is no braille."""
        before = _read(self._stream, self.name, 0, offset)
        line = 1 + len(_LINE_END.findall(before.replace(b"\f", b"\n")))
        return InputError(
            f"{self.name} is not all braille: {what} {wrong} (line {line}, byte {offset + 1} of "
            f"the file); give a file of braille, or its dialect with "
            f"{setting('dialect')} if it has another"
        )

    def _blocks(
        self,
        codes: NDArray[np.uint32],
        masks: NDArray[np.uint8],
        character: int,
        page: int,
        *,
        continues: bool,
        final: bool,
    ) -> list[Block]:
        places = np.arange(character, character + codes.size)
        # One past the last cell with dots before each place; 0 if there is none.
        raised = np.maximum.accumulate(np.where(masks, np.arange(1, codes.size + 1), 0)).tolist()
        alphabet = frozenset(np.flatnonzero(np.bincount(codes)).tolist())
        blocks: list[Block] = []

        def line(start: int, stop: int, after: int, *, ended: bool = True) -> None:
            """Add a line, in pieces if it is long; after it, the next begins."""
            nonlocal continues
            last = max(start, raised[stop - 1]) if stop > start and ended else stop
            while True:
                cut = min(start + LONGEST_BLOCK, last)
                end = character + (after if cut == last else cut)
                piece = slice(start, cut)
                text = Text(codes[piece], places[piece], end, alphabet)
                cells = Cells(masks[piece], places[piece], end)
                blocks.append(Block(text, BlockKind.LINE, 0, cells, continues=continues))
                continues = cut < last
                if cut == last:
                    return
                start = cut

        start = 0
        ends = np.flatnonzero((codes == _LINE_FEED) | (codes == _FORM_FEED) | (codes == _RETURN))
        for at in ends.tolist():
            code = codes[at]
            if at < start:  # the line feed of a carriage return
                continue
            if code == _FORM_FEED:
                if continues or (at > start and raised[at - 1] > start):
                    line(start, at, at)  # the form feed is the place of the page
                if at + 1 < codes.size or not final:
                    page += 1
                    blocks.append(_page(character + at + 1, page))
                start = at + 1
                continue
            following = at + 1
            if code == _RETURN and following < codes.size and codes[following] == _LINE_FEED:
                following += 1
            line(start, at, following)
            start = following
        if start < codes.size and (not final or continues or raised[-1] > start):
            line(start, codes.size, codes.size, ended=final)
        return blocks

    def _ends_before(self, offset: int) -> bool:
        """Tell whether a line or a page ends right before a place of the file."""
        before = _read(self._stream, self.name, offset - 1, 2)
        return before[:1] in (b"\n", b"\f") or (before[:1] == b"\r" and before[1:] != b"\n")

    def _cut(self, part: int) -> int:
        """Place where a part begins: at the start of a line, unless that line is very long."""
        found = self._cuts.get(part)
        if found is None:
            found = self._cuts[part] = self._find_cut(self._first + part * PART_BYTES)
        return found

    def _find_cut(self, offset: int) -> int:
        if offset == self._first or offset >= self._after:
            return min(offset, self._after)
        window = _read(self._stream, self.name, offset - 1, PART_BYTES + 1)
        end = _END.search(window[:-1])
        if end is not None:
            cut = end.end()
            if window[cut - 1 : cut + 1] == b"\r\n":  # the window was too short to see both
                cut += 1
            return min(offset - 1 + cut, self._after)
        if self._masks is None:
            while offset < self._after and 0x80 <= window[1] < 0xC0:  # within a character
                offset, window = offset + 1, window[1:]
        return offset


def _page(character: int, number: int) -> Block:
    """Block that says that the page of a number begins at a place."""
    text = Text.empty(character)
    cells = Cells(np.empty(0, np.uint8), np.empty(0, np.int64), character)
    return Block(text, BlockKind.PAGE, 0, cells, group=number)


def _check_text(sample: bytes, name: str) -> None:
    """Check that a file has something in it, and is not known to be of another kind."""
    if not sample:
        raise InputError(f"{name} is empty; give a file of braille")
    kind = binary_kind(sample)
    if kind and not sample.startswith(_WIDE_MARKS):
        raise InputError(f"{name} is {kind}, not braille; give a file of braille")


def _read(stream: BinaryIO, name: str, offset: int, size: int) -> bytes:
    try:
        stream.seek(offset)
        return stream.read(size)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None


def _end(stream: BinaryIO, name: str) -> int:
    try:
        return stream.seek(0, io.SEEK_END)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None
