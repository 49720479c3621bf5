import time
from itertools import permutations

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.stats import t, ttest_1samp
from statsmodels.genmod.families import Binomial
from statsmodels.genmod.generalized_linear_model import GLM

from vbraille.analysis.statistics.bradleyterry import (
    bradley_terry,
    connected,
    fit,
    position_bias,
    preferred,
)
from vbraille.analysis.statistics.intervals import Unanswerable, mean_share, wilson

# Citations among Biometrika, Communications in Statistics, JASA and JRSS-B:
# Stigler 1994; Agresti 2002, p. 448.
CITATIONS = np.array([[0, 730, 498, 221], [33, 0, 68, 17], [320, 813, 0, 142], [284, 276, 325, 0]])
WIDTHS_MM = [0.5, 1, 1.5, 2, 2.5, 3]


def design(k):
    """Which of k values come against each other: rows of 1 and -1."""
    pairs = [(i, j) for i in range(k) for j in range(i)]
    rows = np.zeros((len(pairs), k))
    for row, (i, j) in zip(rows, pairs, strict=True):
        row[i], row[j] = 1, -1
    return rows, pairs


def penalised(wins):
    """Firth's strengths by maximising the likelihood with Jeffreys' prior."""
    k = len(wins)
    x, pairs = design(k)
    won = np.array([wins[i, j] for i, j in pairs])
    n = won + np.array([wins[j, i] for i, j in pairs])

    def loss(free):
        p = 1 / (1 + np.exp(-x[:, 1:] @ free))
        information = (x[:, 1:].T * (n * p * (1 - p))) @ x[:, 1:]
        likelihood = won @ np.log(p) + (n - won) @ np.log(1 - p)
        return -likelihood - np.linalg.slogdet(information)[1] / 2

    found = np.r_[0, minimize(loss, np.zeros(k - 1), tol=1e-10, method="Powell").x]
    return found - found.mean()


def comparisons(wins_of_each):
    """Columns first, second, chosen, groups of tables of wins."""
    rows = [
        (i, j, 0, who) if n % 2 else (j, i, 1, who)
        for who, wins in enumerate(wins_of_each)
        for i, j in permutations(range(len(wins)), 2)
        for n in range(wins[i, j])
    ]
    return np.array(rows, dtype=int).reshape(-1, 4).T


def test_the_published_scale_of_statistics_journals():
    # Turner and Firth 2012, p. 4: by maximum likelihood, from which many comparisons
    # take the penalty's part away; errors are those of the counts as they are.
    s = bradley_terry(1000 * CITATIONS).strengths
    np.testing.assert_allclose(s - s[0], [0, -2.94907, -0.47957, 0.26895], atol=2e-5)
    scale = bradley_terry(CITATIONS)
    np.testing.assert_allclose(scale.strengths - scale.strengths[0], s - s[0], atol=0.005)
    c = scale.covariance
    errors = np.sqrt(c[0, 0] + np.diag(c) - 2 * c[0])
    np.testing.assert_allclose(errors, [0, 0.10255, 0.06059, 0.07083], atol=2e-4)


@pytest.mark.parametrize("k", [3, 6])
def test_many_comparisons_give_the_likelihood_of_a_binomial_regression(rng, k):
    wins = rng.integers(3000, 9000, (k, k)) * (1 - np.eye(k, dtype=int))
    x, pairs = design(k)
    counts = [(wins[i, j], wins[j, i]) for i, j in pairs]
    theirs = GLM(np.array(counts), x[:, 1:], family=Binomial()).fit()
    scale = bradley_terry(wins)
    np.testing.assert_allclose(scale.strengths[1:] - scale.strengths[0], theirs.params, atol=3e-4)
    to_first = np.eye(k)[1:] - np.eye(k)[0]
    np.testing.assert_allclose(
        to_first @ scale.covariance @ to_first.T, theirs.cov_params(), rtol=1e-3
    )


@pytest.mark.no_cover
@pytest.mark.parametrize("k", [2, 3, 4])
def test_few_comparisons_give_firths_likelihood(rng, k):
    for _ in range(3):
        wins = rng.poisson(1.5, (k, k)) * (1 - np.eye(k, dtype=int))
        wins[np.arange(k - 1), np.arange(1, k)] += 1  # connected
        np.testing.assert_allclose(bradley_terry(wins).strengths, penalised(wins), atol=1e-5)


def test_one_comparison_is_known_in_closed_form():
    # Half a win each way: odds (1 + 1/2) to 1/2.
    found = bradley_terry([[0, 1], [0, 0]])
    np.testing.assert_allclose(found.strengths, [np.log(3) / 2, -np.log(3) / 2])


def test_values_always_or_never_chosen_stay_finite_and_in_order():
    for times in (1, 3, 1000):
        s = bradley_terry(times * np.triu(np.ones((6, 6), dtype=int), 1)).strengths
        assert (np.diff(s) < 0).all()
        np.testing.assert_allclose(s, -s[::-1], atol=1e-6)


