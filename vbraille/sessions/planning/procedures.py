"""Procedures that choose by the answers what is shown.

The plan has all trials that there may be. A procedure gives each one a level when it comes, and the
event of its cue keeps the values. The same answers give the same levels, so that a session that is
resumed goes on as it would have.

A *level* is a value of the procedure's parameter for strings; the difference from the standard
where a design has one; or the two values, the lower first, of which one is preferred.

**Staircases.** One up and two down converges where 70.7 % are right, one up and three down where
79.4 % are (Levitt 1971).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from hashlib import sha256
from statistics import fmean
from typing import Annotated, Literal, NamedTuple

from msgspec import Meta

from vbraille.adaptive.observer import Estimate, Grid, Quest, nearer, psychometric, steps
from vbraille.sessions.planning.design import AnyDesign, Compared
from vbraille.sessions.planning.questions import Question
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Count, Number, Parameter, Positive, Share
from vbraille.toml import Table, WrongValue

THRESHOLD, CENTRE = "threshold", "centre"
PLACES = 9

Level = tuple[float, ...]
Chances = Annotated[tuple[Share, ...], Meta(min_length=1)]


class Outcome(NamedTuple):
    """A level that was shown, and whether the answer was positive.

    An answer is positive if it is right or yes; of two that are preferred, if it is the lower.
    """

    level: Level
    positive: bool


class Procedure(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Keys of all procedures.

    Parameters
    ----------
    parameter
        Number of the look of strings that is varied; None if the design compares one.
    least, most
        Bounds of its values, if the design has none.
    harder
        Whether strings are harder to read with less or with more of it.
    trials
        Most trials of a condition; None for as many as the design has.
    """

    parameter: Parameter | None = None
    least: Number = 0.0
    most: Number = 0.0
    harder: Literal["less", "more"] = "less"
    trials: Count | None = None

    def levels(self, design: AnyDesign) -> tuple[float, ...]:
        """Return the levels that are named, or values of which one is preferred, rising."""
        if not isinstance(design, Compared):
            return self.least, self.most
        away = (abs(value - (design.reference or 0.0)) for value in design.values)
        return tuple(sorted(round(level, PLACES) for level in away))

    def next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        """Return the next level after the answers of a condition; None if enough was asked."""
        enough = self.trials is not None and len(history) >= self.trials
        return None if enough else self._next(design, history, seed)

    def _next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        raise NotImplementedError

    def found(self, design: AnyDesign, history: list[Outcome], seed: str) -> str:
        """Say what is known after the answers of a condition; empty if nothing is."""
        raise NotImplementedError


class Staircase(Procedure, frozen=True, kw_only=True, tag="staircase"):
    """Staircases: harder after right answers, easier after wrong ones.

    Parameters
    ----------
    start
        Where each staircase begins; several are interleaved.
    steps
        Sizes of the step before the first reversal, before the second, and so on.
    right, wrong
        How many right answers running make it harder, and how many wrong ones easier.
    reversals
        After how many reversals a staircase is over.
    """

    start: Annotated[tuple[Number, ...], Meta(min_length=1, max_length=20)]
    steps: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    right: Count = 2
    wrong: Count = 1
    reversals: Count | None = None

    def climbs(self, design: AnyDesign, history: list[Outcome], seed: str) -> list[Climb]:
        """Return the staircases after some answers."""
        climbs = [Climb(self, design, level) for level in self.start]
        for number, ((level, *_), positive) in enumerate(history):
            # An answer that was corrected late may leave one more than the staircases wanted.
            (_drawn(climbs, number, seed) or climbs[0]).take(level, positive)
        return climbs

    def _next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        climb = _drawn(self.climbs(design, history, seed), len(history), seed)
        return None if climb is None else (climb.level,)

    def found(self, design: AnyDesign, history: list[Outcome], seed: str) -> str:
        """Say the mean of the reversals with the last step.

        An odd one is left out at the beginning of each staircase, so that turns at the top and at
        the bottom count alike.
        """
        levels: list[float] = []
        for climb in self.climbs(design, history, seed):
            turned = climb.turned[len(self.steps) - 1 :]
            levels += turned[len(turned) % 2 :]
        return f"{fmean(levels):.3g}, the mean of {len(levels)} reversals" if levels else ""


@dataclass
class Climb:
    """A staircase on its way: its next level, and the levels at which it has turned."""

    rule: Staircase
    design: AnyDesign
    level: float
    turned: list[float] = field(default_factory=list)
    _went_harder: bool | None = None
    _answers: list[bool] = field(default_factory=list)  # since the last step

    def take(self, level: float, right: bool) -> None:
        """Move by an answer to the level that was shown."""
        rule, self.level = self.rule, level
        self._answers.append(right)
        running = rule.right if right else rule.wrong
        if self._answers[-running:] != [right] * running:
            return
        self._answers.clear()
        if self._went_harder not in (None, right):
            self.turned.append(level)
        self._went_harder = right
        size = rule.steps[min(len(self.turned), len(rule.steps) - 1)]
        falls = right == (rule.harder == "less" or isinstance(self.design, Compared))
        least, *_, most = rule.levels(self.design)
        moved = round(level - size if falls else level + size, PLACES)
        self.level = min(max(moved, least), most)


