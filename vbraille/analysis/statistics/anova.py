"""Repeated-measures analysis of variance, with one to four factors within participants.

Every effect is a set of orthonormal contrasts between a participant's scores, and
its sums of squares are those of the contrasts (Winer, Brown and Michels 1991, ch. 4
and 7; Kirk 2013, ch. 10). statsmodels' AnovaRM gives the same F, and the tests hold the
two against each other; but it fits a dummy for each participant in each cell (2 s and
0.4 GB for 200 participants and 26 letters), keeps no sums of squares and knows no
sphericity, so that the contrasts would be needed beside it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import chi2, f

from vbraille.analysis.statistics.design import arrange

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.analysis.statistics.design import Cell

# Sums of squares below this share of the scores' own are rounding.
ROUNDING = 1e-24


@dataclass(frozen=True, slots=True)
class Effect:
    """One effect. What has no value is None, and `note` says why.

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
        Greenhouse and Geisser's, and p with both degrees of freedom times it.
    mauchly_w, mauchly_chi2, mauchly_df, mauchly_p
        Mauchly's test of sphericity.
    partial_eta2
        SS_effect / (SS_effect + SS_error).
    generalised_eta2
        SS_effect over itself, the participants' and all errors' (Olejnik and
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
    mauchly_w: float | None
    mauchly_chi2: float | None
    mauchly_df: int | None
    mauchly_p: float | None
    partial_eta2: float | None
    generalised_eta2: float | None
    note: str

    def __post_init__(self) -> None:
        if self.df1 < 1 or self.df2 < self.df1:
            raise ValueError(f"degrees of freedom {self.df1}, {self.df2} of {self.name}")
        if self.epsilon is not None and not 0 < self.epsilon <= 1:
            raise ValueError(f"epsilon {self.epsilon} of {self.name} is not in 0…1")

    @property
    def df1_corrected(self) -> float | None:
        """`df1` times epsilon."""
        return None if self.epsilon is None else self.epsilon * self.df1

    @property
    def df2_corrected(self) -> float | None:
        """`df2` times epsilon."""
        return None if self.epsilon is None else self.epsilon * self.df2


@dataclass(frozen=True, slots=True)
class Anova:
    """An analysis of variance.

    Parameters
    ----------
    participants
        Those who have a score in every cell, in order of appearance.
    dropped
        Those who have not, each with the cells that are missing: a cell is a
        level of each factor, in the factors' order.
    averaged
        Those of `participants` with more than one score in a cell, each with the
        number of such cells; the mean stands for them.
    effects
        Main effects in the factors' order, then their interactions.
    """

    participants: tuple[str, ...]
    dropped: tuple[tuple[str, tuple[Cell, ...]], ...]
    averaged: tuple[tuple[str, int], ...]
    effects: tuple[Effect, ...]


@dataclass(frozen=True, slots=True)
class _Sphericity:
    epsilon: float
    w: float | None = None
    chi2: float | None = None
    df: int | None = None
    p: float | None = None
    note: str = ""


def anova(
    participants: Sequence[str],
    factors: Mapping[str, Sequence[str]],
    scores: Sequence[float] | NDArray[np.float64],
) -> Anova:
    """Analysis of variance of scores in long form, a row for each score.

    Parameters
    ----------
    participants : str[n]
        Whose score each is.
    factors
        One to four names, each with the level of every row, str[n]. Any name
        will do. Levels count in order of first appearance.
    scores : float[n]
        In any one unit; NaN where a score is missing.

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
    contrasts = [_contrast_scores(cube, subset) for subset in subsets]
    between = _contrast_scores(cube, ())
    error = [_deviations(z) for z in contrasts]
    all_errors = sum(error) + _deviations(between)
    rounding = ROUNDING * float((cube**2).sum())
    return Anova(
        design.participants,
        design.dropped,
        design.averaged,
        tuple(
            _effect(tuple(names[i] for i in subset), z, all_errors, rounding)
            for subset, z in zip(subsets, contrasts, strict=True)
        ),
    )


def orthonormal_contrasts(levels: int) -> NDArray[np.float64]:
    """Helmert's contrasts, each of length 1: float64[levels, levels - 1]."""
    raw = np.tril(np.ones((levels, levels)), -1)[1:] - np.diag(np.arange(1.0, levels), 1)[:-1]
    return (raw / np.linalg.norm(raw, axis=1, keepdims=True)).T


def _contrast_scores(cube: NDArray[np.float64], subset: tuple[int, ...]) -> NDArray[np.float64]:
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
    factors: tuple[str, ...], z: NDArray[np.float64], all_errors: float, rounding: float
) -> Effect:
    """Test of one effect from its contrast scores, float64[n, df1]."""
    n, df1 = z.shape
    df2 = df1 * (n - 1)
    of_effect, of_error = n * float((z.mean(axis=0) ** 2).sum()), _deviations(z)
    total = of_effect + all_errors
    generalised = of_effect / total if total > rounding else None
    name = " × ".join(factors)
    if of_error <= rounding:
        alike = "all participants differ alike between its levels; F has no value"
        return Effect(
            name=name,
            factors=factors,
            df1=df1,
            df2=df2,
            f=None,
            p=None,
            epsilon=None,
            p_corrected=None,
            mauchly_w=None,
            mauchly_chi2=None,
            mauchly_df=None,
            mauchly_p=None,
            partial_eta2=None,
            generalised_eta2=generalised,
            note=alike,
        )
    ratio = (of_effect / df1) / (of_error / df2)
    sphericity = _sphericity(z, one_factor=len(factors) == 1)
    epsilon = sphericity.epsilon
    return Effect(
        name=name,
        factors=factors,
        df1=df1,
        df2=df2,
        f=ratio,
        p=float(f.sf(ratio, df1, df2)),
        epsilon=epsilon,
        p_corrected=float(f.sf(ratio, epsilon * df1, epsilon * df2)),
        mauchly_w=sphericity.w,
        mauchly_chi2=sphericity.chi2,
        mauchly_df=sphericity.df,
        mauchly_p=sphericity.p,
        partial_eta2=of_effect / (of_effect + of_error),
        generalised_eta2=generalised,
        note=sphericity.note,
    )


