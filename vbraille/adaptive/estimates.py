"""What is known about a parameter: the shares of its possible values, and numbers made of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

CREDIBLE = 0.95  # share of a posterior that a credible interval holds


@dataclass(frozen=True, slots=True)
class GridAxis:
    """Possible values of a parameter of whoever answers.

    Parameters
    ----------
    name
        Name of the parameter.
    values
        Values, increasing; a single value fixes the parameter.
    weights
        How likely each value is beforehand, up to a factor; empty if all are equally likely.

    Raises
    ------
    ValueError
        If there is no value, values do not increase, or weights are not as many, not above 0 or
        not finite.
    """

    name: str
    values: tuple[float, ...]
    weights: tuple[float, ...] = ()

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError(f"{self.name} has no values; give one or more")
        if not np.isfinite(self.values).all() or (np.diff(self.values) <= 0).any():
            raise ValueError(f"{self.name} has values that do not increase; sort them")
        if self.weights and len(self.weights) != len(self.values):
            raise ValueError(
                f"{self.name} has {len(self.weights)} weights; there must be {len(self.values)}"
            )
        if not (np.isfinite(self.weights).all() and (np.array(self.weights) > 0).all()):
            raise ValueError(f"{self.name} has a weight that is not above 0")

    @property
    def prior(self) -> NDArray[np.float64]:
        """Probabilities of the values beforehand; float64[values]."""
        weights = np.array(self.weights or (1.0,) * len(self.values))
        return weights / weights.sum()


@dataclass(frozen=True, slots=True)
class GridEstimate:
    """What is known about a parameter after some answers.

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
