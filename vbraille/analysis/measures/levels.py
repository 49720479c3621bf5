"""Levels compared within participants: Lévesque 2009, 4.3 and its supplementary analysis."""

from __future__ import annotations

import math
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from vbraille.analysis.input.trials import LeftOut, natural
from vbraille.analysis.measures.averages import mean_or_none
from vbraille.analysis.schemas import NOTE_COLUMN, Column, Kind, Schema
from vbraille.analysis.statistics.anova import Anova, anova
from vbraille.analysis.statistics.correction import adjust
from vbraille.analysis.statistics.intervals import Interval, mean_duration, mean_interval
from vbraille.analysis.statistics.mixedanova import MixedAnova, mixed_anova
from vbraille.analysis.statistics.paired import PairedTest, paired_t
from vbraille.analysis.statistics.shares import mean_share
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.analysis.input.scoretable import Scores
    from vbraille.analysis.schemas import ResultTable, Row

NOTHING = "there are no scores to compare"
MOST_LEVELS = 12  # they make 66 pairs: more t-tests than anybody should make of one table
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
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        NOTE_COLUMN,
    ),
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
        Column("participant", "participant", "pseudonym"),
        Column("mean", "mean", "in the measure's unit", Kind.NUMBER),
    ),
)
_MIXED = "beside a factor between participants: no test of sphericity, no interval"
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
        Column("low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("high", "to", "upper end", Kind.NUMBER),
        Column("t", "t", "Student's", Kind.NUMBER),
        Column("df", "df", "degrees of freedom", Kind.COUNT),
        Column("p", "p", "two-sided, not corrected", Kind.P),
        Column("p_corrected", "p corrected", "for the tests of this measure and factor", Kind.P),
        Column("d_z", "d_z", "effect size", Kind.NUMBER),
        Column("d_low", "d_z from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("d_high", "d_z to", "upper end", Kind.NUMBER),
        Column("g_z", "g_z", "effect size, corrected", Kind.NUMBER),
        NOTE_COLUMN,
    ),
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
        Column("partial_low", "from", "lower end of its 95 % interval", Kind.NUMBER),
        Column("partial_high", "to", "upper end", Kind.NUMBER),
        Column("generalised_eta2", "generalised eta²", "effect size", Kind.NUMBER),
        NOTE_COLUMN,
    ),
)


def level_means(measures: Sequence[Scores]) -> ResultTable:
    """Mean of every level of every factor.

    Parameters
    ----------
    measures
        Scores of each measure that is compared.
    """
    rows: list[Row] = []
    for scores in measures:
        for factor in scores.factors:
            means = _means(scores, factor)
            groups = _of_groups(means)
            for level in sorted(means, key=natural):
                own = list(means[level].values())
                trials = _trials(scores, factor, level)
                row: Row = {
                    "measure": scores.measure,
                    "factor": factor,
                    "level": level,
                    "participants": len(own),
                    "mean": mean_or_none(own),
                }
                notes = [] if groups else _without(scores.participants, means[level])
                try:
                    interval = _interval(scores, means[level], trials)
                    row |= {"low": interval.low, "high": interval.high}
                except Unanswerable as reason:
                    notes.append(f"no interval: {reason}")
                rows.append(row | {"note": "; ".join(notes)})
    return MEANS.fill(rows, [] if rows else [NOTHING])


def own_means(measures: Sequence[Scores]) -> ResultTable:
    """Mean of every participant at every level of every factor."""
    rows: list[Row] = [
        {
            "measure": scores.measure,
            "factor": factor,
            "level": level,
            "participant": who,
            "mean": of[who],
        }
        for scores in measures
        for factor in scores.factors
        for level, of in sorted(_means(scores, factor).items(), key=lambda pair: natural(pair[0]))
        for who in sorted(of, key=natural)
    ]
    return OWN.fill(rows, [] if rows else [NOTHING])


def t_tests(measures: Sequence[Scores], correction: str) -> ResultTable:
    """Paired t-tests of every pair of levels of every factor.

    Parameters
    ----------
    measures
        Scores of each measure that is compared.
    correction
        How p-values of one measure and factor are corrected: a key of
        `statistics.correction.METHODS`.
    """
    rows: list[Row] = []
    notes: list[str] = []
    for scores in measures:
        for factor in scores.factors:
            means = _means(scores, factor)
            levels = sorted(means, key=natural)
            if len(levels) < 2:
                notes.append(f"{scores.measure}: {factor} is {levels[0]} alone; nothing to compare")
            elif _of_groups(means):
                notes.append(
                    f"{scores.measure}: {factor} has groups of participants, and nobody is in two; "
                    f"no paired test. The analysis of variance compares groups beside a factor "
                    f"within participants, the model of trials legibility in any"
                )
            elif len(levels) > MOST_LEVELS:
                notes.append(
                    f"{scores.measure}: {factor} has {len(levels)} levels; the pairs of more than "
                    f"{MOST_LEVELS} are not tested"
                )
            else:
                rows += _pairs(scores, factor, levels, means, correction)
    return T_TESTS.fill(rows, notes if rows or notes else [NOTHING])


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
        mixed = isinstance(found, MixedAnova)
        if isinstance(found, Anova) and found.averaged:
            who = ", ".join(name for name, _ in found.averaged)
            notes.append(f"{scores.measure}: repeated scores were averaged first, of {who}")
        rows += [
            {
                "measure": scores.measure,
                "effect": effect.name,
                "participants": len(found.participants),
                **{c.name: getattr(effect, c.name, None) for c in ANOVA.columns[3:]},
                "note": "; ".join(filter(None, [effect.note, _MIXED if mixed else ""])),
            }
            for effect in found.effects
        ]
    return ANOVA.fill(rows, notes if rows or notes else [NOTHING]), left_out


