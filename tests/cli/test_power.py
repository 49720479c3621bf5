"""``vbraille power``: a line a thing, and as JSON and CSV."""

import csv
import io
import json

import pytest

ASKED = ["power", "letters", "--effect", "T0=0.3,T25=0.5,T100=0.9", "--participants", "4,8"]
FEW = [*ASKED, "--studies", "60"]


def test_each_comparison_has_a_line(call):
    said = call(*FEW, "--verbose")
    assert said.code == 0
    lines = said.out.splitlines()
    assert lines[0] == "protocol: letters, 78 trials of each person"
    assert lines[1].startswith("planned: legibility of strings by condition; model trials; ")
    assert lines[2] == "assumed: T0 30.0 %, T25 50.0 %, T100 90.0 %"
    told = "8 participants: difference condition: T0 less T100; power 100.0 %, 94.0 % to 100.0 %"
    assert told in lines
    assert lines[-2].startswith("for a power of 80 %: condition: T0 less T100; ")
    assert said.err.splitlines()[-1] == "100 percent"


def test_the_numbers_are_the_same_as_json_and_as_csv(call):
    found = json.loads(call(*FEW, "--json").out)["rows"]
    rows = list(csv.DictReader(io.StringIO(call(*FEW, "--csv").out)))
    assert [float(row["power"]) for row in rows] == [row["power"] for row in found]
    assert len(rows) == 8


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--participants", "40-4"], "'40-4' is a range backwards; give the smaller number first"),
        (["--participants", "few"], "'few' is no number of participants, such as 12, 6,12 or 4-40"),
        (["--participants", "8,4"], "'8,4' are no numbers that grow"),
        (["--participants", "4-9999"], "'4-9999' are 9996 sizes; give at most 1000"),
        (["--effect", "T0"], "'T0' is not NAME=SHARE, such as T0=0.5"),
        (["--effect", "T0=0.1,T0=0.2"], "T0 stands there twice"),
        (["--test", "paired"], "--test is gone; studies are tested as [analysis] of the protocol"),
        (["--cluster", "lab"], "--cluster is gone; --workers shares the work"),
        (["--workers", "0"], "--workers is 0; it must be 1 to 256"),
        (["--keep", "/"], "--keep / cannot be used: Is a directory"),
    ],
)
def test_what_cannot_be_used_is_said_in_one_sentence(options, sentence, call):
    said = call(*FEW, *options)
    assert (said.code, said.out) == (2, "")
    assert said.err.startswith("vbraille: ")
    assert said.err.count("\n") == 1
    assert sentence in said.err
