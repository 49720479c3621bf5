"""Trials of several intervals: what is planned, shown, answered and found again by the measures."""

from collections import Counter

import pytest

from tests.sessions.sittings import Session, kill_often, of
from tests.tiers import by_tier
from vbraille.analysis.input.study import load_study
from vbraille.analysis.measures import scaling
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import rows

REPEATS = by_tier(4, 12, 30)
HEAD = """
format = 1
name = "intervals"
title = "Widths"
source = "ours"
model = "vbd"
[design]
kind = "choice"
parameter = "dot_width_mm"
string = "a"
"""


def toml(form, values, question, repeats=1, **design):
    keys = {"values": values, "reference": 2.0, "repeats": repeats, **design}
    lines = [f"{name} = {value!r}" for name, value in keys.items() if value is not None]
    return HEAD + "\n".join([f'form = "{form}"', *lines, "[question]", question, ""])


WHICH = 'kind = "which"\nright = "more"'
ODD = 'kind = "odd"'
MATCH = 'kind = "match"'
ONE = toml("one", [1.0, 3.0], WHICH, intervals=3)
TRIANGLE = toml("triangle", [1.0, 3.0], ODD)
ABX = toml("abx", [1.0, 3.0], MATCH)
MAGNITUDE = toml("standard", [1.0, 1.5, 2.0, 3.0], 'kind = "magnitude"\nmodulus = 10')
FORMS = {"one": ONE, "triangle": TRIANGLE, "abx": ABX, "standard": MAGNITUDE}


@pytest.mark.parametrize("form", FORMS)
def test_each_place_has_the_standard_as_often(form):
    protocol = parse_protocol(FORMS[form], "page.toml")
    plan = make_plan(protocol, "P1", 1)
    shown = [tuple(s.value for s in trial.stimuli) for trial in plan.trials]
    assert len(set(shown)) == len(shown) == protocol.trials
    standards = [Counter(s[place] == 2.0 for s in shown)[True] for place in range(len(shown[0]))]
    wanted = {"one": [4, 4, 4], "triangle": [6, 6, 6], "abx": [4, 4, 4], "standard": [4, 1]}
    assert standards == wanted[form]


@pytest.mark.parametrize("form", FORMS)
def test_it_is_run_by_a_simulated_person_killed_and_resumed(tmp_path, form):
    session = Session(tmp_path / "s", FORMS[form])
    sat = session.sit()
    assert sat.progress.ended
    table = rows(sat.record)
    if form == "standard":
        assert [float(r["answered"]) for r in table] == pytest.approx(
            [5 * float(r["presented"].split()[1]) for r in table], rel=0.1
        )
    else:
        assert {row["outcome"] for row in table} <= {"right", ""}
    assert {e["stimulus"] for e in of(sat.events, "presented") if "stimulus" in e} >= {0, 1}
    assert bids.files(sat.record)
    kill_often(session, tmp_path / "killed", cuts=3)


def test_at_the_console_all_intervals_are_felt_before_an_answer(tmp_path):
    sat = Session(tmp_path / "s", TRIANGLE).sit(
        ("cue: trial 1", "2"), ("the second has not been felt yet; repeat shows all again", "x"),
        ("cue: .*second", "2"), ("the third has not been felt", "note x"), ("^read:", "4"),
        ("no answer: '4' is none of them", "third"), ("answer: trial 1 .*third", "stop"),
    )  # fmt: skip
    assert [e["answer"] for e in of(sat.events, "answer")] == ["3"]


def studied(tmp_path, text, people=3, noise=0.1):
    folders = []
    for number in range(people):
        session = Session(tmp_path / f"{number}", text, participant=f"P{number + 1}", seed=number)
        session.sit(noise=noise)
        folders.append(session.folder)
    return load_study(folders).judgements


def test_the_point_of_equality_and_the_jnd_are_found_again(tmp_path):
    values = [1.4, 1.8, 2.2, 2.6]
    told = studied(tmp_path, toml("pairs", values, WHICH, REPEATS), people=2, noise=0.15)
    table, means = scaling.equality(told)
    # Noise is on each of two widths, in units of the nominal width.
    nominal = parse_protocol(ONE, "page.toml").geometry.dot_width_mm
    jnd = scaling.QUARTILE * 0.15 * nominal * 2**0.5
    (mean,) = means.records()
    assert mean["participants"] == 2
    for row in table.records():
        assert row["method"] == "constant stimuli"
        assert row["low"] - 0.1 <= 2.0 <= row["high"] + 0.1
        assert row["jnd_low"] - 0.05 <= jnd <= row["jnd_high"] + 0.05
    assert abs(mean["error"]) < 0.15


def test_a_question_turned_round_has_the_same_point_of_equality(tmp_path):
    values = [1.6, 1.8, 2.2, 2.4]
    less = toml("pairs", values, WHICH.replace("more", "less"), REPEATS)
    table, _ = scaling.equality(studied(tmp_path, less, 1, 0.15))
    (row,) = table.records()
    assert row["low"] - 0.1 <= 2.0 <= row["high"] + 0.1


@pytest.mark.parametrize(("form", "question"), [("triangle", ODD), ("abx", MATCH), ("one", WHICH)])
def test_the_share_and_the_threshold_of_several_are_found(tmp_path, form, question):
    more = {"intervals": 3} if form == "one" else {}
    text = toml(form, [2.2, 2.6, 3.2], question, max(REPEATS // 3, 2), **more)
    (row,) = scaling.apart(studied(tmp_path, text, 1, 0.15)).records()
    assert row["guesses"] == pytest.approx(0.5 if form == "abx" else 1 / 3)
    assert row["right"] > row["guesses"]
    assert row["threshold"] is None or 0.05 < row["threshold"] < 1.5


def test_the_exponent_is_found_again(tmp_path):
    text = MAGNITUDE.replace("repeats = 1", "repeats = 4")
    *own, whole = scaling.exponents(studied(tmp_path, text)).records()
    assert whole["participant"] == "all"
    # Estimates of the simulated reader grow as the width that it feels.
    assert whole["low"] - 0.05 <= 1.0 <= whole["high"] + 0.05
    assert len(own) == 3


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (toml("one", [1.0], ODD), "kind is 'odd', which is asked of three stimuli or more"),
        (toml("abx", [1.0], ODD), "which is asked of form = 'one' or 'triangle'"),
        (toml("pairs", [1.0], MATCH), "which is asked of three stimuli"),
        (toml("triangle", [1.0, 3.0], ODD, reference=None), "reference is missing"),
        (toml("single", [1.0], 'kind = "detect"'), "leave one of them out"),
        (toml("abx", [1.0], MATCH, intervals=3), "intervals are of form = 'one'"),
        (toml("abx", [1.0], MATCH, same=1), "same is of form = 'pairs'"),
        (
            toml("single", [1.0, 3.0], 'kind = "identify"', reference=None),
            "which is asked of strings",
        ),
    ],
)
def test_forms_that_cannot_be_are_refused(text, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(text, "page.toml")
    assert says in str(refused.value)
