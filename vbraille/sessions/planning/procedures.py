"""Procedures that choose by the answers what is shown.

The plan has all trials that there may be. A procedure gives each one a level when it comes, and the
event of its cue keeps the values. The same answers give the same levels, so that a session that is
resumed goes on as it would have.

A *level* is a value of the procedure's parameter for strings; the difference from the standard
where a design has one; or the two values, the lower first, of which one is preferred.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated, Literal, NamedTuple

from msgspec import Meta

from vbraille.adaptive.observer import Estimate, Grid, Quest, nearer, psychometric, steps
from vbraille.adaptive.staircase import Rule, Staircases
from vbraille.sessions.planning.design import AnyDesign, Compared
from vbraille.sessions.planning.questions import Question
from vbraille.sessions.planning.trial import Trial
from vbraille.sessions.planning.values import Count, Number, Parameter, Positive, Seconds, Share
from vbraille.toml import Table, WrongValue

THRESHOLD, CENTRE = "threshold", "centre"
PLACES = 9

Level = tuple[float, ...]
Chances = Annotated[tuple[Share, ...], Meta(min_length=1)]


class Outcome(NamedTuple):
    """A level that was shown, whether the answer was positive, and when it was given.

    An answer is positive if it is right or yes; of two that are preferred, if it is the lower.
    """

    level: Level
    positive: bool
    t_s: float


class Procedure(Table, frozen=True, kw_only=True, tag_field="kind"):
    """Keys of all procedures.

    Parameters
    ----------
    parameter
        Number of the look of strings that is varied; None if the design compares one.
    least, most
        Bounds of its values; None if the design has them.
    harder
        Whether strings are harder to read with less or with more of it.
    trials
        Most trials of a condition; None for as many as the design has.
    seconds
        Time of the session after which no further trial is chosen.
    """

    parameter: Parameter | None = None
    least: Number | None = None
    most: Number | None = None
    harder: Literal["less", "more"] = "less"
    trials: Count | None = None
    seconds: Seconds | None = None

    def bounds(self, design: AnyDesign) -> tuple[float, float]:
        """Return the lowest and the highest level, or value of which one is preferred."""
        if not isinstance(design, Compared):
            return self.least or 0.0, self.most or 0.0
        values = [abs(value - (design.reference or 0.0)) for value in design.values]
        return round(min(values), PLACES), round(max(values), PLACES)

    def next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        """Return the next level after the answers of a condition; None if enough was asked."""
        out_of_time = self.seconds and history and history[-1].t_s >= self.seconds
        if out_of_time or len(history) >= (self.trials or len(history) + 1):
            return None
        return self._next(design, history, seed)

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
    target
        Share of right answers that steps of two sizes converge to, with right = wrong = 1.
    reversals
        After how many reversals a staircase is over.
    """

    start: Annotated[tuple[Number, ...], Meta(min_length=1, max_length=20)]
    steps: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    right: Count = 2
    wrong: Count = 1
    target: Annotated[float, Meta(ge=0.05, le=0.95)] | None = None
    reversals: Count | None = None

    def __post_init__(self) -> None:
        if self.target is not None and (self.right, self.wrong) != (1, 1):
            raise WrongValue("target", "is of steps up and down; give right = 1 and wrong = 1")

    def _staircases(self, design: AnyDesign, seed: str) -> Staircases:
        least, most = self.bounds(design)
        easier = 1.0 if self.target is None else self.target / (1 - self.target)
        less = self.harder == "less" or isinstance(design, Compared)
        moves = (self.steps, self.right, self.wrong, easier, less, self.reversals)
        return Staircases([Rule(start, least, most, *moves) for start in self.start], seed)

    def _next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        level = self._staircases(design, seed).next(
            [(level, positive) for (level, *_), positive, _ in history]
        )
        return None if level is None else (level,)

    def found(self, design: AnyDesign, history: list[Outcome], seed: str) -> str:
        """Say the mean of the reversals."""
        found = self._staircases(design, seed).estimate(
            [(level, positive) for (level, *_), positive, _ in history]
        )
        return "" if found is None else f"{found[0]:.3g}, the mean of {found[1]} reversals"


