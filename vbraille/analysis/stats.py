"""Means, intervals and tests of one value a person, for one study or for many at once.

Arrays hold people along the last axis, or people and cells along the last two; any axes before
them are studies, each tested by itself. Shares are tested raw, each person weighing the same, so
that any other package can redo each number. A test that cannot be made has p NaN.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import optimize, special

if TYPE_CHECKING:
    from collections.abc import Iterable

Floats = NDArray[np.float64]

ALPHA = 0.05
FEWEST = 3
NO_SPREAD = 1e-9
NO_TRACE = 1e-14
LARGEST_D = 40.0
QUIET = np.errstate(divide="ignore", invalid="ignore")
TOO_FEW = "no test of fewer than 3 people"
SAME_DIFFERENCE = "no test: the difference is the same for everyone"
SAME_VALUE = "no test: everyone in a group has the same value"
NO_SCATTER = "no test: people do not differ but by rounding"


class TTest(NamedTuple):
    """A difference, and its test by Student's t; arrays have a value for each study.

    Parameters
    ----------
    value, error
        Mean difference, and its standard error.
    t, df, p
        Test, its degrees of freedom, and its two-sided p; NaN where there is none.
    hedges_g
        Effect size: Hedges's g of the differences, or of the pooled spread of two groups.
    note
        Reason for which no test could be made, if all studies have it; else empty.
    """

    value: Floats
    error: Floats
    t: Floats
    df: Floats
    p: Floats
    hedges_g: Floats
    note: str = ""


class FTest(NamedTuple):
    """An effect, and its test by F; arrays have a value for each study.

    Parameters
    ----------
    F, df1, df2, p
        Test, with the degrees of freedom of Greenhouse and Geisser, or of Welch.
    epsilon
        Greenhouse and Geisser's factor; NaN for Welch's test.
    df1_uncorrected, df2_uncorrected, p_uncorrected
        The same without the factor; NaN for Welch's test.
    partial_eta2
        Effect size.
    note
        Reason for which no test could be made; else empty.
    """

    F: Floats
    df1: Floats
    df2: Floats
    p: Floats
    epsilon: Floats
    df1_uncorrected: Floats
    df2_uncorrected: Floats
    p_uncorrected: Floats
    partial_eta2: Floats
    note: str = ""


def t_interval(
    value: ArrayLike, error: ArrayLike, df: ArrayLike, k: ArrayLike = 1
) -> tuple[Floats, Floats]:
    """Return Student's interval of level 1 - 0.05/k."""
    reach = -special.stdtrit(df, ALPHA / 2 / np.asarray(k, np.float64)) * error
    return value - reach, value + reach


def mean_interval(values: ArrayLike) -> tuple[Floats, Floats]:
    """Return Student's interval of the mean over people; NaN of fewer than 3, or all alike."""
    mean, error, _, df, *_ = paired(values)
    return t_interval(mean, error, df)


@QUIET
def mean_share(shares: ArrayLike) -> tuple[Floats, Floats]:
    """Return the interval of the mean share over people, by Student's t on the logit scale."""
    mean, error, _, df, *_ = paired(shares)
    ends = t_interval(special.logit(mean), error / (mean * (1 - mean)), df)
    return special.expit(ends[0]), special.expit(ends[1])


def wilson(right: ArrayLike, trials: ArrayLike) -> tuple[Floats, Floats]:
    """Return Wilson's interval of the share of one person."""
    right, trials = np.asarray(right, np.float64), np.asarray(trials, np.float64)
    z = special.ndtri(1 - ALPHA / 2)
    middle = (right + z**2 / 2) / (trials + z**2)
    reach = z / (trials + z**2) * np.sqrt(right * (trials - right) / trials + z**2 / 4)
    return np.maximum(middle - reach, 0), np.minimum(middle + reach, 1)


def hautus_rate(yes: ArrayLike, trials: ArrayLike) -> Floats:
    """Return a share with half an answer added, so that it is never 0 or 1 (Hautus 1995)."""
    return (np.asarray(yes) + 0.5) / (np.asarray(trials) + 1)


def d_prime(hit_rate: ArrayLike, false_rate: ArrayLike) -> Floats:
    """Return d′ of yes and no."""
    return special.ndtri(hit_rate) - special.ndtri(false_rate)


