"""How often intervals over trials hold the truth: transmitted bits, slopes, correlations."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import brentq
from scipy.special import expit

from tests.benchmarks.coverage_people import Found
from tests.conftest import SEED
from vbraille.analysis.measures.movement import correlation
from vbraille.analysis.measures.trends import slope
from vbraille.analysis.statistics.information import transmission, transmitted_bits
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.braille.spelling import LETTERS

_MASKS = list(LETTERS.values())
DISTANCE = np.array([[(a ^ b).bit_count() for b in _MASKS] for a in _MASKS], float)
PAIR_DISTANCE = np.array(
    [
        [(a ^ b).bit_count() + (c ^ d).bit_count() for b, d in product(range(4), repeat=2)]
        for a, c in product(range(4), repeat=2)
    ],
    float,
)


@dataclass(frozen=True, slots=True)
class Bits:
    """Estimates of one truth: its bits, the plug-in's mean error, ours, and coverage."""

    truth: float
    plain_error: float
    error: float
    typical_error: float
    found: Found


def bits_of(shares: np.ndarray) -> float:
    """Information transmitted of shares of answers, each row presented alike."""
    joint = shares / len(shares)

    def entropy(p: np.ndarray) -> float:
        return float(-(p[p > 0] * np.log2(p[p > 0])).sum())

    return entropy(joint.sum(axis=0)) + entropy(joint.sum(axis=1)) - entropy(joint)


def even(letters: int, right: float) -> np.ndarray:
    """All errors alike."""
    shares = np.full((letters, letters), (1 - right) / (letters - 1))
    np.fill_diagonal(shares, right)
    return shares


def by_dots(distance: np.ndarray, reach: float) -> np.ndarray:
    """Likelier errors differ in fewer dots."""
    shares = np.exp(-distance / reach)
    return shares / shares.sum(axis=1, keepdims=True)


def in_two(letters: int, right: float) -> np.ndarray:
    """Each has two errors of its own."""
    shares = np.eye(letters) * right
    for apart, share in ((1, 0.7), (5, 0.3)):
        shares += np.roll(np.eye(letters), apart, axis=1) * (1 - right) * share
    return shares


def uneven(middle: float) -> np.ndarray:
    """Letters of unequal difficulty, errors by dots, and three in ten not read."""
    random = np.random.default_rng(SEED)
    wrong = np.exp(-DISTANCE / 1.2)
    np.fill_diagonal(wrong, 0)
    wrong /= wrong.sum(axis=1, keepdims=True)
    right = expit(middle + random.normal(0, 1, len(wrong)))[:, None]
    return np.hstack((0.7 * wrong * (1 - right) + np.diag(right[:, 0]), 0.3 * (1 - right)))


def readers() -> dict[str, np.ndarray]:
    """Shares of the answers (columns) to each character (rows), by what kind of reader it is."""
    return {
        "26 letters, all errors alike": even(26, _solve(lambda x: even(26, x), 1.72, 0.1, 0.99)),
        "26, errors by dots": by_dots(
            DISTANCE, _solve(lambda x: by_dots(DISTANCE, x), 1.72, 0.1, 9)
        ),
        "26, uneven, some not read": uneven(_solve(uneven, 1.72, -4, 4)),
        "26, two errors each": in_two(26, 0.5),
        "26, by dots, better": by_dots(
            DISTANCE, _solve(lambda x: by_dots(DISTANCE, x), 3.3, 0.1, 9)
        ),
        "26, near-perfect": even(26, 0.97),
        "26, chance": even(26, 1 / 26),
        "16 pairs, errors by dots": by_dots(
            PAIR_DISTANCE, _solve(lambda x: by_dots(PAIR_DISTANCE, x), 2.5, 0.1, 9)
        ),
        "16 pairs, chance": even(16, 1 / 16),
        "4 characters, all errors alike": even(4, 0.85),
    }


def bits(shares: np.ndarray, answers: int, studies: int) -> Bits:
    """Of so many answers, spread evenly over what is presented."""
    random = np.random.default_rng([SEED, answers, *shares.shape])
    truth = bits_of(shares)
    plain, found, held = [], [], 0
    for study in range(studies):
        counts = random.multinomial(answers // len(shares), shares)
        plain.append(transmitted_bits(counts))
        try:
            estimate = transmission(counts, seed=study)
        except Unanswerable:
            continue
        found.append(estimate.bits)
        held += estimate.interval.low - 1e-9 <= truth <= estimate.interval.high + 1e-9
    errors = np.array(found) - truth
    return Bits(
        truth,
        float(np.mean(plain)) - truth,
        float(errors.mean()) if found else np.nan,
        float(np.sqrt((errors**2).mean())) if found else np.nan,
        Found(len(found), held, studies),
    )


def slopes(trials: int, share: float, change: float, studies: int) -> Found:
    """Of a participant's right answers, whose probability changes so much from first to last."""
    random = np.random.default_rng([SEED, trials, round(100 * share), round(100 * change) + 100])
    chances = share + change * (np.arange(trials) / (trials - 1) - 0.5)
    truth = 10 * change / (trials - 1)
    rows = [slope(right) for right in random.random((studies, trials)) < chances]
    return _held(rows, truth, studies)


def correlations(trials: int, share: float, studies: int) -> Found:
    """Of a participant's durations (log-normal, SD 0.5) with right answers, likelier of short."""
    random = np.random.default_rng([SEED, trials, round(100 * share)])

    def made(rows: int, n: int) -> tuple[np.ndarray, np.ndarray]:
        z = random.normal(0, 1, (rows, n))
        right = random.random((rows, n)) < expit(np.log(share / (1 - share)) - 0.5 * z)
        return np.exp(2 + 0.5 * z), right

    seconds, right = made(1, 2_000_000)
    truth = float(np.corrcoef(seconds[0], right[0])[0, 1])
    rows = [correlation(*row, "trials") for row in zip(*made(studies, trials), strict=True)]
    return _held(rows, truth, studies)


def correlations_of_people(people: int, share: float, studies: int) -> Found:
    """Of participants' mean durations with their shares of 40, of log odds with SD 1."""
    random = np.random.default_rng([SEED, people, round(100 * share)])

    def made(rows: int, n: int) -> tuple[np.ndarray, np.ndarray]:
        z, other = random.normal(0, 1, (2, rows, n))
        right = random.binomial(40, expit(np.log(share / (1 - share)) + z)) / 40
        return np.exp(2 + 0.4 * (-0.6 * z + 0.8 * other)), right

    seconds, right = made(1, 2_000_000)
    truth = float(np.corrcoef(seconds[0], right[0])[0, 1])
    rows = [correlation(*row, "participants") for row in zip(*made(studies, people), strict=True)]
    return _held(rows, truth, studies)


def _held(rows: list[dict], truth: float, studies: int) -> Found:
    given = [row for row in rows if row.get("low") is not None]
    return Found(len(given), sum(r["low"] <= truth <= r["high"] for r in given), studies)


def _solve(made, truth: float, low: float, high: float) -> float:
    """Parameter at which a reader transmits so many bits."""
    return brentq(lambda x: bits_of(made(x)) - truth, low, high)
