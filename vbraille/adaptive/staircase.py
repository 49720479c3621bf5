"""Staircases: harder after right answers, easier after wrong ones; and when enough was asked.

n right answers running make the next level harder, and m wrong ones running make it easier. One up
and two down converges where 70.7 % are right, one up and three down where 79.4 % are (Levitt 1971).
With one up and one down, steps of two sizes converge where a share p is right, if the easier step
is p / (1 - p) times the harder one (Kaernbach 1991).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from hashlib import sha256
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.adaptive.questplus import GridEstimate


@dataclass(frozen=True, slots=True)
class Asked:
    """A question that was answered.

    Parameters
    ----------
    stimulus
        What was shown: a value, or an ordered pair of values.
    outcome
        Number of the outcome. 1 is the positive one: yes, right, or the first of the pair.
    t_s
        Seconds of the session at the answer.
    """

    stimulus: tuple[float, ...]
    outcome: int
    t_s: float = 0.0


@dataclass(frozen=True, slots=True)
class StopRule:
    """Limits, of which the first that is reached ends the questions.

    Parameters
    ----------
    trials
        Most questions; None for no limit.
    sd
        Largest standard deviation of the estimate that is precise enough; None for no limit.
    width
        Largest width of the credible interval of 95 % that is precise enough; None for no limit.
    at_least
        Number of questions before precision counts, since a few lucky answers look precise.
    seconds
        Seconds of the session after which nothing more is asked; None for no limit.

    Raises
    ------
    ValueError
        If a limit is not above 0.
    """

    trials: int | None = None
    sd: float | None = None
    width: float | None = None
    at_least: int = 1
    seconds: float | None = None

    def __post_init__(self) -> None:
        limits = ("trials", "sd", "width", "at_least", "seconds")
        for name in limits:
            value = getattr(self, name)
            if value is not None and not value > 0:
                raise ValueError(f"{name} is {value:g}; it must be above 0")

    @property
    def by_precision(self) -> bool:
        """True if the end of the questions depends on an estimate."""
        return self.sd is not None or self.width is not None

    def out_of_limits(self, history: Sequence[Asked]) -> bool:
        """Tell if the allowed number of questions or seconds is used up."""
        if self.trials is not None and len(history) >= self.trials:
            return True
        return self.seconds is not None and bool(history) and history[-1].t_s >= self.seconds

    def precise(self, asked: int, found: GridEstimate) -> bool:
        """Tell if an estimate after a number of questions is precise enough."""
        if asked < self.at_least or not self.by_precision:
            return False
        return (self.sd is None or found.sd <= self.sd) and (
            self.width is None or found.width <= self.width
        )


_PLACES = 9


@dataclass(slots=True)
class Climb:
    """State of one staircase.

    Parameters
    ----------
    level
        Level of the next question.
    harder
        Whether the last step was a harder one; None before the first step.
    last_right, running
        Whether the last answer was right, and how many like it came running since the last step.
    turned
        Levels at which the staircase turned round, in order.
    """

    level: float
    harder: bool | None = None
    last_right: bool | None = None
    running: int = 0
    turned: list[float] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class StaircaseRule:
    """Rule by which one staircase moves.

    Parameters
    ----------
    start
        Level of the first question.
    least, most
        Bounds, which no level goes beyond.
    steps
        Sizes of the harder step: the first until the first reversal, the second until the second,
        and so on; the last is kept.
    right, wrong
        Number of right answers running that make it harder, and of wrong ones that make it easier.
    easier
        Size of an easier step by that of a harder one: 1, or p / (1 - p) to be right in p.
    harder_is_less
        Whether a lower level is harder.
    reversals
        Number of reversals after which the staircase is over; None if it has no such end.

    Raises
    ------
    ValueError
        If the staircase could not move, or a number is out of range.
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

    def __post_init__(self) -> None:
        if not self.least < self.most:
            raise ValueError(
                f"least is {self.least:g} and most is {self.most:g}: the staircase cannot move; "
                f"make most larger"
            )
        if not self.least <= self.start <= self.most:
            raise ValueError(f"start is {self.start:g}; it must be {self.least:g} to {self.most:g}")
        if not self.steps or not all(step > 0 for step in self.steps):
            raise ValueError(
                "steps must all be above 0, or the staircase cannot move; give one or more"
            )
        way = self.most - self.least
        if max(self.steps) * max(1.0, self.easier) > way * (1 + 1e-9):
            raise ValueError(
                f"steps have one that is longer than the way from {self.least:g} to "
                f"{self.most:g}, so that the staircase could only stand at its ends; make it "
                f"smaller"
            )
        for name, value in (("right", self.right), ("wrong", self.wrong)):
            if value < 1:
                raise ValueError(f"{name} is {value}; it must be 1 or more")
        if not 0.01 <= self.easier <= 100:
            raise ValueError(f"easier is {self.easier:g}; it must be 0.01 to 100")
        if self.reversals is not None and self.reversals < 1:
            raise ValueError(f"reversals is {self.reversals}; it must be 1 or more")

    def is_over(self, climb: Climb) -> bool:
        """True if a staircase has turned round as often as it shall."""
        return self.reversals is not None and len(climb.turned) >= self.reversals

    def take(self, climb: Climb, asked: Asked) -> None:
        """Move a staircase by an answer."""
        climb.level = asked.stimulus[0]  # what was shown counts, if it was not what comes next
        right = asked.outcome == 1
        climb.running = climb.running + 1 if right == climb.last_right else 1
        climb.last_right = right
        if climb.running < (self.right if right else self.wrong):
            return
        climb.running = 0
        if climb.harder is not None and climb.harder != right:
            climb.turned.append(climb.level)
        climb.harder = right
        size = self.steps[min(len(climb.turned), len(self.steps) - 1)]
        size *= 1.0 if right else self.easier
        down = right == self.harder_is_less
        moved = round(climb.level - size if down else climb.level + size, _PLACES)
        climb.level = min(max(moved, self.least), self.most)


