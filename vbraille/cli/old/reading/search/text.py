"""A text found in the blocks of any source: folded letters, a sieve of places, and the next hit."""

from __future__ import annotations

import itertools
import re
import unicodedata
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from vbraille.cli.old.reading.search.structure import extend

Document = None
TextDecoder = None
TYPED = {0x2070: "0"}
to_codes = None
to_text = None

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.cli.old.reading.search.questions import FindText
    from vbraille.translate import Block, Source

# Accents that stand for themselves after a letter, in all scripts whose readers may leave them out.
_ACCENTS = (
    "\u0300-\u036f\u0591-\u05bd\u05bf\u05c1\u05c2\u05c4\u05c5\u05c7\u064b-\u0655\u0670"
    "\u1ab0-\u1aff\u1dc0-\u1dff\u20d0-\u20ff\u3099\u309a"
)
_ACCENT = re.compile(f"[{_ACCENTS}]+")
_QUOTES = "'\"`´‘’‚‛“”„‟′″‹›«»ʼ＇＂"
_DASHES = "-‐‑‒–—―−⁃﹘﹣－"
_SIGNS = {ord(c): sign for sign, same in (("'", _QUOTES), ("-", _DASHES)) for c in same}
_BLANKS = re.compile(r"\s+")
_SMALL = re.compile(f"[{''.join(map(chr, TYPED))}]")
_TABLED = 0x3100  # all letters with accents, and none of the many signs of East Asia
# Where there are characters that are folded to others.
_FOLDED = tuple(
    range(first, last)
    for first, last in (
        (0x80, 0x3400),
        (0xA640, 0xAC00),
        (0xF900, 0x1_0000),
        (0x1_0400, 0x1_1000),
        (0x1_1090, 0x1_1A00),
        (0x1_6E40, 0x1_6E80),
        (0x1_D15E, 0x1_D1C1),
        (0x1_E900, 0x1_E944),
        (0x2_F800, 0x2_FA1E),
    )
)
_NOTHING, _SEVERAL = 0xFFFF_FFFF, 0xFFFF_FFFE
# What is folded before an ASCII letter that follows another has nothing to do with what is after.
_WITHIN_WORD = re.compile("[A-Za-z](?=[A-Za-z])")
_PIECE = 4_096  # characters that are folded together on the way to a place
_NOT_READ = re.compile("[\u00ad\ufeff]+")


def fold(text: str, *, accents: bool) -> str:
    """Text without what makes no difference in a search; a longer text's is never shorter.

    Parameters
    ----------
    text
        Text as it is read.
    accents
        Whether accents make no difference, either.
    """
    text = fold_letters(text, accents=accents)
    return _BLANKS.sub(" ", text)


def fold_letters(text: str, *, accents: bool) -> str:
    """Text without differences of case, signs and perhaps accents; its blanks are as they were."""
    if text.isascii():
        return text.lower().replace('"', "'").replace("`", "'")
    if not unicodedata.is_normalized("NFC", text):
        text = unicodedata.normalize("NFC", text)
    return _without_accents(text) if accents else _caseless(text).translate(_SIGNS)


def _caseless(text: str) -> str:
    """Text without differences of case, and with the numbers of H₂O and 10⁶ as they are typed."""
    folded = text.casefold()
    return folded.translate(TYPED) if _SMALL.search(folded) else folded


def is_plain(text: str) -> bool:
    """Tell if each character of a text is folded alone and to one or more."""
    return _ACCENT.search(text) is None and unicodedata.is_normalized("NFC", text)


def _without_accents(text: str) -> str:
    """Text with small letters without accents, by a table as long as each remains one letter."""
    codes = to_codes(text)
    if int(codes.max()) < _TABLED:
        letters = _letters()[codes]
        if not (letters == _SEVERAL).any():
            return to_text(letters[letters != _NOTHING])
    return _stripped(text)


def _stripped(text: str) -> str:
    left = _ACCENT.sub("", unicodedata.normalize("NFD", _caseless(text)))
    return unicodedata.normalize("NFC", left).translate(_SIGNS)


@cache
def _letters() -> NDArray[np.uint32]:
    """For each code point that has a place in the table: what remains of it."""
    table = np.empty(_TABLED, np.uint32)
    for code in range(_TABLED):
        left = _stripped(chr(code))
        table[code] = _NOTHING if not left else _SEVERAL if len(left) > 1 else ord(left)
    return table


def needle_of(text: str, *, accents: bool) -> str:
    """Fold a text that is looked for; empty if nothing is left of it."""
    return fold(_NOT_READ.sub("", text).strip(), accents=accents).strip()


