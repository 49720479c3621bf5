"""Words from outside, as pages and pictures can have them."""

from __future__ import annotations

import re

# Where a line ends, and the tab: a space does in a line.
_BREAKS = re.compile("[\t-\r\x1c-\x1e\x85\u2028\u2029]+")
# Neither XML nor HTML has these: controls, halves of characters, what is no character.
# What turns the direction of the text around it is no better.
_UNFIT = re.compile(
    "[\0-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufdd0-\ufdef"
    + "".join(chr(plane << 16 | 0xFFFE) + chr(plane << 16 | 0xFFFF) for plane in range(17))
    + "]"
)


def plain(text: str) -> str:
    """Text on one line; what no page can have is spelled, as Python does."""
    return _UNFIT.sub(_spell, _BREAKS.sub(" ", text))


def _spell(found: re.Match[str]) -> str:
    code = ord(found[0])
    if code < 0x100:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
