"""Where in a file of plain text a hit may be: quickly, and never too few places.

A file is decoded and searched by large pieces, without making blocks of them; whether what is
found there is a hit, the blocks decide.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.reading.search.folding import alike, fold_letters, is_plain, unlike
from vbraille.translate.documents.encodings import TextDecoder

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.translate.documents.document import Document

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
class Suspect:
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
    """What lets through each piece of text that a hit may be in.

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
        """Whether a hit may be in a text whose ASCII letters are small.

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
        """Whether a text has as many characters as a hit can have after its first."""
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
) -> Iterator[Suspect]:
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
        yield Suspect(max(0, since), place + characters, end, hit)
        plain_before = plain
        tail = window[-(64 * sieve.characters + _TAIL_BYTES) :]
        offset, place = end, place + characters
        start = place - len(tail)
        if sieve.enough(tail):
            since = start


def behind(
    document: Document, rows: Sequence[Sequence[int | str]], last: int, sieve: Sieve
) -> Iterator[Suspect]:
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
        yield Suspect(int(character), min(place + len(text), end_place), offset, hit)
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
