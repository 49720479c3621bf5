import numpy as np
import pytest

from tests.render.scenes import DOT_PLACES, cell, frame_at, line
from tests.shown import LATERO, array_of, from_left
from vbraille.render import MAPPINGS, STRESS2, VBD, Mapping, single_row

# Of each actuator row, far one first: the dot of a cell's left column, the one of its right
# column (0 for none), and whether it is inverted. Lévesque 2009, fig. 4.5, and its author's
# later code.
TABLES = {
    "alternate": [
        (1, 4, False),
        (0, 0, False),
        (2, 5, False),
        (0, 0, False),
        (3, 6, False),
        (0, 0, False),
    ],
    "paired": [
        (1, 4, False),
        (1, 4, False),
        (2, 5, False),
        (2, 5, False),
        (3, 6, False),
        (3, 6, False),
    ],
    "sheared": [
        (1, 4, True),
        (1, 4, False),
        (2, 5, True),
        (2, 5, False),
        (3, 6, True),
        (3, 6, False),
    ],
    "split-columns": [
        (1, 0, False),
        (0, 4, False),
        (2, 0, False),
        (0, 5, False),
        (3, 0, False),
        (0, 6, False),
    ],
    "row-sheared": [
        (1, 4, False),
        (1, 4, False),
        (2, 5, True),
        (2, 5, True),
        (3, 6, False),
        (3, 6, False),
    ],
    "compact": [
        (1, 4, False),
        (2, 5, False),
        (3, 6, False),
        (0, 0, False),
        (0, 0, False),
        (0, 0, False),
    ],
    "three-rows": [(1, 4, False), (2, 5, False), (3, 6, False)],
    "eight-dots": [
        (1, 4, False),
        (0, 0, False),
        (2, 5, False),
        (0, 0, False),
        (3, 6, False),
        (0, 0, False),
        (7, 8, False),
        (0, 0, False),
    ],
}


def dot_of(side, dot_row):
    return {(row, s): dot for dot, (row, s) in DOT_PLACES.items()}.get((dot_row, side), 0)


def shown(masks, mapping, *, array=None, contrast_of=STRESS2, x_mm=0.0):
    model = contrast_of
    array = array or array_of(mapping.rows, 10, 1.2, 1.8)
    renderer = from_left(
        masks,
        array=array,
        profile=model.style.profile,
        mapping=mapping,
        geometry=model.style.geometry,
        tuning=model.style.tuning,
    )
    return frame_at(renderer, x_mm)


@pytest.mark.parametrize("name", TABLES)
def test_the_table_of_each_method(name):
    mapping = MAPPINGS[name]
    table = [
        (dot_of(0, left), dot_of(1, right), inverted)
        for left, right, inverted in zip(mapping.left, mapping.right, mapping.inverted, strict=True)
    ]
    assert table == TABLES[name]
    assert mapping.rows == {"three-rows": 3, "eight-dots": 8}.get(name, 6)


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
def test_an_inverted_row_idles_at_the_other_end(name):
    idle = [float(inverted) for _, _, inverted in TABLES[name]]
    np.testing.assert_array_equal(MAPPINGS[name].idle(), idle)
    assert MAPPINGS[name].idle().dtype == np.float64
    blank = shown(line(0, 0), MAPPINGS[name])
    np.testing.assert_array_equal(blank, np.repeat(np.array(idle)[:, None], 10, axis=1))


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
        frame = shown(line(cell(dot)), mapping, array=VBD.display, contrast_of=VBD, x_mm=centre_mm)
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
