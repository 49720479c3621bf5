import numpy as np
import pytest

from tests.shown import LATERO, STRESS2_ARRAY, VBD_ARRAY, array_of


def test_the_vbd_has_one_row_of_twelve_at_0_7_mm():
    assert VBD_ARRAY.shape == (1, 12)
    assert VBD_ARRAY.column_pitch_mm == 0.7
    assert VBD_ARRAY.span_mm == pytest.approx(7.7)


def test_the_stress2_has_six_rows_of_ten_at_1_2_by_1_8_mm():
    assert STRESS2_ARRAY.shape == (6, 10)
    assert (STRESS2_ARRAY.column_pitch_mm, STRESS2_ARRAY.row_pitch_mm) == (1.2, 1.8)
    rows, columns = STRESS2_ARRAY.shape
    area_mm = (columns * STRESS2_ARRAY.column_pitch_mm, rows * STRESS2_ARRAY.row_pitch_mm)
    assert area_mm == pytest.approx((12.0, 10.8))


def test_the_latero_has_eight_rows_of_eight():
    assert LATERO.shape == (8, 8)
    assert (LATERO.column_pitch_mm, LATERO.row_pitch_mm) == (1.2, 1.6125)


def test_offsets_count_from_the_left_column_and_the_far_row():
    array = array_of(rows=3, columns=4, column_pitch_mm=0.5, row_pitch_mm=2.0)
    for offsets, expected in (
        (array.column_offsets_mm(), [0, 0.5, 1, 1.5]),
        (array.row_offsets_mm(), [0, 2, 4]),
    ):
        assert offsets.dtype == np.float64
        np.testing.assert_array_equal(offsets, expected)
    assert array.span_mm == 1.5


@pytest.mark.parametrize(("rows", "columns"), [(0, 5), (5, 0), (17, 5), (5, 65), (-1, 5)])
def test_impossible_numbers_of_actuators(rows, columns):
    says = (
        f"^an array of {rows} × {columns} actuators is not possible; "
        "it must be 1 to 16 rows × 1 to 64 columns$"
    )
    with pytest.raises(ValueError, match=says):
        array_of(rows, columns, 1.0, 1.0)


@pytest.mark.parametrize("pitch", [0.0, 0.049, 50.1, -1.0, float("nan"), float("inf")])
def test_impossible_pitches(pitch):
    says = f"_pitch_mm is {pitch:g}; it must be 0.05 to 50 mm$"
    with pytest.raises(ValueError, match=f"^column{says}"):
        array_of(2, 2, pitch, 1.0)
    with pytest.raises(ValueError, match=f"^row{says}"):
        array_of(2, 2, 1.0, pitch)
