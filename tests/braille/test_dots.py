"""Dots and the bits that they are in a mask."""

import pytest

from vbraille.braille.cells import DOT_ROWS, PLACES, Cells, dots_of, mask_of


@pytest.mark.parametrize("mask", range(256))
def test_a_mask_is_its_dots(mask):
    assert mask_of(dots_of(mask)) == mask_of(dots_of(mask) * 2) == mask
    assert Cells.from_dots("".join(map(str, dots_of(mask))) or "0").masks.tolist() == [mask]


def test_a_cell_has_two_columns_of_dots():
    assert sorted(PLACES.values()) == [
        (column, row) for column in (0, 1) for row in range(DOT_ROWS)
    ]
    assert [[PLACES[dot] for dot in dots] for dots in ((1, 2, 3, 7), (4, 5, 6, 8))] == [
        [(column, row) for row in range(DOT_ROWS)] for column in (0, 1)
    ]
