"""A simulated controller of each version of the protocol, on a bench."""

import pytest

from tests.simulation.controlled import INFO, INFO2, Bench


@pytest.fixture(params=[INFO, INFO2], ids=["version 1", "version 2"])
def bench(request):
    """A controller whose timer has begun."""
    bench = Bench(request.param)
    bench.tick()
    return bench


@pytest.fixture
def greeted(bench):
    """A controller that was greeted."""
    bench.send(bench.hello)
    return bench
