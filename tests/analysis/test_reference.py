"""Results to six digits, as any other package gives them."""

import numpy as np
import pytest

from tests.analysis.making import CASES, analysed, row_of, trials_of
from vbraille.analysis import analyse, stats

A, B, C = [20, 22, 25, 18, 24, 23], [17, 21, 22, 18, 19, 22], [15, 20, 21, 12, 20, 16]


def six(value):
    return pytest.approx(value, rel=5e-6)


def groups(first, second):
    """Rows of two groups of people, each person in one."""
    rows = trials_of({"x": first, "y": second})
    return [row | {"participant": row["condition"] + row["participant"]} for row in rows]


@pytest.fixture(scope="module")
def two(tmp_path_factory):
    return analysed(trials_of({"A": A, "B": B}), tmp_path_factory.mktemp("two"))


@pytest.fixture(scope="module")
def three(tmp_path_factory):
    return analysed(trials_of({"A": A, "B": B, "C": C}), tmp_path_factory.mktemp("three"))


def test_two_conditions(two):
    (row,) = two.result.pairs.to_dict("records")
    assert 100 * row["value"] == six(8.33333)
    assert (row["t"], row["df"], row["p"]) == (six(2.89246), 5, six(0.0340888))
    assert (100 * row["low"], 100 * row["high"]) == (six(0.927354), six(15.7393))


def test_three_conditions(three):
    (row,) = three.result.effects.to_dict("records")
    assert (row["F"], row["epsilon"]) == (six(13.3258), six(0.676862))
    assert (row["df1"], row["df2"], row["p"]) == (six(1.35372), six(6.76862), six(0.00651244))
    assert (row["df1_uncorrected"], row["df2_uncorrected"]) == (2, 10)


@pytest.mark.parametrize(
    ("first", "second", "p", "k", "low", "high"),
    [
        ("A", "B", 0.0681776, 2, -0.780533, 17.4472),
        ("A", "C", 0.00378649, 3, 8.23100, 27.6664),
        ("B", "C", 0.0868896, 2, -4.69468, 23.9255),
    ],
)
def test_three_pairs(three, first, second, p, k, low, high):
    row = row_of(three.result.pairs, first=first, second=second)
    assert (row["p_holm"], row["k"]) == (six(p), k)
    assert (100 * row["low"], 100 * row["high"]) == (six(low), six(high))


def test_two_groups(tmp_path):
    rows = groups([20, 22, 25, 18], [(n, 40) for n in (30, 25, 34, 38, 28)])
    (row,) = analysed(rows, tmp_path).result.pairs.to_dict("records")
    assert 100 * row["value"] == six(4.23077)
    assert (row["t"], row["df"], row["p"]) == (six(0.522852), six(6.84257), six(0.617574))
    assert (100 * row["low"], 100 * row["high"]) == (six(-14.9927), six(23.4542))


@pytest.mark.parametrize(
    ("shares", "mean", "low", "high"),
    [
        (A, 84.6154, 71.0170, 92.5068),
        ([(8, 8), (25, 26), (110, 120)], 95.9402, 62.3063, 99.7049),
    ],
)
def test_mean_share(shares, mean, low, high, tmp_path):
    (row,) = analysed(trials_of({"A": shares}), tmp_path).result.means.to_dict("records")
    found = [100 * row[name] for name in ("mean", "low", "high")]
    assert found == [six(mean), six(low), six(high)]


@pytest.mark.parametrize(
    ("first", "second", "value", "t", "p", "low", "high"),
    [
        (
            [(20, 26), (14, 20), (9, 12), (40, 50)],
            [(40, 80), (60, 100), (7, 14), (31, 45)],
            18.2585, 4.08435, 0.0265160, 4.03183, 32.4853,
        ),
        ([26, 24, 25], [22, 21, 17], 19.2308, 3.27327, 0.0820149, -6.04773, 44.5093),
    ],
)  # fmt: skip
def test_unequal_trials_and_few_people(first, second, value, t, p, low, high, tmp_path):
    result = analysed(trials_of({"A": first, "B": second}), tmp_path).result
    (row,) = result.pairs.to_dict("records")
    assert (100 * row["value"], row["t"], row["p"]) == (six(value), six(t), six(p))
    assert (100 * row["low"], 100 * row["high"]) == (six(low), six(high))


def test_a_difference_without_spread_has_no_test(tmp_path):
    analysis = analysed(trials_of({"A": [20, 19, 18], "B": [19, 18, 17]}), tmp_path)
    (row,) = analysis.result.pairs.to_dict("records")
    assert 100 * row["value"] == six(3.84615)
    assert np.isnan([row["p"], row["low"], row["high"], row["t"]]).all()
    assert row["note"]
    assert "is shown" not in analysis.sentences[-1]


def test_unequal_trials_do_not_turn_the_direction_round():
    (row,) = analyse([CASES / "simpson.csv"]).result.pairs.to_dict("records")
    assert (100 * row["value"], row["t"], row["df"]) == (six(9.5), six(19), 3)
    assert row["p"] == six(0.000318343)
    assert (100 * row["low"], 100 * row["high"]) == (six(7.90878), six(11.0912))


def test_table_3_1_leaves_two_people_out_and_names_them():
    analysis = analyse([CASES / "thesis31.csv"])
    means = analysis.result.means.set_index("cell")["mean"] * 100
    assert (round(means["nominal"], 1), round(means["textured"], 1)) == (71.2, 80.2)
    row = row_of(analysis.result.pairs, first="nominal", second="textured")
    assert (round(100 * row["value"], 1), row["participants"]) == (-9.0, 3)
    assert [text.partition(":")[0] for text in analysis.left_out] == ["ML", "RB"]
    averages = analysis.tables["averages"].set_index("condition")["legibility"] * 100
    assert averages["nominal"].round(2) == 78.12
    assert averages["textured"].round(2) == 83.91


def test_intervals_and_p_are_never_at_odds(rng):
    shares = rng.binomial(26, 0.7, (2000, 5, 4)) / 26
    tests = [
        stats.paired(shares[..., one] - shares[..., two]) for one in range(4) for two in range(one)
    ]
    corrected, k = stats.holm(np.stack([test.p for test in tests], axis=-1))
    for n, test in enumerate(tests):
        low, high = stats.t_interval(test.value, test.error, test.df, k[:, n])
        made = ~np.isnan(test.p)
        assert ((corrected[made, n] <= 0.05) == ((low > 0) | (high < 0))[made]).all()


def test_a_study_is_tested_alone_as_it_is_among_others(rng):
    cube = rng.normal(size=(50, 7, 6))
    member = np.array([0, 0, 0, 1, 1, 1, 1])
    values = cube @ stats.contrasts([3, 2], (0, 1))
    for test in (stats.effect_within, stats.effect_with_groups):
        together = test(values, member)
        alone = [test(each, member) for each in values]
        assert np.allclose(together.p, [each.p for each in alone], rtol=1e-9)
