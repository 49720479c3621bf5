"""Repeated-measures analysis of variance, with one to four factors within participants.

Every effect is a set of orthonormal contrasts between a participant's scores, and
its sums of squares are those of the contrasts (Winer, Brown and Michels 1991, ch. 4
and 7; Kirk 2013, ch. 10). statsmodels' AnovaRM gives the same F, and the tests hold the
two against each other; but it fits a dummy for each participant in each cell (2 s and
0.4 GB for 200 participants and 26 letters), keeps no sums of squares and knows no
sphericity, so that the contrasts would be needed beside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.stats import f

from vbraille.analysis.statistics.effectsizes import partial_eta2_interval
from vbraille.analysis.statistics.sphericity import sphericity
from vbraille.analysis.statistics.unanswerable import Unanswerable
from vbraille.analysis.statistics.withinsubject import arrange

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.statistics.withinsubject import Cell

# Sums of squares below this share of the scores' own are rounding.
ROUNDING = 1e-24


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect. A value that cannot be found is None, and `note` says why.

    Parameters
    ----------
    name
        The factors' names, joined by " × ".
    factors
        The factors that act together in it.
    df1, df2
        Degrees of freedom of the effect and of its error.
    f, p
        F, and its p if sphericity holds.
    epsilon, p_corrected
        Greenhouse and Geisser's epsilon, and p with both degrees of freedom multiplied by it.
    huynh_feldt, p_huynh_feldt
        Huynh and Feldt's epsilon, and p with both degrees of freedom multiplied by it.
    mauchly_w, mauchly_chi2, mauchly_df, mauchly_p
        Mauchly's test of sphericity; see `sphericity`.
    partial_eta2, partial_low, partial_high
        SS_effect / (SS_effect + SS_error), and its 95 % interval by noncentral F.
    generalised_eta2
        SS_effect over the sum of itself, the participants' SS and all errors' SS (Olejnik and
        Algina 2003, all factors manipulated).
    note
        Why something is None, or ought not to be read on its own; may be empty.
    """

    name: str
    factors: tuple[str, ...]
    df1: int
    df2: int
    f: float | None
    p: float | None
    epsilon: float | None
    p_corrected: float | None
    huynh_feldt: float | None
    p_huynh_feldt: float | None
    mauchly_w: float | None
    mauchly_chi2: float | None
    mauchly_df: int | None
    mauchly_p: float | None
    partial_eta2: float | None
    partial_low: float | None
    partial_high: float | None
    generalised_eta2: float | None
    note: str

    def __post_init__(self) -> None:
        if self.df1 < 1 or self.df2 < self.df1:
            raise ValueError(f"degrees of freedom {self.df1}, {self.df2} of {self.name}")
        for epsilon in (self.epsilon, self.huynh_feldt):
            if epsilon is not None and not 0 < epsilon <= 1:
                raise ValueError(f"epsilon {epsilon} of {self.name} is not in 0…1")


@dataclass(frozen=True, slots=True)
class Anova:
    """An analysis of variance.

    Parameters
    ----------
    participants
        Participants who have a score in every cell, in order of appearance.
    dropped
        Participants who lack a score, each with the cells that are missing: a cell is a
        level of each factor, in the factors' order.
    averaged
        Members of `participants` with more than one score in a cell, each with the
        number of such cells; the mean stands for them.
    effects
        Main effects in the factors' order, then their interactions.
    """

    participants: tuple[str, ...]
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...]
    averaged: tuple[tuple[str, int], ...]
    effects: tuple[Effect, ...]


