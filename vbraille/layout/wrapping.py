"""Cells broken into lines, as full as they can be, by the rules of their script."""

from __future__ import annotations

import re
import unicodedata
from bisect import bisect_right
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    # Gives the cells that end a line within a word, and those that begin the next.
    Divide = Callable[[int, bytes], tuple[bytes, bytes]]

_SOLID = 0xFF  # in a search for blanks: a cell at which a line must not break
_NO_BREAK_SPACE = "\u00a0"
# Scripts that are written without spaces: Thai, Lao, Tibetan, Burmese, Khmer, kana and Han.
_SPACELESS = re.compile(
    "[\u0e01-\u0fff\u1000-\u109f\u1780-\u17ff\u3001-\u30ff\u3400-\u9fff\uff01-\uff65]"
)
_OPENING = frozenset("([{「『（《〈【〔“‘«เแโใไເແໂໃໄ")
_CLOSING = frozenset(
    ")]}」』）》〉】〕”’»,.;:!?，。、．；：！？·・ーぁぃぅぇぉっゃゅょゎァィゥェォッャュョヮ々ๆໆ។៕ៗฯ།"
)
_JOINERS = frozenset("\u17d2\u1039\u103a\u0f84\u200d")  # what stacks the next letter below


class Piece(NamedTuple):
    """Part of a run of cells that is a line.

    Attributes
    ----------
    start, stop : int
        Cells of the run, as [start, stop).
    indent : int
        Number of blank cells before them.
    before, after : bytes
        Cells that are put before and after them, where a word or a number had to be cut.
    """

    start: int
    stop: int
    indent: int
    before: bytes = b""
    after: bytes = b""


def wrap(
    masks: bytes,
    starts: Sequence[int],
    text: str,
    width: int,
    indent: int = 0,
    runover: int = 0,
    divide: Divide | None = None,
) -> list[Piece]:
    """Break a block into lines.

    The cells of one character stay together, if need be at the cost of the indent. A word is cut
    only where it is longer than a line, and a text without spaces only where a line may begin.

    Parameters
    ----------
    masks
        Dots of each cell; a line may break at those without any.
    starts
        Character of the text that each cell stands for, never decreasing.
    text
        The text.
    width
        Number of cells in a line.
    indent, runover
        Numbers of blank cells before the first line and before the others; less than the width.
    divide
        Function that is called with the character at which a word is cut and the cells from there
        on; None where words are cut without a sign.
    """
    breaks = _breaks(masks, starts, text)
    end = len(breaks)
    leading = end - len(breaks.lstrip(b"\0"))
    if leading == end:
        return [Piece(0, 0, 0)]
    # Deep indents of the source's own must leave room for words: half a line, and the first whole.
    word = len(breaks[leading:].split(b"\0", 1)[0])
    start = leading - min(leading, width // 2, max(0, width - indent - word))
    ends = _ends(breaks, starts, text)
    pieces, before = [], b""
    while end - start > width - indent - len(before):
        full = start + width - indent - len(before)
        last = bisect_right(ends, (full, end)) - 1
        stop, following = ends[last] if last >= 0 else (start, start)
        after, begin = b"", b""
        if stop <= start:
            own = bisect_right(starts, starts[start], start) - start
            if indent and full - start < own <= width:
                indent = width - own  # without so much of an indent, its cells stay together
                continue
            stop = _within_word(starts, start, full - (divide is not None and full - start > 2))
            if divide is not None and full - stop > 0 and starts[stop - 1] != starts[stop]:
                after, begin = divide(starts[stop], masks[stop:end].split(b"\0", 1)[0])
            stop, following = _around(breaks, start, stop)
        pieces.append(Piece(start, stop, indent, before, after))
        start, indent, before = following, runover, begin
    if start < end:
        pieces.append(Piece(start, end, indent, before))
    return pieces


def _breaks(masks: bytes, starts: Sequence[int], text: str) -> bytes:
    """Cells as bytes that are zero where a line may break: at blanks, but for no-break spaces."""
    if _NO_BREAK_SPACE not in text:
        return masks
    return bytes(
        _SOLID if not mask and text[place] == _NO_BREAK_SPACE else mask
        for mask, place in zip(masks, starts, strict=True)
    )


def _ends(breaks: bytes, starts: Sequence[int], text: str) -> list[tuple[int, int]]:
    """Places where a line may end: one past its last cell, and the cell where the next begins."""
    ends = set()
    for blank in re.finditer(rb"\0+", breaks):
        stop, following = blank.span()
        if following == len(breaks) or (
            stop > 0 and _parts(text, starts[stop - 1], starts[following])
        ):
            ends.add((stop, following))
    if _SPACELESS.search(text):
        for at in range(1, len(breaks)):
            if starts[at - 1] != starts[at] and _may_begin(text, starts[at]):
                ends.add(_around(breaks, 0, at))
    return sorted(ends)


def _parts(text: str, before: int, after: int) -> bool:
    """Tell whether a line may end between the cells of two characters, where a blank is.

    The blank may be within the cells of one, or be the table's own before a closing mark.
    """
    own = text[after] in _CLOSING and not text[before + 1 : after] and not text[before].isspace()
    return before != after and not own


def _may_begin(text: str, place: int) -> bool:
    """Tell whether a line of a script without spaces may begin at a character."""
    before, after = text[place - 1], text[place]
    if not (_SPACELESS.match(before) or _SPACELESS.match(after)):
        return False
    is_mark = unicodedata.category(after)[0] == "M"
    return not (is_mark or after in _CLOSING or before in _OPENING or before in _JOINERS)


def _within_word(starts: Sequence[int], start: int, full: int) -> int:
    """Cell at which a word is cut: where a character begins, or else where the line is full."""
    at = full
    while at > start and starts[at - 1] == starts[at]:
        at -= 1
    return at if at > start else full


def _around(breaks: bytes, start: int, at: int) -> tuple[int, int]:
    """One past the last cell before a place that is not blank, and the first such cell after it."""
    stop = start + len(breaks[start:at].rstrip(b"\0"))
    return stop, len(breaks) - len(breaks[at:].lstrip(b"\0"))
