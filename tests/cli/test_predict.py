"""``vbraille predict``: a line a point, or a directory with the table and the maps."""

import csv

from tests.forecast.test_grids import GRID


def test_each_point_has_a_line_and_the_directory_its_files(tmp_path, call):
    path, out = tmp_path / "grid.toml", tmp_path / "predicted"
    path.write_text(GRID.replace('two = ["ca"]\n', ""))
    done = call("predict", path, "--out", out)
    assert done.code == 0
    said = done.out.splitlines()
    assert said[0] == "predicted: by the simulated reader, no data about people"
    assert said[1].startswith("contrast 0.05, text one, speed_mm_s 300.0: ")
    assert said[-1] == f"written: {out}/predictions.csv"
    with (out / "predictions.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(said) - 2 == 4
    assert {row["answers_from_whom"] for row in rows} == {"simulated reader, no data about people"}


def test_what_cannot_be_used_is_said_in_one_sentence(tmp_path, call):
    path = tmp_path / "grid.toml"
    path.write_text(GRID.replace("contrast", "colour"))
    said = call("predict", path)
    assert said.code == 2
    assert said.err.startswith(f"vbraille: {path}")
    assert said.err.count("\n") == 1
    said = call("predict", tmp_path / "none.toml")
    assert (said.code, said.err.count("\n")) == (2, 1)
