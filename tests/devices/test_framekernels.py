"""The compiled packing against the codec's, and against the protocol page's formula."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.packing import packed
from vbraille.devices import framekernels
from vbraille.devices.serial.wire import Levels


def fill(deflections, top, *, gain=255, inverted=0, last=None, step=math.inf):
    shape = deflections.shape
    levels = Levels(deflections.size, top)
    out = np.full(levels.packed_bytes, 0xA5, np.uint8)
    wanted = np.full(shape, np.nan)
    swing = np.broadcast_to(np.asarray(gain) / 255 * top, shape).copy()
    rest = np.broadcast_to(np.asarray(inverted) * top, shape).astype(np.int64)
    last = np.zeros(shape) if last is None else last
    felt = framekernels.fill(deflections, last, wanted, step, swing, rest, levels.bits, out)
    return levels.unpack(out.tobytes()).reshape(shape), wanted, felt, out.tobytes()


@given(st.integers(1, 4), st.integers(1, 9), st.integers(1, 0xFFFF), st.integers(0, 1 << 32))
def test_it_is_the_formula_packed_by_the_codec(rows, columns, top, seed):
    random = np.random.default_rng(seed)
    deflections = random.choice([0.0, 1.0, *random.random(5)], (rows, columns))
    gain = random.integers(0, 256, (rows, columns))
    inverted = random.integers(0, 2, (rows, columns))
    levels, wanted, felt, line = fill(deflections, top, gain=gain, inverted=inverted)
    want = np.rint(deflections * (gain / 255 * top)).astype(int)
    want = np.where(inverted, top - want, want)
    np.testing.assert_array_equal(levels, want)
    np.testing.assert_array_equal(wanted, deflections)
    assert line == packed(want.ravel(), top)
    assert felt == bool(deflections.any())


@pytest.mark.parametrize(("wanted", "went"), [(1.0, 0.6), (0.0, 0.4), (0.55, 0.55), (0.45, 0.45)])
def test_no_actuator_moves_further_than_a_step(wanted, went):
    last = np.full((2, 3), 0.5)
    levels, left, felt, _ = fill(np.full((2, 3), wanted), 1000, last=last, step=0.1)
    np.testing.assert_allclose(left, went)
    np.testing.assert_array_equal(levels, round(went * 1000))
    assert felt
