"""The method of adjustment: a value is turned until it is equal to the standard."""

import pytest

from tests.sessions.sittings import Session, kill_often, of
from tests.tiers import by_tier
from vbraille.analysis.input.study import load_study
from vbraille.analysis.measures import scaling
from vbraille.devices.events import Button, Knob
from vbraille.engine.batch import BatchEngine
from vbraille.errors import InputError
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.record.progress import stimulus_of
from vbraille.sessions.record.replay import frames

ADJUST = """
format = 1
name = "adjust"
title = "Turn it until it is equal"
source = "ours"
model = "vbd"
[design]
kind = "choice"
parameter = "dot_width_mm"
values = [1.0, 2.6]
reference = 1.8
string = "a"
form = "standard"
[question]
kind = "adjust"
step = 0.1
least = 0.5
most = 3.0
"""
STEPS = by_tier(4, 20, 60)


def settings(sat):
    return [float(event["answer"]) for event in of(sat.events, "answer")]


def test_a_simulated_person_turns_it_until_it_is_equal(tmp_path):
    session = Session(tmp_path / "s", ADJUST)
    sat = session.sit()
    assert sat.progress.ended
    assert settings(sat) == pytest.approx([1.8, 1.8], abs=0.1)
    table = rows(sat.record)
    assert sorted(row["presented"] for row in table) == ["1.8 1", "1.8 2.6"]
    assert all(finding.good for finding in check_folder(session.folder))
    assert bids.files(sat.record)
    last = [told.last_attempt[-1] for told in sat.progress.trials.values()]
    assert [stimulus_of(showing).value for showing in last] == settings(sat)
    felt = {line: ticks for line, ticks, _ in frames(sat.record)}
    assert {showing.line for showing in last} <= set(felt)
    kill_often(session, tmp_path / "killed", cuts=4)


def test_lines_turn_it_the_standard_is_shown_again_and_an_undo_takes_a_number(tmp_path):
    sat = Session(tmp_path / "s", ADJUST).sit(
        ("cue: trial 1 of 2$", "+"), ("the second has not been felt", "note x"),
        ("cue: .*second", "+++"), ("turned", "--"), ("turned", "standard"), ("cue: .*2$", "note y"),
        ("cue: .*second", "+"), ("turned", "perhaps"), ("no answer", "equal"),
        ("answer: trial 1", "undo"), ("undo", "2,2"), ("answer: trial 1", "stop"),
    )  # fmt: skip
    begun = sat.record.plan.trials[0].stimuli[1].value
    shown = [s.shown["value_mm"] for s in sat.progress.trials[1].showings]
    turned = [begun, begun + 0.3, begun + 0.1]
    again = [1.8, begun + 0.1, begun + 0.2]
    assert shown == pytest.approx([1.8, *turned, *again])
    first, second = settings(sat)
    assert (first, second) == (pytest.approx(begun + 0.2), 2.2)
    assert rows(sat.record)[0]["early"] == 0


def test_the_value_stays_within_its_bounds(tmp_path):
    sat = Session(tmp_path / "s", ADJUST).sit(
        ("cue: .*second", "+" * 99), ("turned", "+"), ("turned: .* no farther", "equal"),
        ("answer", "stop"),
    )  # fmt: skip
    assert settings(sat) == [3.0]


def test_a_simulated_person_takes_the_last_value_where_equal_ones_are_beyond_it(tmp_path):
    sure = "confidence = { least = 1, most = 5 }\n"
    sat = Session(tmp_path / "s", ADJUST.replace("most = 3.0", "most = 1.6") + sure).sit()
    assert sat.progress.ended
    assert settings(sat) == [1.6, 1.6]
    assert [event["confidence"] for event in of(sat.events, "answer")] == [4, 4]


@pytest.mark.parametrize("keys", ["knob = 2", "buttons = [3, 1, 2]"])
def test_knobs_and_buttons_of_the_device_turn_it(tmp_path, keys):
    class Turned(BatchEngine):
        polls = 0

        def take_events(self):
            Turned.polls += 1
            now = {
                120: [Knob(2, 0.4), Button(1, pressed=True)],
                130: [Button(2, pressed=True), Knob(1, 0.0)],
            }
            return [*super().take_events(), *now.get(Turned.polls, ())]

    sat = Session(tmp_path / "s", ADJUST + keys + "\n").sit(
        *([("turned", "equal")] if "knob" in keys else []), ("answer", "stop"), engine=Turned
    )
    begun = sat.record.plan.trials[0].stimuli[1].value
    assert settings(sat)[0] == pytest.approx(1.5 if "knob" in keys else begun + 0.1)


def test_the_point_of_equality_is_found_again(tmp_path):
    session = Session(tmp_path / "s", ADJUST.replace("form =", f"repeats = {STEPS}\nform ="))
    session.sit(noise=0.15)
    table, _ = scaling.equality(load_study([session.folder]).judgements)
    (row,) = table.records()
    assert (row["method"], row["trials"]) == ("adjustment", 2 * STEPS)
    assert row["low"] - 0.1 <= 1.8 <= row["high"] + 0.1
    nominal = session.protocol.geometry.dot_width_mm
    jnd = scaling.QUARTILE * 0.15 * nominal * 2**0.5
    assert row["jnd_low"] - 0.05 <= jnd <= row["jnd_high"] + 0.05


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (ADJUST.replace("most = 3.0", "most = 0.5"), "less than a step above least"),
        (ADJUST + "buttons = [1, 2]\n", "buttons must be three"),
        (ADJUST.replace('"vbd"', '"vbd"\nmedium = "paper"'), "which turns what a device shows"),
        (ADJUST.replace('form = "standard"', 'form = "abx"'), "asked of one stimulus"),
    ],
)
def test_what_cannot_be_turned_is_refused(text, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(text, "page.toml")
    assert says in str(refused.value)
