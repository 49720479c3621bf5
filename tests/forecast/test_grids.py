"""Predictions over a grid: each point once, the same on any workers, with a map."""

import time

import pytest

from vbraille.errors import InputError
from vbraille.forecast.grids import predict, read_grid, to_json
from vbraille.forecast.workers import Workers

GRID = """format = 1
model = "vbd"
speeds_mm_s = [300.0, 600.0]
noise = 0.3
answers = 5
[texts]
one = ["c"]
two = ["ca"]
[style]
contrast = [0.05, 1.0]
"""


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "grid.toml"
    path.write_text(GRID)
    return str(path)


def test_each_point_is_predicted_once(path):
    grid, found, ended = predict(path, Workers())
    assert ended is None
    assert [one.point for one in found] == grid.points()
    assert len(found) == 8
    one = found[2]  # two cells, answered five times
    assert (one.characters, one.strings) == (10, 5)
    assert one.right == round(10 * one.legibility)
    assert predict(path, Workers())[1] == found
    assert "no data about people" in found[0].row()["answers_from_whom"]
    assert "no data about people" in to_json(grid, found)["about"]


def test_without_noise_all_is_read(path, tmp_path):
    (tmp_path / "grid.toml").write_text(GRID.replace("0.3", "0.0"))
    assert {one.legibility for one in predict(path, Workers())[1]} == {1.0}


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("contrast = [0.05, 1.0]", "colour = [1.0]", "has 'colour'"),
        ("[0.05, 1.0]", "[1.5]", "contrast"),
        ("[0.05, 1.0]", "[]", "has no value; give one or more"),
        ("[0.05, 1.0]", "[1.0, 1.0]", "has a value twice"),
        ("[300.0, 600.0]", "[0.0]", "speeds_mm_s: one is 0 mm/s; it must be 1 to 1000"),
        ('"vbd"', '"vdb"', "model is 'vdb'"),
        ('["c"]', "[]", "has no string"),
        ("answers = 5", "answers = 0", "answers is 0"),
        ("format = 1", "format = 2", "format"),
        ("contrast = [0.05, 1.0]", "travel_mm = [300.0, 2.0]", "too short for one cell"),
    ],
)
def test_a_grid_that_cannot_be_used_is_refused(old, new, sentence):
    with pytest.raises(InputError, match=r"grid\.toml") as caught:
        read_grid(GRID.replace(old, new), "grid.toml")
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_grid_far_too_large_is_refused_before_its_points_are_made():
    lengths = ", ".join(f"{0.1 + n / 100:.2f}" for n in range(100))
    many = "\n".join(f"{name} = [{lengths}]" for name in ("contrast", "texture", "dot_spacing_mm"))
    many += f"\ncell_gap_mm = [{lengths}]\nrow_spacing_mm = [{lengths}]"
    started = time.process_time()
    with pytest.raises(InputError, match="more than 100000 points; make it smaller"):
        read_grid(GRID.replace("contrast = [0.05, 1.0]", many), "grid.toml")
    assert time.process_time() - started < 1
