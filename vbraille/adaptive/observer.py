"""Observers on a grid: estimates of their parameters, and QUEST+ (Watson 2017, J. Vision 17(3):10).

A grid holds all combinations θ of an observer's parameters, equally likely beforehand. After some
answers the posterior is the product of their probabilities p(answer | stimulus, θ). QUEST+ asks the
stimulus with the largest expected information about θ,

    I(s) = h(Σ_θ post(θ) p(s, θ)) - Σ_θ post(θ) h(p(s, θ)),                                  (1)

where p is the probability of a positive answer and h(p) = -p ln p - (1 - p) ln(1 - p). If one
parameter φ is asked about, it is the one with the largest expected fall of its variance (King-Smith
et al. 1994, Vision Research 34:885),

    V(s) = Σ_o p(o) (E[φ | o] - E[φ])².                                                      (2)

**Psychometric functions.** With a guess rate γ and a lapse rate λ a positive answer (yes, or right)
has the probability

    p(x) = γ + (1 - γ - λ) F(x).                                                             (3)

F grows from 0 to 1, with a threshold t and a spread s:

    normal    F = Φ((x - t) / s)
    logistic  F = 1 / (1 + exp(-(x - t) / s))
    weibull   F = 1 - exp(-(x / t)^s),  for x and t above 0.                                 (4)

**Nearer of two.** Of x₁ and x₂ a person chooses the one nearer to an inner value μ. Each distance
is judged with normal noise of standard deviation s:

    p(first) = λ / 2 + (1 - λ) Φ((|x₂ - μ| - |x₁ - μ|) / (s √2)).                            (5)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
# Probability of a positive answer, of a stimulus and the parameters; arrays are broadcast.
Observer = Callable[..., Floats]
Stimulus = tuple[float, ...]

TAILS = (0.025, 0.975)
TIE = 1e-9  # stimuli as good as that are equal, so that the last bit of a machine chooses none
UNLIKELY = 1e-15  # no answer makes a value impossible
MOST_CELLS = 4_000_000  # of a table, which has 32 MB then
PLACES = 9


def phi(z: Floats) -> Floats:
    """Return the cumulative distribution of the standard normal."""
    flat = [math.erfc(value) for value in (np.ravel(z) / -math.sqrt(2)).tolist()]
    return np.array(flat).reshape(np.shape(z)) / 2


SHAPES: dict[str, Observer] = {
    "normal": lambda x, threshold, spread: phi((x - threshold) / spread),
    "logistic": lambda x, threshold, spread: 0.5 + 0.5 * np.tanh((x - threshold) / spread / 2),
    "weibull": lambda x, threshold, spread: -np.expm1(-((x / threshold) ** spread)),
}


def psychometric(shape: str, *, falls: bool = False) -> Observer:
    """Return equation (3), of x, threshold, spread, guess and lapse.

    Parameters
    ----------
    shape
        One of `SHAPES`.
    falls
        Whether positive answers become rarer with x; not for a Weibull function.
    """
    sign = -1.0 if falls else 1.0

    def positive(x: Floats, threshold: Floats, spread: Floats, guess: Floats, lapse: Floats):
        grown = SHAPES[shape](sign * x, sign * threshold, spread)
        return guess + (1 - guess - lapse) * grown

    return positive


def nearer(first: Floats, second: Floats, centre: Floats, spread: Floats, lapse: Floats) -> Floats:
    """Return equation (5), of the first and second value, centre, spread and lapse."""
    further = np.abs(second - centre) - np.abs(first - centre)
    return lapse / 2 + (1 - lapse) * phi(further / (spread * math.sqrt(2)))


class Estimate(NamedTuple):
    """Mean and standard deviation of a posterior, and its interval of 95 %."""

    mean: float
    sd: float
    low: float
    high: float


class Grid:
    """An observer with possible values of its parameters.

    Parameters
    ----------
    observer
        Probability of a positive answer, such as `psychometric` or `nearer` returns.
    axes
        Increasing values of each parameter, in the order in which the observer takes them. A single
        value fixes the parameter.

    Attributes
    ----------
    shape : tuple of int
        Number of values of each parameter. Posteriors are arrays of this shape.
    """

    def __init__(self, observer: Observer, axes: Mapping[str, ArrayLike]) -> None:
        self._observer = observer
        self.axes = {name: np.asarray(values, float) for name, values in axes.items()}
        self.shape = tuple(values.size for values in self.axes.values())

    def chances(self, stimuli: Sequence[Stimulus] | Floats) -> Floats:
        """Return the probability of a positive answer, of shape [stimuli, *shape].

        Raises
        ------
        ValueError
            If the table would be too large.
        """
        cells = len(stimuli) * math.prod(self.shape)
        if cells > MOST_CELLS:
            raise ValueError(f"the grid has {cells} cells of {MOST_CELLS}; make a step larger")
        asked = np.array(stimuli, float).reshape(len(stimuli), -1)
        along = [column.reshape(-1, *(1 for _ in self.shape)) for column in asked.T]
        grid = np.meshgrid(*self.axes.values(), indexing="ij", sparse=True)
        chances = self._observer(*along, *(values[np.newaxis] for values in grid))
        chances = np.broadcast_to(chances, (len(stimuli), *self.shape))
        return np.clip(chances, UNLIKELY, 1 - UNLIKELY)

    def log_likelihood(
        self, stimuli: Sequence[Stimulus] | Floats, positive: ArrayLike, total: ArrayLike
    ) -> Floats:
        """Return the log likelihood of numbers of positive answers, of shape `shape`.

        Parameters
        ----------
        stimuli
            What was shown: values, or pairs of them.
        positive, total
            Number of positive answers to each stimulus, and of all.
        """
        chances = self.chances(stimuli)
        yes, every = np.asarray(positive, float), np.asarray(total, float)
        return np.tensordot(yes, np.log(chances), 1) + np.tensordot(
            every - yes, np.log1p(-chances), 1
        )

    def estimate(self, name: str, log_likelihood: Floats) -> Estimate:
        """Estimate a parameter by its posterior.

        The interval is interpolated: the probability of a value is spread evenly over the half ways
        to its neighbours.
        """
        others = tuple(n for n, other in enumerate(self.axes) if other != name)
        shares = posterior(log_likelihood).sum(axis=others)
        at = self.axes[name]
        mean = float(at @ shares)
        sd = float(np.sqrt((at - mean) ** 2 @ shares))
        edges = np.concatenate((at[:1], (at[1:] + at[:-1]) / 2, at[-1:]))
        low, high = np.interp(TAILS, np.append(0, np.cumsum(shares)), edges).tolist()
        return Estimate(mean, sd, low, high)


def posterior(log_likelihood: Floats) -> Floats:
    """Return probabilities that add up to 1, of log likelihoods."""
    shares = np.exp(log_likelihood - log_likelihood.max())
    return shares / shares.sum()


class Quest:
    """QUEST+. What it asks depends on the history that it is given, and on nothing else.

    Parameters
    ----------
    grid
        The observer.
    stimuli
        What may be asked.
    about
        Name of the parameter that is asked about, by equation (2); empty for all, by equation (1).
    """

    def __init__(self, grid: Grid, stimuli: Sequence[Stimulus], about: str = "") -> None:
        self.grid = grid
        self.stimuli = list(stimuli)
        self._chances = grid.chances(stimuli).reshape(len(self.stimuli), -1)
        self._about = None
        if about:
            along = np.meshgrid(*grid.axes.values(), indexing="ij")
            self._about = along[list(grid.axes).index(about)].ravel()

    def log_likelihood(self, history: Sequence[tuple[Stimulus, bool]]) -> Floats:
        """Return the log likelihood of some answers, of the grid's shape."""
        found = np.zeros(self._chances.shape[1])
        for stimulus, positive in history:
            chances = self._chances[self.stimuli.index(stimulus)]
            found += np.log(chances) if positive else np.log1p(-chances)
        return found.reshape(self.grid.shape)

    def next(self, history: Sequence[tuple[Stimulus, bool]]) -> Stimulus:
        """Return the stimulus that is asked after some answers."""
        shares = posterior(self.log_likelihood(history)).ravel()
        positive = self._chances @ shares
        if self._about is None:
            worth = _entropy(positive) - _entropy(self._chances) @ shares
        else:
            mean = shares @ self._about
            # Of both outcomes: p(o) (E[φ | o] - E[φ])² = (Σ_θ post p(o) φ - p(o) E[φ])² / p(o).
            apart = self._chances @ (shares * self._about) - positive * mean
            worth = apart**2 / positive + apart**2 / (1 - positive)
            worth /= max(shares @ (self._about - mean) ** 2, np.finfo(float).tiny)
        return self.stimuli[int(np.argmax(worth >= worth.max() - TIE))]

    def estimate(self, name: str, history: Sequence[tuple[Stimulus, bool]]) -> Estimate:
        """Estimate a parameter after some answers."""
        return self.grid.estimate(name, self.log_likelihood(history))


def _entropy(positive: Floats) -> Floats:
    return -positive * np.log(positive) - (1 - positive) * np.log1p(-positive)


def steps(least: float, most: float, step: float) -> tuple[float, ...]:
    """Return values from one to another, both ends among them.

    Raises
    ------
    ValueError
        If the step does not lead from one end to the other.
    """
    count = round((most - least) / step)
    if count < 1 or abs(least + count * step - most) > step * 1e-6:
        raise ValueError(f"is {step:g}, which does not lead from {least:g} to {most:g}")
    return tuple(round(least + n * step, PLACES) for n in range(count + 1))