@np.vectorize(otypes=[float])
def d_prime_differencing(hit_rate: float, false_rate: float) -> float:
    """Return d′ of same and different, judged by the difference (Macmillan and Creelman 2005).

    It is 0 where no more hits were given than false alarms.
    """
    if hit_rate <= false_rate:
        return 0.0
    criterion = -np.sqrt(2) * special.ndtri(false_rate / 2)

    def excess(d: float) -> float:
        beyond = np.array([d - criterion, -d - criterion])
        return float(special.ndtr(beyond / np.sqrt(2)).sum() - hit_rate)

    return float(optimize.brentq(excess, 0, LARGEST_D))  # pyright: ignore[reportArgumentType]


@QUIET
def _t_test(value: Floats, error: Floats, df, size: Floats, made, note: str) -> TTest:
    """Return a test, with NaN where it is not made."""
    none = np.where(made, 0.0, np.nan)
    t = value / error + none
    note = "" if np.any(made) else note
    return TTest(
        value, error + none, t, df + none, 2 * special.stdtr(df, -np.abs(t)), size + none, note
    )


@QUIET
def paired(gaps: ArrayLike) -> TTest:
    """Test differences of people by the paired t-test.

    Parameters
    ----------
    gaps : float64[..., people]
        Difference of each person.
    """
    gaps = np.asarray(gaps, np.float64)
    people = gaps.shape[-1]
    if people < FEWEST:
        gaps = np.concatenate([gaps, np.full((*gaps.shape[:-1], FEWEST - people), np.nan)], -1)
        value = np.nansum(gaps, axis=-1) / people if people else gaps[..., 0]
        return _t_test(value, value, np.nan, value, False, TOO_FEW)
    value = gaps.mean(axis=-1)
    spread = gaps.std(axis=-1, ddof=1)
    size = value / spread * (1 - 3 / (4 * (people - 1) - 1))
    made = np.ptp(gaps, axis=-1) >= NO_SPREAD
    return _t_test(value, spread / np.sqrt(people), people - 1, size, made, SAME_DIFFERENCE)


@QUIET
def welch(first: ArrayLike, second: ArrayLike) -> TTest:
    """Test the difference of two groups by Welch's t-test.

    Parameters
    ----------
    first, second : float64[..., people]
        Value of each person of a group.
    """
    one, other = paired(first), paired(second)
    degrees = np.array([np.shape(first)[-1] - 1, np.shape(second)[-1] - 1])
    value = one.value - other.value
    squares = np.stack([one.error**2, other.error**2], axis=-1)
    total = squares.sum(axis=-1)
    df = total**2 / (squares**2 / degrees).sum(axis=-1)
    pooled = (squares * (degrees + 1) * degrees).sum(axis=-1) / degrees.sum()
    size = value / np.sqrt(pooled) * (1 - 3 / (4 * degrees.sum() - 1))
    note = TOO_FEW if degrees.min() < FEWEST - 1 else SAME_VALUE
    return _t_test(value, np.sqrt(total), df, size, ~np.isnan(total), note)


def holm(p: ArrayLike) -> tuple[Floats, Floats]:
    """Correct p by Holm's step-down method, and return the level of each interval.

    Parameters
    ----------
    p : float64[..., tests]
        NaN for a test that was not made, which is not counted.

    Returns
    -------
    corrected, k : float64[..., tests]
        Corrected p, and k such that the interval of level 1 - 0.05/k holds 0 if and only if the
        corrected p is above 0.05: of m tests with r rejected, that of rank i has
        k = max(m - i + 1, m - r, 1).
    """
    p = np.asarray(p, np.float64)
    order = np.argsort(p, axis=-1, kind="stable")
    tests = np.isfinite(p).sum(axis=-1, keepdims=True)
    left = tests - np.arange(p.shape[-1])
    rising = np.take_along_axis(p, order, axis=-1)
    corrected = np.minimum(np.maximum.accumulate(rising * left, axis=-1), 1)
    rejected = (corrected <= ALPHA).sum(axis=-1, keepdims=True)
    k = np.where(np.isnan(rising), np.nan, np.maximum(np.maximum(left, tests - rejected), 1))
    back = np.argsort(order, axis=-1)
    return np.take_along_axis(corrected, back, axis=-1), np.take_along_axis(k, back, axis=-1)


def contrasts(levels: Iterable[int], tested: tuple[int, ...]) -> Floats:
    """Return orthonormal columns that pick an effect out of cells.

    Parameters
    ----------
    levels
        Number of levels of each factor; cells are in the order of the last one first.
    tested
        Places of the factors whose interaction is the effect; none for the mean of all cells.
    """
    made: Any = np.ones((1, 1))
    for place, count in enumerate(levels):
        basis = np.linalg.qr(np.column_stack([np.ones(count), np.eye(count)[:, 1:]]))[0]
        made = np.kron(made, basis[:, 1:] if place in tested else basis[:, :1])
    return made


