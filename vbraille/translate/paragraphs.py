"""Characters into paragraphs: lines joined, white space folded, every place remembered."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

# A longer paragraph is handed on in pieces: no text may grow with the file.
PIECE_CHARACTERS = 8_192
# Cells; a carriage that goes ten metres crosses fewer than this.
LONGEST_BLANK = 4_096

SPACE = 0x20
NO_BREAK_SPACE = 0xA0

_TEXT, _BLANK, _NEWLINE, _BREAK, _DROPPED = range(5)
_KINDS = np.zeros(0x3002, np.uint8)  # the last entry stands for all above
_KINDS[[0x09, 0x20, 0x1680, 0x205F, 0x3000, *range(0x2000, 0x2007), *range(0x2008, 0x200B)]] = (
    _BLANK
)
_KINDS[[0x0A, 0x0B, 0x0D, 0x85, 0x2028]] = _NEWLINE
_KINDS[[0x0C, 0x2029]] = _BREAK
_KINDS[0xAD] = _DROPPED  # a soft hyphen is a hint to a typesetter and would split contractions
_NO_BREAK_SPACES = (0x2007, 0x202F)
_BYTE_ORDER_MARK = 0xFEFF
# Accents that Unicode has whole letters with: Latin, Greek, Cyrillic, Arabic and kana ones.
_COMBINING = frozenset((*range(0x300, 0x370), *range(0x653, 0x656), 0x3099, 0x309A))
# Words before which a hyphen stands for the rest of the word before it.
_SUSPENDED = {"and", "or", "to", "und", "oder", "bis", "et", "ou"}
# Characters after a line break that say whether a space belongs there: such a word and one more.
_WORD = 5
# What a line of a list begins with: a bullet, a dash, a number or a letter, and then a blank.
_MARKER = re.compile(
    r"(?:(?P<bullet>[•‣◦⁃●○■▪*-])|(?P<dash>[–—+])|\(?(?P<number>\d{1,3})[.)]|\(?(?P<letter>[a-z])\))"
    r"[ \t\u00a0\u2000-\u200a\u3000]"
)
_LONGEST_MARKER = 6
_LEADS = np.array([ord(lead) for lead in "•‣◦⁃●○■▪*-–—+(0123456789"], np.uint32)
_BULLET, _DASH = -1, -2
# Characters that must follow a place before it is known what belongs there.
_LOOK_AHEAD = max(_WORD, _LONGEST_MARKER) + 1


@dataclass(frozen=True, slots=True, eq=False)
class Paragraph:
    """A paragraph of text, or a piece of a very long one.

    Parameters
    ----------
    codes : uint32[n]
        Its characters as code points: hard-wrapped lines joined, white space folded.
    source : int64[n]
        Where each stands in the document, counted in characters from its first.
    end : int
        One past the document's last character that belongs to it.
    continues : bool
        Whether this piece goes on where the one before it broke off.
    alphabet : frozenset of int
        Code points among which all of its own are. They are gathered once for
        many paragraphs: array scans between calls of liblouis slow it by a
        fifth on processors that lower their clock for wide vectors.
    """

    codes: NDArray[np.uint32]
    source: NDArray[np.int64]
    end: int
    continues: bool
    alphabet: frozenset[int]

    @property
    def text(self) -> str:
        """The paragraph as a string."""
        return to_text(self.codes)

    def __add__(self, piece: Paragraph) -> Paragraph:
        return Paragraph(
            np.concatenate((self.codes, piece.codes)),
            np.concatenate((self.source, piece.source)),
            piece.end,
            self.continues,
            self.alphabet | piece.alphabet,
        )

    def since(self, character: int) -> Paragraph:
        """The part from a source character on; keeps nothing of the rest in memory."""
        at = int(np.searchsorted(self.source, character))
        codes, source = self.codes[at:].copy(), self.source[at:].copy()
        return Paragraph(codes, source, self.end, True, self.alphabet)


def to_codes(text: str) -> NDArray[np.uint32]:
    """Code points of a string, lone surrogates included."""
    return np.frombuffer(text.encode("utf-32-le", "surrogatepass"), np.uint32)


def to_text(codes: NDArray[np.uint32]) -> str:
    """String of code points, lone surrogates included."""
    return codes.astype("<u4").tobytes().decode("utf-32-le", "surrogatepass")


@dataclass(frozen=True, slots=True)
class Split:
    """What `split_paragraphs` made of a stretch of characters.

    Parameters
    ----------
    paragraphs
        The paragraphs that are complete.
    used
        Characters up to the first that belongs to none of them, or may begin another.
    continues
        Whether that one goes on with the last paragraph.
    item
        Number of the list item that it is a part of then; 0 for none.
    """

    paragraphs: list[Paragraph]
    used: int
    continues: bool
    item: int = 0


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
        Where that character stands in the document, counted in characters from its first.
    """

    codes: NDArray[np.uint32]
    begins: NDArray[np.int64]
    places: NDArray[np.int64]

    @classmethod
    def whole(cls, codes: NDArray[np.uint32], place: int) -> Stretch:
        """Characters from a place of the document on, nothing left out."""
        return cls(codes, np.zeros(1, np.int64), np.full(1, place, np.int64))

    @classmethod
    def joined(cls, parts: list[Stretch]) -> Stretch:
        """Put stretches that follow each other into one."""
        before = np.cumsum([0, *(len(part) for part in parts[:-1])])
        begins = [part.begins + size for part, size in zip(parts, before, strict=True)]
        return cls(
            np.concatenate([part.codes for part in parts]),
            np.concatenate(begins),
            np.concatenate([part.places for part in parts]),
        )

    def place(self, index: NDArray[np.intp] | int) -> NDArray[np.int64]:
        """Places in the document of characters of the stretch, by their indices."""
        run = np.searchsorted(self.begins, index, "right") - 1
        return index + (self.places - self.begins)[run]

    def __len__(self) -> int:
        return self.codes.size