@pytest.mark.no_cover
def test_sparse_comparisons_settle(rng):
    wins = rng.poisson(rng.gamma(0.3, 3, (800, 6, 6))) * (1 - np.eye(6))
    wins = wins[connected(wins)]
    strengths, _ = fit(wins)
    assert len(wins) > 300
    assert np.isfinite(strengths).all()
    assert np.abs(strengths.sum(axis=1)).max() < 1e-9
    one, _ = fit(wins[7:8])
    np.testing.assert_allclose(one[0], strengths[7])


def test_a_scale_that_does_not_settle_is_no_scale():
    with pytest.raises(RuntimeError, match="1 scales"):
        fit(CITATIONS[None].astype(float), most_steps=2)


@pytest.mark.parametrize(
    ("pairs", "whether"),
    [
        ([(0, 1), (1, 2), (2, 3), (3, 4)], True),
        ([(0, 1), (2, 1), (2, 3), (4, 3)], True),
        ([(0, 1), (1, 2), (3, 4)], False),
        ([(0, 1), (1, 2), (2, 3)], False),
    ],
)
def test_which_values_hang_together(pairs, whether):
    wins = np.zeros((1, 5, 5))
    wins[0, *zip(*pairs, strict=True)] = 1
    assert connected(wins).tolist() == [whether]


@pytest.mark.parametrize(
    ("wins", "error", "reason"),
    [
        (np.zeros((3, 3), dtype=int), Unanswerable, "no comparisons"),
        ([[0, 1, 0], [1, 0, 0], [0, 0, 0]], Unanswerable, "never compared"),
    ],
)
def test_what_is_no_table_of_comparisons(wins, error, reason):
    with pytest.raises(error, match=reason):
        bradley_terry(wins)


def wins_by(strengths, times=10_000):
    """Expected wins of values of these strengths."""
    s = np.array(strengths, dtype=float)
    return np.rint(times / (1 + np.exp(s - s[:, None]))).astype(int) * (
        1 - np.eye(len(s), dtype=int)
    )


def best(wins, values=WIDTHS_MM, **options):
    return preferred(values, *comparisons([wins]), seed=1, resamples=20, **options)


def test_the_vertex_of_a_parabola_is_found():
    values = np.array([0.5, 1.2, 1.5, 2, 2.2, 3])  # not evenly spaced
    wins = wins_by(-((values - 1.73) ** 2), 500)
    assert best(wins, values).value == pytest.approx(1.73, abs=0.01)
    # In whatever order the values are named.
    order = np.array([3, 0, 5, 1, 4, 2])
    again = best(wins[np.ix_(order, order)], values[order])
    assert again.value == pytest.approx(best(wins, values).value)


def test_two_equally_chosen_neighbours_give_the_value_between():
    spacings_mm = [1, 1.3, 1.6, 1.9, 2.2, 2.5]
    wins = wins_by([-2, -1, 0, 1, 1, -0.5], 60)
    assert wins[3, 4] == wins[4, 3]
    assert best(wins, spacings_mm).value == pytest.approx(2.05)
    # At the end as well, though one of them is the end.
    assert best(wins_by([1, 1, 0, -1], 60), [1, 2, 3, 4]).value == pytest.approx(1.5)
    assert best(wins_by([-1, 0, 1, 1], 60), [1, 2, 3, 4]).value == pytest.approx(3.5)


def test_at_an_end_it_is_the_end():
    assert best(wins_by([3, 2, 1], 30), [1, 2, 3]).value == 1
    assert best(wins_by([1, 2, 3], 30), [1, 2, 3]).value == 3
    assert best(wins_by([0, 1], 30), [1, 2]).value == 2


def test_three_equals_give_the_middle_one():
    found = best(wins_by([0, 1, 1, 1, 0], 30), [1, 2, 3, 4, 5])
    assert found.value in (2.5, 3)


def test_of_several_it_is_the_mean_of_their_own_with_students_interval(rng):
    s = -((np.array(WIDTHS_MM) - 2) ** 2)
    tables = [wins_by(s + rng.normal(0, 0.3, 6), 30) for _ in range(6)]
    own = [best(table).value for table in tables]
    found = preferred(WIDTHS_MM, *comparisons(tables), seed=3)
    assert found.how == "Student's t over 6 participants' own values"
    assert found.value == pytest.approx(np.mean(own))
    half = t.ppf(0.975, 5) * np.std(own, ddof=1) / np.sqrt(6)
    ends = found.interval
    assert (ends.low, ends.high) == pytest.approx((found.value - half, found.value + half))
    assert found.note == ""


@pytest.mark.parametrize(
    ("people", "why"),
    [(2, "two participants; how people differ is seen of three"), (5, "all values are the same")],
)
def test_participants_of_whom_no_difference_is_seen_have_no_interval(people, why):
    s = -((np.array(WIDTHS_MM) - 2) ** 2)
    found = preferred(WIDTHS_MM, *comparisons([wins_by(s, 3)] * people), seed=3)
    assert found.value == pytest.approx(2)
    assert (found.interval, found.how) == (None, "")
    assert found.note.startswith(f"no interval: {why}")


