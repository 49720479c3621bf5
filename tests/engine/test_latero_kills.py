"""A host that drives a Latero is killed, or its parent, or both: the blades come to rest.

How fast is measured by the benchmark of the same; here the machine may be busy.
"""

import pytest

from tests.benchmarks.bench_latero import kill_both, kill_host, kill_parent, watched
from tests.tiers import heavy

_BUSY_MS = 1000.0


@heavy
@pytest.mark.parametrize("kill", [kill_host, kill_parent, kill_both])
def test_whoever_is_killed_the_blades_rest_and_power_is_off(kill):
    with watched() as (told, rested_ms):
        rest_ms, off_ms = kill(told, rested_ms)
    assert 0 <= rest_ms <= off_ms < _BUSY_MS
