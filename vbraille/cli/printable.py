"""What may be sent to a terminal: nothing that moves its cursor or changes how it works."""

from __future__ import annotations

_CONTROLS = {code: f"\\x{code:02x}" for code in (*range(0x20), *range(0x7F, 0xA0))}


def printable(text: str) -> str:
    r"""Text whose control characters are spelled ``\xhh``: a book may hold any, and so may a name.

    A line break, too, is one.
    """
    return text.translate(_CONTROLS)