def shorten_blanks(codes: NDArray[np.uint32], place: int, before: int = 0) -> tuple[Stretch, int]:
    """Shorten runs of blanks that are longer than any line of a page.

    What stands where a line breaks is not shown, so that the lines stay the same.

    Parameters
    ----------
    codes : uint32[n]
        Code points.
    place
        Where the first of them stands in the document.
    before
        Blanks right before it.

    Returns
    -------
    stretch : Stretch
        The characters with runs of at most `LONGEST_BLANK`.
    after : int
        Blanks at the end, to be given with the characters that follow.
    """
    blank = _kinds(codes) == _BLANK
    others = np.flatnonzero(~blank)
    if not others.size:
        room = max(0, LONGEST_BLANK - before)
        return Stretch.whole(codes[:room].copy(), place), before + codes.size
    after = codes.size - 1 - int(others[-1])
    longest = max(before + int(others[0]), after, int(np.diff(others).max(initial=1)) - 1)
    if longest <= LONGEST_BLANK:
        return Stretch.whole(codes, place), after
    at = np.arange(codes.size)
    run = at - np.maximum.accumulate(np.where(blank, -1 - before, at))
    kept = at[run <= LONGEST_BLANK]
    begins = np.flatnonzero(np.diff(kept, prepend=-2) > 1)
    return Stretch(codes[kept], begins, place + kept[begins]), after


