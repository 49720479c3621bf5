"""Characters into paragraphs: lines joined, white space folded, every place remembered."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.documents.codepoints import (
    BLANK,
    BREAK,
    DROPPED,
    NEWLINE,
    TEXT,
    Words,
    kinds_of,
)
from vbraille.translate.source import Block, BlockKind
from vbraille.translate.text import NO_BREAK_SPACE, SPACE, Text, to_codes, to_text

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from vbraille.translate.documents.codepoints import Stretch

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
    """What `split_paragraphs` made of a stretch of characters.

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
    """Whether a line break stands within a word, after a hyphen, so that no space belongs there.

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
