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
docs/analysis.md has the numbers.

What a participant contributes to all of this is one vector and two matrices as large as the
design has columns, so that thousands of studies are fitted in one go.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.special import expit
from scipy.stats import t as student

from vbraille.analysis.statistics.intervals import LEVEL, Unanswerable

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
        or do not differ at all, so that nobody sees how they vary.
    degrees : float64[studies]
        Degrees of freedom of t, 1 or more; NaN where the error is.
    """

    estimates: NDArray[np.float64]
    errors: NDArray[np.float64]
    degrees: NDArray[np.float64]

    def p_values(self) -> NDArray[np.float64]:
        """Two-sided p that the combination is 0, float64[studies]; NaN where there is no error."""
        with np.errstate(invalid="ignore"):
            return 2 * student.sf(np.abs(self.estimates) / self.errors, self.degrees)

    def ends(self, level: float = LEVEL) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lower and upper ends of the intervals, float64[studies] each; NaN where there is none."""
        half = student.ppf((1 + level) / 2, self.degrees) * self.errors
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
    ValueError
        If the arrays do not fit together, or there are more right answers than answers.
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
    # Firth's penalty leaves a sum of scores that is not 0 even if everybody is alike.
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
        Whether a participant alone determines something that l is about, so that nobody sees how
        people differ in it.
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
    if y.ndim != 3 or y.shape != n.shape or x.ndim != 3 or x.shape[:2] != y.shape[1:]:
        raise ValueError(f"correct {y.shape}, trials {n.shape} and design {x.shape} do not fit")
    if not np.isfinite(x).all():
        raise ValueError("design must be finite")
    if not ((y >= 0) & (y <= n) & (n < np.inf)).all():
        raise ValueError("right answers must be 0 or more, and no more than the trials")
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
