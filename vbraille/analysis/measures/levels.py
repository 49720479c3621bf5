"""Levels compared within participants: Lévesque 2009, 4.3 and its supplementary analysis."""

from __future__ import annotations

import math
from dataclasses import asdict
from itertools import combinations
from typing import TYPE_CHECKING, Any

import pandas as pd

from vbraille.analysis.input.trials import LeftOut
from vbraille.analysis.input.trials import factor as ordered
from vbraille.analysis.results import (
    NOTE_COLUMN,
    PARTICIPANT,
    Column,
    Kind,
    Schema,
    ends,
    mean_or_none,
)
from vbraille.analysis.statistics.anova import Anova, anova
from vbraille.analysis.statistics.intervals import (
    Unanswerable,
    adjust,
    mean_duration,
    mean_interval,
    mean_share,
)
from vbraille.analysis.statistics.paired import paired_t

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.analysis.input.scoretable import Scores
    from vbraille.analysis.results import ResultTable, Row

NOTHING = "there are no scores to compare"
MOST_LEVELS = 12  # they make 66 pairs: more t-tests than should be made of one table
MEANS = Schema(
    "level_means",
    "Means of the levels",
    "Over participants' own means; scores are averaged over other factors, and repeated ones "
    "within the participant; who misses a cell of a level is left out of it. The interval is of "
    "the population's mean: for shares by a logit-normal model of how people differ, for durations "
    "Cox's, for others Student's.",
    (
        Column("measure", "measure", "what is compared, with its unit; legibility from 0 to 1"),
        Column("factor", "factor", "by what"),
        Column("level", "level", "of the factor"),
        Column("participants", "participants", "who have it", Kind.COUNT),
        Column("mean", "mean", "in the measure's unit", Kind.NUMBER),
        *ends(),
        NOTE_COLUMN,
    ),
    empty=NOTHING,
)
OWN = Schema(
    "level_scores",
    "Participants' own means at the levels",
    "What the means, the tests and their figures are made of: scores averaged over other factors, "
    "and repeated ones within the participant.",
    (
        Column("measure", "measure", "what is compared, with its unit; legibility from 0 to 1"),
        Column("factor", "factor", "by what"),
        Column("level", "level", "of the factor"),
        PARTICIPANT,
        Column("mean", "mean", "in the measure's unit", Kind.NUMBER),
    ),
    empty=NOTHING,
)
T_TESTS = Schema(
    "t_tests",
    "Paired t-tests",
    "First less second, over participants; scores are averaged over other factors, and repeated "
    "ones within the participant. d_z is the mean difference by the standard deviation of the "
    "differences, and its interval is by noncentral t; g_z is d_z with Hedges's correction for "
    "few participants. Corrected p takes account of all pairs of a measure and factor. The "
    "interval of a difference of shares ends at -1 and 1.",
    (
        Column("measure", "measure", "what is compared, with its unit; legibility from 0 to 1"),
        Column("factor", "factor", "by what"),
        Column("first", "first", "level"),
        Column("second", "second", "level"),
        Column("participants", "participants", "who have both", Kind.COUNT),
        Column("mean_difference", "mean difference", "in the measure's unit", Kind.NUMBER),
        *ends(),
        Column("t", "t", "Student's", Kind.NUMBER),
        Column("df", "df", "degrees of freedom", Kind.COUNT),
        Column("p", "p", "two-sided, not corrected", Kind.P),
        Column("p_corrected", "p corrected", "for the tests of this measure and factor", Kind.P),
        Column("d_z", "d_z", "effect size", Kind.NUMBER),
        *ends(name="d_", heading="d_z "),
        Column("g_z", "g_z", "effect size, corrected", Kind.NUMBER),
        NOTE_COLUMN,
    ),
    empty=NOTHING,
)
ANOVA = Schema(
    "anova",
    "Repeated-measures analysis of variance",
    "A factor of which every participant has one level is between participants, beside others that "
    "are within. Corrected is by Greenhouse and Geisser's epsilon, which "
    "is too careful with few participants, or by Huynh and Feldt's. Mauchly's test is of "
    "sphericity; with few participants its p is too small. The interval of partial eta² is by "
    "noncentral F. A participant with a missing cell is left out whole; repeated scores of a cell "
    "are averaged first.",
    (
        Column("measure", "measure", "what is compared, with its unit"),
        Column("effect", "effect", "factors that act together"),
        Column("participants", "participants", "who have every cell", Kind.COUNT),
        Column("df1", "df1", "degrees of freedom of the effect", Kind.COUNT),
        Column("df2", "df2", "degrees of freedom of its error", Kind.COUNT),
        Column("f", "F", "mean square of the effect by that of its error", Kind.NUMBER),
        Column("p", "p", "if sphericity holds", Kind.P),
        Column("epsilon", "epsilon", "Greenhouse and Geisser's", Kind.NUMBER),
        Column("p_corrected", "p corrected", "with both degrees of freedom times epsilon", Kind.P),
        Column("huynh_feldt", "Huynh-Feldt epsilon", "Huynh and Feldt's", Kind.NUMBER),
        Column("p_huynh_feldt", "p Huynh-Feldt", "corrected by that epsilon instead", Kind.P),
        Column("mauchly_w", "W", "Mauchly's", Kind.NUMBER),
        Column("mauchly_p", "p of W", "that sphericity holds, as R's mauchly.test", Kind.P),
        Column("partial_eta2", "partial eta²", "effect size", Kind.NUMBER),
        *ends(name="partial_"),
        Column("generalised_eta2", "generalised eta²", "effect size", Kind.NUMBER),
        NOTE_COLUMN,
    ),
    empty=NOTHING,
)


