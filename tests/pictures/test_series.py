import csv
import io
import math
import subprocess
import sys

import numpy as np
import pytest

from tests.pictures.tables import TABLES, make_line, make_page, with_style
from vbraille.pictures.series import mapping, profile, strain, wave, write_csv
from vbraille.render import MAPPINGS, MODELS, STRESS2, VBD, Tuning, single_row

SIX = [each for each in MAPPINGS.values() if each.rows <= 6]


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_profile_rises_at_the_left_edge_and_is_back_at_the_right_one(model):
    table = profile(model)
    u, width = table["u_mm"], model.style.geometry.dot_width_mm
    for name in table.columns:
        if name != "u_mm":
            off = (u <= 0) | (u >= width)
            assert np.allclose(table[name][off], 0, atol=1e-12)
            assert table[name].max() == pytest.approx(1, abs=1e-3)
            assert table[name].min() >= -1e-12
    assert u[np.argmax(table["deflection_T0"])] == pytest.approx(width / 2)


@pytest.mark.parametrize("method", SIX, ids=[each.name for each in SIX])
def test_mapping_idles_at_one_where_a_row_is_inverted(method):
    full_cell = np.array([0x3F], np.uint8)
    chosen = mapping(STRESS2.style, full_cell).where("method", method.name)
    first = (6 - method.rows) // 2
    for row, inverted in enumerate(method.inverted):
        values = chosen[f"deflection_row_{first + row}"]
        assert values[0] == values[-1] == inverted
        shows_dots = {method.left[row], method.right[row]} != {-1}
        assert (np.ptp(values) > 0.9) == shows_dots


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_wave_columns_are_one_curve_shifted_by_the_pitch(model):
    table = wave(with_style(model, tuning=Tuning(texture=0.25)))
    x, pitch = table["x_mm"], model.display.column_pitch_mm
    shift = round(pitch / (x[1] - x[0]))
    assert len(table.columns) == 1 + model.display.columns
    for column in range(1, model.display.columns):
        left = table[f"deflection_column_{column - 1}"]
        right = table[f"deflection_column_{column}"]
        assert right[:-shift] == pytest.approx(left[shift:], abs=1e-9)


def strain_of(width):
    return strain(VBD.style.geometry, Tuning()).where("dot_width_mm", width)


@pytest.mark.parametrize("width", [1.0, 2.0])
def test_strain_of_a_wider_dot_goes_straight_from_expansion_to_compression(width):
    table = strain_of(width)
    values = table["strain_per_mm"]
    between = slice(np.argmax(values), np.argmin(values) + 1)
    assert (np.diff(values[between]) < 0).all()
    assert values[between][0] > 0 > values[between][-1]
    # W < ε rests in between
    narrow = strain_of(0.5)["strain_per_mm"]
    assert (np.abs(narrow[np.argmax(narrow) : np.argmin(narrow)]) < 1e-9).sum() > 10


def test_page_has_the_dots_where_geometry_puts_them():
    lines = [make_line("⠁"), make_line("⠵", number=2, indent=1)]
    table = make_page(lines)
    second = table.where("what", "dot").where("line", 2)
    assert second["x_mm"].size == 12
    raised = second.where("raised", 1)
    assert raised["dot"].tolist() == [1, 3, 5, 6]
    assert raised["cell"].tolist() == [1, 1, 1, 1]
    assert raised["x_mm"] == pytest.approx([12.4, 12.4, 16.1, 16.1])  # 11.1 + 1.3 (+ 3.7)
    assert raised["y_mm"] == pytest.approx([14, 21.2, 17.6, 21.2])  # 14 + 3.6 a row


def test_page_shows_eight_dots_only_where_there_are_some():
    assert set(make_page([make_line("⠿")]).where("what", "dot")["dot"]) == set(range(1, 7))
    eight = make_page([make_line("⡀⢀")]).where("raised", 1)
    assert eight["dot"].tolist() == [7, 8]
    assert eight["y_mm"] == pytest.approx([10.8, 10.8])


def test_page_deflects_the_actuators_that_are_on_a_dot():
    lines = [make_line("⠁"), make_line("⠿⠿", number=2)]
    left_mm = 1.3  # the array is 10.8 mm wide
    table = make_page(lines, x_mm=left_mm + 10.8 / 2).where("what", "actuator")
    assert table["row"].size == 60
    assert set(table["line"]) == {1}
    on = table.where("row", 0)
    assert on["deflection"][0] == pytest.approx(1)  # the left column is on the centre of dot 1
    assert on["deflection"][2:].max() == 0
    assert table["deflection"].sum() == on["deflection"].sum()
    assert on["y_mm"] == pytest.approx(np.full(10, 0.0))
    assert on["x_mm"] == pytest.approx(1.3 + 1.2 * np.arange(10))
    assert set(np.round(table["y_mm"], 9)) == {0, 1.8, 3.6, 5.4, 7.2, 9.0}


def test_page_lays_a_one_row_array_on_the_row_that_it_shows():
    table = make_page([make_line("⠿")], model=with_style(VBD, mapping=single_row(3))).where(
        "what", "actuator"
    )
    assert table["y_mm"] == pytest.approx(np.full(12, 8.0))


def test_page_of_an_empty_line_has_the_array_alone():
    assert set(make_page([make_line("")])["what"]) == {"actuator"}


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.kind)
def test_csv_gives_the_same_numbers_back(table):
    stream = io.StringIO()
    write_csv(table, stream)
    names, *rows = csv.reader(io.StringIO(stream.getvalue()))
    assert names == list(table.columns)
    assert all(len(rows) == column.size for column in table.columns.values())
    for name, spelled in zip(names, zip(*rows, strict=True), strict=True):
        if table[name].dtype.kind == "U":
            assert list(spelled) == table[name].tolist()
        else:
            values = [float(value) if value else math.nan for value in spelled]
            assert values == pytest.approx(table[name], abs=6e-7, nan_ok=True)
            assert "-0" not in spelled


def test_the_numbers_need_no_matplotlib():
    code = (
        "import sys, vbraille.pictures.series as p; from vbraille.render import VBD;"
        "p.wave(VBD);"
        "sys.exit(str({'matplotlib', 'louis'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.stderr.strip() == "set()"