class TurnEstimate(NamedTuple):
    """Estimate of the level that staircases converge to, by their reversals.

    Parameters
    ----------
    mean
        Mean of the levels of the reversals that count.
    sd
        Standard deviation of these levels; NaN for fewer than two.
    reversals
        How many count.
    """

    mean: float
    sd: float
    reversals: int


@dataclass(frozen=True, slots=True)
class Staircases:
    """Several staircases, interleaved so that the next level cannot be foreseen.

    Parameters
    ----------
    rules
        Rule of each staircase.
    seed
        Text that, with the number of the question, draws which staircase is next.

    Raises
    ------
    ValueError
        If there is no rule.
    """

    rules: tuple[StaircaseRule, ...]
    seed: str = ""

    def __post_init__(self) -> None:
        if not self.rules:
            raise ValueError("staircases are none; give one or more")

    def next(self, history: Sequence[Asked]) -> float | None:
        """Level of the next question; None if all staircases are over."""
        climbs = self.climbs(history)
        at = self._drawn(len(history), climbs)
        return None if at is None else climbs[at].level

    def climbs(self, history: Sequence[Asked]) -> list[Climb]:
        """State of each staircase after the questions of all."""
        climbs = [Climb(rule.start) for rule in self.rules]
        for number, asked in enumerate(history):
            # Where an answer was corrected after the next question was shown, one may be left over.
            at = self._drawn(number, climbs) or 0
            self.rules[at].take(climbs[at], asked)
        return climbs

    def estimate(self, history: Sequence[Asked]) -> TurnEstimate | None:
        """Estimate from the reversals made with the last step; None if there are none.

        An odd one is left out at the beginning of each staircase, so that turns at the top and at
        the bottom count alike.
        """
        levels: list[float] = []
        for rule, climb in zip(self.rules, self.climbs(history), strict=True):
            turned = climb.turned[len(rule.steps) - 1 :]
            levels += turned[len(turned) % 2 :]
        if not levels:
            return None
        sd = float(np.std(levels, ddof=1)) if len(levels) > 1 else float("nan")
        return TurnEstimate(float(np.mean(levels)), sd, len(levels))

    def _drawn(self, number: int, climbs: Sequence[Climb]) -> int | None:
        """Number of the staircase that has a question, from 0; None if all are over."""
        left = [
            at
            for at, (rule, climb) in enumerate(zip(self.rules, climbs, strict=True))
            if not rule.is_over(climb)
        ]
        if len(left) < 2:
            return left[0] if left else None
        drawn = sha256(f"{self.seed} {number}".encode()).digest()
        return left[int.from_bytes(drawn[:8], "big") % len(left)]
