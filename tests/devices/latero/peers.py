"""A simulated Latero at a port of this computer, in a thread of the test."""

from __future__ import annotations

import threading
import time
from contextlib import contextmanager

from vbraille.simulation.laterosim import LateroCarriage, LateroSimulator
from vbraille.simulation.specs import parse_hand

PATIENCE_S = 20.0


@contextmanager
def simulated(hand="sweep:60", **options):
    """A Latero that answers until the end; `spec` tells where."""
    options = {"port": 0, "wait_s": 0.0, "say": lambda _: None, **options}
    latero = LateroSimulator(LateroCarriage(parse_hand(hand)), **options)
    ended = threading.Event()
    thread = threading.Thread(target=latero.run, args=(ended.is_set,))
    thread.start()
    try:
        yield latero
    finally:
        ended.set()
        thread.join()
        latero.close()


def address_of(latero):
    """What comes after ``latero:`` in the spec, with the offsets."""
    return latero.spec.partition(":")[2]


def until(true):
    """Wait until something is true."""
    end_s = time.monotonic() + PATIENCE_S
    while not true():
        assert time.monotonic() < end_s
        time.sleep(0.001)