def split_paragraphs(
    stretch: Stretch,
    *,
    continues: bool = False,
    item: int = 0,
    final: bool = True,
    keep_lines: bool = False,
) -> Split:
    """Cut a stretch of characters into paragraphs.

    Parameters
    ----------
    stretch
        The characters.
    continues
        Whether it goes on with an earlier piece of a paragraph.
    item
        Number of the list item that this paragraph is; 0 for none.
    final
        Whether the text ends here; else the last paragraph is left for later.
    keep_lines
        Make a paragraph of every line instead.
    """
    codes = stretch.codes
    kinds = _kinds(codes)
    kinds[codes == _BYTE_ORDER_MARK] = _DROPPED
    text = np.flatnonzero(kinds == _TEXT)
    newline = (kinds == _NEWLINE) | (kinds == _BREAK)
    newline[1:] &= ~((codes[1:] == 0x0A) & (codes[:-1] == 0x0D))
    if text.size == 0:
        line_ends = np.flatnonzero(newline)[-1:] + 1
        return Split([], int(line_ends.sum()) if keep_lines else codes.size, continues, item)
    newlines = _between(newline, text)
    ended = final
    codes = codes.copy()
    for space in _NO_BREAK_SPACES:
        codes[codes == space] = NO_BREAK_SPACE
    if keep_lines:
        keep = _keep_blanks(kinds)
        codes[keep & (kinds == _BLANK)] = SPACE
        ends = newlines > 0
        line_starts = np.maximum.accumulate(
            np.where(newline | (codes == 0x0A), np.arange(codes.size), -1)
        )
        starts = line_starts[text] + 1
        empty = newlines > 1
    else:
        ends = (newlines > 1) | (_between(kinds == _BREAK, text) > 0)
        item = _end_before_items(ends, codes, text, newlines, None if not continues else item)
        after = slice(text[-1], None)
        ended = final or newline[after].sum() > 1 or (kinds[after] == _BREAK).any()
        gaps = np.flatnonzero((_between((kinds != _TEXT) & (kinds != _DROPPED), text) > 0) & ~ends)
        spaces = text[gaps] + 1
        spaces = spaces[~_joins_words(codes, text, gaps, newlines)]
        codes[spaces] = SPACE
        keep = kinds == _TEXT
        keep[spaces] = True
        starts = text
        empty = np.zeros(text.size - 1, bool)
    kept = np.flatnonzero(keep)
    own, source = codes[kept], stretch.place(kept)
    seen = np.zeros(int(own.max()) + 1, np.bool_)
    seen[own] = True
    alphabet = frozenset(np.flatnonzero(seen).tolist())
    accents = not alphabet.isdisjoint(_COMBINING)

    def paragraph(start: int, end: int, continues: bool) -> Paragraph:
        part = slice(start, end)
        piece = Paragraph(own[part], source[part], int(source[end - 1]) + 1, continues, alphabet)
        return _compose(piece) if accents else piece

    last = np.flatnonzero(ends)
    begin = np.concatenate((starts[:1], starts[last + 1]))
    stop = np.concatenate((text[last] + 1, text[-1:] + 1))
    bounds = np.searchsorted(kept, [begin, stop]).T.tolist()
    is_empty = [*empty[last].tolist(), False]
    paragraphs: list[Paragraph] = []
    for n, (start, end) in enumerate(bounds):
        complete = ended or n < len(bounds) - 1
        rest = start
        for cut in _cuts(codes, kept, start, end if complete else end - _LOOK_AHEAD):
            paragraphs.append(paragraph(rest, cut, continues))
            rest, continues = cut, True
        if not complete:
            used = int(begin[-1]) if rest == start else int(kept[rest])
            return Split(paragraphs, used, continues, item if continues else 0)
        paragraphs.append(paragraph(rest, end, continues))
        continues = False
        if is_empty[n]:
            nothing = np.empty(0, np.int64)
            at = int(stretch.place(stop[n] - 1)) + 1
            paragraphs.append(Paragraph(nothing.astype(np.uint32), nothing, at, False, alphabet))
    return Split(paragraphs, codes.size, continues=False)


def _kinds(codes: NDArray[np.uint32]) -> NDArray[np.uint8]:
    """Kind of each character: text, blank, newline, break, or one that is dropped."""
    return _KINDS[np.minimum(codes, _KINDS.size - 1)]


def _between(marked: NDArray[np.bool_], text: NDArray[np.intp]) -> NDArray[np.intp]:
    """How many marked characters stand between each two neighbouring text characters."""
    return np.diff(np.cumsum(marked)[text])