def level_means(measures: Sequence[Scores]) -> ResultTable:
    """Mean of every level of every factor.

    Parameters
    ----------
    measures
        Scores of each measure that is compared.
    """
    rows: list[Row] = []
    for scores, factor, means in _each(measures):
        trials = _trials(scores, factor)
        groups = _of_groups(means)
        for level, every in means.iterrows():
            own = every.dropna()
            row: Row = _what(scores, factor) | {
                "level": level,
                "participants": own.size,
                "mean": mean_or_none(own.to_list()),
            }
            notes = [] if groups else _without(means, own.index)
            try:
                if trials is not None:
                    interval = mean_share(own, trials.loc[level, own.index])
                else:
                    interval = (mean_duration if scores.durations else mean_interval)(own)
                row |= interval._asdict()
            except Unanswerable as reason:
                notes.append(f"no interval: {reason}")
            rows.append(row | {"note": "; ".join(notes)})
    return MEANS.fill(rows)


def own_means(measures: Sequence[Scores]) -> ResultTable:
    """Mean of every participant at every level of every factor."""
    rows: list[Row] = [
        _what(scores, factor) | {"level": level, "participant": who, "mean": mean}
        for scores, factor, means in _each(measures)
        for level, every in means.iterrows()
        for who, mean in every.dropna().items()
    ]
    return OWN.fill(rows)


def t_tests(measures: Sequence[Scores], correction: str) -> ResultTable:
    """Paired t-tests of every pair of levels of every factor.

    Parameters
    ----------
    measures
        Scores of each measure that is compared.
    correction
        How p-values of one measure and factor are corrected: a key of
        `statistics.intervals.METHODS`.
    """
    rows: list[Row] = []
    notes: list[str] = []
    for scores, factor, means in _each(measures):
        of = f"{scores.measure}: {factor}"
        if len(means) < 2:
            notes.append(f"{of} is {means.index[0]} alone; nothing to compare")
        elif _of_groups(means):
            notes.append(
                f"{of} has groups of participants, and nobody is in two; no paired test. The "
                f"analysis of variance compares groups beside a factor within participants, the "
                f"model of trials legibility in any"
            )
        elif len(means) > MOST_LEVELS:
            notes.append(
                f"{of} has {len(means)} levels; the pairs of more than {MOST_LEVELS} are not tested"
            )
        else:
            own = [
                _what(scores, factor) | _pair(means, first, second, scores.trials is not None)
                for first, second in combinations(means.index, 2)
            ]
            tested = [row for row in own if "p" in row]
            for row, p in zip(
                tested, adjust([row["p"] for row in tested], correction), strict=True
            ):
                row["p_corrected"] = float(p)
            rows += own
    return T_TESTS.fill(rows, notes)


def analyses(measures: Sequence[Scores]) -> tuple[ResultTable, list[LeftOut]]:
    """Analyses of variance of all measures, and who was left out of them."""
    rows: list[Row] = []
    notes: list[str] = []
    left_out: list[LeftOut] = []
    for scores in measures:
        if all(_of_groups(_means(scores, factor)) for factor in scores.factors):
            which = " and ".join(scores.factors)
            notes.append(f"{scores.measure}: {which}: groups alone; nothing varies within people")
            continue
        try:
            found = _variance(scores)
        except ValueError as reason:  # Unanswerable, or more factors than can be compared
            notes.append(f"{scores.measure}: {reason}")
            continue
        for who, cells in found.dropped:
            missing = ", ".join(" and ".join(cell) for cell in cells)
            left_out.append(
                LeftOut(f"participant {who}, of the analysis of {scores.measure}", f"no {missing}")
            )
        if found.averaged:
            who = ", ".join(name for name, _ in found.averaged)
            notes.append(f"{scores.measure}: repeated scores were averaged first, of {who}")
        for effect in found.effects:
            told = asdict(effect)
            row: Row = {"measure": scores.measure, "effect": told.pop("name")}
            rows.append(row | {"participants": len(found.participants)} | told)
    return ANOVA.fill(rows, notes), left_out


