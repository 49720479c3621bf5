"""Logistic regression of single trials whose participants are clusters, for many studies at once.

The log odds of a right answer, averaged over the population, are linear in the columns of a
design (Liang and Zeger 1986, with independence as the working correlation). Coefficients have
Firth's penalty (1993), so that conditions in which all or no answers are right have finite ones.

Variances are by the sandwich of participants' scores, with Kauermann and Carroll's correction
(2001) for their number, and t has Satterthwaite's degrees of freedom. These are worked out from
what each participant's own answers can vary by (Bell and McCaffrey 2002 take the model's
variances instead): where most participants have everything right and only a few tell anything,
there are few degrees of freedom. Of those tried by simulation it is the only one that holds the
truth in 93 to 98 of 100 studies of three to twenty participants near the ceiling too;
docs/validation.md has the numbers.

What a participant contributes to all of this is one vector and two matrices as large as the
design has columns, so that thousands of studies are fitted in one go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.special import expit, fdtrc, stdtr, stdtrit

from vbraille.analysis.statistics.intervals import FEWEST_PARTICIPANTS, LEVEL, TAIL, Unanswerable

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

MOST_STEPS = 200
SETTLED = 1e-10  # log odds; steps below it end a fit
_LARGEST_STEP = 2.0  # log odds; first steps from the middle to the ceiling would overshoot
_ALONE = 1e-9  # share of a coefficient's information that must come from others
_ALIKE = 1e-9  # of the variance by chance alone, below which participants do not differ at all
_OWN = 1.0  # trials at the model's share that a participant's own share of a cell is drawn by


@dataclass(frozen=True, slots=True, eq=False)
class TrialsFit:
    """A logistic model that was fitted to the trials of several studies.

    Parameters
    ----------
    coefficients : float64[studies, p]
        Log odds for a unit of each of the design's columns.
    spread : float64[studies, p, p]
        Inverse of the information of all trials.
    leverages : float64[studies, k, p, p]
        Information of each participant's trials.
    scores : float64[studies, k, p]
        Sum of each participant's residuals times the design.
    own : float64[studies, k, p, p]
        Covariance of those scores by chance, at each participant's own shares of right answers.
    settled : bool[studies]
        Whether the steps of the fit became small enough.
    """

    coefficients: NDArray[np.float64]
    spread: NDArray[np.float64]
    leverages: NDArray[np.float64]
    scores: NDArray[np.float64]
    own: NDArray[np.float64]
    settled: NDArray[np.bool_]


@dataclass(frozen=True, slots=True, eq=False)
class Contrasts:
    """A linear combination of coefficients in several studies, on the scale of log odds.

    Parameters
    ----------
    estimates, errors : float64[studies]
        The combination and its standard error. The error is NaN where participants are too few
        or do not differ at all, so that it is not seen how they vary.
    degrees : float64[studies]
        Degrees of freedom of t, 1 or more; NaN where the error is.
    """

    estimates: NDArray[np.float64]
    errors: NDArray[np.float64]
    degrees: NDArray[np.float64]

    def p_values(self) -> NDArray[np.float64]:
        """Two-sided p that the combination is 0, float64[studies]; NaN where there is no error."""
        with np.errstate(invalid="ignore"):
            return 2 * stdtr(self.degrees, -np.abs(self.estimates) / self.errors)

    def ends(self, level: float = LEVEL) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper ends of the intervals, float64[studies] each; NaN where there is none."""
        half = stdtrit(self.degrees, (1 + level) / 2) * self.errors
        return self.estimates - half, self.estimates + half


def fit_trials(
    correct: ArrayLike, trials: ArrayLike, design: ArrayLike, *, penalised: bool = True
) -> TrialsFit:
    """Fit the model to counts of right answers, by Fisher scoring.

    Parameters
    ----------
    correct, trials : int[studies, k, c] or int[k, c]
        Right answers and all answers of each of k participants in each of c cells. A cell without
        trials counts for nothing, whatever its place in the design.
    design : float[k, c, p]
        Design of every cell: p columns, the same in all studies.
    penalised
        Whether Firth's penalty is used. Without it there may be coefficients without bound, at
        which steps never become small.

    Raises
    ------
    Unanswerable
        If there are no trials, or some column of the design follows from the others where there
        are trials.
    """
    y, n, x = _checked(correct, trials, design)
    studies, p = len(y), x.shape[-1]
    _check_rank(_information((n > 0).astype(np.float64), x).sum(axis=1))
    beta = np.zeros((studies, p))
    settled = np.zeros(studies, dtype=bool)
    going = np.arange(studies)
    rows = x.reshape(-1, p)
    for _ in range(MOST_STEPS):
        right, asked = (of[going].reshape(going.size, -1) for of in (y, n))
        share = expit(beta[going] @ rows.T)
        weight = asked * share * (1 - share)
        spread = np.linalg.inv(_information(weight, rows))
        residual = right - asked * share
        if penalised:
            along = ((rows @ spread) * rows).sum(axis=-1)
            residual = residual + weight * along * (0.5 - share)
        step = np.einsum("spq,sq->sp", spread, residual @ rows)
        longest = np.abs(step).max(axis=1)
        step *= (_LARGEST_STEP / np.maximum(longest, _LARGEST_STEP))[:, None]
        beta[going] += step
        done = longest < SETTLED
        settled[going[done]] = True
        going = going[~done]
        if not going.size or np.abs(beta).max() > 30:  # 30: no share is known so well
            break
    share = expit(np.einsum("kcp,sp->skc", x, beta))
    weight = n * share * (1 - share)
    each = _information(weight, x)
    own_share = (y + _OWN * share) / (n + _OWN)
    return TrialsFit(
        beta,
        np.linalg.inv(each.sum(axis=1)),
        each,
        np.einsum("skc,kcp->skp", y - n * share, x),
        _information(n * own_share * (1 - own_share), x),
        settled,
    )


