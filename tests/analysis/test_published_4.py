"""The published numbers of chapter 4, made again from what they follow from."""

from collections import Counter
from itertools import combinations

import numpy as np
import pytest
from scipy import stats

from tests.analysis.making import from_rows
from tests.analysis.published import EXACT, RECONSTRUCTED, TOLD, each
from vbraille.analysis.input.scoretable import of_sheet
from vbraille.analysis.input.trials import natural
from vbraille.analysis.primary import arrange, compare
from vbraille.analysis.results import Kind, round_half_up, to_print
from vbraille.analysis.statistics.intervals import Interval
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import load_protocol

LETTERS = TOLD["chapter_4"]


def table_of_scores(**columns):
    """Scores of a sheet: a column a level, a value a participant."""
    rows = [
        {"participant": f"S{n}", "texture": level, "score": repr(float(value))}
        for level, values in columns.items()
        for n, value in enumerate(values, 2)
    ]
    scores = of_sheet(from_rows("published", rows))
    anything = Interval(-np.inf, np.inf)
    return compare(arrange(scores, ["texture"], ("score", "score", ""), "linear", anything), "none")


@each(*((EXACT, name, test) for name, test in LETTERS["t_tests_df5"].items() if "p" in test))
def test_4_p_of_every_t(told):
    (test,) = told
    p = 2 * stats.t.sf(abs(test["t"]), LETTERS["design"]["analysed"] - 1)
    assert to_print(p, Kind.P) == f"{test['p']:.3f}"


@each((RECONSTRUCTED, "speed", LETTERS["t_tests_df5"]["speed_T100_vs_T0"]))
def test_4_p_of_the_t_that_was_withdrawn(told):
    (test,) = told
    p = 2 * stats.t.sf(test["t"], LETTERS["design"]["analysed"] - 1)
    assert round_half_up(p, 4) == f"{test['p_recomputed']}"
    assert p < 0.05 < LETTERS["anova"]["reading_speed"]["p"]


@each(*((EXACT, name, test) for name, test in LETTERS["anova"].items()))
def test_4_p_of_every_f(told):
    (test,) = told
    subjects, levels = LETTERS["design"]["analysed"], LETTERS["design"]["modes"]
    assert test["df"] == [levels - 1, (levels - 1) * (subjects - 1)]
    assert to_print(stats.f.sf(test["F"], *test["df"]), Kind.P) == f"{test['p']:.3f}"


def scores_of_chapter_4():
    """Six made-up subjects with the printed means and the printed t of each pair of levels."""
    means, n = LETTERS["mean_legibility_pct"], LETTERS["design"]["analysed"]

    def variance(first, second):
        t = LETTERS["t_tests_df5"][f"{first}_vs_{second}"]["t"]
        return n * ((means[first] - means[second]) / t) ** 2

    # How T25 and T100 depart from T0, from subject to subject: two columns of that covariance.
    to_25, to_100 = variance("T0", "T25"), variance("T0", "T100")
    both = (to_25 + to_100 - variance("T25", "T100")) / 2
    root = np.linalg.cholesky([[to_25, both], [both, to_100]])
    apart = np.linalg.qr(np.column_stack([np.ones(n), np.arange(n), np.arange(n) ** 2]))[0][:, 1:]
    of_25, of_100 = root @ apart.T * np.sqrt(n - 1)
    base = np.linspace(-20, 20, n)  # a subject's own level, which nothing here depends on
    return table_of_scores(
        T0=means["T0"] + base, T25=means["T25"] + base + of_25, T100=means["T100"] + base + of_100
    )


