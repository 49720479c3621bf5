"""Text from outside, made fit for pages and pictures."""

from __future__ import annotations

import re

# Ends of lines and the tab become a space.
_BREAKS = re.compile("[\t-\r\x1c-\x1e\x85\u2028\u2029]+")
# Characters that XML and HTML forbid: controls, lone surrogates, noncharacters.
# So are those that turn the direction of the text around them.
_UNFIT = re.compile(
    "[\0-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufdd0-\ufdef"
    + "".join(chr(plane << 16 | 0xFFFE) + chr(plane << 16 | 0xFFFF) for plane in range(17))
    + "]"
)


def plain(text: str) -> str:
    """Put a text on one line; what no page can show is spelled as Python spells it."""
    return _UNFIT.sub(lambda found: ascii(found[0])[1:-1], _BREAKS.sub(" ", text))
