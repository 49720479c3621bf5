"""Markers of the items of lists: bullets, and numbers in all their forms."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from vbraille.translate.trees import Element

BULLET = "• "
MOST = 1_000  # columns, rows or blanks that are one
_ROMAN = re.findall(r"([a-z]+)(\d+)", "m1000 cm900 d500 cd400 c100 xc90 l50 xl40 x10 ix9 v5 iv4 i1")


def numeral(number: int, form: str) -> str:
    """Number of an item: in letters (a, A), in Roman numerals (i, I), with a zero (01), or plain.

    >>> numeral(28, "a"), numeral(14, "I"), numeral(3, "01"), numeral(0, "a")
    ('ab', 'XIV', '03', '0')
    """
    if form in ("a", "A") and number > 0:
        letters = ""
        while number > 0:
            number, letter = divmod(number - 1, 26)
            letters = chr(ord(form) + letter) + letters
        return letters
    if form in ("i", "I") and 0 < number < 4000:
        text = ""
        for letters, value in _ROMAN:
            times, number = divmod(number, int(value))
            text += letters * times
        return text.upper() if form == "I" else text
    return f"{number:02}" if form == "01" else str(number)


def whole(text: str | None, otherwise: int = 1) -> int:
    """Number that an attribute says; another if it says none."""
    return int(text) if text and re.fullmatch(r"\s*-?\d{1,6}\s*", text) else otherwise


class Level(NamedTuple):
    """A level of a list.

    Parameters
    ----------
    form
        Form of its numbers, as of `numeral`, or "bullet", or "none".
    text
        Text around its number, such as "%1.%2)".
    start
        Number of its first item.
    legal
        Whether the numbers of all levels are plain in it.
    step
        What is added for each item.
    """

    form: str = "bullet"
    text: str = "•"
    start: int = 1
    legal: bool = False
    step: int = 1


def counted(text: str) -> int:
    """Number of things that an attribute says, at least one and not more than a book has."""
    return min(max(whole(text), 1), MOST)


@dataclass(slots=True)
class Numbering:
    """Counts the items of a list.

    Parameters
    ----------
    levels
        Levels of the list.
    counts
        Numbers of the last items, by levels; lists that count on from each other share them.
    starts
        Numbers with which levels begin anew when they are first come to.
    """

    levels: dict[int, Level] = field(default_factory=dict)
    counts: dict[int, int] = field(default_factory=dict)
    starts: dict[int, int] = field(default_factory=dict)

    def restart(self, at: int) -> None:
        """Begin a level anew, and those within it."""
        for level in [level for level in self.counts if level >= at]:
            del self.counts[level]

    def marker(self, at: int = 0, said: str | None = None) -> str:
        """Count an item of a level, or take the number that it says; give what stands before it."""
        level = self.levels.get(at, Level())
        following = self.counts.get(at, level.start - level.step) + level.step
        number = whole(said, self.starts.pop(at, following))
        self.restart(at)
        self.counts[at] = number
        if level.form == "bullet" and level.text.strip():
            return BULLET
        if level.form in ("bullet", "none"):
            return ""
        label = level.text
        for place in range(9):
            one = self.levels.get(place, level)
            shown = numeral(self.counts.get(place, one.start), "1" if level.legal else one.form)
            label = label.replace(f"%{place + 1}", shown)
        return f"{label.strip()} " if label.strip() else ""


def html_list(element: Element) -> Numbering:
    """Numbering of a list of HTML or DTBook."""
    style = element.get("style")
    is_daisy = element.name == "list"
    kind = element.get("type", "pl") if is_daisy else element.name
    if "none" in style or kind == "pl":
        return Numbering({0: Level("none")})
    if kind in ("ul", "menu"):
        return Numbering()
    form = element.get("enum" if is_daisy else "type", "1")
    step = -1 if "reversed" in element.attributes else 1
    first = sum(child.name == "li" for child in element.elements) if step < 0 else 1
    return Numbering({0: Level(form, "%1.", whole(element.get("start"), first), step=step)})
