"""``vbraille structure``."""

import json
from pathlib import Path

SAMPLES = Path(__file__).parents[1] / "translate/braillefiles/samples"


def test_what_a_file_has_is_said_a_line_each(call):
    said = call("structure", SAMPLES / "brailleutils.pef")
    assert (said.code, said.err) == (0, "")
    assert said.out == "title: Generated document\nheadings: 0\npages of the file: 4\n"


def test_the_same_as_json(call):
    found = json.loads(call("structure", SAMPLES / "file2brl.brf", "--json").out)
    assert found["counts"]["pages of the file"] == 3
    assert (found["title"], found["headings"], found["unshown"]) == ("", [], {})


def test_a_file_that_is_not_there(call, tmp_path):
    said = call("structure", tmp_path / "x.txt")
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("vbraille: there is no file ")
