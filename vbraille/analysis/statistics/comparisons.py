"""Cells of a design compared: means, effects, differences of levels, simple effects.

A cell is a combination of levels of the factors. A participant has a score, or some answers, in
the cells of the own group. Two models give the same kinds of numbers:

- `CellShares`, by `trialsmodel`: a logistic regression of single trials, participants as clusters;
- `CellScores`, of participants' own scores: each contrast of cells has its own error, from how the
  participants of each group differ in it (Welch 1938; Satterthwaite 1946). Within participants
  that is the t-test of their own contrasts, which supposes no sphericity. Effects of several
  degrees of freedom are by the analysis of variance, corrected by Greenhouse and Geisser.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import expit, gammaln, stdtr, stdtrit

from vbraille.analysis.statistics.anova import Anova, anova, orthonormal_contrasts
from vbraille.analysis.statistics.intervals import (
    FEWEST_PARTICIPANTS,
    ROUNDING,
    TAIL,
    Interval,
    Unanswerable,
    adjust,
    mean_interval,
    mean_share,
    too_few,
)
from vbraille.analysis.statistics.trialsmodel import (
    compare,
    compare_all,
    difference,
    fit_trials,
    separate_cells,
    tells_difference,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.statistics.trialsmodel import TrialsFit

    Floats = NDArray[np.float64]

FEWEST_OF_GROUP = 2
MOST_LEVELS = 12  # they make 66 pairs: more than should be compared
_FEW_DIFFER = "fewer than three participants have anything wrong, or right"
_ALIKE = "participants do not differ, or are too few to tell"


class CellEstimate(NamedTuple):
    """A mean or a difference, its interval and its test; None where there is none.

    Parameters
    ----------
    value
        In the measure's unit; of logarithms, a logarithm.
    low, high
        Ends of the 95 % interval.
    size
        ComparedEffect size of a difference: the odds ratio of shares, else Hedges's g.
    t, df, p
        Test that a difference is 0.
    participants
        How many tell of it.
    note
        Reason why there is no interval or test; or empty.
    """

    value: float | None = None
    low: float | None = None
    high: float | None = None
    size: float | None = None
    t: float | None = None
    df: float | None = None
    p: float | None = None
    participants: int = 0
    note: str = ""


class JointEffect(NamedTuple):
    """Test of an effect: F, both degrees of freedom and p; None where there is no test."""

    f: float | None = None
    df1: float | None = None
    df2: float | None = None
    p: float | None = None
    note: str = ""


class LevelPair(NamedTuple):
    """Two levels of a factor, first less second.

    Parameters
    ----------
    factor, first, second
        Number of the factor, and of its levels.
    weights : float64[cells]
        Weights of the cells in the difference.
    at
        Factor and level at which the difference is a simple effect; None over all.
    """

    factor: int
    first: int
    second: int
    weights: Floats
    at: tuple[int, int] | None = None


class CellDesign:
    """Cells by their levels.

    Parameters
    ----------
    levels : int64[cells, factors]
        Number of each cell's level of each factor.
    """

    def __init__(self, levels: NDArray[np.int64]) -> None:
        self.levels = levels

    def effects(self) -> list[tuple[int, ...]]:
        """Factors that act by themselves, then those that act together."""
        many = range(self.levels.shape[1])
        return [own for size in range(1, len(many) + 1) for own in combinations(many, size)]

    def contrasts(self, own: tuple[int, ...]) -> Floats:
        """Contrasts of cells that are 0 without an effect, float64[q, cells].

        They are averages over those combinations of the other factors' levels at which there are
        all levels of the effect's.

        Raises
        ------
        Unanswerable
            If a factor has one level, or there is no such combination.
        """
        sizes = [int(self.levels[:, at].max()) + 1 for at in own]
        if 1 in sizes:
            raise Unanswerable("a factor has one level")
        whole, others = self._whole(own, math.prod(sizes))
        apart = np.ones((1, 1))
        for size in sizes:
            apart = np.kron(apart, orthonormal_contrasts(size).T)
        place = np.ravel_multi_index(tuple(self.levels[:, list(own)].T), tuple(sizes))
        contrasts = apart[:, place] / others
        contrasts[:, ~whole] = 0.0
        return contrasts

    def compared(self, own: tuple[int, ...]) -> list[LevelPair]:
        """Differences in an effect: of a factor's levels, or simple effects of two factors."""
        if len(own) == 1:
            return self.pairs(own[0]) if self.levels[:, own[0]].max() < MOST_LEVELS else []
        return self.simple_effects(own)

    def pairs(self, factor: int) -> list[LevelPair]:
        """All pairs of a factor's levels, each averaged over those of the other factors."""
        return list(self._pairs(factor, np.ones(len(self.levels), bool), None))

    def simple_effects(self, own: tuple[int, ...]) -> list[LevelPair]:
        """Pairs of the first factor's levels at each level of the second; of two factors alone."""
        if len(own) != 2:
            return []
        factor, other = own
        return [
            pair
            for level in range(int(self.levels[:, other].max()) + 1)
            for pair in self._pairs(factor, self.levels[:, other] == level, (other, level))
        ]

    def _pairs(
        self, factor: int, chosen: NDArray[np.bool_], at: tuple[int, int] | None
    ) -> Iterator[LevelPair]:
        mine = self.levels[:, factor]
        rest = np.delete(self.levels, factor, axis=1)
        for first, second in combinations(range(int(mine.max()) + 1), 2):
            weights = np.zeros(len(mine))
            both = [
                (one, two)
                for one in np.flatnonzero(chosen & (mine == first))
                for two in np.flatnonzero(chosen & (mine == second))
                if (rest[one] == rest[two]).all()
            ]
            for one, two in both:
                weights[one] += 1 / len(both)
                weights[two] -= 1 / len(both)
            if both:
                yield LevelPair(factor, first, second, weights, at)

    def _whole(self, own: tuple[int, ...], size: int) -> tuple[NDArray[np.bool_], int]:
        """Cells at whose other levels there are all of an effect, and how many of those."""
        rest = np.delete(self.levels, list(own), axis=1)
        _, which = np.unique(rest, axis=0, return_inverse=True)
        which = which.ravel()
        whole = np.flatnonzero(np.bincount(which) == size)
        if not whole.size:
            raise Unanswerable("no combination of the other factors has all of its levels")
        return np.isin(which, whole), whole.size


