"""QUEST+ on a grid (Watson 2017, Journal of Vision 17(3):10): ask what tells most.

The grid has a table p[o, s, θ]: how likely outcome o of stimulus s is for each combination θ of the
parameters. After n trials the posterior is prior × Π p[oₙ, sₙ, θ], kept as logarithms. The next
stimulus is the one with the largest expected information about θ,

    I(s) = Σ_o h(Σ_θ post(θ) p[o, s, θ]) - Σ_θ post(θ) Σ_o h(p[o, s, θ]),    h(p) = -p ln p,   (1)

which is the expected fall of the posterior's entropy. If one parameter φ is asked about and the
others are only in the way, what counts is how near its estimate comes, and the next stimulus is the
one with the largest expected fall of its variance (King-Smith et al. 1994, Vision Research 34:885),
as a share of it,

    V(s) = Σ_o p(o) (E[φ | o] - E[φ])² / var φ,    p(o) = Σ_θ post(θ) p[o, s, θ].            (2)

Of simulated people who compare two values, the second comes some per cent nearer to what they like
than the entropy of φ does (docs/measured.md).

Stimuli within 1e-9 of the best count as equally good, and the first of them is taken: so a
last bit in which two machines differ changes no question.

**Psychometric functions.** A shape F grows from 0 to 1 with the stimulus x. With a guess rate γ
and a lapse rate λ, a positive answer (yes, or right) has the probability

    p(x) = γ + (1 - γ - λ) F(x).                                               (3)

γ is 0 for yes or no, and 1/2 for one of two alternatives. The shapes have a threshold t and a
spread s:

    normal    F = Φ((x - t) / s)
    logistic  F = 1 / (1 + exp(-(x - t) / s))
    weibull   F = 1 - exp(-(x / t)^s),  for x and t above 0; s is the slope.   (4)

**Nearer of two.** Of two values x₁ and x₂ a person chooses the one that is nearer to an inner
value μ. Each distance is judged with independent normal noise of standard deviation s, so that

    p(first) = λ / 2 + (1 - λ) Φ((|x₂ - μ| - |x₁ - μ|) / (s √2)).              (5)

On a log scale, x and μ stand for their natural logarithms, and s is a share of them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]
    Stimulus = tuple[float, ...]

CREDIBLE = 0.95  # share of a posterior that a credible interval holds


@dataclass(frozen=True, slots=True)
class GridAxis:
    """Possible values of a parameter of the observer, all equally likely beforehand.

    Parameters
    ----------
    name
        Name of the parameter.
    values
        Values, increasing; a single value fixes the parameter.

    Raises
    ------
    ValueError
        If there is no value, or values do not increase.
    """

    name: str
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError(f"{self.name} has no values; give one or more")
        if not np.isfinite(self.values).all() or (np.diff(self.values) <= 0).any():
            raise ValueError(f"{self.name} has values that do not increase; sort them")


class GridEstimate(NamedTuple):
    """Estimate of a parameter after some answers.

    Parameters
    ----------
    mean, median
        Mean and median of the posterior, in the unit of the parameter.
    sd
        Standard deviation of the posterior.
    low, high
        Ends of the credible interval of 95 %, which has equal tails.
    """

    mean: float
    median: float
    sd: float
    low: float
    high: float

    @property
    def width(self) -> float:
        """Width of the credible interval."""
        return self.high - self.low


def estimate(values: tuple[float, ...], shares: NDArray[np.float64]) -> GridEstimate:
    """Estimate a parameter from the probabilities of its values.

    Median and interval are interpolated: the probability of a value is spread evenly from halfway
    to the value below it to halfway to the one above.

    Parameters
    ----------
    values
        Values, increasing.
    shares : float64[values]
        Their probabilities, which add up to 1.
    """
    at = np.array(values)
    mean = float(at @ shares)
    sd = float(np.sqrt(((at - mean) ** 2) @ shares))
    if at.size == 1:
        return GridEstimate(mean, mean, 0.0, mean, mean)
    edges = np.concatenate((at[:1], (at[1:] + at[:-1]) / 2, at[-1:]))
    below = np.concatenate(((0.0,), np.cumsum(shares)))
    tail = (1 - CREDIBLE) / 2
    low, median, high = np.interp((tail, 0.5, 1 - tail), below / below[-1], edges).tolist()
    return GridEstimate(mean, median, sd, low, high)


_UNLIKELY = 1e-15  # least probability of an answer, so that no answer makes all values impossible


def phi(z: Floats) -> Floats:
    """Cumulative distribution of the standard normal, by Python's own erfc; any shape."""
    erfc = math.erfc
    made = [erfc(value) for value in (np.ravel(z) / -math.sqrt(2.0)).tolist()]
    return np.array(made).reshape(np.shape(z)) / 2


