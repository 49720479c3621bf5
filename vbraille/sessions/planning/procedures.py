"""Procedures that choose what is shown by the answers so far.

The plan has all trials that there may be. A procedure gives each one a value when it comes, and the
event of its cue keeps the value. The same answers give the same values, so that a session which is
resumed goes on as it would have.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Literal, NamedTuple

from msgspec import Meta

from vbraille.adaptive.questplus import GridAxis, GridQuest, detection_quest
from vbraille.adaptive.staircase import Asked, StaircaseRule, Staircases
from vbraille.sessions.planning.values import Count
from vbraille.toml import Table, WrongValue


class Outcome(NamedTuple):
    """A value that was shown, and whether the answer was positive: right, or yes."""

    value: float
    positive: bool


class ByAnswers(Table, kw_only=True, tag_field="kind"):
    """What all procedures have.

    Parameters
    ----------
    parameter
        Number of the look that is varied.
    least, most
        Bounds of its values.
    """

    parameter: Literal["texture", "contrast", "dot_width_mm"]
    least: float
    most: float

    def __post_init__(self) -> None:
        if not self.least < self.most:
            raise WrongValue("most", f"must be more than least, {self.least:g}")

    def next(self, history: list[Outcome], seed: str) -> float | None:
        """Return the next value after the answers of a condition; None if enough was asked."""
        raise NotImplementedError


class StaircaseTable(ByAnswers, kw_only=True, tag="staircase"):
    """Staircases: harder after right answers, easier after wrong ones.

    Parameters
    ----------
    starts
        Where each staircase begins; several are interleaved.
    steps
        Sizes of the steps, until the first reversal, the second, and so on.
    right
        How many right answers running make it harder.
    reversals
        After how many reversals a staircase is over.
    """

    starts: Annotated[tuple[float, ...], Meta(min_length=1)]
    steps: Annotated[tuple[float, ...], Meta(min_length=1)]
    right: Count = 2
    reversals: Count = 10

    def next(self, history: list[Outcome], seed: str) -> float | None:
        """Return the level of the staircase that is drawn next."""
        rules = tuple(
            StaircaseRule(
                start, self.least, self.most, self.steps, self.right, reversals=self.reversals
            )
            for start in self.starts
        )
        asked = [Asked((value,), int(positive)) for value, positive in history]
        return Staircases(rules, seed).next(asked)


class QuestTable(ByAnswers, kw_only=True, tag="quest"):
    """QUEST+: the value that is expected to tell most about the threshold.

    Parameters
    ----------
    step
        From one value to the next.
    spread, guess, lapse
        Possible values of the other parameters of the psychometric function.
    trials, sd
        After how many trials, or at which standard deviation of the threshold, it is over.
    """

    step: Annotated[float, Meta(gt=0)]
    spread: Annotated[tuple[float, ...], Meta(min_length=1)]
    guess: tuple[float, ...] = (0.0,)
    lapse: tuple[float, ...] = (0.03,)
    trials: Count = 40
    sd: float = 0.0

    def next(self, history: list[Outcome], seed: str) -> float | None:
        """Return the value that is expected to tell most."""
        grid = _grid(self)
        asked = [((value,), int(positive)) for value, positive in history]
        if len(asked) >= self.trials or grid.estimate(asked, "threshold").sd <= self.sd:
            return None
        (value,) = grid.next(asked)
        return value


@lru_cache(maxsize=8)
def _grid(table: QuestTable) -> GridQuest:
    """Return the grid of a table, which takes a while to make."""
    count = round((table.most - table.least) / table.step)
    values = tuple(round(table.least + n * table.step, 9) for n in range(count + 1))
    return detection_quest(
        "normal",
        values,
        GridAxis("threshold", values),
        GridAxis("spread", table.spread),
        GridAxis("guess", table.guess),
        GridAxis("lapse", table.lapse),
    )


AnyProcedure = StaircaseTable | QuestTable