def unfolded(text: str, at: int, *, accents: bool) -> int:
    """Index of the character of a text of which `fold` made the one at an index."""
    start, end = 0, len(text)
    while (cut := _WITHIN_WORD.search(text, start + _PIECE)) is not None:
        folded = len(fold(text[start : cut.end()], accents=accents))
        if folded > at:
            end = cut.end()
            break
        start, at = cut.end(), at - folded
    low, high = start, end - 1
    while low < high:
        middle = (low + high) // 2
        if len(fold(text[start : middle + 1], accents=accents)) > at:
            high = middle
        else:
            low = middle + 1
    return low


def alike(letter: str, *, accents: bool) -> str:
    """All characters that fold to a letter or a sign; of letters of ASCII only small ones."""
    return letter + _alike(accents)[0].get(letter, "")


def unlike(needle: str, *, accents: bool) -> Iterable[str]:
    """Characters that are folded to several, which may be in what is sought or around its ends."""
    for character, folded in _alike(accents)[1]:
        ends = range(1, len(folded))
        if (
            folded in needle
            or needle in folded
            or any(needle.startswith(folded[n:]) or needle.endswith(folded[:n]) for n in ends)
        ):
            yield character


@cache
def _alike(accents: bool) -> tuple[dict[str, str], list[tuple[str, str]]]:
    """For each character that others fold to: those; and what folds to several."""
    alone: dict[str, str] = {}
    several: list[tuple[str, str]] = []
    for character in map(chr, itertools.chain((0x22, 0x60), *_FOLDED)):
        if accents:
            folded = _stripped(character)
        else:
            folded = _caseless(unicodedata.normalize("NFC", character)).translate(_SIGNS)
        if len(folded) > 1:
            several.append((character, folded))
        elif folded and folded != character:
            alone[folded] = alone.get(folded, "") + character
    return alone, several


PIECE_BYTES = 262_144
_CHUNKS = 4  # of the document's, which are decoded together on the way back
_TAIL_BYTES = 4_096
_NO_TEXT = re.compile("[\\s\u00ad\ufeff\u0300-\u036f\u0653-\u0655\u3099\u309a]+")
_SOFT_HYPHEN, _BYTE_ORDER_MARK = "\u00ad", "\ufeff"
# A soft hyphen before a line break joins two parts of a word; a line is kept as it is, or not.
_IN_LINE = "(?:[^\\S\n\r\v\f\u0085\u2028\u2029]|\u00ad)*"
_SOFT_BREAK = re.compile(f"\u00ad{_IN_LINE}(?:\r\n|[\n\v\r\u0085\u2028]){_IN_LINE}")
# Bytes in UTF-8 with which all accents begin, and signs and letters that join others.
_JOINING = re.compile(rb"[\xcc\xcd\xd6-\xd9\xdb-\xdf\xe0\xe1\xe3\xea\xef\xf0]|\xe2[\x83\xab-\xb7]")
# Encodings of which each byte below 128 is its character, whatever stands before it.
_ASCII_SAFE = ("utf-8", "ascii", "cp125", "iso8859", "latin", "koi8", "mac")


@dataclass(frozen=True, slots=True)
class SearchedPart:
    """A part of a document that was looked through.

    Parameters
    ----------
    start, end
        Place of its first character, and one past its last.
    offset
        Where it ends in the file, in bytes.
    hit
        Whether a hit may begin in it.
    """

    start: int
    end: int
    offset: int
    hit: bool


class Sieve:
    """Sieve that lets through each piece of text in which a hit may be.

    Parameters
    ----------
    needle
        Folded text that is looked for; not empty.
    accents
        Whether accents make no difference.
    """

    def __init__(self, needle: str, *, accents: bool) -> None:
        self.characters = len(needle)
        self._accents = accents
        same = {letter: alike(letter, accents=accents) for letter in {*needle}}
        ascii_only = {c: "".join(filter(str.isascii, every)) or c for c, every in same.items()}
        self._folded = re.compile(_pattern(needle, {}))
        self._ascii = re.compile(_pattern(needle, ascii_only))
        self._plain = re.compile(_pattern(needle, same))
        self._odd = tuple(unlike(needle, accents=accents))

    def may_hold(self, text: str, *, plain: bool) -> bool:
        """Tell whether a hit may be in a text whose ASCII letters are small.

        Parameters
        ----------
        text
            Part of a document.
        plain
            Whether all its characters are folded alone.
        """
        if "\b" in text:
            return True  # a backspace strikes out what is around it
        if text.isascii():
            return self._ascii.search(text) is not None
        joined = _SOFT_HYPHEN in text or _BYTE_ORDER_MARK in text
        if plain and not joined and not any(odd in text for odd in self._odd):
            return self._plain.search(text) is not None
        variants = [text]
        if joined:
            text = text.replace(_BYTE_ORDER_MARK, "")
            variants = [_SOFT_BREAK.sub("", text), text]
        return any(
            self._folded.search(
                fold_letters(variant.replace(_SOFT_HYPHEN, ""), accents=self._accents)
            )
            for variant in variants
        )

    def enough(self, tail: str) -> bool:
        """Tell whether a text has as many characters as a hit can have after its first."""
        most = 64 * self.characters + _TAIL_BYTES
        return any(  # what comes first is nearly always enough
            len(_NO_TEXT.sub("", tail[:cut])) > 2 * self.characters
            for cut in (8 * self.characters, most)
        )


