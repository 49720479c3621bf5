"""Items of lists in plain text: which lines begin one."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from vbraille.translate.text import to_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.translate.documents.words import Words

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
