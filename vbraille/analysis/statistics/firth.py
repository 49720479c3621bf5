"""Bias-reduced scales of many tables of paired comparisons at once, as a bootstrap needs."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit

if TYPE_CHECKING:
    from numpy.typing import NDArray

SMALLEST_STEP = 1e-10
LARGEST_STEP = 1.0  # keeps the first steps of one-sided comparisons from overshooting
MOST_STEPS = 1000  # convergence is linear; tens of thousands of sparse tables took fewer than 400


def connected(wins: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether comparisons lead from every value to every other, bool[r] of float64[r, k, k]."""
    k = wins.shape[-1]
    ways = (wins + wins.swapaxes(1, 2) > 0) + np.eye(k)
    for _ in range(k.bit_length()):  # each squaring doubles the length of the ways
        ways = np.minimum(ways @ ways, 1.0)
    return np.asarray(ways.min(axis=(1, 2)) > 0)


def fit(
    wins: NDArray[np.float64], *, most_steps: int = MOST_STEPS
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Strengths and their covariances, by Fisher scoring on Firth's modified score.

    Firth 1993: to the wins of i over j and of j over i half the leverage of their
    pair is added, h_ij = w_ij var(s_i - s_j), where w_ij = n_ij π_ij π_ji is the
    pair's information. It depends on the strengths, so that it is worked out anew
    in every step.

    Parameters
    ----------
    wins : float64[r, k, k]
        wins[., i, j] is how often i was chosen over j; every table must be connected.
    most_steps
        Number of steps after which the fit is given up.

    Returns
    -------
    strengths : float64[r, k]
        Natural logarithms of the strengths, with sum 0.
    covariance : float64[r, k, k]
        Inverse of the information.

    Raises
    ------
    RuntimeError
        If a table has not settled after so many steps.
    """
    r, k, _ = wins.shape
    strengths, covariance = np.zeros((r, k)), np.empty((r, k, k))
    going = np.arange(r)
    for _ in range(most_steps):
        s, won = strengths[going], wins[going]
        share = expit(s[:, :, None] - s[:, None, :])
        both = share * share.swapaxes(1, 2)
        weight = (won + won.swapaxes(1, 2)) * both
        inverse = _inverse(weight)
        own = np.diagonal(inverse, axis1=1, axis2=2)
        leverage = weight * (own[:, :, None] + own[:, None, :] - 2 * inverse)
        # Wins that were not expected less losses that were not. The large numbers of one-sided
        # comparisons are left out, since their difference would be lost in rounding.
        surprise = (won + leverage / 2) * share.swapaxes(1, 2)
        score = (surprise - surprise.swapaxes(1, 2)).sum(axis=2)
        # Where the leverage is as large as the comparisons (one for each pair, say), steps by the
        # information alone would be too long and never settle.
        step = np.einsum("rij,rj->ri", _inverse(weight + leverage * both), score)
        longest = np.abs(step).max(axis=1)
        step *= (LARGEST_STEP / np.maximum(longest, LARGEST_STEP))[:, None]
        strengths[going] = s + step
        covariance[going] = inverse
        going = going[longest > SMALLEST_STEP]
        if not going.size:
            return strengths - strengths.mean(axis=1, keepdims=True), covariance
    raise RuntimeError(f"{going.size} scales of paired comparisons did not settle")


def _inverse(weight: NDArray[np.float64]) -> NDArray[np.float64]:
    """Covariances of strengths of sum 0, from the information of each pair, float64[r, k, k].

    1/k in every place takes up the direction in which all strengths move together.
    """
    k = weight.shape[-1]
    information = np.eye(k) * weight.sum(axis=2, keepdims=True) - weight
    return np.linalg.inv(information + 1 / k) - 1 / k