SHAPES: dict[str, Callable[[Floats, Floats, Floats], Floats]] = {
    "normal": lambda x, threshold, spread: phi((x - threshold) / spread),
    "logistic": lambda x, threshold, spread: 0.5 + 0.5 * np.tanh((x - threshold) / spread / 2),
    "weibull": lambda x, threshold, spread: -np.expm1(-((x / threshold) ** spread)),
}
"""Shapes by equation (4), of stimulus, threshold and spread; arrays are broadcast."""


def detected(
    shape: str, x: Floats, threshold: Floats, spread: Floats, guess: Floats, lapse: Floats
) -> Floats:
    """Probability of a positive answer, equation (3).

    Parameters
    ----------
    shape
        Name of one of `SHAPES`.
    x, threshold, spread, guess, lapse
        Stimulus and parameters; arrays are broadcast.

    Returns
    -------
    float64 of the common shape, 0 … 1
    """
    return limited(guess + (1 - guess - lapse) * SHAPES[shape](x, threshold, spread))


def nearer(
    first: Floats,
    second: Floats,
    centre: Floats,
    spread: Floats,
    lapse: Floats,
    *,
    log: bool = False,
) -> Floats:
    """Probability that the first of two values is chosen as nearer to a centre, equation (5).

    Parameters
    ----------
    first, second, centre
        Values in the same unit; above 0 if they are judged on a log scale. Arrays are broadcast.
    spread
        Standard deviation of the noise of each distance, in the unit of the values; on a log
        scale, a share.
    lapse
        Share of answers given without regard to the values.
    log
        Whether distances are judged on a log scale.

    Returns
    -------
    float64 of the common shape, 0 … 1
    """
    if log:
        first, second, centre = np.log(first), np.log(second), np.log(centre)
    further = np.abs(second - centre) - np.abs(first - centre)
    return limited(lapse / 2 + (1 - lapse) * phi(further / (spread * math.sqrt(2))))


def limited(probability: Floats) -> Floats:
    """Probabilities kept a little away from 0 and 1, so that no answer is impossible."""
    return np.clip(probability, _UNLIKELY, 1 - _UNLIKELY)


MOST_CELLS = 4_000_000  # of a table, which then takes 32 MB for each outcome
MOST_AXES = 3
_TIE = 1e-9
_LEAST = 1e-300
_PLACES = 9  # decimal places of the values of a grid


