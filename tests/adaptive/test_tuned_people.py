"""Thirty questions by the answers tell as much as the source's ninety, of simulated people."""

import pytest

from tests.benchmarks.tuned_people import KINDS, tune
from tests.tiers import by_tier

PEOPLE = by_tier(12, 60, 500)


@pytest.mark.parametrize("kind", list(KINDS)[::3] if PEOPLE == 12 else KINDS)
def test_thirty_adaptive_trials_beside_ninety_fixed_ones(kind):
    tuned = tune(kind, PEOPLE, seed=3)
    adaptive, six, fixed = tuned.rmse()
    print(f"{kind}: {adaptive:.3f}, on six values {six:.3f}, fixed {fixed:.3f} mm")
    assert adaptive <= fixed
    assert adaptive <= 0.2