class QuestPlus(Procedure, frozen=True, kw_only=True, tag="quest"):
    """QUEST+: what is expected to tell most about the threshold, or the preferred value.

    Parameters
    ----------
    step
        From one value to the next; None for those of the design alone.
    furthest
        Largest difference of two values of which one is preferred.
    scale
        Scale on which their distances are judged.
    shape
        Shape of the psychometric function.
    spread, guess, lapse
        Possible values of its other parameters. Without guess, strings are not guessed, and of
        several stimuli each is guessed as often.
    sd, width
        Standard deviation, and width of the interval of 95 %, that are precise enough.
    at_least
        Trials of a condition before precision counts.
    """

    step: Positive | None = None
    furthest: Positive | None = None
    scale: Literal["linear", "log"] = "linear"
    shape: Literal["normal", "logistic", "weibull"] = "normal"
    spread: Annotated[tuple[Positive, ...], Meta(min_length=1)]
    guess: Chances | None = None
    lapse: Chances = (0.03,)
    sd: Positive | None = None
    width: Positive | None = None
    at_least: Count = 10

    def _next(self, design: AnyDesign, history: list[Outcome], seed: str) -> Level | None:
        found, asked = self._estimate(design, history)
        precise = (self.sd is not None and found.sd <= self.sd) or (
            self.width is not None and found.high - found.low <= self.width
        )
        if precise and len(history) >= self.at_least:
            return None
        return quest_of(self, design).next(asked)

    def _estimate(self, design: AnyDesign, history: list[Outcome]) -> tuple[Estimate, list]:
        """Estimate what is asked about, and return the answers as QUEST+ has them."""
        quest, asked = quest_of(self, design), [(level, positive) for level, positive, _ in history]
        return quest.estimate(next(iter(quest.grid.axes)), asked), asked

    def found(self, design: AnyDesign, history: list[Outcome], seed: str) -> str:
        """Say the estimate and its interval."""
        if not history:
            return ""
        found, _ = self._estimate(design, history)
        return f"{found.mean:.3g}, 95 % between {found.low:.3g} and {found.high:.3g}"


@lru_cache(maxsize=8)
def quest_of(table: QuestPlus, design: AnyDesign) -> Quest:
    """Return the QUEST+ of a table, which takes a while to make.

    Raises
    ------
    WrongValue
        If the values do not make a grid.
    """
    least, most = table.bounds(design)
    compared = isinstance(design, Compared)
    try:
        if table.step:
            values = steps(least, most, table.step)
        elif compared:
            away = (abs(value - (design.reference or 0.0)) for value in design.values)
            values = tuple(sorted(round(level, PLACES) for level in away))
        else:
            raise ValueError("is missing; give the step from value to value")
        axes = {"spread": table.spread, "lapse": table.lapse}
        if compared and design.reference is None:
            furthest = (table.furthest or most) + 1e-9
            pairs = [(a, b) for a in values for b in values if a < b <= a + furthest]
            grid = Grid(nearer(log=table.scale == "log"), {CENTRE: values, **axes})
            return Quest(grid, pairs, CENTRE)
        guess = table.guess or ((1 / alternatives(design),) if compared else (0.0,))
        axes = {"spread": table.spread, "guess": guess, "lapse": table.lapse}
        shape = psychometric(table.shape, falls=table.harder == "more" and not compared)
        grid = Grid(shape, {THRESHOLD: values, **axes})
        return Quest(grid, [(value,) for value in values], THRESHOLD)
    except ValueError as error:
        raise WrongValue("procedure.step", str(error)) from None


def alternatives(design: Compared) -> int:
    """Return how many answers there are to a trial, of which one is right."""
    return 2 if design.form == "abx" else len(design.items({})[0].split())


def put(table: Procedure, design: AnyDesign, trial: Trial, level: Level) -> Trial:
    """Return a trial of the plan at a level."""
    if not isinstance(design, Compared):
        assert table.parameter is not None, "it is checked"
        return trial.at(table.parameter, level[0])
    if design.reference is None:
        low, high = level
        values = (low, high) if trial.values[0] < trial.values[1] else (high, low)
        return trial.with_values(design.parameter, values)
    away = level[0] if design.values[0] > design.reference else -level[0]
    other = round(design.reference + away, PLACES)
    standard = design.reference
    values = tuple(standard if value == standard else other for value in trial.values)
    return trial.with_values(design.parameter, values)


def outcome_of(
    design: AnyDesign, question: Question, trial: Trial, level: float, answer: str, t_s: float
) -> Outcome:
    """Return what an answer to a trial, as it was shown, tells a procedure.

    Parameters
    ----------
    level
        Value of what the procedure varies, if a string was shown.
    """
    positive = question.positive(trial, answer)
    if not isinstance(design, Compared):
        return Outcome((level,), positive, t_s)
    if design.reference is None:
        chosen = trial.values[int(answer) - 1]
        return Outcome(tuple(sorted(trial.values)), chosen == min(trial.values), t_s)
    apart = max(abs(value - design.reference) for value in trial.values)
    return Outcome((round(apart, PLACES),), positive, t_s)


AnyProcedure = Staircase | QuestPlus
