"""Whether several combinations of a trials model's coefficients are 0 together.

It is Wald's test with the sandwich that `trialsmodel` corrects for few participants, Q = d' V⁻¹ d,
whose distribution is taken for Hotelling's T² with η degrees of freedom: (η - q + 1) Q / (η q) is F
with q and η - q + 1 (Zhang 2012; Tipton and Pustejovsky 2015, who call it AHT). As V is a sum over
participants, η is worked out from how much V varies by chance, by all of its elements together;
for q = 1 it is Satterthwaite's degrees of freedom of t, and F is t².
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.stats import f as fisher

from vbraille.analysis.statistics.trialsmodel import adjusted_weights, term_covariance
from vbraille.analysis.statistics.unanswerable import Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from vbraille.analysis.statistics.trialsmodel import TrialsFit

FEWEST_DEGREES = 1.0  # of the error; with fewer F tells nothing
_SINGULAR = 1e-9  # of the variance by chance, below which participants do not differ in something


@dataclass(frozen=True, slots=True, eq=False)
class JointTest:
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


def try_jointly(fit: TrialsFit, weights: ArrayLike, estimates: ArrayLike) -> JointTest:
    """Test that several quantities are 0 together.

    Parameters
    ----------
    fit
        A fitted model.
    weights : float[studies, q, p]
        How each of the q quantities changes with each coefficient; none follows from the others.
    estimates : float[studies, q]
        The quantities.

    Raises
    ------
    Unanswerable
        If there are no more participants than quantities.
    ValueError
        If the weights are not those of the coefficients.
    """
    studies, participants, p = fit.scores.shape
    rows, d = np.asarray(weights, np.float64), np.asarray(estimates, np.float64)
    q = d.shape[-1]
    if rows.shape != (studies, q, p) or d.shape != (studies, q):
        raise ValueError(f"weights {rows.shape} and estimates {d.shape} do not fit the model")
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