def test_of_one_participant_the_comparisons_are_resampled():
    s = -((np.array(WIDTHS_MM) - 2) ** 2)
    one = preferred(WIDTHS_MM, *comparisons([wins_by(s, 6)]), seed=3, resamples=300)
    assert one.how == "bootstrap over the comparisons of one participant"
    assert one.interval.low < one.value < one.interval.high
    assert one == preferred(WIDTHS_MM, *comparisons([wins_by(s, 6)]), seed=3, resamples=300)


def test_at_the_end_of_what_was_tested_the_best_may_lie_beyond():
    # It was an interval of no width.
    beyond = "at the end of what was tested, and the best may lie beyond"
    widest = wins_by(np.arange(6) * 2, 6)
    for people in (1, 5):
        found = preferred(WIDTHS_MM, *comparisons([widest] * people), seed=3, resamples=50)
        assert (found.value, found.interval) == (3, None)
        whose = "it" if people == 1 else "the value of 5 of 5 participants"
        assert found.note == f"{whose} is {beyond}; no interval"
    inner = [wins_by(-((np.array(WIDTHS_MM) - best_mm) ** 2), 30) for best_mm in (2.3, 2.6)]
    found = preferred(WIDTHS_MM, *comparisons([*inner, widest]), seed=3)
    assert found.note == f"the value of 1 of 3 participants is {beyond}"
    assert found.interval.low < found.value < found.interval.high == 3


def test_an_interval_that_reaches_the_end_says_so():
    tables = [wins_by(-((np.array(WIDTHS_MM) - best_mm) ** 2), 30) for best_mm in (1, 1.8, 2.6)]
    found = preferred(WIDTHS_MM, *comparisons(tables), seed=3)
    assert (found.interval.low, found.interval.high) == (0.5, pytest.approx(3))
    assert found.note == (
        "the interval reaches the end of what was tested; the best may lie beyond"
    )


def test_who_has_no_scale_is_left_out_and_counted():
    s = -((np.array(WIDTHS_MM) - 2) ** 2)
    some = [wins_by(s + bent * np.arange(6), 30) for bent in (-0.1, 0, 0.1)]
    short = np.zeros((6, 6), int)
    short[0, 1] = 3
    found = preferred(WIDTHS_MM, *comparisons([*some, short]), seed=3)
    assert found.value == preferred(WIDTHS_MM, *comparisons(some), seed=3).value
    assert found.note == ("without 1 of 4 participants, whose own comparisons prefer no value")
    with pytest.raises(Unanswerable, match="a scale of their own"):
        preferred([1, 2, 3], [0, 1], [1, 2], [0, 0], [0, 1], seed=1)


def test_one_participants_few_comparisons_have_no_interval():
    # A chain, highest in the middle: a resample that misses one link says nothing.
    wins = np.zeros((6, 6), int)
    for better, worse in ((1, 0), (2, 1), (2, 3), (3, 4), (4, 5)):
        wins[better, worse] = 1
    found = best(wins)
    assert (found.value, found.interval) == (pytest.approx(1.5, abs=0.3), None)
    assert found.note == (
        "no interval: too few comparisons; most resamples leave some values uncompared"
    )


@pytest.mark.no_cover
def test_the_bootstrap_of_a_session_is_quick(rng):
    s = -((np.array(WIDTHS_MM) - 2) ** 2)
    columns = comparisons([rng.binomial(6, wins_by(s, 1000) / 1000)])
    began = time.process_time()
    preferred(WIDTHS_MM, *columns, seed=1)
    assert time.process_time() - began < 5


def test_what_has_no_preferred_value():
    alike = np.ones((3, 3), dtype=int) - np.eye(3, dtype=int)
    with pytest.raises(Unanswerable, match="equally often"):
        best(alike, [1, 2, 3])
    with pytest.raises(Unanswerable, match="no comparisons"):
        best(0 * alike, [1, 2, 3])


def test_position_bias_is_the_binomial_test():
    found = position_bias([0] * 9 + [1], [7] * 10)
    assert found.share_first == 0.9
    assert found.p == pytest.approx(2 * 11 / 1024)
    assert found.interval == wilson(9, 10)
    assert position_bias([0, 1], [0, 0]).p == 1
    with pytest.raises(Unanswerable, match="no comparisons"):
        position_bias([], [])


def test_of_several_the_position_bias_is_of_people():
    chosen = [0] * 9 + [1] + [0] * 6 + [1] * 4 + [0] * 5 + [1] * 5
    groups = np.repeat([0, 1, 2], 10)
    found = position_bias(chosen, groups)
    assert found.share_first == pytest.approx(20 / 30)
    assert found.interval == mean_share([0.9, 0.6, 0.5], [10, 10, 10])
    assert found.p == pytest.approx(ttest_1samp([0.9, 0.6, 0.5], 0.5).pvalue)
    assert position_bias(chosen[:20], groups[:20])[1:] == (None, None)
    assert position_bias([0, 1] * 3, np.repeat([0, 1, 2], 2)).p is None
