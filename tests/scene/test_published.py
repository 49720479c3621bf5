"""Numbers of chapters 5, 6 and 8 of the thesis that the displays have: Lévesque 2009."""

import math

import pytest

from vbraille.render import STRESS2, STRESS2_8X8


def test_the_grid_of_dots_of_the_memory_game():
    columns = math.floor(113 / STRESS2.display.column_pitch_mm)
    rows = math.floor(60 / STRESS2.display.row_pitch_mm)
    assert (columns, rows) == (94, 33)


def test_the_display_of_8_by_8_is_as_large_as_printed():
    display = STRESS2_8X8.display
    width, height = display.span_mm + 0.5, display.depth_mm + 1.2  # contactors, from later code
    assert (width, height) == pytest.approx((8.9, 11.0))
    assert (round(width), round(height)) == (9, 11)
    # Half of the diagonal between centres is the radius that pruning needs: 8.5.3.
    assert math.hypot(display.span_mm, display.depth_mm) / 2 == pytest.approx(6.45, abs=0.005)


def test_an_actuator_has_its_share_of_a_millisecond():
    rows, columns = STRESS2_8X8.display.shape
    assert 1e3 / (rows * columns) == pytest.approx(15.6, abs=0.03)
