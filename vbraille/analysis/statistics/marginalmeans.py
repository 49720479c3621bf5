"""Estimated shares of right answers in conditions, and how far they are apart.

All come from a fitted `trialsmodel`; shares are those of the population's answers, averaged over
its people.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import expit
from scipy.stats import f as fisher
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, TAIL, Unanswerable
from vbraille.analysis.statistics.trialsmodel import adjusted_weights, combine, term_covariance

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.analysis.statistics.trialsmodel import Contrasts, TrialsFit

FEWEST_DEGREES = 1.0  # of the error; with fewer F tells nothing
_SINGULAR = 1e-9  # of the variance by chance, below which participants do not differ in something
TO_D = math.sqrt(3) / math.pi
"""What a logarithm of an odds ratio is multiplied by for Cohen's d of what lies beneath: the
standard deviation of the logistic distribution (Hasselblad and Hedges 1995)."""


class JointTest(NamedTuple):
    """Tests of several studies.

    Parameters
    ----------
    f, df2, p : float64[studies]
        F, its second degrees of freedom, and the p that all combinations are 0; NaN where
        participants are too few, or do not differ in something that is tested.
    df1
        How many combinations are tested: the first degrees of freedom.
    """

    f: NDArray[np.float64]
    df1: int
    df2: NDArray[np.float64]
    p: NDArray[np.float64]


def separate_cells(participants: int, cells: int) -> NDArray[np.float64]:
    """Design in which each cell has log odds of its own: float64[participants, cells, cells].

    Cells may be conditions within participants, groups between them, or both crossed; a
    participant has no trials in the cells of other groups.
    """
    return np.tile(np.eye(cells), (participants, 1, 1))


def difference(
    fit: TrialsFit, first: ArrayLike, second: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ends of the interval of a difference of two shares of right answers, first less second.

    It is that of the inverse hyperbolic tangent of the difference, by the slope along
    the coefficients (delta method) and t with the degrees of freedom of the difference itself.
    With those of the odds ratio instead it would hold the truth 91 times in 100 near the ceiling,
    and 99 times when put together of the two shares' own intervals (Newcombe 1998).

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float[p]
        Values of the design's columns at each.

    Returns
    -------
    low, high : float64[studies]
        From -1 to 1; NaN where there is no interval.
    """
    (one, up), (two, down) = (_share(fit, of) for of in (first, second))
    value = one - two
    apart = combine(fit, up - down)
    half = student.ppf(1 - TAIL, apart.degrees) * apart.errors / (1 - value**2)
    middle = np.arctanh(value)
    return np.tanh(middle - half), np.tanh(middle + half)


def tells_difference(correct: ArrayLike, trials: ArrayLike) -> NDArray[np.bool_]:
    """Whether three participants or more have something wrong, and as many something right.

    Where fewer have, `difference` is wider than it says: of three people near the ceiling it then
    holds the truth 99 to 100 times in 100.

    Parameters
    ----------
    correct, trials : int[studies, k, c]
        Right answers and all answers of each participant in each of the cells that are compared.

    Returns
    -------
    bool[studies]
    """
    right, asked = (np.asarray(of).sum(axis=-1) for of in (correct, trials))
    some = [(of > 0).sum(axis=-1) >= FEWEST_PARTICIPANTS for of in (right, asked - right)]
    return some[0] & some[1]


def compare(fit: TrialsFit, first: ArrayLike, second: ArrayLike) -> Contrasts:
    """Test that two shares of right answers are the same.

    They are compared as 2 asin √share, by the slope along the coefficients: the errors of this do
    not depend on the share. Log odds find too much in two groups of twenty people near the ceiling
    (6.2 % of studies in which there is nothing, where this finds 5.4).

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float[p]
        Values of the design's columns at each.

    Returns
    -------
    Contrasts
        Difference of the two, first less second, with its error and degrees of freedom of t.
    """
    (one, up), (two, down) = (_even(fit, of) for of in (first, second))
    return replace(combine(fit, up - down), estimates=one - two)


def compare_all(fit: TrialsFit, contrasts: ArrayLike) -> JointTest:
    """Test that several contrasts of shares are 0 together, the shares as 2 asin √share.

    Parameters
    ----------
    fit
        A model whose columns are cells of their own, as `separate_cells` makes them.
    contrasts : float[q, cells]
        Weights of the cells in each contrast.

    Raises
    ------
    Unanswerable
        If there are no more participants than contrasts.
    """
    rows = np.asarray(contrasts, np.float64)
    values, slopes = zip(*(_even(fit, cell) for cell in np.eye(rows.shape[-1])), strict=True)
    # The slope of a cell is along its own coefficient alone.
    weights = rows[None] * np.sum(slopes, axis=0)[:, None]
    return _try_jointly(fit, weights, np.stack(values, axis=-1) @ rows.T)