def _drawn(climbs: list[Climb], number: int, seed: str) -> Climb | None:
    """Return the staircase of a question, which cannot be foreseen; None if all are over."""
    left = [each for each in climbs if len(each.turned) < (each.rule.reversals or math.inf)]
    if not left:
        return None
    drawn = sha256(f"{seed} {number}".encode()).digest()
    return left[int.from_bytes(drawn[:8], "big") % len(left)]


class QuestPlus(Procedure, frozen=True, kw_only=True, tag="quest"):
    """QUEST+: what is expected to tell most about the threshold, or the preferred value.

    Parameters
    ----------
    step
        From one value to the next; None for those of the design alone.
    furthest
        Largest difference of two values of which one is preferred.
    shape
        Shape of the psychometric function.
    spread, guess, lapse
        Possible values of its other parameters. Without guess, strings are not guessed, and of
        several stimuli each is guessed as often.
    sd
        Standard deviation that is precise enough.
    at_least
        Trials of a condition before precision counts.
    """

    step: Positive | None = None
    furthest: Positive | None = None
    shape: Literal["normal", "logistic", "weibull"] = "normal"
    spread: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    guess: Chances | None = None
    lapse: Chances = (0.03,)
    sd: Positive | None = None
    at_least: Count = 10

    def _next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        found = self._estimate(design, history)
        if self.sd and found.sd <= self.sd and len(history) >= self.at_least:
            return None
        return quest_of(self, design).next(history)

    def _estimate(self, design: AnyDesign, history: list[Outcome]) -> Estimate:
        quest = quest_of(self, design)
        return quest.estimate(next(iter(quest.grid.axes)), history)

    def found(self, design: AnyDesign, history: list[Outcome], seed: str) -> str:
        """Say the estimate and its interval."""
        if not history:
            return ""
        found = self._estimate(design, history)
        return f"{found.mean:.3g}, 95 % between {found.low:.3g} and {found.high:.3g}"


@lru_cache(maxsize=8)
def quest_of(table: QuestPlus, design: AnyDesign) -> Quest:
    """Return the QUEST+ of a table, which takes a while to make.

    Raises
    ------
    WrongValue
        If the values do not make a grid.
    """
    values = table.levels(design)
    try:
        if table.step:
            values = steps(values[0], values[-1], table.step)
        elif not isinstance(design, Compared):
            raise ValueError("is missing; give the step from value to value")
        if isinstance(design, Compared) and design.reference is None:
            grid = Grid(nearer, {CENTRE: values, "spread": table.spread, "lapse": table.lapse})
            furthest = (table.furthest or values[-1]) + 1e-9
            pairs = [(a, b) for a in values for b in values if a < b <= a + furthest]
            return Quest(grid, pairs, CENTRE)
        chance, falls = 0.0, table.harder == "more"
        if isinstance(design, Compared):
            chance = 1 / (2 if design.form == "abx" else len(design.items({})[0].split()))
            falls = False
        guess, observer = table.guess or (chance,), psychometric(table.shape, falls=falls)
        axes = {THRESHOLD: values, "spread": table.spread, "guess": guess, "lapse": table.lapse}
        return Quest(Grid(observer, axes), [(value,) for value in values], THRESHOLD)
    except ValueError as error:
        raise WrongValue("procedure.step", str(error)) from None


def put(table: Procedure, design: AnyDesign, trial: Trial, level: Level) -> Trial:
    """Return a trial of the plan at a level."""
    if not isinstance(design, Compared):
        assert table.parameter is not None, "it is checked"
        return trial.at(table.parameter, level[0])
    standard = design.reference
    if standard is None:
        first, second = trial.values
        return trial.with_values(design.parameter, sorted(level, reverse=first > second))
    away = level[0] if design.values[0] > standard else -level[0]
    other = round(standard + away, PLACES)
    values = [standard if value == standard else other for value in trial.values]
    return trial.with_values(design.parameter, values)


def outcome_of(
    design: AnyDesign, question: Question, trial: Trial, level: float, answer: str
) -> Outcome:
    """Return what an answer to a trial, as it was shown, tells a procedure.

    Parameters
    ----------
    level
        Value of what the procedure varies, if a string was shown.
    """
    positive, values = question.positive(trial, answer), trial.values
    if not isinstance(design, Compared):
        return Outcome((level,), positive)
    if design.reference is None:
        preferred = values[int(answer) - 1]
        return Outcome(tuple(sorted(values)), preferred == min(values))
    apart = max(abs(value - design.reference) for value in values)
    return Outcome((round(apart, PLACES),), positive)


AnyProcedure = Staircase | QuestPlus