def _pattern(needle: str, alike: dict[str, str]) -> str:
    """Pattern of a needle in text whose blanks are of any length, and in which lines may break.

    With a text for a letter, any character of it may stand for the letter.
    """

    def letter(c: str) -> str:
        same = alike.get(c, c)
        one = re.escape(c) if same == c else f"[{re.escape(same)}]"
        return one + (r"\s*" if c == "-" else "")

    return r"\s+".join("".join(map(letter, word)) for word in needle.split(" "))


def ahead(
    document: Document,
    row: Sequence[int | str],
    sieve: Sieve,
    piece_bytes: int = PIECE_BYTES,
) -> Iterator[SearchedPart]:
    """Look through a document from a chunk on, whose row in the document's index is given."""
    _, character, offset, held, flag, skip, *_ = row
    decoder = TextDecoder(document.encoding.name)
    decoder.restore((bytes.fromhex(str(held)), int(flag)))
    offset, place = int(offset), int(character) - int(skip)
    tail, plain_before = "", True
    since = start = place  # where a hit may begin that is not at its end yet
    while offset < document.size:
        raw = document.read(offset, piece_bytes)
        if not raw:
            return
        end = offset + len(raw)
        text, characters = _decode(decoder, document, raw, offset, final=end >= document.size)
        plain = _is_plain(document, raw, text)
        window = tail + text
        # Where a hit may have begun before the tail, the blocks must say.
        hit = since < start or sieve.may_hold(window, plain=plain and plain_before)
        yield SearchedPart(max(0, since), place + characters, end, hit)
        plain_before = plain
        tail = window[-(64 * sieve.characters + _TAIL_BYTES) :]
        offset, place = end, place + characters
        start = place - len(tail)
        if sieve.enough(tail):
            since = start


def behind(
    document: Document, rows: Sequence[Sequence[int | str]], last: int, sieve: Sieve
) -> Iterator[SearchedPart]:
    """Look through a document backwards from the end of a chunk, whose number is given."""
    after = last + 1
    while after > 0:
        first = max(0, after - _CHUNKS)
        _, character, offset, held, flag, skip, *_ = rows[first]
        decoder = TextDecoder(document.encoding.name)
        decoder.restore((bytes.fromhex(str(held)), int(flag)))
        offset, place = int(offset), int(character) - int(skip)
        if after < len(rows):
            end, end_place = int(rows[after][2]), int(rows[after][1])
        else:
            end, end_place = document.size, 1 << 62
        stop = min(document.size, end + _TAIL_BYTES)
        raw = document.read(offset, stop - offset)
        text, _ = _decode(decoder, document, raw, offset, final=stop >= document.size)
        plain = _is_plain(document, raw, text)
        while stop < document.size and not sieve.enough(text[max(0, end_place - place) :]):
            raw = document.read(stop, PIECE_BYTES)
            if not raw:
                break
            end = stop + len(raw)
            more, _ = _decode(decoder, document, raw, stop, final=end >= document.size)
            plain = plain and _is_plain(document, raw, more)
            text, stop = text + more, end
        hit = sieve.may_hold(text, plain=plain)
        yield SearchedPart(int(character), min(place + len(text), end_place), offset, hit)
        after = first


def _decode(
    decoder: TextDecoder, document: Document, raw: bytes, at: int, *, final: bool
) -> tuple[str, int]:
    """Text of bytes with small ASCII letters, and how many characters it was before."""
    if document.encoding.name.startswith(_ASCII_SAFE):  # much quicker, where it can be done
        text = decoder.decode(raw.lower(), at, final=final)
        return text, len(text)
    text = decoder.decode(raw, at, final=final)
    return text.lower(), len(text)


