"""``vbraille power``: a line a thing, and as JSON."""

import json

import pytest

ASKED = ["power", "letters", "--effect", "T0=0.3,T25=0.5,T100=0.9", "--participants", "4,8"]
FEW = [*ASKED, "--studies", "200"]


def test_each_test_has_a_line(call):
    said = call(*FEW)
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert "8 participants: T0 and T100: power 100.0 % (98.1 to 100.0 %)" in lines
    assert "power 80 %: T0 and T100: 4 participants" in lines
    assert len(lines) == 2 * 4 + 4


def test_json_has_the_same_numbers_each_time(call):
    first, again = (json.loads(call(*FEW, "--json").out) for _ in range(2))
    assert first == again
    other = json.loads(call(*FEW, "--json", "--seed", "2").out)
    assert first["rows"] != other["rows"]


@pytest.mark.parametrize(
    ("options", "named"),
    [
        (["--participants", "40-4"], "40-4"),
        (["--participants", "few"], "few"),
        (["--participants", "2"], "3 to 500"),
        (["--participants", "9999"], "500"),
        (["--effect", "T0"], "T0"),
        (["--effect", "T0=0.5"], "T25"),
        (["--effect", "T0=0.5,T25=0.5,T100=1"], "below 1"),
        (["--studies", "0"], "--studies"),
        (["--between", "-1"], "--between"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(options, named, call):
    said = call(*FEW, *options)
    assert (said.code, said.out, said.err.count("\n")) == (2, "", 1)
    assert said.err.startswith("vbraille: ")
    assert named in said.err