def _sphericity(z: NDArray[np.float64], *, one_factor: bool) -> _Sphericity:
    """Whether an effect's contrasts vary alike and apart, as F supposes.

    With S the covariance of d contrasts over n participants, Greenhouse and Geisser
    1959 estimate Box's (1954) ε = tr(S)² / (d tr(S²)); Mauchly 1940 tests
    W = |S| / (tr(S)/d)^d, and -(n - 1 - (2d² + d + 2)/(6d)) ln W is chi-square with
    d(d + 1)/2 - 1 degrees of freedom (Anderson 2003, 10.7).
    """
    n, d = z.shape
    if d == 1:
        only = "two levels" if one_factor else "one contrast"
        return _Sphericity(1.0, note=f"{only}: sphericity holds by itself")
    deviations = z - z.mean(axis=0)
    spread = np.linalg.svd(deviations, compute_uv=False) ** 2  # (n - 1) times S's eigenvalues
    shares = spread / spread.sum()
    epsilon = min(1.0, 1 / (d * float((shares**2).sum())))
    if n - 1 < d:
        return _Sphericity(
            epsilon, note=f"{n} participants are too few to test the sphericity of {d} contrasts"
        )
    if shares.min() <= 1e-12 * shares.max():
        return _Sphericity(
            epsilon, note="some contrasts follow from the others; sphericity cannot be tested"
        )
    log_w = min(0.0, float(np.log(d * shares).sum()))
    df = d * (d + 1) // 2 - 1
    statistic = -(n - 1 - (2 * d**2 + d + 2) / (6 * d)) * log_w
    return _Sphericity(epsilon, float(np.exp(log_w)), statistic, df, float(chi2.sf(statistic, df)))
