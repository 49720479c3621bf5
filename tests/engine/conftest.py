"""Rigs for compiled ticks, which are closed however a test ends."""

from contextlib import ExitStack, closing

import pytest

from tests.engine.steady import PICTURES, Rig


@pytest.fixture
def rigs():
    """A maker of rigs; what it takes is what `Rig` takes."""
    with ExitStack() as made:
        yield lambda *ends, **how: made.enter_context(closing(Rig(*ends, **how)))


@pytest.fixture
def rig(rigs):
    """A rig with a line under the hand, whose ticks are compiled."""
    rig = rigs()
    rig.loop.show(PICTURES[0], 0)
    rig.settle()
    return rig
