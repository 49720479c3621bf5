"""Thirty questions by the answers tell as much as the source's ninety, of simulated people."""

import pytest

from tests.benchmarks.tuned_people import KINDS, PROTOCOLS, SEED, tune
from tests.tiers import by_tier

PEOPLE = by_tier(12, 60, 500)


@pytest.mark.parametrize("kind", list(KINDS)[::3] if PEOPLE == 12 else KINDS)
@pytest.mark.parametrize("protocol", PROTOCOLS[:1] if PEOPLE < 500 else PROTOCOLS)
def test_thirty_adaptive_trials_beside_ninety_fixed_ones(protocol, kind):
    tuned = tune(kind, PEOPLE, 3 if PEOPLE < 500 else SEED, protocol)
    adaptive, six, fixed = tuned.rmse()
    print(f"{protocol}, {kind}: {adaptive:.3f}, on six values {six:.3f}, fixed {fixed:.3f} mm")
    assert adaptive <= fixed
    assert adaptive <= 0.2
