"""What is shown in each condition of a session, and how often; which conditions there are."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from itertools import permutations, product
from typing import TYPE_CHECKING

from vbraille.braille.spelling import LETTERS, name_dots, to_braille
from vbraille.sessions.planning.conduct import check_name, check_range

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.render import Tuning

MOST_TRIALS = 10_000
PARAMETERS = ("dot_width_mm", "dot_gap_mm")

_LEFT_DOTS, _RIGHT_DOTS = 0b01000111, 0b10111000


@dataclass(frozen=True, slots=True)
class Combinations:
    """Every combination of some cells.

    Parameters
    ----------
    characters
        Dot masks of the cells.
    length
        Cells of a combination.
    before, after
        Dot masks of the delimiters: shown, but not asked for.
    repeats
        Of each combination, in each condition.

    Raises
    ------
    ValueError
        If a number is out of range, a cell stands twice, or nothing raised
        would be shown.
    """

    characters: tuple[int, ...]
    length: int
    before: tuple[int, ...] = ()
    after: tuple[int, ...] = ()
    repeats: int = 1

    def __post_init__(self) -> None:
        check_range("length", self.length, 1, 100)
        check_range("repeats", self.repeats, 1, MOST_TRIALS)
        if not self.characters:
            raise ValueError("characters are none; give one or more")
        _check_distinct("characters have", map(name_dots, self.characters))
        if 0 in self.characters and not any(self.before + self.after):
            raise ValueError(
                "a combination is all blank, and nothing can be felt of it; give before and after"
            )

    @property
    def trials(self) -> int:
        """Trials of each condition."""
        return len(self.characters) ** self.length * self.repeats

    @property
    def cells(self) -> int:
        """Cells of the longest line."""
        return len(self.before) + self.length + len(self.after)

    @property
    def masks(self) -> frozenset[int]:
        """All cells that are shown."""
        return frozenset(self.before + self.characters + self.after)

    def items(self) -> list[tuple[int, ...]]:
        """Cells asked for in the trials of a condition, in the order of the design."""
        return list(product(self.characters, repeat=self.length)) * self.repeats


@dataclass(frozen=True, slots=True)
class StringList:
    """Strings of a list.

    Parameters
    ----------
    strings
        Dot masks of each.
    reorder
        Whether the cells of a string come in another order at each showing.
    repeats
        Of each string, in each condition.

    Raises
    ------
    ValueError
        If a number is out of range, or a string shows nothing raised.
    """

    strings: tuple[tuple[int, ...], ...]
    reorder: bool = False
    repeats: int = 1

    def __post_init__(self) -> None:
        check_range("repeats", self.repeats, 1, MOST_TRIALS)
        if not self.strings:
            raise ValueError("strings are none; give one or more")
        for number, masks in enumerate(self.strings, 1):
            if not any(masks):
                raise ValueError(
                    f"strings, number {number}, has no dots, and nothing can be felt of it; "
                    f"give it a cell with some"
                )

    @property
    def trials(self) -> int:
        """Trials of each condition."""
        return len(self.strings) * self.repeats

    @property
    def cells(self) -> int:
        """Cells of the longest line."""
        return max(map(len, self.strings))

    @property
    def masks(self) -> frozenset[int]:
        """All cells that are shown."""
        return frozenset(mask for masks in self.strings for mask in masks)

    def items(self) -> list[tuple[int, ...]]:
        """Cells of the trials of a condition, in the order of the design."""
        return list(self.strings) * self.repeats

    def listed(self, masks: tuple[int, ...]) -> tuple[int, ...] | None:
        """String of the list that these cells are an order of; None if none is, or none changes."""
        if not self.reorder:
            return None
        cells = sorted(masks)
        return next((string for string in self.strings if sorted(string) == cells), None)


@dataclass(frozen=True, slots=True)
class Choice:
    """Pairs of one string at two values of a parameter.

    Parameters
    ----------
    parameter
        One of `PARAMETERS`; ``dot_gap_mm`` is from edge to edge between the two
        dots of a cell.
    values
        To compare.
    string
        Dot masks of what is shown at both.
    repeats
        Of each ordered pair of different values, in each condition.

    Raises
    ------
    ValueError
        If a number is out of range, there are no two different values, or the
        string does not show the parameter.
    """

    parameter: str
    values: tuple[float, ...]
    string: tuple[int, ...]
    repeats: int = 1

    def __post_init__(self) -> None:
        check_range("repeats", self.repeats, 1, MOST_TRIALS)
        if self.parameter not in PARAMETERS:
            raise ValueError(f"parameter is {self.parameter}; it must be {' or '.join(PARAMETERS)}")
        if len(self.values) < 2:
            raise ValueError(f"values are {len(self.values)}; give two or more to compare")
        _check_distinct("values have", (f"{value:.15g}" for value in self.values))
        for value in self.values:
            check_range("a value", value, 0, 50, " mm")
        if not any(self.string):
            raise ValueError("string has no dots; give one with some")
        both = any(mask & _LEFT_DOTS and mask & _RIGHT_DOTS for mask in self.string)
        if self.parameter == "dot_gap_mm" and not both:
            raise ValueError("string has no cell with a gap; give one with a left and a right dot")

    @property
    def trials(self) -> int:
        """Trials of each condition."""
        return len(self.values) * (len(self.values) - 1) * self.repeats

    @property
    def cells(self) -> int:
        """Cells of the line."""
        return len(self.string)

    @property
    def masks(self) -> frozenset[int]:
        """All cells that are shown."""
        return frozenset(self.string)

    def items(self) -> list[tuple[float, ...]]:
        """Values of the first and the second stimulus in the trials of a condition."""
        return list(permutations(self.values, 2)) * self.repeats


Design = Combinations | StringList | Choice


@dataclass(frozen=True, slots=True)
class Condition:
    """What a design is shown with.

    Parameters
    ----------
    name
        Of the condition.
    tuning
        What it is shown with.
    own
        Names of those values of the tuning that the condition itself gives;
        the others are the display's.

    Raises
    ------
    ValueError
        If the name cannot be used.
    """

    name: str
    tuning: Tuning
    own: frozenset[str] = field(default_factory=frozenset)

    def __post_init__(self) -> None:
        check_name("name", self.name)


@dataclass(frozen=True, slots=True)
class Rules:
    """What a plan must keep beside its design.

    Parameters
    ----------
    each_letter
        How often each letter of the alphabet is shown in each condition, exactly; None if it
        does not matter.
    each_letter_at_least
        The same, at least.
    never_twice_running
        Whether no two neighbouring trials may show the same: the same string, the same cells
        in whatever order where they are reordered, or the same two values one after the other.

    Raises
    ------
    ValueError
        If a number is out of range.
    """

    each_letter: int | None = None
    each_letter_at_least: int | None = None
    never_twice_running: bool = False

    def __post_init__(self) -> None:
        check_range("each_letter", self.each_letter, 1, MOST_TRIALS)
        check_range("each_letter_at_least", self.each_letter_at_least, 1, MOST_TRIALS)

    def problem(self, lines: Iterable[tuple[int, ...]]) -> str:
        """Say which letter is shown too often or too seldom in a condition; empty if none is."""
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


def name_cell(mask: int) -> str:
    """Name a cell in a message: its braille character and its dots."""
    return f"{to_braille((mask,))} ({name_dots(mask)})"


def _check_distinct(what: str, names: Iterable[str]) -> None:
    for name, times in Counter(names).items():
        if times > 1:
            raise ValueError(f"{what} {name} twice; leave one out")


def _times(number: int) -> str:
    return "once" if number == 1 else f"{number} times"