def _keep_blanks(kinds: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Text, and the blanks that have text after them on their line."""
    places = np.arange(kinds.size)
    text = np.where(kinds == _TEXT, places, kinds.size)
    newline = np.where((kinds == _NEWLINE) | (kinds == _BREAK), places, kinds.size)
    next_text = np.minimum.accumulate(text[::-1])[::-1]
    next_newline = np.minimum.accumulate(newline[::-1])[::-1]
    return (kinds == _TEXT) | ((kinds == _BLANK) & (next_text < next_newline))


def _joins_words(
    codes: NDArray[np.uint32],
    text: NDArray[np.intp],
    gaps: NDArray[np.intp],
    newlines: NDArray[np.intp],
) -> NDArray[np.bool_]:
    """Whether a line break stands within a word, after its hyphen, so that no space belongs there.

    After a soft hyphen always; after a hyphen between letters, but for a
    hyphen that stands for the rest of a word ("pre- and post-war").
    """
    joins = (codes[text[gaps] + 1] == 0xAD) & (newlines[gaps] == 1)
    hyphens = np.isin(codes[text[gaps]], (0x2D, 0x2010)) & (newlines[gaps] == 1)
    for n in np.flatnonzero(hyphens):
        at, after = text[gaps[n]], text[gaps[n] + 1]
        word = to_text(codes[after : after + _WORD])
        within = at > 0 and chr(codes[at - 1]).isalnum() and word[0].isalnum()
        joins[n] |= within and word.split(maxsplit=1)[0] not in _SUSPENDED
    return joins


def _end_before_items(
    ends: NDArray[np.bool_],
    codes: NDArray[np.uint32],
    text: NDArray[np.intp],
    newlines: NDArray[np.intp],
    item: int | None,
) -> int:
    """Mark that paragraphs end where the next line begins an item of a list.

    A bullet always begins one. A dash does in a list of dashes, and a number in its turn; the
    first of either stands at a paragraph's start or after a colon, and so may a number 1
    anywhere: a line of prose, too, can begin with a dash or with a number that ends a sentence.

    Parameters
    ----------
    ends : bool[n]
        Whether a paragraph ends after each character of ``text`` but the last; changed here.
    item
        Number of the list item that the first paragraph is in; None if it begins here.

    Returns
    -------
    int
        Number of the list item that the last paragraph is, or -2 in a list of dashes; else 0.
    """
    starts = np.concatenate(([-1], np.flatnonzero((newlines > 0) | ends)))
    at = text[starts + 1]
    following = codes[np.minimum(at + 1, codes.size - 1)]
    leads = np.isin(codes[at], _LEADS) | (following == ord(")"))
    blank_lines = np.flatnonzero(ends)
    block, item_now = 0, item or 0
    for start in starts[leads].tolist():
        begins = bool(ends[start]) if start >= 0 else item is None
        here = int(np.searchsorted(blank_lines, start, "right"))
        if here != block:
            block, item_now = here, 0
        found = _MARKER.match(to_text(codes[text[start + 1] : text[start + 1] + _LONGEST_MARKER]))
        if found is None or (start < 0 and item is not None):
            continue
        if found["number"]:
            number = int(found["number"])
        elif found["letter"]:
            number = ord(found["letter"]) - ord("a") + 1
        else:
            number = _BULLET if found["bullet"] else _DASH
        expected = number in (_BULLET, 1, item_now + 1 if item_now >= 0 else item_now)
        if begins or expected or codes[text[start]] == ord(":"):
            item_now = number
            if start >= 0:
                ends[start] = True
    return item_now if block == blank_lines.size else 0


def _cuts(codes: NDArray[np.uint32], kept: NDArray[np.intp], start: int, end: int) -> Iterator[int]:
    """Where to cut a paragraph that is too long: after a sentence, else a space, else anywhere."""
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


def _compose(paragraph: Paragraph) -> Paragraph:
    """Make letters with combining accents one character where Unicode has one.

    Many tables know é and not e followed by U+0301.
    """
    if _COMBINING.isdisjoint(paragraph.codes.tolist()):
        return paragraph
    composed: list[str] = []
    places: list[int] = []
    for character, place in zip(paragraph.text, paragraph.source.tolist(), strict=True):
        together = ""
        if composed and ord(character) in _COMBINING:
            together = unicodedata.normalize("NFC", composed[-1] + character)
        if len(together) == 1:
            composed[-1] = together
        else:
            composed.append(character)
            places.append(place)
    codes = to_codes("".join(composed))
    return Paragraph(
        codes,
        np.array(places, np.int64),
        paragraph.end,
        paragraph.continues,
        frozenset(codes.tolist()),
    )
