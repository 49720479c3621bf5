"""Dots and the bits that they are in a mask."""

from vbraille.braille.cells import DOT_ROWS, PLACES, dots_of, mask_of
from vbraille.braille.spelling import spell


def test_a_mask_is_its_dots():
    for mask in range(256):
        assert mask_of(dots_of(mask)) == mask_of(dots_of(mask) * 2) == mask
        assert spell("".join(map(str, dots_of(mask))) or "0", {}) == (mask,)


def test_a_cell_has_two_columns_of_dots():
    assert sorted(PLACES.values()) == [
        (column, row) for column in (0, 1) for row in range(DOT_ROWS)
    ]
    assert [[PLACES[dot] for dot in dots] for dots in ((1, 2, 3, 7), (4, 5, 6, 8))] == [
        [(column, row) for row in range(DOT_ROWS)] for column in (0, 1)
    ]