class GridQuest:
    """A QUEST+ procedure; what it says depends on the history that it is given, and nothing else.

    Parameters
    ----------
    stimuli
        Stimuli that may be asked: single values, or ordered pairs.
    axes
        Parameters of the observer, of which one to three have several values.
    table : float64[outcomes, stimuli, …axes]
        Probability of each outcome.
    about
        Name of the parameter that the questions are to tell about, by equation (2); empty for all
        together, by equation (1).

    Raises
    ------
    ValueError
        If there is no stimulus, one is given twice, or too many parameters have several values.
    """

    def __init__(
        self,
        stimuli: Sequence[Stimulus],
        axes: Sequence[GridAxis],
        table: NDArray[np.float64],
        about: str = "",
    ) -> None:
        self.stimuli, self.axes = tuple(stimuli), tuple(axes)
        self._index = {stimulus: n for n, stimulus in enumerate(self.stimuli)}
        if not self.stimuli or len(self._index) < len(self.stimuli):
            raise ValueError("stimuli are none, or have one twice; give each once")
        shape = tuple(len(axis.values) for axis in self.axes)
        if not 1 <= sum(size > 1 for size in shape) <= MOST_AXES:
            raise ValueError(f"1 to {MOST_AXES} parameters must have several values")
        names = [axis.name for axis in self.axes]
        if about and about not in names:
            raise ValueError(f"there is no parameter {about!r}; there is {', '.join(names)}")
        flat = np.ascontiguousarray(table.reshape(len(table), len(self.stimuli), -1))
        self._logs = np.log(flat)
        self._uncertain = -(flat * self._logs).sum(axis=0)
        # With two outcomes, the first follows from the second.
        self._table = flat[1:] if len(flat) == 2 else flat
        # The logarithm of the same probability for each combination of parameters.
        self._prior = np.full(flat.shape[-1], np.log(math.prod(1 / size for size in shape)))
        # The value of what is asked about in each combination of parameters.
        self._along: NDArray[np.float64] | None = None
        if about:
            each = np.meshgrid(*(axis.values for axis in self.axes), indexing="ij")
            self._along = each[names.index(about)].reshape(-1)
        # The last history and its posterior: the next history goes on from it as a rule.
        self._kept: tuple[tuple[tuple[Stimulus, int], ...], NDArray[np.float64]] = ((), self._prior)

    def __repr__(self) -> str:
        several = " × ".join(f"{len(axis.values)} of {axis.name}" for axis in self.axes)
        return f"<GridQuest: {len(self.stimuli)} stimuli, {several}>"

    def __contains__(self, stimulus: object) -> bool:
        return stimulus in self._index

    def posterior(self, history: Sequence[tuple[Stimulus, int]]) -> NDArray[np.float64]:
        """Probability of each combination of parameters after some answers; float64[…axes].

        Parameters
        ----------
        history
            Stimuli that were asked, each with the number of its outcome.

        Raises
        ------
        KeyError
            If a stimulus is none of the grid.
        """
        return self._flat(history).reshape([len(axis.values) for axis in self.axes])

    def next(self, history: Sequence[tuple[Stimulus, int]]) -> Stimulus:
        """Stimulus that tells most after some answers, by equation (1) or (2).

        `posterior` describes the arguments and the errors.
        """
        gains = self.gains(history)
        return self.stimuli[int(np.flatnonzero(gains >= gains.max() - _TIE)[0])]

    def gains(self, history: Sequence[tuple[Stimulus, int]]) -> NDArray[np.float64]:
        """Expected information of each stimulus, by equation (1) or (2); float64[stimuli]."""
        posterior = self._flat(history)
        likely = self._by_outcome(posterior, 1.0)
        if self._along is None:
            return _entropy(likely) - np.einsum("sp,p->s", self._uncertain, posterior)
        off = self._along - self._along @ posterior
        variance = max(float(off**2 @ posterior), _LEAST)
        moved = self._by_outcome(posterior * off, 0.0)
        return (moved**2 / np.maximum(likely, _LEAST)).sum(axis=0) / variance

    def _by_outcome(self, weights: NDArray[np.float64], total: float) -> NDArray[np.float64]:
        """Sum of each outcome's probability times weights that add up to so much; [o, stimuli]."""
        # This is no product by BLAS, whose threads would wait for each other on a busy machine.
        sums = np.einsum("osp,p->os", self._table, weights)
        return np.stack((total - sums[0], sums[0])) if len(sums) == 1 else sums

    def estimate(self, history: Sequence[tuple[Stimulus, int]], name: str) -> GridEstimate:
        """Estimate a parameter after some answers, whatever the others are.

        Raises
        ------
        KeyError
            If there is no parameter of that name, or a stimulus is none of the grid.
        """
        names = [axis.name for axis in self.axes]
        if name not in names:
            raise KeyError(name)
        at = names.index(name)
        others = tuple(n for n in range(len(names)) if n != at)
        return estimate(self.axes[at].values, self.posterior(history).sum(axis=others))

    def _flat(self, history: Sequence[tuple[Stimulus, int]]) -> NDArray[np.float64]:
        told = tuple((stimulus, outcome) for stimulus, outcome in history)
        before, logs = self._kept
        if told[: len(before)] != before:
            before, logs = (), self._prior
        for stimulus, outcome in told[len(before) :]:
            logs = logs + self._logs[outcome, self._index[stimulus]]
        self._kept = told, logs
        shares = np.exp(logs - logs.max())
        return shares / shares.sum()