def effect_names(within: int) -> list[tuple[int, ...]]:
    """Return the places of the factors of each effect within people, the mean of all first."""
    return [each for size in range(within + 1) for each in combinations(range(within), size)]


def effect_within(values: ArrayLike, member: ArrayLike | None = None) -> FTest:
    """Test an effect within people, corrected by Greenhouse and Geisser.

    Parameters
    ----------
    values : float64[..., people, contrasts]
        Cells times the contrasts of the effect.
    member : int[people]
        Group of each person, from 0; None for one group. Of unequal groups the mean of the
        groups' means is tested (type III).
    """
    values, member, means = _in_groups(values, member)
    sizes = np.bincount(member)
    weight = (1 / sizes).sum() / sizes.size**2
    squares = (means.mean(axis=-2) ** 2).sum(axis=-1) / weight
    return _spherical(squares, values - means[..., member, :], len(member) - sizes.size, 1)


def effect_with_groups(values: ArrayLike, member: ArrayLike) -> FTest:
    """Test how groups differ in an effect within people, or in their means.

    One contrast is tested by Welch's F, several are tested together and corrected by Greenhouse
    and Geisser; `effect_within` describes the arguments.
    """
    values, member, means = _in_groups(values, member)
    sizes = np.bincount(member)
    if values.shape[-1] == 1:
        return welch_f([values[..., member == group, 0] for group in range(sizes.size)])
    off = means - values.mean(axis=-2, keepdims=True)
    squares = (sizes[:, None] * off**2).sum(axis=(-1, -2))
    residuals = values - means[..., member, :]
    return _spherical(squares, residuals, len(member) - sizes.size, sizes.size - 1)


def _in_groups(values: ArrayLike, member: ArrayLike | None) -> tuple[Floats, NDArray, Floats]:
    values = np.asarray(values, np.float64)
    member = np.zeros(values.shape[-2], int) if member is None else np.asarray(member)
    groups = range(member.max(initial=0) + 1)
    means = [values[..., member == group, :].mean(axis=-2) for group in groups]
    return values, member, np.stack(means, axis=-2)


@QUIET
def _spherical(squares: Floats, residuals: Floats, df: int, times: int) -> FTest:
    """Test a sum of squares against residuals float64[..., people, contrasts]."""
    width = residuals.shape[-1]
    spread = np.swapaxes(residuals, -1, -2) @ residuals / df
    trace = np.trace(spread, axis1=-2, axis2=-1)
    made = trace >= NO_TRACE
    none = np.where(made, 0.0, np.nan)
    epsilon = trace**2 / (width * (spread**2).sum(axis=(-1, -2))) + none
    f = squares / times / trace + none
    df1 = width * times + none
    df2 = width * df + none
    corrected = epsilon * df1, epsilon * df2
    return FTest(
        f,
        *corrected,
        special.fdtrc(*corrected, f),
        epsilon,
        df1,
        df2,
        special.fdtrc(df1, df2, f),
        squares / (squares + trace * df) + none,
        "" if np.any(made) else NO_SCATTER,
    )


@QUIET
def welch_f(groups: list[Floats]) -> FTest:
    """Test whether groups have the same mean by Welch's F; float64[..., people] each."""
    count = len(groups)
    sizes = np.array([group.shape[-1] for group in groups])
    means, errors = (
        np.stack([getattr(paired(group), name) for group in groups], axis=-1)
        for name in ("value", "error")
    )
    weights = 1 / errors**2
    total = weights.sum(axis=-1, keepdims=True)
    centre = (weights * means).sum(axis=-1, keepdims=True) / total
    uneven = ((1 - weights / total) ** 2 / (sizes - 1)).sum(axis=-1)
    between = (weights * (means - centre) ** 2).sum(axis=-1) / (count - 1)
    f = between / (1 + 2 * (count - 2) / (count**2 - 1) * uneven)
    df1 = count - 1 + 0 * uneven
    df2 = (count**2 - 1) / 3 / uneven
    squares = (sizes * (means - means @ sizes[:, None] / sizes.sum()) ** 2).sum(axis=-1)
    size = squares / (squares + errors**2 @ (sizes * (sizes - 1)))
    none = np.full_like(f, np.nan)
    note = TOO_FEW if sizes.min() < FEWEST else SAME_VALUE
    note = "" if np.isfinite(f).any() else note
    return FTest(f, df1, df2, special.fdtrc(df1, df2, f), none, none, none, none, size, note)
