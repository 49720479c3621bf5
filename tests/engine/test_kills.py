"""Processes that are killed while they read: the actuators come to rest by themselves."""

import pytest

from tests.benchmarks.bench_faults import KILLS, LIMIT_MS, killed_ms
from tests.tiers import by_tier


@pytest.mark.parametrize("who", by_tier(("both",), KILLS, KILLS))
@pytest.mark.parametrize("version", by_tier((2,), (1, 2), (1, 2)))
def test_the_actuators_rest_within_the_watchdog_s_time(who, version):
    """Version 2 has two axes and the angle here, and a hand that reads a page."""
    taken = killed_ms(who, by_tier(1, 3, 50), version)
    assert 0 < max(taken) <= LIMIT_MS