class CellShares:
    """Right answers by participant and cell.

    Parameters
    ----------
    correct, asked : int64[k, cells]
        Right answers, and all answers.
    design
        The cells.
    """

    def __init__(
        self, correct: NDArray[np.int64], asked: NDArray[np.int64], design: CellDesign
    ) -> None:
        self.correct, self.asked, self.design = correct, asked, design

    @cached_property
    def fit(self) -> TrialsFit:
        """Model of all trials."""
        return fit_trials(self.correct, self.asked, separate_cells(*self.asked.shape))

    def mean(self, cell: int) -> CellEstimate:
        """Mean over participants of their own shares in a cell."""
        have = self.asked[:, cell] > 0
        right, asked = self.correct[have, cell], self.asked[have, cell]
        own = right / asked
        if not own.size:
            return CellEstimate(note="no trials")
        value = float(own.mean())
        try:
            found = mean_share(own, asked)
        except Unanswerable as reason:
            return CellEstimate(value, participants=own.size, note=f"no interval: {reason}")
        low, high = min(found.low, value), max(found.high, value)
        return CellEstimate(value, low, high, participants=own.size)

    def contrast(self, weights: Floats) -> CellEstimate:
        """Difference of weighted shares."""
        told = weights != 0
        have = (self.asked[:, told] > 0).any(axis=1)
        share = expit(self.fit.coefficients[0])
        log_odds = float(self.fit.coefficients[0] @ weights)
        made = CellEstimate(
            value=float(share @ weights),
            size=math.exp(min(max(log_odds, -600.0), 600.0)),
            participants=int(have.sum()),
        )
        if made.participants < FEWEST_PARTICIPANTS:
            return made._replace(note=f"no interval: {too_few(made.participants)}")
        test = compare(self.fit, weights)
        if np.isnan(test.errors[0]):
            return made._replace(note=f"no interval: {_ALIKE}")
        made = made._replace(
            t=float(test.estimates[0] / test.errors[0]),
            df=float(test.degrees[0]),
            p=float(test.p_values()[0]),
        )
        sides = [(self.asked[:, side] > 0).any(axis=1).sum() for side in (weights > 0, weights < 0)]
        if min(sides) < FEWEST_PARTICIPANTS:
            return made._replace(note="no interval: a group has fewer than three participants")
        if not tells_difference(self.correct[:, told], self.asked[:, told]):
            return made._replace(note=f"no interval: {_FEW_DIFFER}")
        low, high = difference(self.fit, weights)
        return made._replace(low=float(low[0]), high=float(high[0]))

    def joint(self, own: tuple[int, ...]) -> JointEffect:
        """Test of an effect: Wald's, as F with the degrees of freedom of Hotelling's T²."""
        try:
            contrasts = self.design.contrasts(own)
            if len(self.asked) < FEWEST_PARTICIPANTS:
                raise Unanswerable(too_few(len(self.asked)))
            found = compare_all(self.fit, contrasts)
        except Unanswerable as reason:
            return JointEffect(note=f"no test: {reason}")
        if np.isnan(found.p[0]):
            return JointEffect(note=f"no test: {_ALIKE}")
        return JointEffect(float(found.f[0]), found.df1, float(found.df2[0]), float(found.p[0]))


