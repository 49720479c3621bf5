"""Where in a file of plain text a hit may be: quickly, and never too few places.

A file is decoded and searched by large pieces, without making blocks of them; whether what is
found there is a hit, the blocks decide.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING

from vbraille.reading.seeking.folding import COMBINING, cases, fold_letters, unlike_ascii
from vbraille.translate.documents.encodings import TextDecoder

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vbraille.translate.documents.document import Document

PIECE_BYTES = 262_144
_CHUNKS = 4  # of the document's, which are decoded together on the way back
_TAIL_BYTES = 4_096
_NO_TEXT = re.compile(f"[\\s\u00ad\ufeff{COMBINING}]+")
_SOFT_HYPHEN, _BYTE_ORDER_MARK = "\u00ad", "\ufeff"
# A soft hyphen before a line break joins two parts of a word; a line is kept as it is, or not.
_IN_LINE = "(?:[^\\S\n\r\v\f\u0085\u2028\u2029]|\u00ad)*"
_SOFT_BREAK = re.compile(f"\u00ad{_IN_LINE}(?:\r\n|[\n\v\r\u0085\u2028]){_IN_LINE}")
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
        self._folded = re.compile(_pattern(needle, lambda letter: re.escape(letter)))
        self._plain = re.compile(_pattern(needle, _any_case))
        self._odd = tuple(unlike_ascii(needle))

    def may_hold(self, text: str, *, combining: bool) -> bool:
        """Whether a hit may be in a text whose ASCII letters are small.

        Parameters
        ----------
        text
            Part of a document.
        combining
            Whether there may be combining accents in it.
        """
        if "\b" in text:
            return True  # a backspace strikes out what is around it
        if text.isascii():
            return self._folded.search(text) is not None
        joined = _SOFT_HYPHEN in text or _BYTE_ORDER_MARK in text
        if (
            not self._accents
            and not joined
            and not combining
            and not any(odd in text for odd in self._odd)
        ):
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


def _any_case(letter: str) -> str:
    same = cases(letter)
    return re.escape(letter) if len(same) == 1 else f"[{re.escape(same)}]"


def _pattern(needle: str, letter) -> str:
    """Pattern of a needle in text whose blanks are of any length, and in which lines may break."""
    words = [
        "".join(letter(c) + (r"\s*" if c in "-\u2010" else "") for c in word)
        for word in needle.split(" ")
    ]
    return r"\s+".join(words)


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
    tail, combined = "", False
    since = start = place  # where a hit may begin that is not at its end yet
    while offset < document.size:
        raw = document.read(offset, piece_bytes)
        if not raw:
            return
        end = offset + len(raw)
        text, characters = _decode(decoder, document, raw, offset, final=end >= document.size)
        combining = _combining(document, raw, text)
        window = tail + text
        # Where a hit may have begun before the tail, the blocks must say.
        hit = since < start or sieve.may_hold(window, combining=combining or combined)
        yield Suspect(max(0, since), place + characters, end, hit)
        combined = combining
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
        combining = _combining(document, raw, text)
        while stop < document.size and not sieve.enough(text[max(0, end_place - place) :]):
            raw = document.read(stop, PIECE_BYTES)
            if not raw:
                break
            end = stop + len(raw)
            more, _ = _decode(decoder, document, raw, stop, final=end >= document.size)
            combining = combining or _combining(document, raw, more)
            text, stop = text + more, end
        hit = sieve.may_hold(text, combining=combining)
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


def _combining(document: Document, raw: bytes, text: str) -> bool:
    """Whether there may be combining accents in a piece of text, given its bytes."""
    if text.isascii():
        return False
    if document.encoding.name.startswith("utf-8"):
        return (
            b"\xcc" in raw
            or b"\xcd" in raw
            or any(accent in text for accent in "\u0653\u0654\u0655\u3099\u309a")
            or raw[0] & 0xC0 == 0x80  # the piece begins within a character
        )
    return not unicodedata.is_normalized("NFC", text)