def _is_plain(document: Document, raw: bytes, text: str) -> bool:
    """Tell if all characters of a piece of text are folded alone, given its bytes."""
    if text.isascii():
        return True
    # A piece may begin within a character.
    if document.encoding.name.startswith("utf-8") and raw[0] & 0xC0 != 0x80:
        return _JOINING.search(raw) is None or is_plain(text)
    return is_plain(text)


SPAN_CHARACTERS = 32_768


@dataclass(frozen=True, slots=True)
class Sought:
    """Text that is looked for.

    Parameters
    ----------
    needle
        Folded text; not empty.
    accents
        Whether accents make no difference.
    start
        Place of the source from which on it is looked for, or before which.
    """

    needle: str
    accents: bool
    start: int


@dataclass(frozen=True, slots=True)
class _Span:
    """Text of some blocks that follow each other, and as much after it as a hit may need.

    Parameters
    ----------
    text, places
        Characters, with a blank between two blocks, and the place of each in the source.
    length
        Number of characters before those of the blocks that come after the span.
    """

    text: str
    places: NDArray[np.int64]
    length: int


def forward(
    source: Source, first: int, sought: Sought, characters: int = SPAN_CHARACTERS
) -> Iterator[int | float]:
    """Look for the first hit from a block on, in spans of at least so many characters.

    Yields
    ------
    int or float
        How much of the source was seen, 0 to 1, as floats; then the place of a hit, if any.
    """
    number = first
    while source.block(number) is not None:
        span, after = _span(source, number, None, sought, characters=characters)
        found = first_hit(span, sought)
        if found is not None:
            yield found
            return
        number = after
        yield source.progress(number)


def backward(
    source: Source, last: int, sought: Sought, characters: int = SPAN_CHARACTERS
) -> Iterator[int | float]:
    """Look for the last hit that begins in a block or before it, as `forward` does."""
    after = last + 1
    while after > 0:
        first = after
        size = 0
        while first > 0 and size < characters:
            first -= 1
            block = source.block(first)
            size += 1 if block is None else len(block.text) + 1
        span, _ = _span(source, first, after, sought)
        found = last_hit(span, sought)
        if found is not None:
            yield found
            return
        after = first
        yield 1.0 - source.progress(first)


def within(
    source: Source, characters: tuple[int, int], sought: Sought, *, backward: bool
) -> int | None:
    """Place of the first or last hit that begins in a range of the source's characters."""
    start, end = characters
    first, last = source.block_at(start), source.block_at(end)
    if first is None:
        return None
    span, _ = _span(source, first, None if last is None else last + 1, sought, end)
    return last_hit(span, sought) if backward else first_hit(span, sought)


def first_hit(span: _Span, sought: Sought) -> int | None:
    """Place of the first hit that begins in a span at the start or after it."""
    folded = fold(span.text, accents=sought.accents)
    before = span.text[: int(np.searchsorted(span.places, sought.start))]
    # What is folded may grow together with what comes next.
    at = max(0, len(fold(before, accents=sought.accents)) - 4) if before else 0
    while (at := folded.find(sought.needle, at)) >= 0:
        index = unfolded(span.text, at, accents=sought.accents)
        if index >= span.length:
            return None
        if span.places[index] >= sought.start:
            return int(span.places[index])
        at += 1
    return None


def last_hit(span: _Span, sought: Sought) -> int | None:
    """Place of the last hit that begins in a span before the start."""
    folded = fold(span.text, accents=sought.accents)
    limit = min(span.length, int(np.searchsorted(span.places, sought.start)))
    if limit <= 0:
        return None
    upto = len(fold(span.text[:limit], accents=sought.accents)) + 4 + len(sought.needle)
    while (at := folded.rfind(sought.needle, 0, upto)) >= 0:
        index = unfolded(span.text, at, accents=sought.accents)
        if index < limit:
            return int(span.places[index])
        upto = at + len(sought.needle) - 1
    return None


