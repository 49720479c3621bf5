"""A picture that moves by itself: Lévesque 2009, eqs. 8.1 and 8.2."""

import math

import numpy as np
import pytest

from tests.shown import LATERO, STRESS2_ARRAY, VBD_ARRAY, part_of
from vbraille.render import STRESS2
from vbraille.render.program import vibration
from vbraille.render.work import ProgramKind


def frames_of(program, times_s, **where):
    frames = np.full((len(times_s), *program.shape), np.nan)
    for frame, time_s in zip(frames, times_s, strict=True):
        program.frame(0.0, frame, time_s=time_s, **where)
    return frames


@pytest.mark.parametrize("display", [VBD_ARRAY, STRESS2_ARRAY, LATERO], ids=lambda d: d.name)
@pytest.mark.parametrize("frequency_hz", [50.0, 7.3])
def test_neighbours_swing_against_each_other(display, frequency_hz):
    program = vibration(display, frequency_hz)
    times_s = np.arange(500) / 1000
    row, column = np.indices(display.shape)
    sign = np.where((row + column) % 2, -1.0, 1.0)
    wave = np.sin(2 * np.pi * frequency_hz * times_s)
    want = (1 + sign * wave[:, None, None]) / 2
    got = frames_of(program, times_s)
    np.testing.assert_allclose(got, want, rtol=0, atol=1e-12)


def test_it_is_the_same_wherever_the_array_is():
    program = vibration(STRESS2_ARRAY, 50.0)
    frame = frames_of(program, [0.0123])[0]
    for x_mm, theta_rad, part in ((50.0, 0.0, 0), (-1e5, 1.0, 3), (math.nan, 0.0, -1)):
        out = np.zeros(program.shape)
        program.frame(x_mm, out, theta_rad=theta_rad, part=part, time_s=0.0123)
        np.testing.assert_array_equal(out, frame)
    assert part_of(program, 7.0) == 0


def test_what_moves_and_what_does_not():
    program = vibration(STRESS2_ARRAY, 50.0)
    line = STRESS2.style.render(np.full(3, 63, np.uint8), STRESS2_ARRAY)
    assert program.kind is ProgramKind.VIBRATION
    still = frames_of(line, [0.0, 0.3, 7.0])
    np.testing.assert_array_equal(still[1:], still[:-1])
    with pytest.raises(ValueError, match="a vibration has no frames along a line"):
        program.path(np.arange(3.0))
    with pytest.raises(ValueError, match=r"^the frame has not the shape of the array$"):
        program.frame(0.0, np.zeros((6, 9)))
