"""How much is tried: what every change needs, what is heavier, and what takes hours.

The environment variable ``TESTS`` chooses: nothing for `make test`, ``all`` for `make test-all`,
``soak`` for `make soak`. A tier has all that the one before it has.
"""

import os
from enum import IntEnum
from typing import TypeVar

import pytest
from hypothesis import settings

T = TypeVar("T")


class Tier(IntEnum):
    """The tiers, the lightest first."""

    TEST = 0
    ALL = 1
    SOAK = 2


TIER = Tier[os.environ.get("TESTS", "test").upper()]


def by_tier(test: T, all: T, soak: T) -> T:  # noqa: A002 - the tiers are called so
    """Choose the value of the tier that runs, such as how many examples of a law are tried."""
    return (test, all, soak)[TIER]


def examples(count: int) -> settings:
    """Try a law on so many examples in `make test-all`, on fewer and many more in the others."""
    return settings(max_examples=by_tier(max(count // 3, 10), count, 50 * count))


# A test that costs more than it is worth in every run; the mark's place says why.
heavy = pytest.mark.skipif(TIER < Tier.ALL, reason="for `make test-all`")