def _variance(scores: Scores) -> Anova | MixedAnova:
    """Analysis of variance, with the factors that groups of participants differ in between them.

    Raises
    ------
    ValueError
        If there is nothing to compare, or more factors than can be compared.
    """
    apart = _between(scores)
    if not apart:
        return anova(scores.participants, scores.factors, scores.scores)
    # Nobody has a score in a group of others; who misses one in the own group is left out whole.
    known = [at for at, score in enumerate(scores.scores) if not math.isnan(score)]
    factors = {name: [of[at] for at in known] for name, of in scores.factors.items()}
    between = {name: of for name, of in factors.items() if name in apart}
    within = {name: of for name, of in factors.items() if name not in apart}
    who = [scores.participants[at] for at in known]
    return mixed_anova(who, between, within, [scores.scores[at] for at in known])


def _between(scores: Scores) -> set[str]:
    """Factors of which every participant has one level, beside others of which they have more."""
    found: set[str] = set()
    for name, column in scores.factors.items():
        rows = zip(scores.participants, column, scores.scores, strict=True)
        own = {(who, level) for who, level, score in rows if not math.isnan(score)}
        if len(own) == len({who for who, _ in own}) and len({level for _, level in own}) > 1:
            found.add(name)
    return found if len(found) < len(scores.factors) else set()


def _means(scores: Scores, factor: str) -> dict[str, dict[str, float]]:
    """Mean of each participant at each level of a factor: of each cell first, then over cells.

    Whoever lacks one of a level's cells has no mean there: it would be the mean of other things
    than the others' means.
    """
    cells: dict[tuple[str, str, tuple[str, ...]], list[float]] = {}
    apart = _between(scores)
    others = [of for name, of in scores.factors.items() if name != factor and name not in apart]
    cell_of = zip(*others, strict=True) if others else ((),) * len(scores.scores)
    columns = (scores.participants, scores.factors[factor], cell_of, scores.scores)
    for who, level, cell, score in zip(*columns, strict=True):
        if not math.isnan(score):
            cells.setdefault((level, who, tuple(cell)), []).append(score)
    means: dict[str, dict[str, list[float]]] = {level: {} for level in scores.factors[factor]}
    for (level, who, _), values in cells.items():
        means[level].setdefault(who, []).append(float(np.mean(values)))
    full = math.prod(len(set(column)) for column in others)
    return {
        level: {who: float(np.mean(values)) for who, values in of.items() if len(values) == full}
        for level, of in means.items()
    }


def _of_groups(means: dict[str, dict[str, float]]) -> bool:
    """Tell if each participant has one level, and not all the same."""
    own = [who for of in means.values() for who in of]
    return len(own) == len(set(own)) and sum(map(bool, means.values())) > 1


def _trials(scores: Scores, factor: str, level: str) -> dict[str, int] | None:
    """Number of answers that each participant gave at a level; None if scores are no shares."""
    if scores.trials is None:
        return None
    columns = (scores.participants, scores.factors[factor], scores.trials)
    answers: dict[str, int] = {}
    for who, at, number in zip(*columns, strict=True):
        if at == level:
            answers[who] = answers.get(who, 0) + number
    return answers


def _interval(scores: Scores, means: dict[str, float], trials: dict[str, int] | None) -> Interval:
    """Interval of the population's mean, by the method for shares, for durations or for others."""
    own = list(means.values())
    if trials is not None:
        return mean_share(own, [trials[who] for who in means])
    return mean_duration(own) if scores.durations else mean_interval(own)


def _pairs(
    scores: Scores,
    factor: str,
    levels: Sequence[str],
    means: dict[str, dict[str, float]],
    correction: str,
) -> Iterator[Row]:
    """Rows for all pairs of levels, with p corrected for the number of pairs."""
    rows: list[Row] = []
    tested: list[Row] = []
    for first, second in combinations(levels, 2):
        have = [means[first].keys(), means[second].keys()]
        both = sorted(have[0] & have[1], key=natural)
        row: Row = {
            "measure": scores.measure,
            "factor": factor,
            "first": first,
            "second": second,
            "participants": len(both),
        }
        notes = _without(scores.participants, both)
        try:
            test = paired_t(
                [means[first][who] for who in both], [means[second][who] for who in both]
            )
        except Unanswerable as reason:
            notes.append(str(reason))
            if both:
                row["mean_difference"] = float(
                    np.mean([means[first][who] - means[second][who] for who in both])
                )
        else:
            row |= _tested(test)
            if scores.trials is not None:  # shares differ by 1 at most
                row |= {"low": max(test.low, -1.0), "high": min(test.high, 1.0)}
            tested.append(row)
            if test.d_low is None:
                notes.append("no interval of d_z: t is too large for one")
            if test.g_z is None:
                notes.append("no g_z of two participants")
        rows.append(row | {"note": "; ".join(notes)})
    corrected = adjust([float(row["p"]) for row in tested], correction)
    known = {
        (row["first"], row["second"]): p for row, p in zip(tested, corrected.tolist(), strict=True)
    }
    for row in rows:
        yield row | {"p_corrected": known.get((row["first"], row["second"]))}


def _without(participants: Iterable[str], having: Iterable[str]) -> list[str]:
    """Note on who is left out; empty if nobody is."""
    without = sorted({*participants} - {*having}, key=natural)
    return [f"without {', '.join(without)}: a score is missing"] if without else []


def _tested(test: PairedTest) -> Row:
    names = ("mean_difference", "low", "high", "t", "df", "p", "d_z", "d_low", "d_high", "g_z")
    return {name: getattr(test, name) for name in names}
