"""Markers of the items of lists: bullets, and numbers in all their forms."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.translate.trees import Element

BULLET = "• "
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


def list_markers(element: Element) -> Callable[[Element], str]:
    """Make what gives the number or bullet of each item of a list of HTML or DTBook."""
    style = (element.get("style") + element.get("list-style-type")).replace(" ", "")
    is_daisy = element.name == "list"
    kind = element.get("type", "pl") if is_daisy else element.name
    if "none" in style or kind == "pl":
        return lambda _: ""
    if kind in ("ul", "menu"):
        return lambda _: BULLET
    form = element.get("enum" if is_daisy else "type", "1")
    step = -1 if "reversed" in element.attributes else 1
    items = sum(child.name == "li" for child in element.elements)
    following = whole(element.get("start"), items if step < 0 else 1)

    def marker(item: Element) -> str:
        nonlocal following
        number = whole(item.get("value"), following)
        following = number + step
        return f"{numeral(number, form)}. "

    return marker
