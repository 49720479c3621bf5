"""Numbers of chapters 5, 6 and 8 of the thesis, recomputed: Lévesque 2009.

Counts are reconstructed: they are the only ones that give the percentages that are printed.
"""

import math

import numpy as np
import pytest

from vbraille.render import STRESS2, STRESS2_8X8

# Table 6.2: right answers of 36, by shape, for gratings, dots and vibrations of 2 cm and of 3 cm.
COUNTS = {
    "right triangle": (27, 33, 34, 29, 30, 31),
    "inverted triangle": (31, 23, 31, 30, 32, 28),
    "circle": (21, 35, 31, 17, 32, 32),
    "square": (16, 28, 25, 31, 30, 34),
    "diamond": (27, 21, 26, 25, 23, 32),
    "plus": (7, 23, 29, 19, 27, 35),
}
# The percentages as printed: 2 cm G D V all, 3 cm G D V all, both G D V all.
TABLE_6_2 = {
    "right triangle": (75, 92, 94, 87, 81, 83, 86, 83, 78, 88, 90, 85),
    "inverted triangle": (86, 64, 86, 79, 83, 89, 78, 83, 85, 76, 82, 81),
    "circle": (58, 97, 86, 81, 47, 89, 89, 75, 53, 93, 88, 78),
    "square": (44, 78, 69, 64, 86, 83, 94, 88, 65, 81, 82, 76),
    "diamond": (75, 58, 72, 69, 69, 64, 89, 74, 72, 61, 81, 71),
    "plus": (19, 64, 81, 55, 53, 75, 97, 75, 36, 69, 89, 65),
    "all": (60, 76, 82, 72, 70, 81, 89, 80, 65, 78, 85, 76),
}
# Table 6.3: answers of 216 by shape presented and shape answered, and the percentages printed.
TABLE_6_3 = {
    (184, 6, 5, 5, 11, 5): ("85.2", "2.8", "2.3", "2.3", "5.1", "2.3"),
    (5, 175, 2, 4, 18, 12): ("2.3", "81.0", "0.9", "1.9", "8.3", "5.6"),
    (9, 7, 168, 14, 13, 5): ("4.2", "3.2", "77.8", "6.5", "6.0", "2.3"),
    (13, 8, 16, 164, 12, 3): ("6.0", "3.7", "7.4", "75.9", "5.6", "1.4"),
    (5, 12, 37, 4, 154, 4): ("2.3", "5.6", "17.1", "1.9", "71.3", "1.9"),
    (8, 17, 5, 14, 32, 140): ("3.7", "7.9", "2.3", "6.5", "14.8", "64.8"),
}
# Table 6.4, of 90, by orientation: 0°, 45°, 90°, -45°.
TABLE_6_4 = {
    (82, 6, 1, 1): ("91.1", "6.7", "1.1", "1.1"),
    (1, 77, 9, 3): ("1.1", "85.6", "10.0", "3.3"),
    (0, 6, 78, 6): ("0.0", "6.7", "86.7", "6.7"),
    (2, 4, 8, 76): ("2.2", "4.4", "8.9", "84.4"),
}


def percent(right, of):
    """A percentage of a few, rounded half up."""
    return math.floor(100 * right / of + 0.5)


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


def test_the_percentages_of_table_6_2_are_those_of_its_counts():
    counts = np.array(list(COUNTS.values())).reshape(6, 2, 3)
    with_all = np.concatenate([counts, counts.sum(axis=0, keepdims=True)])
    wrong = []
    for (shape, printed), own in zip(TABLE_6_2.items(), with_all, strict=True):
        trials = 36 * (6 if shape == "all" else 1)
        got = [
            percent(right, trials * (3 if method == 3 else 1) * (2 if size == 2 else 1))
            for size, one in enumerate([*own, own.sum(axis=0)])
            for method, right in enumerate([*one, one.sum()])
        ]
        wrong += [(shape, n) for n, (a, b) in enumerate(zip(got, printed, strict=True)) if a != b]
    # 82 of 84: those of all shapes of 2 cm by dots, 75.46 %, and by vibrations, 81.48 %, are
    # printed as 76 and 82, which is what they give if they are rounded to one digit first.
    assert wrong == [("all", 1), ("all", 2)]
    sums = [f"{100 * counts[:, 0, method].sum() / 216:.1f}" for method in (1, 2)]
    assert sums == ["75.5", "81.5"]
    assert counts.sum() == 985


def test_the_percentages_of_the_text_are_those_of_the_counts():
    counts = np.array(list(COUNTS.values())).reshape(6, 2, 3)
    method = [f"{100 * right / 432:.1f}" for right in counts.sum(axis=(0, 1))]
    assert method == ["64.8", "78.0", "85.2"]
    small, large = (f"{100 * right / 648:.1f}" for right in counts.sum(axis=(0, 2)))
    assert (small, large) == ("72.2", "79.8")
    assert f"{100 * counts.sum() / 1296:.1f}" == "76.0"
    best = [counts[:, size, one].sum() for size, one in ((1, 2), (0, 2), (1, 1))]
    assert [f"{100 * right / 216:.1f}" for right in best] == ["88.9", "81.5", "80.6"]


@pytest.mark.parametrize(("table", "of"), [(TABLE_6_3, 216), (TABLE_6_4, 90)])
def test_the_rows_of_confusions_are_whole_and_as_printed(table, of):
    for counts, printed in table.items():
        assert sum(counts) == of
        assert tuple(f"{100 * count / of:.1f}" for count in counts) == printed


def test_the_diagonal_of_table_6_3_is_table_6_2():
    diagonal = [counts[n] for n, counts in enumerate(TABLE_6_3)]
    assert diagonal == [sum(counts) for counts in COUNTS.values()]


def test_experiments_have_as_many_trials_as_they_say():
    assert 6 * 2 * 4 * 3 == 144  # shapes, sizes, repetitions, methods
    wavelengths = np.arange(1.0, 6.5, 0.5)
    differences = np.abs(wavelengths[:, None] - wavelengths)
    by_difference = {d: np.count_nonzero(differences == d) for d in np.arange(0.5, 5.5, 0.5)}
    assert all(count == 22 - 4 * d for d, count in by_difference.items())
    assert sum(by_difference.values()) == 110
    assert 6 * 3 * 5 == 90  # orientations, wavelengths, repetitions
    assert 4 * 10 == 40
    icons = 4 * 2 * 2  # shapes, orientations, wavelengths
    assert (icons, icons * 3) == (16, 48)


def test_the_mean_of_fine_orientations_is_that_of_its_parts():
    assert f"{(76.0 + 60.6 + 4 * 35.0) / 6:.1f}" == "46.1"
    assert f"{(41.8 + 50.7 + 45.7) / 3:.1f}" == "46.1"
