"""A simulated controller on a bench."""

import pytest

from tests.simulation.controlled import Bench
from vbraille.devices.serial.wire import Hello


@pytest.fixture
def bench():
    """A controller whose timer has begun."""
    bench = Bench()
    bench.tick()
    return bench


@pytest.fixture
def greeted(bench):
    """A controller that was greeted."""
    bench.send(Hello())
    return bench
