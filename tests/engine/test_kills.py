"""Processes that are killed while they read: the actuators come to rest by themselves."""

import pytest

from tests.benchmarks.bench_faults import KILLS, LIMIT_MS, killed_ms
from tests.tiers import by_tier


@pytest.mark.parametrize("who", by_tier(("both",), KILLS, KILLS))
@pytest.mark.parametrize("axes", by_tier(("xyθ",), ("x", "xyθ"), ("x", "xyθ")))
def test_the_actuators_rest_within_the_watchdog_s_time(who, axes):
    taken = killed_ms(who, by_tier(1, 3, 50), axes)
    assert 0 < max(taken) <= LIMIT_MS
