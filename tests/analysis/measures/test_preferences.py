"""Which of two was chosen: how often, how strongly, and the value that is liked best."""

from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.analysis.making import from_rows, record
from tests.tiers import examples
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.measures.preferences import tuning
from vbraille.analysis.statistics.bradleyterry import bradley_terry, position_bias

WIDTHS_MM = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0]


def comparisons(*told):
    """Of participant, first, second and chosen value, and maybe the parameter."""
    names = ("participant", "presented", "answered", "parameter")
    rows = [
        dict(zip(names, (who, f"{first:g} {second:g}", f"{chosen:g}", *more), strict=False))
        | {"condition": "all"}
        for who, first, second, chosen, *more in told
    ]
    return parse([from_rows("made", rows)]).comparisons


def nearest(values, liked, people=1, repeats=3, parameter="dot_width_mm"):
    """All ordered pairs, several times; chosen is what is nearer, the first of equals."""
    return [
        (f"P{who}", a, b, b if abs(b - liked) < abs(a - liked) - 1e-9 else a, parameter)
        for who in range(people)
        for _ in range(repeats)
        for a, b in permutations(values, 2)
    ]


def test_how_often_each_was_chosen():
    choices, _ = tuning(comparisons(*nearest(WIDTHS_MM[:4], 1.4)), seed=1)
    assert choices.frame["value"].tolist() == [0.5, 1, 1.5, 2]
    assert choices.frame["presented"].tolist() == [18] * 4
    # 1.5 is the nearest, then 1, 2, 0.5: each wins 6 times over every one behind it.
    assert choices.frame["chosen"].tolist() == [0, 12, 18, 6]
    assert choices.frame["share"].tolist() == [times / 18 for times in (0, 12, 18, 6)]
    assert set(choices.frame["parameter"].tolist()) == {"dot_width_mm"}


def test_the_scale_is_bradley_and_terrys():
    told = [("P1", 1, 2, 2), ("P1", 2, 1, 2), ("P2", 2, 3, 2), ("P1", 3, 1, 3), ("P2", 1, 2, 1)]
    choices, _ = tuning(comparisons(*told), seed=1)
    scale = bradley_terry([[0, 1, 0], [2, 0, 1], [1, 0, 0]])
    assert choices.frame["strength"].tolist() == pytest.approx(scale.strengths)
    assert choices.frame["error"].tolist() == pytest.approx(np.sqrt(np.diag(scale.covariance)))
    assert choices.frame["chosen"].tolist() == [1, 3, 1]
    assert sum(choices.frame["strength"].tolist()) == pytest.approx(0)


def test_the_preferred_value_is_found():
    told = nearest(WIDTHS_MM, 2.0)  # 1.5 and 2.5 are as near: the first of them is chosen
    _, liked = tuning(comparisons(*told), seed=1)
    (row,) = liked.records()
    assert (row["participants"], row["comparisons"]) == (1, 90)
    assert row["preferred"] == pytest.approx(2.0)
    assert 1.5 < row["low"] <= 2.0 <= row["high"] < 2.5
    assert row["how"] == "bootstrap over the comparisons of one participant"
    assert row["note"] == ""


def test_between_two_chosen_alike_it_is_the_middle():
    # Lévesque 2009, 3.3: 2.0 mm, between the two most selected gaps.
    told = nearest([1, 1.3, 1.6, 1.9, 2.2, 2.5], 2.05, parameter="dot_gap_mm")
    _, liked = tuning(comparisons(*told), seed=1)
    assert record(liked, parameter="dot_gap_mm")["preferred"] == pytest.approx(2.05)


def test_each_parameter_has_its_own():
    told = [*nearest([1, 2, 3], 3, people=5), *nearest([10, 20], 10, parameter="gap")]
    choices, liked = tuning(comparisons(*told), seed=1)
    assert [row[:2] for row in choices.rows] == [
        ("dot_width_mm", 1),
        ("dot_width_mm", 2),
        ("dot_width_mm", 3),
        ("gap", 10),
        ("gap", 20),
    ]
    width, gap = liked.records()
    assert (width["participants"], width["comparisons"], width["preferred"]) == (5, 90, 3)
    assert width["how"] is None
    assert (gap["participants"], gap["comparisons"], gap["preferred"]) == (1, 6, 10)


def test_the_side_that_was_favoured():
    told = [("P1", 1, 2, 1)] * 6 + [("P1", 2, 1, 2)] * 3 + [("P1", 2, 1, 1)]
    (row,) = tuning(comparisons(*told), seed=1)[1].records()
    bias = position_bias([0] * 9 + [1], [0] * 10)
    assert (row["first_share"], row["first_p"]) == (0.9, bias.p)
    assert (row["first_low"], row["first_high"]) == (bias.interval.low, bias.interval.high)


def test_all_chosen_alike_leave_nothing_preferred():
    told = [("P1", a, b, a) for a, b in permutations([1, 2, 3], 2)]
    choices, liked = tuning(comparisons(*told), seed=1)
    assert choices.frame["strength"].tolist() == pytest.approx([0, 0, 0])
    (row,) = liked.records()
    assert row["preferred"] is row["low"] is row["how"] is None
    assert row["note"] == (
        "no preferred value: all values were chosen equally often; none is preferred"
    )
    assert row["first_share"] == 1


def test_values_that_do_not_hang_together_have_no_scale():
    choices, liked = tuning(comparisons(("P1", 1, 2, 1), ("P1", 3, 4, 3)), seed=1)
    why = "some values were never compared with the others, even by way of a third"
    assert set(choices.frame["note"].tolist()) == {f"no strength: {why}"}
    assert choices.frame["strength"].isna().all()
    assert choices.frame["share"].tolist() == [1, 0, 1, 0]
    assert liked.frame["note"].tolist() == [f"no preferred value: {why}"]


def test_the_same_seed_gives_the_same_interval():
    told = comparisons(*nearest([1, 2, 3, 4], 2.2, repeats=1))
    one, same, other = (tuning(told, seed=seed)[1] for seed in (4, 4, 5))
    assert one.rows == same.rows
    assert one.records()[0]["low"] != other.records()[0]["low"]


PAIRS = st.lists(st.sampled_from([1, 2, 3, 4.5]), min_size=2, max_size=2, unique=True)


@examples(10)
@given(st.lists(st.tuples(st.sampled_from(["P1", "P2"]), PAIRS, st.booleans()), min_size=1))
def test_of_any_comparisons_both_tables_are_made(told):
    made = comparisons(*((who, *pair, pair[second]) for who, pair, second in told))
    choices, liked = tuning(made, seed=1)
    assert sum(choices.frame["chosen"].tolist()) == len(told) == liked.frame["comparisons"].iloc[0]
    assert sum(choices.frame["presented"].tolist()) == 2 * len(told)
    for row in liked.records():
        assert row["preferred"] is None or 1 <= row["preferred"] <= 4.5
        assert row["low"] is None or 1 <= row["low"] < row["high"] <= 4.5
    assert np.isfinite([row["share"] for row in choices.records()]).all()
