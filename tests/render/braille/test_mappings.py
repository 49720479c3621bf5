from dataclasses import replace

import numpy as np
import pytest

from tests.render.scenes import DOT_PLACES, cell, frame_at, line
from tests.shown import LATERO, array_of, from_left
from vbraille.render import MAPPINGS, STRESS2, VBD, Mapping, single_row

# Of each actuator row, far one first: the dot of a cell's left column, the one of its right
# column (0 for none), and "!" if it is inverted. Lévesque 2009, fig. 4.5, and its author's
# later code.
WRITTEN = {
    "alternate": "14 00 25 00 36 00",
    "paired": "14 14 25 25 36 36",
    "sheared": "14! 14 25! 25 36! 36",
    "split-columns": "10 04 20 05 30 06",
    "row-sheared": "14 14 25! 25! 36 36",
    "compact": "14 25 36 00 00 00",
    "three-rows": "14 25 36",
    "eight-dots": "14 00 25 00 36 00 78 00",
}
TABLES = {
    name: [(int(row[0]), int(row[1]), row.endswith("!")) for row in rows.split()]
    for name, rows in WRITTEN.items()
}


def shown(masks, mapping, *, array=None, model=STRESS2, x_mm=0.0):
    array = array or array_of(mapping.rows, 10, 1.2, 1.8)
    return frame_at(from_left(masks, replace(model.style, mapping=mapping), array), x_mm)


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("dot", DOT_PLACES)
def test_a_dot_swings_the_rows_that_its_table_says(name, dot):
    geometry = STRESS2.style.geometry
    side = DOT_PLACES[dot][1]
    centre_mm = side * geometry.dot_spacing_mm + geometry.dot_width_mm / 2
    # The left column on the dot's centre, where the swing is full at every texture.
    frame = shown(line(cell(dot)), MAPPINGS[name], x_mm=centre_mm)
    idle = [float(inverted) for _, _, inverted in TABLES[name]]
    full = [float(dot in (left, right)) for left, right, _ in TABLES[name]]
    np.testing.assert_allclose(frame[:, 0], np.abs(np.subtract(idle, full)), atol=1e-12)


@pytest.mark.parametrize("name", TABLES)
def test_rows_that_the_method_does_not_name_rest(name):
    columns_over_dots = shown(np.full(4, 255, np.uint8), MAPPINGS[name], array=LATERO, x_mm=-1.3)
    rows = MAPPINGS[name].rows
    own = slice((8 - rows) // 2, (8 + rows) // 2)  # the method stands in the middle, or above it
    np.testing.assert_array_equal(np.delete(columns_over_dots, own, axis=0), 0.0)
    assert np.ptp(columns_over_dots[own]) > 0.1


def test_all_methods_show_dots_1_to_6_and_the_one_for_eight_rows_all_dots():
    for name, mapping in MAPPINGS.items():
        more = (7, 8) if name == "eight-dots" else ()
        assert mapping.shown_dots() == cell(1, 2, 3, 4, 5, 6, *more)


@pytest.mark.parametrize(("dot_row", "dots"), [(1, (1, 4)), (2, (2, 5)), (3, (3, 6))])
def test_a_single_dot_row(dot_row, dots):
    mapping = single_row(dot_row)
    assert mapping.name == f"dot-row-{dot_row}"
    assert mapping.rows == 1
    assert mapping.shown_dots() == cell(*dots)
    np.testing.assert_array_equal(mapping.idle(), [0.0])
    for dot, (_, side) in DOT_PLACES.items():
        centre_mm = side * VBD.style.geometry.dot_spacing_mm + VBD.style.geometry.dot_width_mm / 2
        frame = shown(line(cell(dot)), mapping, array=VBD.display, model=VBD, x_mm=centre_mm)
        assert frame[0, 0] == pytest.approx(float(dot in dots), abs=1e-12)


@pytest.mark.parametrize(
    ("left", "right", "inverted"),
    [((0,), (0, 1), (False,)), ((0,), (0,), (False, True)), ((), (0,), (False,)), ((), (), ())],
)
def test_tables_of_unlike_length(left, right, inverted):
    with pytest.raises(ValueError, match=r"^the tables of mapping odd differ in length$"):
        Mapping("odd", left, right, inverted)


@pytest.mark.parametrize(("left", "right", "row"), [(4, 0, 4), (0, 4, 4), (-2, 0, -2), (0, -2, -2)])
def test_tables_that_name_no_dot_row(left, right, row):
    says = f"^mapping odd shows dot row {row}; there are 0 to 3$"
    with pytest.raises(ValueError, match=says):
        Mapping("odd", (left,), (right,), (False,))