class CellScores:
    """Scores by participant and cell.

    Parameters
    ----------
    scores : float64[k, cells]
        Each participant's score in each cell; NaN for none.
    design
        The cells.
    group : int64[k]
        Group of each participant.
    groups : int64[cells]
        Group that has each cell.
    scale
        Least and greatest score that there may be.
    """

    def __init__(
        self,
        scores: Floats,
        design: CellDesign,
        group: NDArray[np.int64],
        groups: NDArray[np.int64],
        scale: Interval = Interval(-math.inf, math.inf),  # noqa: B008 - a tuple never changes
    ) -> None:
        self.scores, self.design, self.scale = scores, design, scale
        self.group, self.groups = group, groups

    def mean(self, cell: int) -> CellEstimate:
        """Mean over participants of their scores in a cell, with Student's interval."""
        own = self.scores[:, cell]
        own = own[~np.isnan(own)]
        if not own.size:
            return CellEstimate(note="no scores")
        value = float(own.mean())
        try:
            low, high = mean_interval(own)
        except Unanswerable as reason:
            return CellEstimate(value, participants=own.size, note=f"no interval: {reason}")
        ends = max(low, self.scale.low), min(high, self.scale.high)
        return CellEstimate(value, *ends, participants=own.size)

    def contrast(self, weights: Floats) -> CellEstimate:
        """Difference of weighted scores, with an error of its own."""
        terms, sizes = [], []
        for group in np.unique(self.groups[weights != 0]):
            mine = (self.groups == group) & (weights != 0)
            own = self.scores[self.group == group][:, mine]
            own = own[~np.isnan(own).any(axis=1)]
            terms.append(own @ weights[mine])
            sizes.append(max(weights[mine].clip(0).sum(), -weights[mine].clip(None, 0).sum()))
        many = [term.size for term in terms]
        made = CellEstimate(participants=sum(many))
        if 0 in many:
            return made._replace(note="no difference: a level has no complete participant")
        value = float(sum(term.mean() for term in terms))
        made = made._replace(value=value)
        if made.participants < FEWEST_PARTICIPANTS:
            return made._replace(note=f"no interval: {too_few(made.participants)}")
        if min(many) < FEWEST_OF_GROUP:
            return made._replace(note="no interval: a group has one participant")
        variances = np.array([term.var(ddof=1) for term in terms])
        parts, error_df = variances / many, np.array(many) - 1
        largest = max(np.abs(term).max() for term in terms)
        if parts.sum() <= (ROUNDING * largest) ** 2:
            return made._replace(note=f"no interval: {_ALIKE}")
        error = math.sqrt(parts.sum())
        df = float(parts.sum() ** 2 / (parts**2 / error_df).sum())
        pooled = float((variances / np.square(sizes) * error_df).sum() / error_df.sum())
        half = float(stdtrit(df, 1 - TAIL)) * error
        most = self.scale.high - self.scale.low
        return made._replace(
            low=max(value - half, -most),
            high=min(value + half, most),
            size=value / math.sqrt(pooled) * hedges_correction(int(error_df.sum())),
            t=value / error,
            df=df,
            p=float(2 * stdtr(df, -abs(value) / error)),
        )

    def joint(self, own: tuple[int, ...]) -> JointEffect:
        """Test of an effect: t² of one contrast, else by the analysis of variance."""
        try:
            contrasts = self.design.contrasts(own)
        except Unanswerable as reason:
            return JointEffect(note=f"no test: {reason}")
        if len(contrasts) == 1:
            found = self.contrast(contrasts[0])
            if found.t is None or found.p is None:
                return JointEffect(note=found.note.replace("no interval", "no test"))
            return JointEffect(found.t**2, 1, found.df, found.p)
        return self._varied(own) or self._smallest(own)

    def _varied(self, own: tuple[int, ...]) -> JointEffect | None:
        """Test by the analysis of variance; None where it is none of such a design."""
        found = self._anova
        if found is None or isinstance(found, JointEffect):
            return found
        wanted = {str(at) for at in own}
        effect = next(one for one in found.effects if set(one.name.split(" × ")) == wanted)
        if effect.p_corrected is None:
            return JointEffect(note=f"no test: {effect.note or _ALIKE}")
        epsilon = effect.epsilon or 1.0
        return JointEffect(effect.f, effect.df1 * epsilon, effect.df2 * epsilon, effect.p_corrected)

    @cached_property
    def _anova(self) -> Anova | JointEffect | None:
        """Analysis of variance of all effects, or why there is none; see `_varied`."""
        levels = self.design.levels
        names = [str(at) for at in range(levels.shape[1])]
        apart = [
            at
            for at in range(levels.shape[1])
            if all(np.unique(levels[self.groups == group, at]).size == 1 for group in self.groups)
        ]
        within = [at for at in range(levels.shape[1]) if at not in apart]
        crossed = math.prod(int(levels[:, at].max()) + 1 for at in range(levels.shape[1]))
        if not within or crossed != len(levels):
            return None
        who, cell = np.nonzero(self.groups == self.group[:, None])
        try:
            found = anova(
                [f"{one}" for one in who],
                {names[at]: [f"{level}" for level in levels[cell, at]] for at in within},
                self.scores[who, cell],
                {names[at]: [f"{level}" for level in levels[cell, at]] for at in apart},
            )
        except Unanswerable as reason:
            return JointEffect(note=f"no test: {reason}")
        if len(found.participants) < FEWEST_PARTICIPANTS:
            return JointEffect(note=f"no test: {too_few(len(found.participants))}")
        return found

    def _smallest(self, own: tuple[int, ...]) -> JointEffect:
        """Smallest p of the pairs of a factor, times their number."""
        if len(own) > 1:
            return JointEffect(note="no test: an interaction of groups alone has several parts")
        pairs = self.design.compared(own)
        known = [p for pair in pairs if (p := self.contrast(pair.weights).p) is not None]
        if not known:
            return JointEffect(note=f"no test: {_ALIKE}")
        return JointEffect(
            p=min(1.0, min(known) * len(known)), note="by the smallest p of its pairs"
        )


