"""How often intervals over people hold the truth: shares, means, differences, preferred values."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import permutations

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit, logit

from tests.conftest import SEED
from vbraille.analysis.statistics.bradleyterry import preferred
from vbraille.analysis.statistics.comparisons import CellDesign, CellScores
from vbraille.analysis.statistics.intervals import (
    MEANS,
    SPREADS,
    Interval,
    Unanswerable,
    log_likelihood,
    mean_duration,
    quantiles,
)

PEOPLE = (3, 5, 6, 10, 20)
SPREAD = (0.5, 1.0, 1.5)
SHARES = (0.5, 0.8, 0.95)
VALUES_MM = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0])
REPEATS = 3  # of each ordered pair, as in the protocols
_BATCH = 500
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(100)
_WEIGHTS /= _WEIGHTS.sum()


@dataclass(frozen=True, slots=True)
class Found:
    """Studies that had an interval, those whose interval held the truth, and all."""

    given: int
    held: int
    studies: int

    @property
    def coverage(self) -> float:
        """Of the intervals that were given, in per cent."""
        return 100 * self.held / self.given if self.given else np.nan

    def text(self) -> str:
        """Coverage, and the share of studies with an interval where not all have one."""
        if not self.given:
            return "none"
        rest = "" if self.given == self.studies else f" ({100 * self.given / self.studies:.0f})"
        return f"{self.coverage:.1f}{rest}"


def mean_of(centre: float, sd: float) -> float:
    """Mean share of a population whose log odds have this mean and standard deviation."""
    return float(expit(centre + sd * _NODES) @ _WEIGHTS)


def centre_of(mean: float, sd: float) -> float:
    """Mean of the log odds of a population with this mean share."""
    return brentq(lambda centre: mean_of(centre, sd) - mean, -20.0, 20.0)


def shares(people: int, trials: int, share: float, sd: float, centred: str, studies: int) -> Found:
    """Coverage of the mean share, of `centred` "mean" or "middle": which share is given."""
    centre = centre_of(share, sd) if centred == "mean" else float(logit(share))
    truth = mean_of(centre, sd)
    random = np.random.default_rng([SEED, people, trials, round(100 * share), round(10 * sd)])
    right = random.binomial(trials, expit(random.normal(centre, sd, (studies, people))))
    each = np.array([log_likelihood(float(k), float(trials)) for k in range(trials + 1)])
    each = each.reshape(trials + 1, -1)
    held = 0
    for part in np.array_split(right, max(1, studies // _BATCH)):
        counts = np.zeros((len(part), trials + 1), np.float32)
        np.add.at(counts, (np.arange(len(part))[:, None], part), 1)
        likely = (counts @ each).reshape(-1, MEANS, SPREADS)
        low, high = quantiles(likely, float(trials))
        held += int(((low <= truth) & (truth <= high)).sum())
    return Found(studies, held, studies)


def durations(people: int, sd: float, studies: int) -> Found:
    """Of mean durations of 40 trials, log-normal between people (SD given) and within (0.5)."""
    random = np.random.default_rng([SEED, people, round(10 * sd)])
    own = np.exp(random.normal(2.0, sd, (studies, people)))
    seconds = own * np.exp(random.normal(0.0, 0.5, (40, studies, people))).mean(axis=0)
    truth = float(np.exp(2.0 + sd**2 / 2 + 0.125))
    ends = [mean_duration(row) for row in seconds]
    return Found(studies, sum(e.low <= truth <= e.high for e in ends), studies)


def differences(people: int, share: float, sd: float, studies: int) -> Found:
    """Of two conditions' mean shares of 40 trials: 0.5 apart in log odds, SD 0.5 over people."""
    random = np.random.default_rng([SEED, people, round(100 * share), round(10 * sd)])
    centre, apart = centre_of(share, sd), np.hypot(sd, 0.5)
    own = random.normal(centre, sd, (studies, people))
    other = own - 0.5 + random.normal(0.0, 0.5, own.shape)
    truth = mean_of(centre, sd) - mean_of(centre - 0.5, float(apart))
    first, second = (random.binomial(40, expit(at)) / 40 for at in (own, other))
    given = held = 0
    design, cells = CellDesign(np.array([[0], [1]])), np.zeros(2, np.int64)
    for each in np.stack([first, second], axis=-1):
        scores = CellScores(each, design, np.zeros(people, np.int64), cells, Interval(0.0, 1.0))
        found = scores.contrast(np.array([1.0, -1.0]))
        if found.low is None or found.high is None:
            continue
        given += 1
        held += found.low <= truth <= found.high
    return Found(given, held, studies)


def preference(people: int, best_mm: float, sd_mm: float, studies: int) -> Found:
    """Of preferred values: worth falls with the square of the distance (mm) from one's best.

    The best is normal over people, but none lies outside what is tested.
    """
    random = np.random.default_rng([SEED, people, round(100 * best_mm), round(10 * sd_mm)])
    pairs = np.tile(list(permutations(range(len(VALUES_MM)), 2)), (REPEATS, 1))
    first, second = np.tile(pairs, (people, 1)).T
    groups = np.repeat(np.arange(people), len(pairs))
    ends = VALUES_MM[0], VALUES_MM[-1]
    mean_mm = float(np.clip(best_mm + sd_mm * _NODES, *ends) @ _WEIGHTS)
    given = held = 0
    for _ in range(studies):
        liked = np.clip(random.normal(best_mm, sd_mm, people), *ends)
        own = liked[groups]
        worth = (VALUES_MM[second] - own) ** 2 - (VALUES_MM[first] - own) ** 2
        chosen = (random.random(groups.size) > expit(2.0 * worth)).astype(int)
        try:
            found = preferred(
                VALUES_MM, first, second, chosen, groups, seed=SEED, resamples=400
            ).interval
        except Unanswerable:
            continue
        if found is not None:
            truth = liked[0] if people == 1 else mean_mm
            given += 1
            held += found.low <= truth <= found.high
    return Found(given, held, studies)
