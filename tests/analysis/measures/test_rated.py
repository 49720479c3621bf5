"""Ratings: by hand, and by what made them."""

import numpy as np
import pandas as pd
import pytest

from tests.tiers import by_tier
from vbraille.analysis.measures.rated import compared, summarised
from vbraille.analysis.statistics.intervals import mean_interval

STUDIES = by_tier(300, 2000, 10_000)


def rated(numbers, who):
    return pd.DataFrame({"number": np.asarray(numbers, float), "participant": list(who)})


def test_each_participant_weighs_the_same():
    found = summarised(rated([1, 1, 1, 1, 5, 3], "aaaabc"))
    assert (found["participants"], found["ratings"]) == (3, 6)
    assert found["mean"] == pytest.approx(3)
    assert (found["low"], found["high"]) == mean_interval([1, 5, 3])
    assert [found[of] for of in ("low_quartile", "median", "high_quartile")] == [1, 3, 5]


def test_ties_count_half():
    found = compared(rated([3, 4], "aa"), rated([3, 2, 1], "aab"))
    assert found["higher"] == pytest.approx((0.5 + 1 + 1 + 1) / 4)
    assert found["participants"] == 1
    assert found["note"] == (
        "no interval: one participant; how people differ is seen of three or more"
    )
    note = compared(rated([1], "a"), rated([1], "b"))["note"]
    assert note == "no share: no participant rated both"


def test_an_interval_of_order_ends_where_shares_do():
    found = compared(rated([3, 3, 2], "abc"), rated([1, 2, 2], "abc"))
    assert found["higher"] == pytest.approx(2.5 / 3)
    assert found["high"] == 1


@pytest.mark.parametrize("people", [3, 8])
def test_the_interval_of_the_mean_holds_the_truth(people):
    random = np.random.default_rng(people)
    own = random.normal(4.0, 1.0, (STUDIES, people, 1))
    numbers = np.clip(np.round(own + random.normal(0, 1, (STUDIES, people, 10))), 1, 7)
    many = random.normal(4.0, 1.0, 400_000) + random.normal(0, 1, 400_000)
    truth = np.clip(np.round(many), 1, 7).mean()
    who = np.repeat(np.arange(people), 10)
    found = [summarised(rated(one.ravel(), who)) for one in numbers]
    # There is none where all people have rated alike.
    held = np.mean([one["low"] <= truth <= one["high"] for one in found if "low" in one])
    assert 0.92 < held < 0.985
