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


def test_a_picture_that_nobody_named_gets_a_name_of_its_own_and_says_it(call, here):
    for name in ("vbraille-wave.png", "vbraille-wave-2.png", "vbraille-wave-3.png"):
        said = call("plot", "wave")
        assert (said.code, said.out, said.err) == (0, f"{TITLE}{name}\n", "")
    drawn = sorted(here.glob("*.png"))
    assert [path.name for path in drawn] == [
        "vbraille-wave-2.png",
        "vbraille-wave-3.png",
        "vbraille-wave.png",
    ]
    assert len({path.read_bytes() for path in drawn}) == 1


def test_a_picture_with_a_name_has_it(call, here):
    assert call("plot", "wave", "--out", "mine.svg").out == f"{TITLE}mine.svg\n"
    assert [path.name for path in here.glob("*.svg")] == ["mine.svg"]


def test_numbers_go_nowhere_but_to_the_output(call, here):
    assert call("plot", "wave", "--csv").out.startswith("x_mm,deflection_column_0,")
    said = call("plot", "wave", "--csv", "--out", "mine.svg")
    assert said.code == 2
    assert "leave out either --csv or --out" in said.err
    assert not list(here.glob("*.svg"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ((), "lines: 3 drawn, from line 1; --lines chooses others"),
        (("--lines", "2-"), "lines: 2 drawn, from line 2; --lines chooses others"),
        (("--lines", "2-3"), "lines: 2 drawn, from line 2"),
        (("--lines", "3"), "lines: 1 drawn, from line 3"),
    ],
)
def test_a_page_says_how_many_lines_it_has(call, text, options, said):
    out = call("plot", "page", text, *options).out.splitlines()
    assert out[0].startswith("drawn: STReSS²: line ")
    assert out[1:] == [said]


def test_the_array_of_a_page_stands_with_its_left_column_where_it_is_told_to(call, text):
    said = call("plot", "page", text, "--x", "12.5", "--csv").out
    rows = list(csv.DictReader(io.StringIO(said)))
    left = [float(row["x_mm"]) for row in rows if row["column"] == "0"]
    assert left == [12.5] * 6
    drawn = call("plot", "page", text, "--x", "12.5")
    assert ", left column at 12.5 mm, " in drawn.out.splitlines()[0]


def test_the_resolution_is_drawn_and_said(call, here):
    said = call("plot", "resolution")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert lines[0].endswith(", vbraille-resolution.png")
    assert "over the canvas of 220 × 150 mm: 23.6 to 45.2 µm" in lines
    assert (here / "vbraille-resolution.png").exists()


def test_the_resolution_is_of_no_display_and_no_text(call, text):
    refused = call("plot", "resolution", "--model", "vbd")
    assert refused.code == 2
    assert "leave --model out" in refused.err
    assert call("plot", "resolution", text).code == 2
    assert call("plot", "resolution", "--csv").out.startswith("what,x_mm,y_mm,resolution_um,")