def _span(
    source: Source,
    first: int,
    after: int | None,
    sought: Sought,
    upto: int | None = None,
    characters: int = SPAN_CHARACTERS,
) -> tuple[_Span, int]:
    """Blocks from a number on, and the number of the first that is not in the span.

    They go up to the number `after`; if that is None, up to the place `upto`; if that is None,
    too, they are as many as have so many characters.
    """
    texts: list[str] = []
    places: list[NDArray[np.int64]] = []
    size = length = 0
    number = following = first
    more = 0
    block = source.block(first)
    inside = True
    while block is not None and (inside or more <= 4 * len(sought.needle)):
        if texts and not block.continues:
            texts.append(" ")
            places.append(_blank(block))
            size += 1
        texts.append(str(block.text))
        places.append(block.text.places)
        size += len(block.text)
        if inside:
            number += 1
            length = size
            if after is not None:
                inside = number < after
            elif upto is not None:
                inside = block.text.end <= upto
            else:
                inside = size < characters
            following = number
        else:
            more += len(fold(texts[-1], accents=sought.accents))
            following += 1
        block = source.block(following)
    joined = np.concatenate(places) if places else np.empty(0, np.int64)
    return _Span("".join(texts), joined, length), number


def _blank(block: Block) -> NDArray[np.int64]:
    """Place of the blank before a block: that of its first character."""
    first = int(block.text.places[0]) if len(block.text) else block.text.end
    return np.full(1, first, np.int64)


_NEAR_CHARACTERS = 4_096  # that are looked through before the time is looked at


def find_text(source: Source, query: FindText, *, near: bool = False) -> Iterator[int | float]:
    """Look for a text.

    Parameters
    ----------
    near
        Whether only what is near matters: the steps are then small, and far more are needed for
        a long plain text. The answer is the same.

    Yields
    ------
    int or float
        How much of the source was seen, 0 to 1, as floats; then the place of the text, if any.
    """
    needle = needle_of(query.text, accents=query.fold_accents)
    if not needle:
        return
    sought = Sought(needle, query.fold_accents, query.start)
    if isinstance(source, Document) and not near:
        yield from (_back_in if query.backward else _on_in)(source, sought)
        return
    characters = _NEAR_CHARACTERS if near else SPAN_CHARACTERS
    if query.backward:
        yield from _before(source, sought, characters)
    elif (first := source.block_at(query.start)) is not None:
        yield from forward(source, first, sought, characters)


def _before(source: Source, sought: Sought, characters: int) -> Iterator[int | float]:
    while sought.start >= _known_character(source) and extend(source):
        yield 0.0
    last = source.block_at(sought.start)
    if last is None:
        last = _last(source)
    yield from backward(source, last, sought, characters)


def _last(source: Source) -> int:
    """Number of the last block; the source must be complete."""
    number = 1
    while source.block(number) is not None:
        number *= 2
    low, high = number // 2, number
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if source.block(middle) is None else (middle, high)
    return low


def _known_character(source: Source) -> int:
    """Place up to which the source is known; the rows of its index have it second."""
    rows = source.index().rows
    character = rows[-1][1] if rows else 0
    return character if isinstance(character, int) else 0


def _on_in(document: Document, sought: Sought) -> Iterator[int | float]:
    """Look for a text from its start on in a plain text."""
    sieve = Sieve(sought.needle, accents=sought.accents)
    rows = document.index().rows
    row = rows[_row_before(rows, sought.start)]
    for suspect in ahead(document, row, sieve):
        if suspect.hit and suspect.end > sought.start:
            found = yield from _hit(document, suspect, sought, backward=False)
            if found is not None:
                yield found
                return
        yield suspect.offset / document.size


def _back_in(document: Document, sought: Sought) -> Iterator[int | float]:
    """Look for a text backwards from its start in a plain text."""
    while sought.start >= _known_character(document) and extend(document):
        yield 0.0
    sieve = Sieve(sought.needle, accents=sought.accents)
    rows = document.index().rows
    for suspect in behind(document, rows, _row_before(rows, sought.start), sieve):
        if suspect.hit:
            found = yield from _hit(document, suspect, sought, backward=True)
            if found is not None:
                yield found
                return
        yield 1.0 - suspect.offset / document.size


def _hit(
    document: Document, suspect: SearchedPart, sought: Sought, *, backward: bool
) -> Generator[float, None, int | None]:
    """Have the blocks say whether there is a hit; they are read as far as that."""
    while suspect.end >= _known_character(document) and extend(document):
        yield _known_character(document) / max(suspect.end, 1) * suspect.offset / document.size
    start = suspect.start if backward else max(suspect.start, sought.start)
    return within(document, (start, suspect.end), sought, backward=backward)


def _row_before(rows: tuple[tuple[int | str, ...], ...], character: int) -> int:
    """Number of the last row whose chunk begins at a character or before it."""
    low, high = 0, len(rows)
    while high - low > 1:
        middle = (low + high) // 2
        at = rows[middle][1]
        low, high = (middle, high) if isinstance(at, int) and at <= character else (low, middle)
    return low
