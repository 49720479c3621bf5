"""``vbraille plot``: what is drawn where."""

import csv
import io

import pytest

TITLE = "drawn: VBD: the array passes a dot 2 mm wide, T = 0 %, "


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch):
    """Where pictures without a name go."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_picture_with_a_name_has_it(call, here):
    assert call("plot", "wave", "--out", "mine.svg").out == f"{TITLE}mine.svg\n"
    assert [path.name for path in here.glob("*.svg")] == ["mine.svg"]


def test_numbers_go_nowhere_but_to_the_output(call, here):
    assert call("plot", "wave", "--csv").out.startswith("x_mm,deflection_column_0,")
    assert not list(here.iterdir())


def test_a_picture_without_a_name_has_its_kind_and_replaces_none(call, here):
    assert call("plot", "wave").out == f"{TITLE}vbraille-wave.png\n"
    said = call("plot", "wave")
    assert said.code == 2
    assert "vbraille-wave.png" in said.err
    assert [path.name for path in here.iterdir()] == ["vbraille-wave.png"]


def test_the_array_of_a_page_stands_with_its_left_column_where_it_is_told_to(call, text):
    said = call("plot", "page", text, "--x", "12.5", "--csv").out
    rows = list(csv.DictReader(io.StringIO(said)))
    left = [float(row["x_mm"]) for row in rows if row["column"] == "0"]
    assert left == [12.5] * 6
    drawn = call("plot", "page", text, "--x", "12.5")
    assert ", left column at 12.5 mm, " in drawn.out.splitlines()[0]


def test_another_suffix_is_refused_by_naming_the_two(call, here):
    said = call("plot", "wave", "--out", "wave.pdf")
    assert said.code == 2
    assert ".png or .svg" in said.err
    assert not list(here.iterdir())
