"""The planned comparison: the measure, what it is compared by, and which trials it leaves out."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.measures import CHOICES, MEASURES, Measure, level_of, usual_measure
from vbraille.analysis.read import Trials, caught, in_order
from vbraille.analysis.tables import taken_s
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from pandas import DataFrame, Series


@dataclass(frozen=True)
class Plan:
    """A comparison, as ``[analysis]`` of a protocol plans it, or as is usual for the question.

    Parameters
    ----------
    question
        Kind of the question whose trials are compared.
    measure
        Key of `MEASURES`; empty if nothing is compared.
    factors
        Columns of the trials whose levels are compared.
    too_fast_s, too_slow_s
        Trials that took less, or more, are left out.
    catch_right
        Least share of a person's catch trials that are right.
    participants
        Number of people that was planned; None if none was.
    departures
        Sentences on what was chosen otherwise than planned.
    """

    question: str
    measure: str
    factors: tuple[str, ...]
    too_fast_s: float = 0.0
    too_slow_s: float = np.inf
    catch_right: float = 0.0
    participants: int | None = None
    departures: list[str] = field(default_factory=list)

    @property
    def of(self) -> Measure:
        """The measure."""
        return MEASURES[self.measure]


def plan_of(
    trials: Trials, measure: str | None = None, factors: Sequence[str] | None = None
) -> Plan:
    """Return the plan of trials: that of their protocol, or the usual one of the question.

    Parameters
    ----------
    measure, factors
        What is compared instead, and by which columns; None as planned.

    Raises
    ------
    InputError
        If trials are of several protocols, or something does not fit the question.
    """
    frame = trials.frame
    protocols = sorted(set(frame["protocol"]))
    if len(protocols) > 1:
        raise InputError(
            f"trials are of several protocols: {', '.join(filter(None, protocols))}; "
            f"choose one with --protocol"
        )
    planned = _of_protocol(trials)
    question = planned.question if planned else str(frame["question"].mode()[0])
    others = int((frame["question"] != question).sum())
    if others:
        trials.notes.append(f"{others} trials of other questions than {question} are not compared")
    asked = frame[frame["question"] == question]
    plan = planned or Plan(question, usual_measure(asked), ("condition",))
    chosen = {"measure": measure, "factors": None if factors is None else tuple(factors)}
    for name, value in chosen.items():
        if value is not None and value != getattr(plan, name):
            if planned:
                plan.departures.append(f"The {name} is not as planned, {getattr(plan, name)}.")
            plan = replace(plan, **{name: value})
    _check(plan, asked)
    if plan.measure == "threshold":
        plan = replace(plan, factors=_not_along(asked, plan.factors))
    varied = tuple(name for name in plan.factors if asked[name].nunique() > 1)
    return replace(plan, factors=varied)


def asked_of(trials: Trials, plan: Plan) -> DataFrame:
    """Return the trials of the planned question, with the levels of its factors in their order."""
    asked = trials.frame[trials.frame["question"] == plan.question]
    return asked.assign(**{name: in_order(_level_names(asked[name])) for name in plan.factors})


def _level_names(values: Series) -> Series:
    """Return levels as text, numbers without superfluous places."""
    return values.map(lambda value: f"{value:g}" if isinstance(value, float) else str(value))


def _of_protocol(trials: Trials) -> Plan | None:
    """Return the plan in the protocol of the sessions; None if there are no sessions."""
    if not trials.contents:
        return None
    from vbraille.sessions.record.trials import protocol_of

    protocol = protocol_of(trials.contents[0])
    planned = protocol.analysis
    own = {factor.name for factor in protocol.factors}
    columns = [f"factor_{name}" if name in own else name for name in planned.factors or ()]
    return Plan(
        protocol.asks.kind,
        planned.measure or "",
        tuple(columns),
        planned.too_fast_s or 0.0,
        planned.too_slow_s or np.inf,
        planned.catch_right or 0.0,
        planned.participants,
    )


def _check(plan: Plan, asked: DataFrame) -> None:
    """Refuse a measure or a factor that the trials do not have."""
    if plan.measure:
        known = [name for name, each in MEASURES.items() if plan.question in each.questions]
        if plan.measure not in known:
            raise InputError(
                f"measure {plan.measure!r} is not of the question {plan.question}; known: "
                f"{', '.join(known) or 'none'}"
            )
    untold = asked["outcome"].isna() & (plan.question in CHOICES)
    if untold.any() and plan.measure in ("right", "threshold", "duration"):
        raise InputError(
            f"{untold.sum()} answers to {plan.question} have neither outcome nor correct, so that "
            f"it is not known whether they are right"
        )
    for name in plan.factors:
        if name not in asked:
            raise InputError(f"there is no column {name!r} to compare by")
        if asked[name].isna().any():
            raise InputError(f"{name} is missing in some trials; all need it to be compared by it")


def _not_along(asked: DataFrame, factors: tuple[str, ...]) -> tuple[str, ...]:
    """Return the factors without those along which a threshold is found."""
    level = level_of(asked)
    if level not in asked:
        return factors
    shown = asked[asked["outcome"].isin(("hit", "miss"))]
    return tuple(
        name
        for name in factors
        if name != level and shown.groupby(name, observed=True)[level].nunique().max() > 1
    )


def leave_out(trials: Trials, plan: Plan) -> None:
    """Leave out trials and people as planned, and catch trials, and say so.

    Raises
    ------
    InputError
        If no trial is left.
    """
    frame = trials.frame
    watched = caught(frame)
    if watched.any():
        right = frame.loc[watched, "right"]
        trials.notes.append(f"{right.size} catch trials are left out, {right.sum()} of them right")
        shares = right.groupby(frame["participant"], observed=True).mean()
        for person, share in shares[shares < plan.catch_right].items():
            trials.left_out.append(f"{person}: {100 * share:.0f} % of catch trials right")
            frame = frame[frame["participant"] != person]
    frame = frame[~caught(frame)]
    taken = taken_s(frame)
    wrong = (taken < plan.too_fast_s) | (taken > plan.too_slow_s)
    if wrong.any():
        limits = f"{plan.too_fast_s:g} to {plan.too_slow_s:g} s"
        trials.notes.append(f"{wrong.sum()} trials outside {limits} are left out, as planned")
    frame = frame[~wrong]
    if frame.empty:
        raise InputError("the plan leaves out every trial; see [analysis] of the protocol")
    trials.frame = frame.reset_index(drop=True)
