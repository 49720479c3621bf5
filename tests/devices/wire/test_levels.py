"""Levels in as few bits as they need, and counters that wrap."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.devices.serial.wire import Levels, unwrap

# Levels


def packed_by_hand(levels, bits):
    number = 0
    for level in levels:
        number = number << bits | level
    left_over = -len(levels) * bits % 8
    return (number << left_over).to_bytes((len(levels) * bits + left_over) // 8, "big")


@pytest.mark.parametrize("bits", range(1, 17))
@examples(30)  # of each of sixteen widths
@given(choice=st.data())
def test_levels_of_any_width(bits, choice):
    top_level = choice.draw(st.integers(1 << (bits - 1), (1 << bits) - 1))
    wanted = choice.draw(st.lists(st.integers(0, top_level), min_size=1, max_size=70))
    levels = Levels(len(wanted), top_level)
    packed = levels.pack(np.array(wanted, np.uint16))
    assert levels.bits == bits
    assert packed == packed_by_hand(wanted, bits)
    assert len(packed) == levels.packed_bytes
    assert levels.unpack(packed).tolist() == wanted
    levels.check(packed)


@pytest.mark.parametrize("dtype", [np.uint16, np.int64, np.uint8, np.int32, ">i4"])
def test_levels_of_any_integers_in_rows_and_columns(dtype):
    wanted = np.arange(60).reshape(6, 10)
    levels = Levels(60, 1023)
    for order in ("C", "F"):
        packed = levels.pack(np.asarray(wanted, dtype, order=order))
        assert packed == packed_by_hand(range(60), 10)


def test_bits_left_over_are_not_read():
    levels = Levels(1, 1)
    assert levels.unpack(b"\xff").tolist() == [1]
    assert levels.unpack(b"\x7f").tolist() == [0]


@pytest.mark.parametrize(
    "wrong",
    [
        np.array([0, 151, 0]),
        np.array([0, 151, 0], np.uint16),
        np.array([0, -1, 0]),
        np.array([0, 65536, 0]),
        np.array([0.0, 1.0, 2.0]),
        np.array([0, np.nan, 2]),
        np.array([True, False, True]),
        np.array([0, 1]),
        np.array([0, 1, 2, 3]),
    ],
)
def test_levels_have_bounds(wrong):
    with pytest.raises(ValueError, match="levels are"):
        Levels(3, 150).pack(wrong)


def test_no_levels_are_not_possible():
    with pytest.raises(ValueError, match="actuators"):
        Levels(0, 1023)
    for top_level in (0, 65536):
        with pytest.raises(ValueError, match="top level"):
            Levels(1, top_level)


# Counters that wrap


@given(
    bits=st.integers(1, 32),
    start=st.integers(-(2**40), 2**40),
    shares=st.lists(st.floats(-1, 1, exclude_max=True), max_size=30),
)
@example(bits=8, start=0, shares=[-1.0, -1.0, 0.999])
def test_counts_are_unwrapped(bits, start, shares):
    half = 1 << (bits - 1)
    true = last = start
    for share in shares:
        true += max(int(share * half), -half)
        last = unwrap(true % (2 * half), last, bits)
        assert last == true


def test_unwrapping_ignores_bits_above_the_width():
    assert unwrap(0xFFFF_FFFF, 0, 16) == -1
    assert unwrap(5, 0xFFFE, 16) == 0x10005
    assert unwrap(0x80, 0, 8) == -0x80  # as near either way: the lower