def anova(
    participants: Sequence[str],
    factors: Mapping[str, Sequence[str]],
    scores: Sequence[float] | NDArray[np.float64],
) -> Anova:
    """Analysis of variance of scores in long form, a row for each score.

    Parameters
    ----------
    participants : str[n]
        The participant of each score.
    factors
        One to four names, each with the level of every row, str[n]. Any name
        will do. Levels count in order of first appearance.
    scores : float[n]
        Scores in any one unit; NaN where a score is missing.

    Raises
    ------
    Unanswerable
        If there are no scores, a factor has one level, there are over 2000
        cells, or fewer than two participants have a score in each.
    ValueError
        If there are no or too many factors, columns differ in length, or a
        score is infinite.
    """
    design = arrange(participants, factors, scores)
    cube = design.cube
    names = tuple(factors)
    subsets = [
        s for size in range(1, len(names) + 1) for s in combinations(range(len(names)), size)
    ]
    contrasts = [contrast_scores(cube, subset) for subset in subsets]
    between = contrast_scores(cube, ())
    error = [_deviations(z) for z in contrasts]
    all_errors = sum(error) + _deviations(between)
    rounding = ROUNDING * float((cube**2).sum())
    cells = math.prod(cube.shape[1:])
    return Anova(
        design.participants,
        design.dropped,
        design.averaged,
        tuple(
            _effect(tuple(names[i] for i in subset), z, all_errors, rounding, cells)
            for subset, z in zip(subsets, contrasts, strict=True)
        ),
    )


def orthonormal_contrasts(levels: int) -> NDArray[np.float64]:
    """Helmert's contrasts, each of length 1: float64[levels, levels - 1]."""
    raw = np.tril(np.ones((levels, levels)), -1)[1:] - np.diag(np.arange(1.0, levels), 1)[:-1]
    return (raw / np.linalg.norm(raw, axis=1, keepdims=True)).T


def contrast_scores(cube: NDArray[np.float64], subset: tuple[int, ...]) -> NDArray[np.float64]:
    """Each participant's scores on the contrasts of an effect, float64[participants, df1].

    The contrasts are the Kronecker product of each factor's: its own if it acts
    in the effect, the mean (also of length 1) if not. One axis is contracted after
    the other, so that the product is never made.
    """
    for axis, levels in enumerate(cube.shape[1:]):
        mean = np.full((levels, 1), levels**-0.5)
        matrix = orthonormal_contrasts(levels) if axis in subset else mean
        cube = np.moveaxis(np.tensordot(cube, matrix, axes=(axis + 1, 0)), -1, axis + 1)
    return cube.reshape(cube.shape[0], -1)


def _deviations(z: NDArray[np.float64]) -> float:
    """Sum of squares about the mean over participants."""
    return float(((z - z.mean(axis=0)) ** 2).sum())


def _effect(
    factors: tuple[str, ...],
    z: NDArray[np.float64],
    all_errors: float,
    rounding: float,
    cells: int,
) -> Effect:
    """Test of one effect from its contrast scores, float64[n, df1]."""
    n, df1 = z.shape
    df2 = df1 * (n - 1)
    of_effect, of_error = n * float((z.mean(axis=0) ** 2).sum()), _deviations(z)
    total = of_effect + all_errors
    generalised = of_effect / total if total > rounding else None
    name = " × ".join(factors)
    if of_error <= rounding:
        empty: dict[str, Any] = dict.fromkeys(Effect.__slots__)
        known = {"name": name, "factors": factors, "df1": df1, "df2": df2}
        alike = "all participants differ alike between its levels; F has no value"
        return Effect(**empty | known | {"generalised_eta2": generalised, "note": alike})
    ratio = (of_effect / df1) / (of_error / df2)
    found = sphericity(z, cells=cells, one_factor=len(factors) == 1)
    p, p_greenhouse, p_huynh = (
        float(f.sf(ratio, epsilon * df1, epsilon * df2))
        for epsilon in (1.0, found.epsilon, found.huynh_feldt)
    )
    low, high, note = None, None, found.note
    try:
        interval = partial_eta2_interval(ratio, df1, df2)
        low, high = interval.low, interval.high
    except Unanswerable as reason:
        note = "; ".join(filter(None, (note, f"no interval of partial eta²: {reason}")))
    return Effect(
        name=name,
        factors=factors,
        df1=df1,
        df2=df2,
        f=ratio,
        p=p,
        epsilon=found.epsilon,
        p_corrected=p_greenhouse,
        huynh_feldt=found.huynh_feldt,
        p_huynh_feldt=p_huynh,
        mauchly_w=found.w,
        mauchly_chi2=found.chi2,
        mauchly_df=found.df,
        mauchly_p=found.p,
        partial_eta2=of_effect / (of_effect + of_error),
        partial_low=low,
        partial_high=high,
        generalised_eta2=generalised,
        note=note,
    )
