"""Names of people, conditions and items: which are the same, and in which order they are listed."""

from __future__ import annotations

import re
import unicodedata
from decimal import Decimal
from typing import TYPE_CHECKING

from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")
_PLAIN_NUMBER = re.compile(r"\d+(?:[.,]\d+)?|[.,]\d+")
_DASHES = dict.fromkeys(map(ord, "‐‑‒–—−"), "-")
_INVISIBLE = ("Cf", "Cc")
_VARIATIONS = dict.fromkeys(range(0xFE00, 0xFE10))


def visible(name: str) -> str:
    """Return a name composed (NFC), without invisible marks and double blanks."""
    shown = " ".join(name.split())
    if shown.isascii() and shown.isprintable():
        return shown
    shown = "".join(each for each in shown if unicodedata.category(each) not in _INVISIBLE)
    return unicodedata.normalize("NFC", shown.translate(_VARIATIONS)).strip()


def likeness(name: str, *, person: bool = False) -> str:
    """Return what all spellings of a name share.

    Case, width, blanks, the kind of a dash, leading zeros and 1.0 do not count.

    Parameters
    ----------
    person
        Whether the name is a pseudonym, in which blanks, hyphens and the like do not count either.

    >>> likeness("Ｐ001"), likeness("p 1"), likeness("T0.50"), likeness("T0,5"), likeness("t.5")
    ('p1', 'p1', 't0.5', 't0.5', 't0.5')
    """
    plain = unicodedata.normalize("NFKC", visible(name).translate(_DASHES)).casefold()
    plain = _PLAIN_NUMBER.sub(_shortest, plain).replace(" ", "")
    return re.sub(r"[\W_]+", "", plain) if person else plain


def _shortest(match: re.Match[str]) -> str:
    return format(Decimal(match.group().replace(",", ".")).normalize(), "f")


def check_alike(names: Iterable[str], what: str) -> None:
    """Refuse different spellings that look like one name.

    Parameters
    ----------
    what
        What the names are names of, such as "participant".

    Raises
    ------
    InputError
        If two are alike; the sentence names both.
    """
    seen: dict[str, str] = {}
    for name in dict.fromkeys(names):
        other = seen.setdefault(likeness(name, person=what == "participant"), name)
        if other != name:
            raise InputError(
                f"{what} {other!r} and {name!r} look like one; spell them alike, or give them "
                f"names that differ by more than zeros, capitals and signs"
            )


def natural(name: str) -> tuple[list[str], list[float]]:
    """Return a key that sorts names as people do: T0, T25, T100.

    >>> sorted(["T100", "T25", "T0"], key=natural)
    ['T0', 'T25', 'T100']
    """
    words = [word.casefold() for word in _NUMBER.split(name)]
    return words, [float(number.replace(",", ".")) for number in _NUMBER.findall(name)]
