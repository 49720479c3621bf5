"""Legibility over time: the past ten trials, and the slope of right and wrong."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from tests.analysis.making import made, record
from vbraille.analysis.measures.trends import PAST, over_time, slopes

COLUMNS = "participant condition session trial presented answered"


def read(correct, whose="P1 T0 s1", first=1):
    """Lines of trials that were right or wrong."""
    return [f"{whose} {n} a {'a' if right else 'c'}" for n, right in enumerate(correct, first)]


def trials_of(*lines):
    return made(*lines, columns=COLUMNS)[0]


@given(st.lists(st.booleans(), min_size=1, max_size=25))
def test_the_average_is_over_the_past_ten_trials(correct):
    table = over_time(trials_of(*read(correct)))
    for n, row in enumerate(table.records(), 1):
        assert (row["number"], row["trial"], row["correct"]) == (n, n, correct[n - 1])
        if n < PAST:
            assert (row["average"], row["note"]) == (None, "fewer than 10 trials yet")
        else:
            assert row["average"] == np.mean(correct[n - 10 : n])
            assert row["note"] == ""


def test_each_session_and_condition_begins_anew():
    lines = [
        *read([0] * 12), *read([1] * 12, "P1 T25 s1", 13), *read([1] * 12, "P1 T0 s2"),
        *read([1] * 9, "P2 T0 s1"),
    ]  # fmt: skip
    trials = trials_of(*lines)
    known = [row for row in over_time(trials).records() if row["average"] is not None]
    told = {
        (r["participant"], r["session"], r["condition"], r["trial"]): r["average"] for r in known
    }
    assert told == {
        **{("P1", "s1", "T0", n): 0.0 for n in (10, 11, 12)},
        **{("P1", "s1", "T25", n): 1.0 for n in (22, 23, 24)},
        **{("P1", "s2", "T0", n): 1.0 for n in (10, 11, 12)},
    }
    whose = slopes(trials).frame[["participant", "session", "condition"]]
    assert whose.agg(" ".join, axis=1).tolist() == ["P1 s1 T0", "P1 s1 T25", "P1 s2 T0", "P2 s1 T0"]
    assert len(over_time(trials)) == 45


def test_trials_are_taken_in_their_order_not_the_tables():
    lines = read([1] * 10 + [0] * 10)
    assert over_time(trials_of(*lines[::-1])).rows == over_time(trials_of(*lines)).rows


def test_the_slope_is_that_of_a_line_through_right_and_wrong():
    correct = [0, 1, 0, 0, 1, 1, 0, 1, 1, 1, 1, 1]
    row = record(slopes(trials_of(*read(correct))), participant="P1")
    fit = stats.linregress(range(12), correct)
    half = stats.t.ppf(0.975, 10) * fit.stderr
    assert row["trials"] == 12
    assert fit.slope > 0
    assert row["slope"] == pytest.approx(10 * fit.slope)
    assert (row["low"], row["high"]) == pytest.approx(
        (10 * (fit.slope - half), 10 * (fit.slope + half))
    )
    # The p of a correlation, which is the same test.
    assert row["p"] == pytest.approx(stats.pearsonr(range(12), correct).pvalue)
    assert row["note"] == ""
    down = record(slopes(trials_of(*read([1 - right for right in correct]))), participant="P1")
    assert (down["slope"], down["p"]) == pytest.approx((-row["slope"], row["p"]))


def test_a_tenth_more_right_in_each_ten_trials_is_ten_per_cent():
    correct = [n < right for right in range(11) for n in range(10)]
    rows = slopes(trials_of(*read(correct))).records()
    # Within each ten the right ones come first, which a line hardly sees.
    assert rows[0]["slope"] == pytest.approx(0.1, abs=0.01)
    assert rows[0]["p"] < 0.001


@pytest.mark.parametrize(
    ("correct", "slope", "note"),
    [
        ([1], None, "1 trial: a slope needs three"),
        ([1, 0], None, "2 trials: a slope needs three"),
        ([1, 1, 1], 0.0, "no interval and no p: every trial is right"),
        ([0, 0, 0], 0.0, "no interval and no p: every trial is wrong"),
    ],
)
def test_what_has_no_slope_or_no_p(correct, slope, note):
    row = record(slopes(trials_of(*read(correct))), participant="P1")
    assert (row["slope"], row["low"], row["high"]) == (slope, None, None)
    assert (row["p"], row["note"], row["trials"]) == (None, note, len(correct))
