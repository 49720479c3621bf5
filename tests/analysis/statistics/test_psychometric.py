"""Psychometric functions: against a search of their likelihood, and against what made them."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import expit
from scipy.stats import norm

from tests.benchmarks.coverage_readers import curve, just_noticeable
from tests.tiers import by_tier
from vbraille.analysis.statistics.intervals import Unanswerable
from vbraille.analysis.statistics.psychometric import fit_psychometric

LEVELS = np.linspace(0.25, 1.75, 7)
COUNTS = {0.5: [10, 13, 12, 17, 19, 19, 20], None: [1, 0, 4, 9, 17, 18, 20]}
ALARMS = [7, 4, 9, 13, 18, 19, 20]  # of a reader who says yes to 6 of 20 blanks
STUDIES = by_tier(8, 200, 1000)


def written_out(shape, x, m, s):
    """The curves as textbooks have them."""
    if shape == "logistic":
        return 1 / (1 + math.exp(-(x - m) / s))
    if shape == "normal":
        return 0.5 * math.erfc((m - x) / (s * math.sqrt(2)))
    return 1 - 2 ** -((x / m) ** (1 / s))


def minus_log_posterior(at, shape, counts, guess, blanks):
    """Compute the log likelihood of threshold, log spread, lapses and free guesses, written out."""
    m, log_s, lapse = at[:3]
    floor = at[3] if guess is None else guess
    if not (0 <= lapse <= 0.1 and 0 <= floor <= 0.9 and m > 0):
        return np.inf
    shares = [
        floor + (1 - floor - lapse) * written_out(shape, x, m, math.exp(log_s)) for x in LEVELS
    ]
    answers = [(of, 20, share) for of, share in zip(counts, shares, strict=True)]
    right = sum(
        of * math.log(max(share, 1e-9)) + (n - of) * math.log(max(1 - share, 1e-9))
        for of, n, share in [*answers, (*blanks, floor)]
    )
    return -right - 19 * math.log1p(-lapse)


@pytest.mark.parametrize(
    ("guess", "counts", "blanks"),
    [
        (0.5, COUNTS[0.5], (0, 0)),
        (None, COUNTS[None], (0, 0)),
        (None, COUNTS[None], (0, 12)),
        (None, ALARMS, (6, 20)),
    ],
    ids=["which of two", "yes and no", "no false alarm", "false alarms"],
)
@pytest.mark.parametrize("shape", ["logistic", "normal", "weibull"])
def test_the_estimate_is_the_most_likely(shape, guess, counts, blanks):
    def lost(at):
        return minus_log_posterior(at, shape, counts, guess, blanks)

    found = fit_psychometric(LEVELS, counts, [20] * 7, shape=shape, guess=guess, blanks=blanks)
    ours = [found.threshold, math.log(found.spread), found.lapse, found.guess]
    start = [0.9, -1.3, 0.02] + ([0.1] if guess is None else [])
    exactly = {"xatol": 1e-9, "fatol": 1e-12, "maxiter": 8000, "maxfev": 8000}
    exactly |= {"adaptive": True}
    best = minimize(lost, start, method="Nelder-Mead", options=exactly)
    for _ in range(6):  # a simplex that is caught at a bound goes on when it is made anew
        best = minimize(lost, best.x + 1e-3, method="Nelder-Mead", options=exactly)
    assert lost(ours[: len(start)]) <= best.fun + 1e-7
    assert found.threshold == pytest.approx(best.x[0], abs=2e-4)
    assert math.log(found.spread) == pytest.approx(best.x[1], abs=2e-3)
    assert found.threshold_interval.low < found.threshold < found.threshold_interval.high
    assert found.spread_interval.low < found.spread < found.spread_interval.high


def test_a_level_that_stands_there_twice_is_one():
    levels = [*LEVELS, 1.0, 2.0]
    counts, trials = [*COUNTS[0.5], 8, 0], [20] * 7 + [10, 0]
    counts[3], trials[3] = 9, 10
    twice = fit_psychometric(levels, counts, trials)
    assert twice == fit_psychometric(LEVELS, COUNTS[0.5], [20] * 7)


def test_all_below_a_level_and_all_above_have_an_interval():
    found = fit_psychometric(LEVELS, [0, 0, 0, 20, 20, 20, 20], [20] * 7, guess=0.0)
    assert 0.7 < found.threshold_interval.low < found.threshold_interval.high < 1.05


@pytest.mark.parametrize(
    ("guess", "blanks", "counts", "beyond"),
    [
        (0.5, (0, 0), COUNTS[0.5], []),
        (None, (6, 20), ALARMS, []),
        (0.0, (0, 0), [9, 11, 10, 14, 17, 19, 20], ["begins below the lowest level"]),
        (0.0, (0, 0), [0, 1, 0, 3, 6, 5, 9], ["ends above the highest level"]),
        (0.5, (0, 0), [14, 15, 14, 15, 14, 16, 15], ["begins below", "ends above"]),
    ],
    ids=["inside", "false alarms", "below", "above", "both"],
)
def test_the_interval_lies_between_quantiles(guess, blanks, counts, beyond):
    """Integrate the posterior over even steps, independently of the product."""
    found = fit_psychometric(LEVELS, counts, [20] * 7, guess=guess, blanks=blanks)

    def middles(low, high, size):
        return low + (np.arange(size) + 0.5) / size * (high - low)

    m = middles(-0.5, 2.5, 150)  # half of the levels' range below them and above
    s = np.exp(middles(math.log(0.025), math.log(3.0), 50))
    lapse = middles(0, 0.1, 5)
    floors = middles(0, 0.9, 45) if guess is None else np.array([guess])
    grid = np.meshgrid(m, s, lapse, floors, indexing="ij", sparse=True)
    log = 19 * np.log1p(-grid[2])
    for x, of, n in [*zip(LEVELS, counts, [20] * 7, strict=True), (-np.inf, *blanks)]:
        share = grid[3] + (1 - grid[3] - grid[2]) * expit((x - grid[0]) / grid[1])
        share = np.clip(share, 1e-9, 1 - 1e-9)
        log = log + of * np.log(share) + (n - of) * np.log1p(-share)
    mass = np.exp(log - log.max())
    ends, spread = found.threshold_interval, found.spread_interval
    for own, edges, low, estimate, high in (
        (mass.sum(axis=(1, 2, 3)), (-0.5, 2.5), ends.low, found.threshold, ends.high),
        (mass.sum(axis=(0, 2, 3)), np.log([0.025, 3.0]),
         *np.log([spread.low, found.spread, spread.high])),
    ):  # fmt: skip
        sums = np.concatenate([[0], np.cumsum(own) / own.sum()])
        least, most = np.interp([0.025, 0.975], sums, np.linspace(*edges, sums.size))
        near = 0.02 * (most - least)
        assert edges[0] <= low <= high <= edges[1]
        assert low == pytest.approx(min(least, estimate), abs=near)
        assert high == pytest.approx(max(most, estimate), abs=near)
    assert (ends.low < 0.25, ends.high > 1.75) == tuple(
        any(words in note for note in beyond) for words in ("begins below", "ends above")
    )
    said = [part for part in found.note.split("; ") if part.startswith("the interval")]
    assert len(said) == len(beyond)
    assert all(words in part for words, part in zip(beyond, said, strict=True))


def test_a_threshold_that_was_not_reached_is_said():
    found = fit_psychometric(LEVELS, [0, 1, 0, 1, 1, 2, 4], [20] * 7, guess=0.0)
    assert found.threshold > 1.75
    assert found.note == (
        "the threshold is beyond the levels that were presented; "
        "the interval ends above the highest level presented, 1.75"
    )


def test_no_threshold_nor_its_interval_is_beyond_the_scale():
    """At either end: contrast goes from 0 to 1, whatever else the answers would say."""
    for counts in ([14, 13, 15, 16, 18, 19, 20], [0, 1, 0, 1, 1, 2, 4]):
        levels = LEVELS / 1.75
        free = fit_psychometric(levels, counts, [20] * 7, guess=0.0)
        kept = fit_psychometric(levels, counts, [20] * 7, guess=0.0, scale=(0.0, 1.0))
        ends = kept.threshold_interval
        assert 0 <= ends.low <= kept.threshold <= ends.high <= 1
        assert free.threshold_interval.low < 0 or free.threshold_interval.high > 1


@pytest.mark.parametrize("guess", [0.5, 0.0])
def test_intervals_hold_the_truth(guess):
    random = np.random.default_rng(7)
    shares = guess + (1 - guess - 0.02) * norm.cdf(LEVELS, 1.0, 0.3)
    held = 0
    for _ in range(STUDIES):
        found = fit_psychometric(
            LEVELS, random.binomial(20, shares), [20] * 7, shape="normal", guess=guess
        )
        held += found.threshold_interval.low <= 1.0 <= found.threshold_interval.high
    assert held / STUDIES > 0.95 - 3 * math.sqrt(0.05 / STUDIES)


@pytest.mark.parametrize("alarms", by_tier([0.3], [0.02, 0.2, 0.3], [0.02, 0.2, 0.3]))
def test_false_alarms_do_not_move_thresholds(alarms):
    """Seven levels of 24 trials and 24 blanks, as `bench_trials_coverage` tries 1,000 times."""
    found = curve(24, "logistic", alarms, 2 * STUDIES)
    covered, error = found["threshold"], found["bias"].error
    assert covered.given == covered.studies
    assert covered.held / covered.given > 0.95 - 3 * math.sqrt(0.05 / covered.given)
    assert abs(error) < 0.02 + 3 * 0.12 / math.sqrt(covered.given)


def test_guesses_are_the_share_of_yes_at_nothing():
    """With enough blank trials, that share and no other."""
    found = fit_psychometric(LEVELS, ALARMS, [20] * 7, guess=None, blanks=(3000, 10_000))
    assert found.guess == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize(
    ("change", "error", "reason"),
    [
        ({"positive": [20] * 7}, Unanswerable, "all answers are the same"),
        ({"positive": [20, 18, 15, 12, 9, 4, 1]}, Unanswerable, "does not rise"),
        ({"levels": [1.0] * 7}, Unanswerable, "1 level; a curve needs 3"),
    ],
    ids=["all", "falling", "one level"],
)
def test_what_is_no_curve(change, error, reason):
    given = {"levels": LEVELS, "positive": COUNTS[0.5], "trials": [20] * 7}
    with pytest.raises(error, match=reason):
        fit_psychometric(**{**given, **change})


def test_lapses_at_both_ends_leave_the_point_of_equality_and_the_spread():
    """The answers have exact shares; a fit with lapses at one end alone is far too flat."""
    levels, many = np.linspace(-2.1, 2.1, 7), 1000
    share = 0.04 + 0.92 * norm.cdf(levels, 0.3, 0.5)
    given = levels, np.round(many * share), np.full(7, many)
    even = fit_psychometric(*given, shape="normal", even=True)
    assert (even.threshold, even.spread) == pytest.approx((0.3, 0.5), abs=0.01)
    assert even.guess == even.lapse == pytest.approx(0.04, abs=0.005)
    assert even.shares(levels) == pytest.approx(share, abs=0.005)
    assert fit_psychometric(*given, shape="normal", guess=0.0).spread > 0.6


@pytest.mark.parametrize("lapse", by_tier([0.0], [0.0, 0.05], [0.0, 0.02, 0.05]))
def test_equality_and_the_just_noticeable_are_within_their_intervals(lapse):
    readers = by_tier(40, 400, 4000)
    spread = math.sqrt(0.95 * 0.05 / readers)
    for share in just_noticeable(readers, lapse):
        assert 0.93 - 4 * spread <= share <= min(0.98 + 4 * spread, 1.0)