@each(*((EXACT, f"{a} and {b}", a, b) for a, b in combinations(LETTERS["mean_legibility_pct"], 2)))
def test_4_scores_with_the_printed_means_and_t(told):
    scores, test = scores_of_chapter_4(), LETTERS["t_tests_df5"]["{}_vs_{}".format(*told)]
    rows = {row["of"]: row for row in scores.rows()}
    first, second = sorted(told, key=natural)
    row = rows[f"texture: {first} less {second}"]
    sign = 1 if first == told[0] else -1
    assert (row["df2"], f"{sign * row['statistic']:.3f}") == (5, f"{test['t']:.3f}")
    assert to_print(row["p"], Kind.P) == f"{test['p']:.3f}"
    for level in told:
        assert rows[level]["value"] == pytest.approx(LETTERS["mean_legibility_pct"][level])


@each((RECONSTRUCTED, "F", LETTERS["consistency"]))
def test_4_f_from_the_means_and_the_three_t(told):
    (consistency,) = told
    (effect,) = scores_of_chapter_4().effects
    f = effect.test.f
    assert effect.test.df2 / effect.test.df1 == pytest.approx(5)  # both times epsilon
    assert round_half_up(f, 2) == "10.66"
    assert "= 10.66 (10.849 printed)" in consistency
    # Means are rounded to 1 %, differences thus by up to 1 %: F is the printed one within that.
    means, n = LETTERS["mean_legibility_pct"], LETTERS["design"]["analysed"]
    found = []
    for off in np.linspace(-0.5, 0.5, 5):
        m = np.array([means["T0"], means["T25"] + off, means["T100"]])
        ts = [LETTERS["t_tests_df5"][f"{a}_vs_{b}"]["t"] for a, b in combinations(means, 2)]
        d = [m[a] - m[b] for a, b in combinations(range(3), 2)]
        error = n * sum((x / t) ** 2 for x, t in zip(d, ts, strict=True)) / 6
        found.append(n * m.var() * 3 / 2 / error)
    assert found[2] == pytest.approx(f)
    assert min(found) < LETTERS["anova"]["legibility"]["F"] < max(found)


@each((EXACT, "overall", LETTERS["mean_legibility_pct"]))
def test_4_overall_legibility(told):
    (means,) = told
    assert round_half_up(np.mean(list(means.values())), 0) == f"{LETTERS['overall_pct']}"


@each((EXACT, "words", LETTERS["words"]))
def test_4_words(told):
    (words,) = told
    (mean,) = table_of_scores(words=words["per_subject_pct_ascending"]).means
    assert mean.participants == LETTERS["design"]["subjects"]
    assert round_half_up(mean.value, 0) == f"{words['mean_pct']}"


@each((RECONSTRUCTED, "S4", LETTERS["words"]))
def test_4_words_of_who_read_some(told):
    (words,) = told
    shares = {
        n: [round_half_up(100 * k / words[n], 1) for k in range(words[n] + 1)]
        for n in ("list_len", "S2_read", "S4_read")
    }
    # 26 of 30 words are 86.67 %, printed as 87 % once, and cut to 86 % once.
    assert shares["S4_read"][26] == "86.7"
    assert round_half_up(100 * 26 / words["S4_read"], 0) == "87"
    # All others are whole numbers of words, of 40 or of the 20 that S2 read.
    others = {f"{value:.1f}" for value in words["per_subject_pct_ascending"]} - {"87.0"}
    assert others <= {*shares["list_len"], *shares["S2_read"]}


@each((EXACT, "letters", LETTERS["design"]))
def test_4_design(told):
    (design,) = told
    protocol = load_protocol("letters")
    trials = make_plan(protocol, "P1", 1).trials
    assert [sum(t.block == block for t in trials) for block in (1, 2)] == design["blocks"]
    assert sum(len(t.presented) for t in trials) == design["letters"]
    modes = Counter(t.condition for t in trials)
    assert list(modes.values()) == [design["strings_per_mode"]] * design["modes"]
    for mode in modes:
        letters = Counter("".join(t.presented for t in trials if t.condition == mode))
        assert list(letters.values()) == [design["letter_count_each"]] * 26
    assert {len(t.presented) for t in trials} == {design["string_len"]}
