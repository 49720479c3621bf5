"""Practice: trials before block 1, of items that the test does not show."""

from __future__ import annotations

from dataclasses import dataclass

from vbraille.braille.spelling import to_braille
from vbraille.sessions.planning.conduct import check_range
from vbraille.sessions.planning.design import (
    MOST_TRIALS,
    Choice,
    Combinations,
    Design,
    StringList,
)

Item = tuple[float, ...]  # the cells asked for, or the values compared


@dataclass(frozen=True, slots=True)
class Practice:
    """What is practised.

    Parameters
    ----------
    trials
        How many there are.
    items
        What they show, instead of the design's own: dot masks of the cells asked for, or
        two values. None if there is no practice, and in protocols of version 0.1, whose
        practice was drawn from the test.

    Raises
    ------
    ValueError
        If there are too many.
    """

    trials: int = 0
    items: tuple[Item, ...] = ()

    def __post_init__(self) -> None:
        check_range("trials", self.trials, 0, MOST_TRIALS)

    def lines(self, design: Design) -> list[tuple[int, ...]]:
        """Cells of all lines that are practised, delimiters and all; none of comparisons."""
        if isinstance(design, Choice):
            return []
        around = (design.before, design.after) if isinstance(design, Combinations) else ((), ())
        return [(*around[0], *map(int, item), *around[1]) for item in self.items]

    def values(self, design: Design) -> set[float]:
        """Values that are practised; none of strings."""
        return {v for item in self.items for v in item} if isinstance(design, Choice) else set()

    def problem(self, design: Design) -> str:
        """Say what cannot be practised beside a test of that design; empty if all can."""
        if isinstance(design, Choice):
            shared = self.values(design) & set(design.values)
            if shared:
                return f"has the value {min(shared):g} mm, which the test compares; give another"
            return ""
        for item, line in zip(self.items, self.lines(design), strict=True):
            if not any(line):
                return "has a string without dots, and nothing can be felt of it"
            if _is_shown(design, item):
                return (
                    f"has the string {to_braille(tuple(map(int, item)))}, which the test shows; "
                    f"give another"
                )
        return ""


def content(design: Design, item: Item) -> Item:
    """What an item shows, whatever the order of its cells where they come in any order."""
    if isinstance(design, StringList) and design.reorder:
        return tuple(sorted(item))
    return item


def _is_shown(design: Combinations | StringList, item: Item) -> bool:
    if isinstance(design, Combinations):
        return len(item) == design.length and set(item) <= set(design.characters)
    return content(design, item) in {content(design, string) for string in design.strings}
