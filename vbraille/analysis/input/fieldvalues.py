"""What one field of a table says; a ValueError tells why it says nothing."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING

from vbraille.analysis.statistics.intervals import LARGEST
from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import LETTERS, UNREAD, to_braille

if TYPE_CHECKING:
    from collections.abc import Callable

UNKNOWN = frozenset(("", "n/a", "na", "nan"))  # a value that is not known, in any case
_PAIR = re.compile(r"\s*([0-9.,]+)\s+([0-9.,]+)\s*")
_CELLS = {
    UNREAD: UNREAD,
    **{chr(UNICODE_BLANK + mask): chr(UNICODE_BLANK + mask) for mask in range(256)},
    **{letter: to_braille((mask,)) for letter, mask in LETTERS.items()},
    **{letter.upper(): to_braille((mask,)) for letter, mask in LETTERS.items()},
}


def parse_cells(text: str) -> str:
    """Unicode braille of a string as a table has it: Unicode braille, or letters.

    Raises
    ------
    ValueError
        If something is no cell.
    """
    try:
        return "".join([_CELLS[place] for place in text.strip()])
    except KeyError as error:
        raise ValueError(
            f"is {text.strip()!r}, and {error.args[0]!r} is no cell; give letters a to z or "
            f"Unicode braille, with {UNREAD} for a place not read"
        ) from None


def parse_presented(text: str) -> str:
    """Unicode braille of what was shown, in which no place may be marked as unread."""
    cells = parse_cells(text)
    if not cells or UNREAD in cells:
        raise ValueError(f"is {text!r}; give the cells that were shown")
    return cells


def parse_name(text: str) -> str:
    """A name, which must not be empty."""
    if not text.strip():
        raise ValueError("is empty; name it")
    return text.strip()


def parse_whole(text: str) -> int:
    """A whole number; 0 if it is not known."""
    if text.strip().lower() in UNKNOWN:
        return 0
    if not re.fullmatch(r"[0-9]{1,9}(\.0)?", text.strip()):
        raise ValueError(f"is {text!r}; give a whole number from 1")
    return int(float(text))


def parse_seconds(text: str, *, number: Callable[[str], float]) -> float:
    """Seconds; NaN if they are not known.

    Parameters
    ----------
    number
        Function that gives the value of a number's text.
    """
    if text.strip().lower() in UNKNOWN:
        return math.nan
    try:
        seconds = number(text)
    except ValueError:
        seconds = -1.0
    if not 0 <= seconds <= LARGEST:
        raise ValueError(f"is {text!r}; give seconds, or nothing if they are not known")
    return seconds


def is_pair(presented: str) -> bool:
    """Whether two values were presented, and not a string of cells."""
    return _PAIR.fullmatch(presented) is not None


def parse_pair(
    presented: str, answered: str, *, number: Callable[[str], float]
) -> tuple[float, float, int]:
    """First and second of two values, and which was chosen: 0 or 1.

    Parameters
    ----------
    number
        Function that gives the value of a number's text.
    """
    found = _PAIR.fullmatch(presented)
    try:
        first, second = map(number, found.groups() if found else ("", ""))
        chosen = number(answered)
    except ValueError:
        first = second = chosen = math.inf
    if first == second or chosen not in (first, second) or max(first, second) > LARGEST:
        raise ValueError(
            f"presented is {presented!r} and answered {answered!r}; a comparison presents two "
            f"values, such as 1.5 2, and is answered by one of them"
        )
    return first, second, int(chosen == second)
