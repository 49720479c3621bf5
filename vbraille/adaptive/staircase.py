"""Staircases: harder after right answers, easier after wrong ones.

One up and two down converges where 70.7 % are right, one up and three down where 79.4 % are (Levitt
1971). With one up and one down, steps of two sizes converge where a share p is right, if the easier
step is p / (1 - p) times the harder one (Kaernbach 1991).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from hashlib import sha256

import numpy as np

PLACES = 9


Asked = tuple[float, bool]  # a level that was shown, and whether the answer was right


@dataclass(frozen=True)
class Rule:
    """Movement of one staircase.

    Parameters
    ----------
    start, least, most
        Level of the first question, and the bounds.
    steps
        Sizes of the harder step before the first reversal, before the second, and so on.
    right, wrong
        How many right answers running make it harder, and how many wrong ones easier.
    easier
        Size of an easier step by that of a harder one.
    harder_is_less
        Whether a lower level is harder.
    reversals
        After how many reversals it is over; None for no such end.
    """

    start: float
    least: float
    most: float
    steps: tuple[float, ...]
    right: int = 2
    wrong: int = 1
    easier: float = 1.0
    harder_is_less: bool = True
    reversals: int | None = None


@dataclass
class Climb:
    """State of a staircase: its next level, and the levels at which it has turned."""

    rule: Rule
    level: float
    turned: list[float] = field(default_factory=list)
    _harder: bool | None = None
    _last: bool | None = None
    _running: int = 0

    @property
    def is_over(self) -> bool:
        """Tell whether it has turned as often as it shall."""
        return self.rule.reversals is not None and len(self.turned) >= self.rule.reversals

    def take(self, level: float, right: bool) -> None:
        """Move by an answer to the level that was shown."""
        rule = self.rule
        self.level = level
        self._running = self._running + 1 if right == self._last else 1
        self._last = right
        if self._running < (rule.right if right else rule.wrong):
            return
        self._running = 0
        if self._harder not in (None, right):
            self.turned.append(level)
        self._harder = right
        size = rule.steps[min(len(self.turned), len(rule.steps) - 1)]
        size *= 1.0 if right else rule.easier
        moved = level - size if right == rule.harder_is_less else level + size
        self.level = min(max(round(moved, PLACES), rule.least), rule.most)


class Staircases:
    """Several staircases, interleaved so that the next level cannot be foreseen.

    Parameters
    ----------
    rules
        Rule of each staircase.
    seed
        Text that, with the number of the question, draws which staircase is next.
    """

    def __init__(self, rules: Sequence[Rule], seed: str) -> None:
        self._rules = rules
        self._seed = seed

    def next(self, history: Sequence[Asked]) -> float | None:
        """Return the level of the next question; None if all staircases are over."""
        climb = self._drawn(len(history), self.climbs(history))
        return None if climb is None else climb.level

    def climbs(self, history: Sequence[Asked]) -> list[Climb]:
        """Return the staircases after some answers."""
        climbs = [Climb(rule, rule.start) for rule in self._rules]
        for number, answered in enumerate(history):
            # An answer that was corrected late may leave one more than the staircases wanted.
            (self._drawn(number, climbs) or climbs[0]).take(*answered)
        return climbs

    def estimate(self, history: Sequence[Asked]) -> tuple[float, int] | None:
        """Return the mean level of the reversals with the last step, and their number, or None.

        An odd one is left out at the beginning of each staircase, so that turns at the top and at
        the bottom count alike.
        """
        levels: list[float] = []
        for climb in self.climbs(history):
            turned = climb.turned[len(climb.rule.steps) - 1 :]
            levels += turned[len(turned) % 2 :]
        return (float(np.mean(levels)), len(levels)) if levels else None

    def _drawn(self, number: int, climbs: Sequence[Climb]) -> Climb | None:
        left = [climb for climb in climbs if not climb.is_over]
        if not left:
            return None
        drawn = sha256(f"{self._seed} {number}".encode()).digest()
        return left[int.from_bytes(drawn[:8], "big") % len(left)]
