"""The table ``[rules]`` of a protocol: what the finished plan is checked for."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

from vbraille.braille.spelling import LETTERS
from vbraille.errors import check_range
from vbraille.sessions.planning.design import MOST_TRIALS
from vbraille.toml.tomlfile import Table

if TYPE_CHECKING:
    from collections.abc import Iterable


class Rules(Table, frozen=True):
    """Rules that a plan must follow beside its design.

    Parameters
    ----------
    each_letter
        Exact number of times that each letter of the alphabet is shown in each condition; None
        for any number.
    each_letter_at_least
        Least number of times that each letter is shown in each condition; None for any number.
    never_twice_running
        Whether no two neighbouring trials may show the same. Two trials show the same if they
        have the same string, the same cells in any order where cells are reordered, or the same
        two values in the same order.
    at_most_running
        Largest number of neighbouring trials that may have the same level of a factor, by the
        factor's name; "condition" stands for the conditions, and a column of the items' file for
        itself.
    balanced_quarters
        Whether each quarter of the test has each condition equally often, as far as numbers allow.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    each_letter: int | None = None
    each_letter_at_least: int | None = None
    never_twice_running: bool = False
    at_most_running: dict[str, int] = {}  # noqa: RUF012  (msgspec copies an empty default)
    balanced_quarters: bool = False

    def __post_init__(self) -> None:
        check_range("each_letter", self.each_letter, 1, MOST_TRIALS)
        check_range("each_letter_at_least", self.each_letter_at_least, 1, MOST_TRIALS)
        for most in self.at_most_running.values():
            check_range("at_most_running: one", most, 1, MOST_TRIALS)

    @property
    def searched(self) -> bool:
        """Whether an order that keeps the rules must be searched for."""
        return bool(self.at_most_running) or self.balanced_quarters

    def problem(self, lines: Iterable[tuple[int, ...]]) -> str:
        """Sentence about a letter that is shown too often or too seldom; empty if all is right."""
        shown = Counter(mask for masks in lines for mask in masks)
        for letter, mask in LETTERS.items():
            if self.each_letter not in (None, shown[mask]):
                return f"{letter} is shown {_times(shown[mask])}; each_letter is {self.each_letter}"
            if shown[mask] < (self.each_letter_at_least or 0):
                return (
                    f"{letter} is shown {_times(shown[mask])}; "
                    f"each_letter_at_least is {self.each_letter_at_least}"
                )
        return ""


def _times(number: int) -> str:
    return "once" if number == 1 else f"{number} times"
