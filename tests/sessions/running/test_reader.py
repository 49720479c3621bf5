"""The simulated reader compares whatever its model can tell, and refuses the rest."""

import pytest

from tests.sessions.sittings import COMPARED, Session
from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.export import rows
from vbraille.sessions.running.reader import Simulated, pair_of

MORE = '[question]\nkind = "which"\nright = "more"\n'
NEAREST = '[question]\nkind = "which"\nright = "nearest"\nreference = {}\n'
VALUES = {
    "dot_spacing_mm": (3.2, 4.2),
    "cell_gap_mm": (6.0, 7.2),
    "contrast": (0.4, 1.0),
    "dot_width_mm": (1.0, 2.0),
    "dot_gap_mm": (1.0, 2.0),
}


def comparing(parameter, question="", values=None, model="vbd"):
    low, high = values or VALUES[parameter]
    text = COMPARED.replace("dot_width_mm", parameter).replace("[1.0, 2.0]", f"[{low}, {high}]")
    text = text.replace('"a"', '"ca"').replace("vbd", model)
    return text.replace("values", "repeats = 2\nvalues") + question


def table(tmp_path, toml):
    return rows(Session(tmp_path / "s", toml).sit().record)


@pytest.mark.parametrize("parameter", by_tier([*VALUES][:1], [*VALUES], [*VALUES]))
def test_it_tells_which_of_two_has_more(tmp_path, parameter):
    outcomes = [row["outcome"] for row in table(tmp_path, comparing(parameter, MORE))]
    assert outcomes == ["right"] * 4


BOTH = ["dot_spacing_mm", "cell_gap_mm"]


@pytest.mark.parametrize("parameter", by_tier(BOTH[1:], BOTH, BOTH))
def test_it_tells_which_of_two_lengths_is_nearest(tmp_path, parameter):
    low, high = VALUES[parameter]
    toml = comparing(parameter, NEAREST.format(low + 0.1 * (high - low)))
    trials = table(tmp_path, toml)
    assert [row["outcome"] for row in trials] == ["right"] * 4
    assert {row["answered"] for row in trials} == {f"{low:g}"}


def test_asked_what_it_likes_it_takes_the_stronger_or_the_length_it_was_told(tmp_path):
    strong = table(tmp_path / "a", comparing("contrast"))
    assert {row["answered"] for row in strong} == {"1"}
    protocol = parse_protocol(comparing("dot_spacing_mm"), "p.toml")
    nominal = protocol.geometry.dot_spacing_mm
    near = table(tmp_path / "b", comparing("dot_spacing_mm", values=(nominal - 0.5, nominal + 0.1)))
    assert {row["answered"] for row in near} == {f"{nominal + 0.1:g}"}


def refusal(toml):
    protocol = parse_protocol(toml, "p.toml")
    with pytest.raises(InputError) as caught:
        Simulated(protocol, make_plan(protocol, "P1", 1))
    return str(caught.value)


def test_what_it_cannot_tell_is_refused_in_a_sentence():
    nearest = refusal(comparing("contrast", NEAREST.format(0.5)))
    assert "asks which of two is nearest to a contrast of 0.5, and the simulated reader" in nearest
    cycles = refusal(comparing("texture_cycles", MORE, (3, 11), "stress2"))
    assert "does not feel which texture is finer; type the answers" in cycles


def test_dots_that_tell_a_distance_are_found():
    protocol = parse_protocol(comparing("cell_gap_mm"), "p.toml")
    style = protocol.style
    line = protocol.line(protocol.design.string)  # a blank, c and a
    between = pair_of("cell_gap_mm", line, style.mapping, style.geometry)
    assert (between.columns, between.first, between.cells) == (3, 1, 1)
    assert between.distance_mm == pytest.approx(style.geometry.cell_gap_mm)
    within = pair_of("dot_spacing_mm", line, style.mapping, style.geometry)
    assert (within.first, within.cells) == (0, 0)
    assert within.distance_mm == pytest.approx(style.geometry.dot_spacing_mm)
    assert pair_of("dot_spacing_mm", (1, 1), style.mapping, style.geometry) is None
