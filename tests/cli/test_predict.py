"""``vbraille predict``: a line a point, or a directory with the table and the maps."""

import csv

from tests.forecast.test_grids import GRID
from vbraille.cli.main import main


def test_each_point_has_a_line_and_the_directory_its_files(tmp_path, capsys):
    path, out = tmp_path / "grid.toml", tmp_path / "predicted"
    path.write_text(GRID.replace('two = ["ca"]\n', ""))
    assert main(["predict", str(path), "--out", str(out)]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "predicted: by the simulated reader, no data about people"
    assert said[1].startswith("contrast 0.05, text one, speed_mm_s 300.0: ")
    assert said[-1] == f"written: {out}/predictions.csv, map.png, map.svg"
    with (out / "predictions.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(said) - 2 == 4
    assert {row["answers_from_whom"] for row in rows} == {"simulated reader, no data about people"}
    assert (out / "map.png").read_bytes().startswith(b"\x89PNG")


def test_what_cannot_be_used_is_said_in_one_sentence(tmp_path, capsys):
    path = tmp_path / "grid.toml"
    path.write_text(GRID.replace("contrast", "colour"))
    assert main(["predict", str(path)]) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"vbraille: {path}")
    assert said.count("\n") == 1
    assert main(["predict", str(tmp_path / "none.toml")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