def steps(least: float, most: float, step: float) -> tuple[float, ...]:
    """Values from one to another in equal steps; both ends are among them.

    Raises
    ------
    ValueError
        If the values do not increase, or the step does not lead from one end to the other.
    """
    if not (least < most and 0 < step <= most - least):
        raise ValueError(
            f"step is {step:g}; it must be above 0 and at most {max(most - least, 0):g}, the way "
            f"from {least:g} to {most:g}"
        )
    count = round((most - least) / step)
    if abs(least + count * step - most) > step * 1e-6:
        raise ValueError(
            f"step is {step:g}, and steps of it from {least:g} do not meet {most:g}; give one "
            f"that does"
        )
    return tuple(round(least + n * step, _PLACES) for n in range(count + 1))


def ordered_pairs(values: Sequence[float]) -> tuple[tuple[float, float], ...]:
    """All pairs of two different values, the lower first."""
    return tuple((low, high) for low, high in product(values, values) if low < high)


def detection_quest(
    shape: str,
    values: Sequence[float],
    threshold: GridAxis,
    spread: GridAxis,
    guess: GridAxis,
    lapse: GridAxis,
    *,
    falls: bool = False,
    about: str = "",
) -> GridQuest:
    """QUEST+ of positive and other answers to single values; outcome 1 is the positive one.

    Parameters
    ----------
    shape
        Name of a shape of `vbraille.cli.old.reading.questplus.SHAPES`.
    values
        Values that may be asked.
    threshold, spread, guess, lapse
        Possible values of the parameters.
    falls
        Whether positive answers become rarer with larger values: the shape is mirrored then.
    about
        Name of the parameter that the questions are to tell about; empty for all together.

    Raises
    ------
    ValueError
        If the grid cannot be used, or the shape has no mirror image.
    """
    if shape == "weibull" and (falls or min(*values, *threshold.values) <= 0):
        raise ValueError("shape is 'weibull', which is for values above 0 and grows with them")
    axes = (threshold, spread, guess, lapse)
    _check_size(len(values), axes)
    x, at, *others = _spread_out(np.array(values), axes)
    positive = detected(shape, -x if falls else x, -at if falls else at, *others)
    return GridQuest(
        [(value,) for value in values], axes, np.stack((1 - positive, positive)), about
    )


def nearer_quest(
    pairs: Sequence[tuple[float, float]],
    centre: GridAxis,
    spread: GridAxis,
    lapse: GridAxis,
    *,
    log: bool = False,
    about: str = "",
) -> GridQuest:
    """QUEST+ of which of two values is nearer to an inner one; outcome 1 is the first of the pair.

    Parameters
    ----------
    pairs
        Pairs that may be asked.
    centre, spread, lapse
        Possible values of the parameters of `vbraille.cli.old.reading.questplus.nearer`.
    log
        Whether distances are judged on a log scale.
    about
        Name of the parameter that the questions are to tell about; empty for all together.

    Raises
    ------
    ValueError
        If the grid cannot be used.
    """
    axes = (centre, spread, lapse)
    _check_size(len(pairs), axes)
    asked = np.array(pairs).reshape(-1, 2)
    first, *parameters = _spread_out(asked[:, 0], axes)
    second, *_ = _spread_out(asked[:, 1], axes)
    chosen = nearer(first, second, *parameters, log=log)
    return GridQuest(list(pairs), axes, np.stack((1 - chosen, chosen)), about)


def _entropy(likely: NDArray[np.float64]) -> NDArray[np.float64]:
    """Entropy in nats of outcomes, along the first dimension."""
    likely = limited(likely)
    return -(likely * np.log(likely)).sum(axis=0)


def _spread_out(
    stimuli: NDArray[np.float64], axes: Sequence[GridAxis]
) -> list[NDArray[np.float64]]:
    """Stimuli and values of each axis, each along a dimension of its own."""
    each = [stimuli, *(np.array(axis.values) for axis in axes)]
    return [part.reshape([-1 if n == at else 1 for n in range(len(each))])
            for at, part in enumerate(each)]  # fmt: skip


def _check_size(stimuli: int, axes: Sequence[GridAxis]) -> None:
    cells = stimuli * math.prod(len(axis.values) for axis in axes)
    if cells > MOST_CELLS:
        raise ValueError(
            f"the grid has {cells} cells; it must have at most {MOST_CELLS}: make a step larger"
        )


def geometric(low: float, high: float, count: int) -> tuple[float, ...]:
    """Values from one to another, each the same multiple of the one before."""
    values = tuple(round(v, _PLACES) for v in np.geomspace(low, high, count).tolist())
    assert all(a < b for a, b in pairwise(values)), "they increase"
    return values
