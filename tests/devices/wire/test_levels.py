"""Levels in as few bits as they need, and counters that wrap."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.packing import packed
from tests.tiers import examples
from vbraille.devices.serial.wire import Levels, unwrap

# Levels


@pytest.mark.parametrize("bits", range(1, 17))
@examples(30)  # of each of sixteen widths
@given(choice=st.data())
def test_levels_of_any_width(bits, choice):
    top_level = choice.draw(st.integers(1 << (bits - 1), (1 << bits) - 1))
    wanted = choice.draw(st.lists(st.integers(0, top_level), min_size=1, max_size=70))
    levels = Levels(len(wanted), top_level)
    line = packed(wanted, top_level)
    assert levels.bits == bits
    assert len(line) == levels.packed_bytes
    assert levels.unpack(line).tolist() == wanted


def test_bits_left_over_are_not_read():
    levels = Levels(1, 1)
    assert levels.unpack(b"\xff").tolist() == [1]
    assert levels.unpack(b"\x7f").tolist() == [0]


@pytest.mark.parametrize("line", [bytes(2), bytes(4), packed([0, 151, 0], 150)])
def test_levels_have_bounds(line):
    with pytest.raises(ValueError, match="level"):
        Levels(3, 150).unpack(line)


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
