"""Bytes of a text file in any encoding, piece by piece, to code points, and their kinds.

A byte-order mark decides; else strict UTF-8; else what is the likeliest by the
first 64 kB. No byte is ever dropped: one that the encoding cannot read is
taken as windows-1252.
"""

from __future__ import annotations

import codecs
import os
import re
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

import numpy as np

from vbraille.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray


# In cells; a carriage that goes ten metres crosses fewer than this.
LONGEST_BLANK = 4_096
_HALF = LONGEST_BLANK // 2
TEXT, BLANK, NEWLINE, BREAK, DROPPED = range(5)
_KINDS = np.zeros(0x3002, np.uint8)  # the last entry stands for all code points above
_KINDS[[0x09, 0x20, 0x1680, 0x205F, 0x3000, *range(0x2000, 0x2007), *range(0x2008, 0x200B)]] = BLANK
_KINDS[[0x0A, 0x0B, 0x0D, 0x85, 0x2028]] = NEWLINE
_KINDS[[0x0C, 0x2029]] = BREAK
_KINDS[0xAD] = DROPPED  # a soft hyphen is a hint to a typesetter and would split contractions


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A stretch of a document's characters, some of which may have been left out.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    begins : int64[runs]
        Index of the first character of each run that nothing is left out of; from 0, growing.
    places : int64[runs]
        Place of that character in the document, counted in characters from the first.
    """

    codes: NDArray[np.uint32]
    begins: NDArray[np.int64]
    places: NDArray[np.int64]

    @classmethod
    def whole(cls, codes: NDArray[np.uint32], place: int) -> Stretch:
        """Characters from a place of the document on, with none left out."""
        return cls(codes, np.zeros(1, np.int64), np.full(1, place, np.int64))

    @classmethod
    def joined(cls, parts: list[Stretch]) -> Stretch:
        """Join stretches that follow each other into one."""
        before = np.cumsum([0, *(len(part) for part in parts[:-1])])
        begins = [part.begins + size for part, size in zip(parts, before, strict=True)]
        return cls(
            np.concatenate([part.codes for part in parts]),
            np.concatenate(begins),
            np.concatenate([part.places for part in parts]),
        )

    def place(self, index: NDArray[np.intp] | int) -> NDArray[np.int64]:
        """Places in the document of characters of the stretch, given their indices."""
        run = np.searchsorted(self.begins, index, "right") - 1
        return index + (self.places - self.begins)[run]

    def __len__(self) -> int:
        return self.codes.size


def shorten_blanks(codes: NDArray[np.uint32], place: int, before: int = 0) -> tuple[Stretch, int]:
    """Shorten runs of blanks that are longer than any line of a page.

    Blanks at which a line breaks are not shown, so that the lines stay the same.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    place
        Place of the first code point in the document.
    before
        Number of blanks right before the first code point.

    Returns
    -------
    stretch : Stretch
        The characters with runs of at most `LONGEST_BLANK`.
    after : int
        Number of blanks at the end, to be given with the characters that follow.
    """
    blank = kinds_of(codes) == BLANK
    if blank.all():
        room = max(0, LONGEST_BLANK - before)
        return Stretch.whole(codes[:room].copy(), place), before + codes.size
    after = int(np.argmin(blank[::-1]))
    # A run that is too long has all of at least one such row.
    rows = blank[: blank.size // _HALF * _HALF].reshape(-1, _HALF)
    long = before + int(np.argmin(blank)) > LONGEST_BLANK or rows.all(axis=1).any()
    if not long:
        return Stretch.whole(codes, place), after
    at = np.arange(codes.size)
    run = at - np.maximum.accumulate(np.where(blank, -1 - before, at))
    kept = at[run <= LONGEST_BLANK]
    begins = np.flatnonzero(np.diff(kept, prepend=-2) > 1)
    return Stretch(codes[kept], begins, place + kept[begins]), after


def kinds_of(codes: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """Kind of each character: text, blank, newline, break, or one that is dropped."""
    return np.take(_KINDS, codes, mode="clip")


class Words:
    """Words of a stretch: where characters of text stand together, and what is between them.

    Parameters
    ----------
    codes : uint32[n]
        Code points of the stretch.
    kinds : uint8[n]
        Kind of each.

    Attributes
    ----------
    first, last : int
        Index of the first and last character that is text; -1 if none is.
    stops, begins : intp[gaps]
        For each gap between words: index of the last character before it, and of the first after.
    line_ends : intp[m]
        Indices of characters that end a line.
    newlines : intp[k]
        Those without the second of a carriage return and a line feed.
    """

    def __init__(self, codes: NDArray[np.uint32], kinds: NDArray[np.uint8]) -> None:
        self._kinds = kinds
        is_text = kinds == TEXT
        edges = np.flatnonzero(is_text[1:] != is_text[:-1])
        begun = int(is_text[:1].any())
        stops, begins = edges[1 - begun :: 2], edges[begun::2] + 1
        self.first = self.last = -1
        if begun or begins.size:
            self.first = 0 if begun else int(begins[0])
            self.last = codes.size - 1 if is_text[-1] else int(stops[-1])
        gaps = max(begins.size + begun - 1, 0)
        self.stops, self.begins = stops[:gaps], begins[begins.size - gaps :]
        ends = self.line_ends = np.flatnonzero((kinds == NEWLINE) | (kinds == BREAK))
        second = (ends > 0) & (codes[ends] == 0x0A) & (codes[ends - 1] == 0x0D)
        self.newlines = ends[~second]

    def counted(self, places: NDArray[np.intp]) -> NDArray[np.intp]:
        """Count in each gap the indices that are in it, given some that are no text."""
        inner = places[(places > self.first) & (places < self.last)]
        return np.bincount(np.searchsorted(self.begins, inner), minlength=self.begins.size)

    def places(self, kind: int) -> NDArray[np.intp]:
        """Indices of the characters of a kind."""
        return np.flatnonzero(self._kinds == kind)

    def line_starts(self, places: NDArray[np.intp]) -> NDArray[np.intp]:
        """Index of the first character on the line of each character, given their indices."""
        before = np.searchsorted(self.line_ends, places)
        return np.concatenate(([0], self.line_ends + 1))[before]


SAMPLE_BYTES = 65_536

_WIDE = ("utf-16", "utf-32")

_MARKS = (  # UTF-32 before UTF-16: its little-endian mark begins with the other's
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
# Beginnings of files that people mistake for text; no text begins like one of them.
_MAGIC = {
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF87a": "a GIF image",
    b"GIF89a": "a GIF image",
    b"PK\x03\x04": "a zip archive (a .docx, .odt or .epub is one too)",
    b"PK\x05\x06": "a zip archive",
    b"%PDF-": "a PDF document",
    b"\x1f\x8b": "a gzip archive",
    **{b"BZh%d1AY&SY" % level: "a bzip2 archive" for level in range(1, 10)},
    b"\xfd7zXZ": "an xz archive",
    b"7z\xbc\xaf": "a 7-zip archive",
    b"\x7fELF": "a program",
    b"\xd0\xcf\x11\xe0": "an old Office document",
    b"OggS\0": "an Ogg media file",
    b"ID3\2": "an MP3 file",
    b"ID3\3": "an MP3 file",
    b"ID3\4": "an MP3 file",
    b"\x89HDF": "an HDF5 file",
    b"SQLite format 3\0": "a database",
}
_TEXT_CONTROLS = frozenset(b"\b\t\n\v\f\r\x1a\x1b")
# Encodings that Python has for text, but that no text file is written in.
_NO_FILE_ENCODINGS = {"idna", "punycode", "unicode-escape", "raw-unicode-escape"}
_ASCII_LETTERS = [bytes([code]) for code in range(0x80) if chr(code).isalpha()]
# Encodings of Latin letters, the likeliest first, and of others.
_LATIN = ("cp1252", "iso8859-15", "cp1250", "iso8859-2", "cp1254", "cp1257")
_OLD_LATIN = ("mac-roman", "cp850", "cp852")
_OTHERS = (
    "cp1251", "koi8_r", "koi8_u", "cp866", "iso8859_5", "mac_cyrillic", "cp1253", "iso8859_7",
    "cp1255", "cp1256", "iso8859_6", "cp874", "cp932", "euc_jp", "iso2022_jp", "gb18030", "big5",
    "cp949",
)  # fmt: skip
# A shorter text says too little to tell DOS and Mac code pages from windows-1252.
_TELLING_BYTES = 256
# Letters beyond ASCII of languages that have many readers, the likeliest together.
_ALPHABETS = (
    "àâæçéèêëîïôœùûüÿ", "äöüß", "áéíñóúü", "àâãáçéêíóôõúü", "àèéìíîòóùú", "àáçèéíïòóúü", "åäöéü",
    "åæøéòô", "áéëèïóöüê", "áðéíóúýþæö", "ąćęłńóśźż", "áčďéěíňóřšťúůýž", "áäčďéíĺľňóôŕšťúýž",
    "áéíóöőúüű", "ăâîșțşţ", "čćđšž", "çğıöşüâîû", "āčēģīķļņšūž", "ąčęėįšųūž", "äõöüšž",
)  # fmt: skip
# What is hardly ever in a text of the right encoding: controls, signs within words, half a word.
_UNLIKELY = re.compile(
    "[\x80-\x9f\ufffd]|"
    r"(?<=[^\W\d_])[^\x00-\x7f\w\s’‘“”»«–—…](?=[^\W\d_])|"
    r"(?<!\d)[¼½¾](?=[^\W\d_])"
)


@dataclass(frozen=True, slots=True)
class Encoding:
    """Encoding by which the bytes of a file are read.

    Parameters
    ----------
    name
        Name that Python has for the codec.
    skip
        Number of bytes in the byte-order mark at the start.
    """

    name: str
    skip: int = 0


def binary_kind(sample: bytes) -> str | None:
    """Kind of a file whose beginning shows that it is no text; None if it may be text."""
    for magic, kind in _MAGIC.items():
        if sample.startswith(magic):
            return kind
    if sample.startswith(tuple(mark for mark, _ in _MARKS)) or not sample:
        return None
    controls = sum(sample.count(c) for c in range(32) if c not in _TEXT_CONTROLS)
    zeros = sample.count(0)
    few = 1 + len(sample) / 20  # a few stray ones are no reason to refuse a text
    if controls - zeros > few or (zeros > few and _wide(sample) is None):
        return "binary data"
    return None


def find_encoding(sample: bytes) -> Encoding:
    """Encoding of a file that begins with these bytes.

    Parameters
    ----------
    sample
        First `SAMPLE_BYTES` of the file, or all of a shorter file.
    """
    for mark, name in _MARKS:
        if sample.startswith(mark):
            return Encoding(name, skip=len(mark))
    wide = _wide(sample)
    if wide is not None:
        return Encoding(wide)
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        decoder.decode(sample, final=len(sample) < SAMPLE_BYTES)
    except UnicodeDecodeError:
        return Encoding("utf-8" if _mostly_utf8(sample) else _detect(sample))
    return Encoding("utf-8")


def _wide(sample: bytes) -> str | None:
    """UTF-16 or UTF-32 if zeros stand where a mostly Western text has them; otherwise None.

    Detectors take such a text for another if it is short, or in the wrong byte order.
    """
    if sample.count(0) < 2:  # a single one may be a stray
        return None
    zeros = [
        quarter.count(0) / max(len(quarter), 1) for quarter in (sample[n::4] for n in range(4))
    ]
    if zeros[0] < 0.1 and min(zeros[2:]) > 0.9:
        return "utf-32-le"
    if zeros[3] < 0.1 and min(zeros[:2]) > 0.9:
        return "utf-32-be"
    even, odd = (half.count(0) / max(len(half), 1) for half in (sample[0::2], sample[1::2]))
    if odd > 0.4 and even < odd / 4:
        return "utf-16-le"
    if even > 0.4 and odd < even / 4:
        return "utf-16-be"
    return None


def _mostly_utf8(sample: bytes) -> bool:
    """Tell if the bytes are UTF-8 beyond ASCII except some damaged ones.

    What is two characters in other encodings is hardly ever one of UTF-8 by chance.
    """
    text = sample.decode("utf-8", "surrogateescape")
    damaged = sum("\udc80" <= c <= "\udcff" for c in text)
    whole = sum(c > "\x7f" for c in text) - damaged
    return whole >= damaged


def _detect(sample: bytes) -> str:
    plain = sum(map(sample.count, _ASCII_LETTERS))
    name, score, others = _latin(sample)
    if others < 4 or (2 * others < plain and (score > 0.8 or 8 * others < plain)):
        return name
    import charset_normalizer

    found = charset_normalizer.from_bytes(sample, cp_isolation=list(_OTHERS)).best()
    return name if found is None else codecs.lookup(found.encoding).name


def _latin(sample: bytes) -> tuple[str, float, int]:
    """Encoding in which a Latin text has letters of one language only, or the most of one.

    Returns
    -------
    name
        The first of several that are as likely.
    score
        1 if all letters beyond ASCII are of one language, and less the more are not.
    others
        Number of these letters, and of what no text has.
    """
    best = "", -3.0, 0
    for encoding in _LATIN + (_OLD_LATIN if len(sample) >= _TELLING_BYTES else ()):
        text = sample.decode(encoding, "replace")
        marks = len(_UNLIKELY.findall(text))
        letters = [c for c in text.lower() if c > "\x7f" and c.isalpha() and c not in "ªºµ"]
        of_one = max(sum(map(alphabet.count, letters)) for alphabet in _ALPHABETS)
        likely = of_one - 2 * (len(letters) - of_one) - 2 * marks
        score = likely / (len(letters) + marks) if letters or marks else 1.0
        if score > best[1]:
            best = codecs.lookup(encoding).name, score, len(letters) + marks
    return best


def named_encoding(name: str, sample: bytes) -> Encoding | None:
    """Encoding that a user names, for a file that begins with these bytes.

    The result is None if there is no such text encoding.
    """
    try:
        codec = codecs.lookup(name)
        nothing = codecs.getincrementaldecoder(codec.name)("strict").decode(b"", False)
    except (LookupError, ValueError, TypeError, AssertionError):
        return None
    if not isinstance(nothing, str) or codec.name in _NO_FILE_ENCODINGS:  # base64, zlib and such
        return None
    for mark, marked in _MARKS:
        if sample.startswith(mark) and marked.startswith(codec.name.removesuffix("-sig")):
            return Encoding(marked, skip=len(mark))
    name = codec.name
    return Encoding(f"{name}-le" if name in {"utf-16", "utf-32"} else name)


def first_not_utf8(sample: bytes) -> int:
    """Offset of the first byte that no UTF-8 text would have: an invalid one, or a zero."""
    try:
        sample.decode("utf-8")
    except UnicodeDecodeError as error:
        return error.start
    return max(sample.find(0), 0)


class TextDecoder:
    """An incremental decoder that loses no byte and remembers where the first bad one was.

    Parameters
    ----------
    encoding
        Name that Python has for a codec.

    Attributes
    ----------
    first_bad : int or None
        Offset in the file of the first byte that the encoding cannot read. A lone surrogate of
        UTF-16 or UTF-32 does not count: it stays what it is.
    """

    def __init__(self, encoding: str) -> None:
        self.first_bad: int | None = None
        self._strict = "surrogatepass" if encoding.startswith(_WIDE) else "strict"
        self._decoder = codecs.getincrementaldecoder(encoding)(self._strict)

    def decode(self, piece: bytes, offset: int, *, final: bool) -> str:
        """Text of the next bytes, which stand at the given offset of the file."""
        state = self.state()
        # The third is for ISO 2022, which cannot keep an escape that never ends for the next piece.
        for errors, last in (
            (self._strict, final),
            ("vbraille-keep", final),
            ("vbraille-keep", True),
        ):
            self._decoder.errors = errors
            try:
                return self._decoder.decode(piece, last)
            except UnicodeError as error:
                if isinstance(error, UnicodeDecodeError) and self.first_bad is None:
                    self.first_bad = offset - len(state[0]) + error.start
            self.restore(state)
        raise AssertionError("what keeps every byte fails at none")

    def state(self) -> tuple[bytes, int]:
        """State that `restore` needs to go on from here."""
        return self._decoder.getstate()

    def restore(self, state: tuple[bytes, int]) -> None:
        """Go on from an earlier `state`."""
        self._decoder.reset()
        self._decoder.setstate(state)


def _keep(error: UnicodeError) -> tuple[str, int]:
    """Take undecodable bytes as windows-1252, lone surrogates as themselves."""
    if not isinstance(error, UnicodeDecodeError):
        raise error
    bad = error.object[error.start : error.end]
    if error.encoding.startswith(_WIDE):
        try:
            return bad.decode(error.encoding, "surrogatepass"), error.end
        except UnicodeDecodeError:
            pass
    # The five bytes that windows-1252 leaves open become the control characters of their numbers.
    return "".join(bytes([b]).decode("cp1252", "ignore") or chr(b) for b in bad), error.end


codecs.register_error("vbraille-keep", _keep)


CHUNK_BYTES = 65_536


def open_file(path: Path | str) -> BinaryIO:
    """Open a file for reading; what cannot be read twice, such as a pipe, is kept first.

    Raises
    ------
    InputError
        If it is missing, unreadable or a directory.
    """
    path = Path(path)
    try:
        stream = path.open("rb")
        # A pipe cannot be read twice, and a file of /proc does not say how long it is.
        if not stream.seekable() or (path.is_file() and not path.stat().st_size):
            with stream:
                return _kept(stream)
    except FileNotFoundError:
        raise InputError(f"there is no file {path}; check the name") from None
    except IsADirectoryError:
        raise InputError(f"{path} is a directory; give a text file in it") from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"{path} cannot be read: {reason}") from None
    return stream


def keep_stream(stream: BinaryIO, name: str) -> BinaryIO:
    """Read all that a stream gives, such as standard input, into a temporary file.

    Parameters
    ----------
    stream
        Bytes to read to their end, which may be more than memory holds.
    name
        Name of the stream in messages.

    Raises
    ------
    InputError
        If the stream cannot be read, or what it gives cannot be kept.
    """
    try:
        return _kept(stream)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None


def _kept(stream: BinaryIO) -> BinaryIO:
    """Temporary file with all that a stream gives, since a text is read more than once."""
    from tempfile import TemporaryFile

    with ExitStack() as opened:
        kept = opened.enter_context(TemporaryFile())
        # Python's buffer is bypassed, which asks a terminal for more after its end was typed.
        while chunk := os.read(stream.fileno(), CHUNK_BYTES):
            kept.write(chunk)
        kept.flush()
        opened.pop_all()  # closing it is left to the caller
    return kept
