"""Numbers and letters before the items of a list."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

BULLET = "• "
_STYLES = {
    "decimal": "1",
    "decimal-leading-zero": "1",
    "lower-alpha": "a",
    "lower-latin": "a",
    "upper-alpha": "A",
    "upper-latin": "A",
    "lower-roman": "i",
    "upper-roman": "I",
}
_ROMANS = (
    (1000, "m"),
    (900, "cm"),
    (500, "d"),
    (400, "cd"),
    (100, "c"),
    (90, "xc"),
    (50, "l"),
    (40, "xl"),
    (10, "x"),
    (9, "ix"),
    (5, "v"),
    (4, "iv"),
    (1, "i"),
)


@dataclass(slots=True)
class Numbering:
    """How the items of a list that is being read are numbered.

    Parameters
    ----------
    style
        Style of the numbers: "1", "a", "A", "i" or "I"; "•" for bullets, empty for nothing.
    number
        Number of the next item.
    step
        What is added to the number from item to item.
    """

    style: str
    number: int = 1
    step: int = 1

    def marker(self, attributes: Mapping[str, str]) -> str:
        """Text before the next item, which has these attributes."""
        if not self.style:
            return ""
        if self.style == "•":
            return BULLET
        self.number = whole(attributes.get("value"), self.number)
        number, self.number = self.number, self.number + self.step
        return f"{numeral(number, attributes.get('type') or self.style)}. "


def numbering_of(name: str, attributes: Mapping[str, str]) -> Numbering:
    """Numbering of the list that an element begins."""
    style = attributes.get("style", "")
    numbering = "1" if name == "ol" else "•"
    if "list-style" in style:
        words = style.partition("list-style")[2].partition(";")[0].replace(":", " ").split()
        if "none" in words:
            return Numbering("")
        numbering = next((_STYLES[word] for word in words if word in _STYLES), numbering)
    if name != "ol":
        return Numbering(numbering)
    numbering = attributes.get("type") or attributes.get("enum") or numbering
    if numbering not in {"1", "a", "A", "i", "I"}:
        numbering = "1"
    if "reversed" not in attributes:
        return Numbering(numbering, whole(attributes.get("start"), 1))
    # How many items a list has, from which it would count down, is not known where it begins.
    if "start" not in attributes:
        return Numbering("•")
    return Numbering(numbering, whole(attributes.get("start"), 1), -1)


def whole(text: str | None, otherwise: int) -> int:
    """Whole number of an attribute; the other value if it has none of at most nine digits."""
    digits = (text or "").strip()
    plain = digits.removeprefix("-")
    return int(digits) if plain.isascii() and plain.isdigit() and len(plain) < 10 else otherwise


def numeral(number: int, numbering: str) -> str:
    """Numeral of a list's item.

    >>> [numeral(28, numbering) for numbering in "1aAiI"]
    ['28', 'ab', 'AB', 'xxviii', 'XXVIII']
    """
    if numbering in "aA" and number > 0:
        letters = ""
        while number:
            number, letter = divmod(number - 1, 26)
            letters = chr(ord(numbering) + letter) + letters
        return letters
    if numbering in "iI" and 0 < number < 4000:
        roman = ""
        for value, sign in _ROMANS:
            roman += sign * (number // value)
            number %= value
        return roman if numbering == "i" else roman.upper()
    return str(number)