def hedges_correction(df: int) -> float:
    """Factor that makes a standardised mean difference unbiased, below 1.

    J = Γ(df/2) / (√(df/2) · Γ((df - 1)/2)), Hedges 1981, equation 6e. This is the
    exact factor, not its approximation 1 - 3/(4 df - 1).

    Raises
    ------
    ValueError
        If `df` is below 2.
    """
    if df < 2:
        raise ValueError(f"{df} degrees of freedom; the correction needs two")
    return math.exp(float(gammaln(df / 2) - gammaln((df - 1) / 2)) - math.log(df / 2) / 2)


class ComparedEffect(NamedTuple):
    """An effect and what is in it.

    Parameters
    ----------
    factors
        Numbers of the factors that act together.
    test
        Test of the effect.
    p
        p corrected for all effects; None without a test.
    pairs
        Differences of levels, or simple effects of an interaction, each with its p corrected:
        for the others of this effect, and at least that of the effect itself.
    """

    factors: tuple[int, ...]
    test: JointEffect
    p: float | None
    pairs: tuple[tuple[LevelPair, CellEstimate, float | None], ...]


def effects(data: CellShares | CellScores, correction: str) -> list[ComparedEffect]:
    """Test all effects of a design and compare the levels in them.

    The effects are one family, corrected together. The differences within an effect are corrected
    among themselves, and count only as far as the effect does: their p is at least its. So the
    chance of any wrong finding, where there is nothing to be found, is that of the effects.

    Parameters
    ----------
    correction
        A key of `intervals.METHODS`.
    """
    design = data.design
    found = [(own, data.joint(own)) for own in design.effects()]
    pairs = [design.compared(own) for own, _ in found]
    told = [[data.contrast(pair.weights) for pair in of] for of in pairs]
    family, within = correct_family(
        np.array([[np.nan if test.p is None else test.p for _, test in found]]),
        [np.array([[np.nan if one.p is None else one.p for one in of]]) for of in told],
        correction,
    )
    return [
        ComparedEffect(
            own,
            test,
            _known(family[0, at]),
            tuple(
                (pair, one, _known(p))
                for pair, one, p in zip(pairs[at], told[at], within[at][0], strict=True)
            ),
        )
        for at, (own, test) in enumerate(found)
    ]


def correct_family(
    effect_p: Floats, pair_p: Sequence[Floats], correction: str
) -> tuple[Floats, list[Floats]]:
    """Correct p of effects as one family, and those of the differences in each effect.

    Parameters
    ----------
    effect_p : float64[studies, effects]
        p of each effect; NaN where there is none.
    pair_p : float64[studies, pairs] each
        p of the differences in each effect.
    correction
        A key of `intervals.METHODS`.

    Returns
    -------
    float64[studies, effects], and a list of float64[studies, pairs]
        Corrected p; that of a difference is at least that of its effect.
    """
    family = _adjusted(effect_p, correction)
    within = [_adjusted(own, correction) for own in pair_p]
    return family, [np.maximum(own, family[:, [at]]) for at, own in enumerate(within)]


def _adjusted(p: Floats, correction: str) -> Floats:
    """P corrected in each study for those that it has, float64[studies, n]."""
    known = ~np.isnan(p)
    if known.all():
        return adjust(p, correction)
    corrected = np.full_like(p, np.nan)
    for study, own in enumerate(known):
        corrected[study, own] = adjust(p[study, own], correction)
    return corrected


def _known(p: float) -> float | None:
    return None if math.isnan(p) else float(p)
