"""Psychometric functions: how likely each answer is, by the stimulus and by who answers.

A shape F grows from 0 to 1 with the stimulus x. With a guess rate γ and a lapse rate λ, a positive
answer (yes, or right) has the probability

    p(x) = γ + (1 - γ - λ) F(x).                                               (1)

γ is 0 for yes or no, and 1/2 for one of two alternatives. The shapes have a threshold t and a
spread s:

    normal    F = Φ((x - t) / s)
    logistic  F = 1 / (1 + exp(-(x - t) / s))
    weibull   F = 1 - exp(-(x / t)^s),  for x and t above 0; s is the slope.   (2)

**Nearer of two.** Of two values x₁ and x₂ somebody chooses the one that is nearer to an inner
value μ. Each distance is judged with independent normal noise of standard deviation s, so that

    p(first) = λ / 2 + (1 - λ) Φ((|x₂ - μ| - |x₁ - μ|) / (s √2)).              (3)

On a log scale, x and μ stand for their natural logarithms, and s is a share of them.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

_LEAST = 1e-15  # least probability of an answer, so that no answer makes all values impossible


def phi(z: Floats) -> Floats:
    """Cumulative distribution of the standard normal, by Python's own erfc; any shape."""
    erfc = math.erfc
    made = [erfc(value) for value in (np.ravel(z) / -math.sqrt(2.0)).tolist()]
    return np.array(made).reshape(np.shape(z)) / 2


def normal(x: Floats, threshold: Floats, spread: Floats) -> Floats:
    """Shape of the cumulative normal, equation (2); arrays are broadcast."""
    return phi((x - threshold) / spread)


def logistic(x: Floats, threshold: Floats, spread: Floats) -> Floats:
    """Shape of the logistic function, equation (2); arrays are broadcast."""
    return 0.5 + 0.5 * np.tanh((x - threshold) / spread / 2)


def weibull(x: Floats, threshold: Floats, spread: Floats) -> Floats:
    """Shape of the Weibull function, equation (2); arrays are broadcast."""
    return -np.expm1(-((x / threshold) ** spread))


SHAPES: dict[str, Callable[[Floats, Floats, Floats], Floats]] = {
    "normal": normal,
    "logistic": logistic,
    "weibull": weibull,
}


def detected(
    shape: str, x: Floats, threshold: Floats, spread: Floats, guess: Floats, lapse: Floats
) -> Floats:
    """Probability of a positive answer, equation (1).

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
    """Probability that the first of two values is chosen as nearer to a centre, equation (3).

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
    return np.clip(probability, _LEAST, 1 - _LEAST)
