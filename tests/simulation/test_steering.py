"""Orders to a simulated hand: taken once, whole, and answered; by all who share the memory."""

import math
import os

import pytest

from tests.engine.test_loop import info
from vbraille.devices import open_device
from vbraille.errors import InputError
from vbraille.simulation.steering import BeAt, ReadLine, ReadPage, Steering


@pytest.fixture
def ends():
    """Both ends, as a program and the process of a device have them."""
    steering = Steering()
    return steering, Steering(steering.descriptor)


def test_an_order_is_taken_once_and_answered(ends):
    ours, theirs = ends
    assert theirs.take() is None
    assert not ours.done_at(10**12)
    ours.give(ReadLine(120.5))
    assert not ours.done_at(10**12)
    assert theirs.take() == ReadLine(120.5)
    assert theirs.take() is None
    assert not ours.done_at(10**12)
    theirs.answer(500)
    assert not ours.done_at(499)
    assert ours.done_at(500)
    ours.give(ReadLine(7.0))
    assert not ours.done_at(10**12)


@pytest.mark.parametrize(
    "order", [ReadLine(3.5), ReadPage(25, 14.0, 270.0), BeAt(1.5, -2.0, 0.25), BeAt(1.0)]
)
def test_any_order_arrives_as_it_was_given(ends, order):
    ours, theirs = ends
    ours.give(order)
    taken = theirs.take()
    assert taken == order
    assert type(taken) is type(order)


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        (BeAt, (math.nan, 0, 0)),
        (BeAt, (0, math.inf, 0)),
        (ReadPage, (0, 14, 1)),
        (ReadPage, (2, 0, 1)),
        (ReadPage, (2, math.nan, 1)),
    ],
)
def test_an_order_that_cannot_be_done_is_not_given(kind, numbers):
    with pytest.raises(ValueError, match="it must"):
        kind(*numbers)


def test_of_several_orders_the_last_counts(ends):
    ours, theirs = ends
    for end_mm in (1.0, 2.0, 3.0):
        ours.give(ReadLine(end_mm))
    assert theirs.take() == ReadLine(3.0)
    theirs.answer(0)
    assert ours.done_at(0)


def test_an_answer_to_another_order_is_none(ends):
    ours, theirs = ends
    ours.give(ReadLine(1.0))
    theirs.take()
    ours.give(ReadLine(2.0))
    theirs.answer(0)
    assert not ours.done_at(10**12)


def test_an_order_in_the_writing_is_left_for_later(ends):
    ours, theirs = ends
    ours.give(ReadLine(1.0))
    whole = bytes(ours._slots.memory)
    for at in range(64, len(whole)):  # its slot, or one that does not matter
        ours._slots.memory[at] ^= 1
        assert theirs.take() in (None, ReadLine(1.0))
        ours._slots.memory[at] ^= 1
        theirs._taken = 0
    assert theirs.take() == ReadLine(1.0)


def test_orders_from_before_a_device_was_opened_are_not_for_it(ends):
    ours, _ = ends
    ours.give(ReadLine(1.0))
    late = Steering(ours.descriptor)
    assert late.take() is None
    ours.give(ReadLine(2.0))
    assert late.take() == ReadLine(2.0)


def test_the_descriptor_goes_with_whoever_made_the_memory():
    ours = Steering()
    descriptor = ours.descriptor
    theirs = Steering(descriptor)
    del theirs
    os.fstat(descriptor)
    del ours
    with pytest.raises(OSError, match="Bad file"):
        os.fstat(descriptor)


@pytest.mark.parametrize("descriptor", ["999999", "0", "x", "", str(2**70)])
def test_what_is_no_memory_for_it_is_refused(descriptor):
    with pytest.raises(InputError, match=f"nothing can steer a hand by steering={descriptor};"):
        open_device(f"sim:?hand=sweep:60&steering={descriptor}", info())


def test_a_device_that_there_is_not_is_named_as_it_was_asked_for():
    with pytest.raises(InputError, match=r"^there is no device sim:\?speed=3; give sim:\?hand="):
        open_device("sim:?speed=3&steering=5", info())