def combine(fit: TrialsFit, weights: ArrayLike) -> Contrasts:
    """Combine coefficients linearly, with the error that few participants leave.

    Parameters
    ----------
    fit
        A fitted model.
    weights : float[p] or float[studies, p]
        What the coefficients are multiplied by before they are added up.

    Raises
    ------
    Unanswerable
        If there are fewer than two participants.
    ValueError
        If the weights are not those of the coefficients.
    """
    studies, participants, p = fit.scores.shape
    ell = np.broadcast_to(np.asarray(weights, np.float64), (studies, p))
    if participants < 2:
        raise Unanswerable("one participant; how people differ is not seen")
    adjusted, alone = adjusted_weights(fit, ell)
    variance = (np.einsum("skp,skp->sk", adjusted, fit.scores) ** 2).sum(axis=1)
    # Firth's penalty leaves a sum of scores that is not 0 even if all are alike.
    left = np.einsum("spq,sq->sp", fit.spread, fit.scores.sum(axis=1))
    own = fit.scores - np.einsum("skpq,sq->skp", fit.leverages, left)
    differing = (np.einsum("skp,skp->sk", adjusted, own) ** 2).sum(axis=1)
    form = term_covariance(fit, adjusted, adjusted)
    trace = np.trace(form, axis1=1, axis2=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        degrees = trace**2 / (form**2).sum(axis=(1, 2))
    unknown = alone | ~fit.settled | ~(differing > _ALIKE * trace) | ~(degrees > 0)
    return Contrasts(
        np.einsum("sp,sp->s", fit.coefficients, ell),
        np.where(unknown, np.nan, np.sqrt(variance)),
        np.where(unknown, np.nan, np.maximum(degrees, 1.0)),
    )


def adjusted_weights(
    fit: TrialsFit, weights: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Weights of each participant's scores in a combination l of the coefficients.

    They are (I - M_k B)^(-1/2)' B l, with M_k the participant's information and B the inverse of
    the whole's. What a participant alone determines and l is not about is left out, as by a
    generalised inverse.

    Parameters
    ----------
    fit
        A fitted model.
    weights : float64[studies, p]
        The combination l.

    Returns
    -------
    adjusted : float64[studies, k, p]
        Weights of the scores.
    alone : bool[studies]
        Whether a participant alone determines something that l is about, so that people's
        differences in it do not show.
    """
    whole = np.einsum("spq,sq->sp", fit.spread, weights)
    p = whole.shape[-1]
    factor = np.linalg.cholesky(fit.spread)
    kept = np.eye(p) - np.einsum("sji,skjl,slm->skim", factor, fit.leverages, factor)
    values, vectors = np.linalg.eigh((kept + kept.swapaxes(-1, -2)) / 2)
    # In these coordinates B l is solve(factor, B l), and the correction a symmetric matrix.
    turned = np.linalg.solve(factor, whole[..., None])[:, None]
    along = (vectors.swapaxes(-1, -2) @ turned)[..., 0]
    single = values < _ALONE
    length = np.abs(along).max(axis=(1, 2))
    alone = (single & (np.abs(along) > 1e-6 * length[:, None, None])).any(axis=(1, 2))
    root = np.where(single, 0.0, np.where(single, 1.0, values) ** -0.5)
    back = (vectors @ (root * along)[..., None])[..., 0]
    return np.einsum("sij,skj->ski", factor, back), alone


def term_covariance(
    fit: TrialsFit, first: NDArray[np.float64], second: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Covariance by chance of the participants' terms of two combinations of coefficients.

    A participant's term is a_k'(U_k - M_k B U), U the sum of all scores: the fit takes its part of
    each. With C_k the covariance of U_k by chance, and C that of U, the covariance of the term of
    participant k in the first combination and that of participant l in the second is
    a_k'(δ C_k - C_k B M_l - M_k B C_l + M_k B C B M_l) b_l.

    Parameters
    ----------
    fit
        A fitted model.
    first, second : float64[studies, k, p]
        Weights a and b of the scores, as `adjusted_weights` gives them.

    Returns
    -------
    float64[studies, k, k]
    """
    noisy = [np.einsum("skij,skj->ski", fit.own, of) for of in (first, second)]
    pulled = [
        np.einsum("ski,sij->skj", np.einsum("skij,skj->ski", fit.leverages, of), fit.spread)
        for of in (first, second)
    ]
    form = pulled[0] @ fit.own.sum(axis=1) @ pulled[1].swapaxes(1, 2)
    form -= noisy[0] @ pulled[1].swapaxes(1, 2)
    form -= pulled[0] @ noisy[1].swapaxes(1, 2)
    at = np.arange(form.shape[1])
    form[:, at, at] += np.einsum("ski,ski->sk", first, noisy[1])
    return form


def _information(weight: NDArray[np.float64], x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum over cells of weights, float64[…, c], times x x' of x, float64[…, c, p]."""
    return (weight[..., None] * x).swapaxes(-1, -2) @ x


def _checked(
    correct: ArrayLike, trials: ArrayLike, design: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    y, n, x = (np.asarray(of, np.float64) for of in (correct, trials, design))
    if y.ndim == 2:
        y, n = y[None], n[None]
    if not n.sum(axis=(1, 2)).all():
        raise Unanswerable("no trials")
    return y, n, x


def _check_rank(information: NDArray[np.float64]) -> None:
    """Refuse a design in which a column follows from the others."""
    size = np.sqrt(np.diagonal(information, axis1=1, axis2=2))
    if not size.all():
        raise Unanswerable("a part of the model has no trials")
    scaled = information / size[:, :, None] / size[:, None, :]
    if np.linalg.eigvalsh(scaled)[:, 0].min() < 1e-10:
        raise Unanswerable("a part of the model follows from the others")


FEWEST_DEGREES = 1.0  # of the error; with fewer F tells nothing
_SINGULAR = 1e-9  # of the variance by chance, below which participants do not differ in something
TO_D = math.sqrt(3) / math.pi
"""Factor from a logarithm of an odds ratio to Cohen's d of what lies beneath: the
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
    fit: TrialsFit, weights: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Ends of the interval of a difference of shares of right answers.

    It is that of the inverse hyperbolic tangent of the difference, by the slope along
    the coefficients (delta method) and t with the degrees of freedom of the difference itself.
    With those of the odds ratio instead it would hold the truth 91 times in 100 near the ceiling,
    and 99 times when put together of the two shares' own intervals (Newcombe 1998).

    Parameters
    ----------
    fit
        A model whose columns are cells of their own, as `separate_cells` makes them.
    weights : float[cells]
        What the shares are multiplied by before they are added up; those above 0 add up to 1, and
        those below to -1.

    Returns
    -------
    low, high : float64[studies]
        From -1 to 1; NaN where there is no interval.
    """
    row = np.asarray(weights, np.float64)
    share = expit(fit.coefficients)
    value = share @ row
    apart = combine(fit, share * (1 - share) * row)
    half = stdtrit(apart.degrees, 1 - TAIL) * apart.errors / (1 - value**2)
    middle = np.arctanh(value)
    return np.tanh(middle - half), np.tanh(middle + half)


def tells_difference(correct: ArrayLike, trials: ArrayLike) -> NDArray[np.bool_]:
    """True if three participants or more have something wrong, and as many something right.

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


def compare(fit: TrialsFit, weights: ArrayLike) -> Contrasts:
    """Test that a difference of shares of right answers is 0.

    They are compared as 2 asin √share, by the slope along the coefficients: the errors of this do
    not depend on the share. Log odds find too much in two groups of twenty people near the ceiling
    (6.2 % of studies in which there is nothing, where this finds 5.4).

    Parameters
    ----------
    fit, weights
        As for `difference`.

    Returns
    -------
    Contrasts
        The difference with its error and degrees of freedom of t.
    """
    row = np.asarray(weights, np.float64)
    even, slope = _even(fit)
    return replace(combine(fit, slope * row), estimates=even @ row)


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
    even, slope = _even(fit)
    return _try_jointly(fit, rows[None] * slope[:, None], even @ rows.T)


def _even(fit: TrialsFit) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """2 asin √share of each cell, float64[studies, cells], and its slope along the coefficient."""
    share = expit(fit.coefficients)
    return 2 * np.arcsin(np.sqrt(share)), np.sqrt(share * (1 - share))


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
    return JointTest(f, q, df2, fdtrc(q, df2, np.maximum(f, 0.0)))


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