def _share(fit: TrialsFit, at: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Share at values of the design's columns, and its slope along the coefficients."""
    columns = np.asarray(at, np.float64)
    share = expit(fit.coefficients @ columns)
    return share, (share * (1 - share))[:, None] * columns


def _even(fit: TrialsFit, at: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same of 2 asin √share."""
    columns = np.asarray(at, np.float64)
    share = expit(fit.coefficients @ columns)
    return 2 * np.arcsin(np.sqrt(share)), np.sqrt(share * (1 - share))[:, None] * columns


def _try_jointly(fit: TrialsFit, rows: NDArray[np.float64], d: NDArray[np.float64]) -> JointTest:
    """Test that several quantities are 0 together.

    It is Wald's test with the sandwich that `trialsmodel` corrects for few participants,
    Q = d' V⁻¹ d, whose distribution is taken for Hotelling's T² with η degrees of freedom:
    (η - q + 1) Q / (η q) is F with q and η - q + 1 (Zhang 2012; Tipton and Pustejovsky 2015, who
    call it AHT). As V is a sum over participants, η is worked out from how much V varies by
    chance, by all of its elements together; for q = 1 it is Satterthwaite's degrees of freedom of
    t, and F is t².

    Parameters
    ----------
    fit
        A fitted model.
    rows : float64[studies, q, p]
        How each of the q quantities changes with each coefficient; none follows from the others.
    d : float64[studies, q]
        The quantities.

    Raises
    ------
    Unanswerable
        If there are no more participants than quantities.
    """
    studies, participants, _ = fit.scores.shape
    q = d.shape[-1]
    if participants <= q:
        raise Unanswerable(f"{participants} participants; it takes {q + 1} or more")
    each = [adjusted_weights(fit, rows[:, at]) for at in range(q)]
    adjusted = np.stack([of for of, _ in each], axis=1)
    alone = np.any([single for _, single in each], axis=0)
    chance = np.empty((studies, q, q))
    for one in range(q):
        for two in range(one, q):
            form = term_covariance(fit, adjusted[:, one], adjusted[:, two])
            chance[:, one, two] = chance[:, two, one] = np.trace(form, axis1=1, axis2=2)
    root, known = _inverse_root(chance)
    # In these coordinates the variances by chance are 1, and all is of one size.
    adjusted = np.einsum("sqr,srkp->sqkp", root, adjusted)
    d = np.einsum("sqr,sr->sq", root, d)
    terms = np.einsum("sqkp,skp->sqk", adjusted, fit.scores)
    variance = terms @ terms.swapaxes(1, 2)
    own, differing = _inverse_root(variance)
    known &= differing & ~alone & fit.settled
    eta = q * (q + 1) / _variation(fit, adjusted)
    size = (np.einsum("sqr,sr->sq", own, d) ** 2).sum(axis=1)
    df2 = eta - q + 1
    known &= df2 >= FEWEST_DEGREES
    df2 = np.where(known, df2, np.nan)
    f = df2 * size / (eta * q)
    return JointTest(f, q, df2, fisher.sf(f, q, df2))


def _variation(fit: TrialsFit, adjusted: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum of the variances of all elements of V by chance, where their means are those of I."""
    q = adjusted.shape[1]
    forms = {
        (one, two): term_covariance(fit, adjusted[:, one], adjusted[:, two])
        for one in range(q)
        for two in range(one, q)
    }
    total = np.zeros(adjusted.shape[0])
    for (one, two), form in forms.items():
        # Of normal terms: cov(z_k w_k, z_l w_l) = cov(z_k, z_l) cov(w_k, w_l) + crosswise.
        own = forms[one, one] * forms[two, two] + form * form.swapaxes(1, 2)
        total += (1 if one == two else 2) * own.sum(axis=(1, 2))
    return total


def _inverse_root(
    matrices: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Symmetric inverse root of each matrix, and whether it has one; 0 where it has none."""
    values, vectors = np.linalg.eigh(matrices)
    whole = values[:, 0] > _SINGULAR * np.maximum(values[:, -1], np.finfo(float).tiny)
    safe = np.where(whole[:, None], values, 1.0)
    root = np.einsum("sij,sj,skj->sik", vectors, safe**-0.5, vectors)
    return np.where(whole[:, None, None], root, 0.0), whole