def _variance(scores: Scores) -> Anova:
    """Analysis of variance, with the factors that groups of participants differ in between them."""
    apart = _between(scores)
    # Nobody has a score in a group of others; who misses one in the own group is left out whole.
    rows = [at for at, score in enumerate(scores.scores) if not apart or not math.isnan(score)]
    factors = {name: [of[at] for at in rows] for name, of in scores.factors.items()}
    return anova(
        [scores.participants[at] for at in rows],
        {name: of for name, of in factors.items() if name not in apart},
        [scores.scores[at] for at in rows],
        {name: of for name, of in factors.items() if name in apart},
    )


def _between(scores: Scores) -> set[str]:
    """Factors of which every participant has one level, beside others of which they have more."""
    found: set[str] = set()
    for name, column in scores.factors.items():
        rows = zip(scores.participants, column, scores.scores, strict=True)
        own = {(who, level) for who, level, score in rows if not math.isnan(score)}
        if len(own) == len({who for who, _ in own}) and len({level for _, level in own}) > 1:
            found.add(name)
    return found if len(found) < len(scores.factors) else set()


def _each(measures: Sequence[Scores]) -> Iterator[tuple[Scores, str, Any]]:
    """Each measure with each factor, and what `_means` gives of it."""
    return ((scores, name, _means(scores, name)) for scores in measures for name in scores.factors)


def _what(scores: Scores, factor: str) -> Row:
    return {"measure": scores.measure, "factor": factor}


def _means(scores: Scores, name: str) -> pd.DataFrame:
    """Mean of each participant at each level of a factor, NaN for none; [levels, participants].

    It is of each cell first, then over cells. Whoever lacks one of a level's cells has no mean
    there: it would be the mean of other things than the others' means.
    """
    apart = _between(scores)
    others = [of for own, of in scores.factors.items() if own != name and own not in apart]
    frame = pd.DataFrame(
        {"level": ordered(scores.factors[name]), "who": ordered(scores.participants)}
        | {f"other {at}": list(of) for at, of in enumerate(others)}
    )
    by = list(frame)
    cells = frame.assign(score=scores.scores).dropna(subset="score")
    cells = cells.groupby(by, observed=True)["score"].mean()
    own = cells.groupby(level=["level", "who"], observed=False).agg(["mean", "size"])
    full = math.prod(len(set(column)) for column in others)
    return own["mean"].where(own["size"] == full).unstack("who")


def _of_groups(means: pd.DataFrame) -> bool:
    """Tell if each participant has one level, and not all the same."""
    known = means.notna()
    return bool((known.sum() <= 1).all() and known.any(axis="columns").sum() > 1)


def _trials(scores: Scores, name: str) -> Any:
    """Number of answers of each participant at each level; None if scores are no shares."""
    if scores.trials is None:
        return None
    frame = pd.DataFrame({"level": scores.factors[name], "who": scores.participants})
    return frame.assign(trials=scores.trials).pivot_table("trials", "level", "who", "sum")


def _pair(means: Any, first: str, second: str, shares: bool) -> Row:
    """Columns of a paired test of two levels, or the note that says why there is none."""
    both = means.loc[[first, second]].dropna(axis="columns")
    row: Row = {"first": first, "second": second, "participants": both.columns.size}
    notes = _without(means, both.columns)
    try:
        test = paired_t(both.loc[first], both.loc[second])
    except Unanswerable as reason:
        notes.append(str(reason))
        row["mean_difference"] = mean_or_none((both.loc[first] - both.loc[second]).to_list())
    else:
        row |= asdict(test)
        if shares:  # they differ by 1 at most
            row |= {"low": max(test.low, -1.0), "high": min(test.high, 1.0)}
        if test.d_low is None:
            notes.append("no interval of d_z: t is too large for one")
        if test.g_z is None:
            notes.append("no g_z of two participants")
    return row | {"note": "; ".join(notes)}


def _without(means: Any, having: Iterable[object]) -> list[str]:
    """Note on participants left out of those who have any score; empty if there are none."""
    without = [who for who in means if who not in set(having)]
    return [f"without {', '.join(without)}: a score is missing"] if without else []
