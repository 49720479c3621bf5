"""Limits of a trial: the stimulus fades at the end of its exposure; answers are in time or late."""

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, kill_often, of
from vbraille.errors import InputError
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.replay import frames


def limited(*lines, toml=MINI):
    return toml + "\n".join(("[trial]", *lines, ""))


def test_the_stimulus_fades_at_the_end_of_its_exposure(tmp_path):
    sat = Session(tmp_path / "s", limited("exposure_s = 0.4"), hand="sweep:60").sit(
        ("ended: .* by exposure", "c"), ("answer: trial 1", "stop")
    )
    (ended,) = of(sat.events, "ended")
    (cue,) = of(sat.events, "cue")[:1]
    assert ended["by"] == "exposure"
    assert ended["t_s"] - cue["t_s"] == pytest.approx(0.4, abs=0.11)  # a poll has 0.1 s here
    shown = [(ticks, deflections) for line, ticks, deflections in frames(sat.record) if line == 1]
    ticks, deflections = shown[0]
    late = (ticks["time_ns"] - ticks["time_ns"][0]) / 1e9 > 0.6
    assert late.any()
    assert (deflections[late] == deflections[late][0]).all()
    assert not (deflections[~late] == deflections[late][0]).all()
    row = rows(sat.record)[0]
    assert (row["ended_by"], row["early"]) == ("exposure", 0)
    assert "late" not in row


def test_the_exposure_counts_from_the_first_touch_if_asked_for(tmp_path):
    toml = limited("exposure_s = 0.3", 'exposure_from = "contact"')
    sat = Session(tmp_path / "s", toml, hand="sweep:40").sit(
        ("ended: .* by exposure", "c"), ("answer: trial 1", "stop")
    )
    contact, ended = of(sat.events, "contact")[0], of(sat.events, "ended")[0]
    assert ended["t_s"] - contact["t_s"] == pytest.approx(0.3, abs=0.11)


def test_each_of_two_stimuli_has_its_exposure_and_pauses_are_left_out(tmp_path):
    toml = limited("exposure_s = 0.3", toml=COMPARED)
    sat = Session(tmp_path / "s", toml, hand="sweep:40").sit(
        ("ended: the first, by exposure", "pause"), ("pause", ""), ("cue: .*second", "pause"),
        ("pause", "note x"), ("note", "note y"), ("note", "note z"), ("note", ""),
        ("ended: .* by exposure; type", "2"), ("answer: trial 1", "stop"),
    )  # fmt: skip
    assert [e["stimulus"] for e in of(sat.events, "ended")] == [0, 1]
    assert rows(sat.record)[0]["early"] == 0


def test_early_and_late_answers_are_told_apart(tmp_path):
    toml = limited("exposure_s = 0.5", "answer_s = 0.3")
    sat = Session(tmp_path / "s", toml, hand="sweep:20").sit(
        ("cue: trial 1", "c"), ("no answer", "c"),
        ("ended: .* by exposure", "c"), ("answer: trial 2", "note in between"),
        ("late: trial 3", "c"), ("answer: trial 3", "stop"),
    )  # fmt: skip
    told = [(row["early"], row["late"]) for row in rows(sat.record)]
    assert told[:3] == [(1, 0), (0, 0), (0, 1)]
    assert [e.get("late", False) for e in of(sat.events, "answer")] == [False, False, True]


def test_without_an_exposure_the_time_counts_from_the_start_signal(tmp_path):
    sat = Session(tmp_path / "s", limited("answer_s = 0.5"), hand="sweep:20").sit(
        ("late: trial 1", "c"), ("no answer", "c"), ("answer: trial 1", "stop")
    )
    late = of(sat.events, "answer")[0]
    assert late["t_s"] - of(sat.events, "cue")[0]["t_s"] > 0.5
    assert (late["early"], late["late"]) == (True, True)


MISSED = limited("exposure_s = 0.3", "answer_s = 0.2", 'late = "missed"')


def test_an_answer_that_does_not_come_is_missed_and_the_session_goes_on(tmp_path):
    sat = Session(tmp_path / "s", MISSED, hand="sweep:60").sit(
        ("missed: trial 1", "note slow"), ("ended: .* by exposure", "c"),
        ("missed: trial 3", "undo"), ("undo: trial 3", "a"), ("answer: trial 3", "note so"),
        ("missed: trial 4", ""), ("last", ""),
    )  # fmt: skip
    assert sat.progress.ended
    table = rows(sat.record)
    assert [row["answered"] for row in table] == ["", "⠉", "⠁", ""]
    assert [row["late"] for row in table] == [1, 0, 1, 1]
    assert [row["analysed"] for row in table] == [0, 1, 1, 0]
    assert len(of(sat.events, "missed")) == 3


def test_a_missed_practice_trial_is_not_asked_again(tmp_path):
    toml = MISSED + '[practice]\ntrials = 1\nstrings = ["ca"]\n'
    sat = Session(tmp_path / "s", toml, hand="sweep:60").sit(
        ("missed: practice 1", "note x"), ("cue: trial 1", "stop")
    )
    assert sat.progress.begun
    assert sat.progress.done == 0


@pytest.mark.parametrize("toml", [MISSED, limited("exposure_s = 0.5", "answer_s = 0.1")])
def test_killed_and_resumed_it_loses_no_answer(tmp_path, toml):
    session = Session(tmp_path / "s", toml, hand="sweep:60")
    session.sit()
    kill_often(session, tmp_path / "killed")


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        (limited('late = "missed"'), "[trial] late is of answer_s"),
        (limited('exposure_from = "contact"'), "[trial] exposure_from is of exposure_s"),
        (
            limited("exposure_s = 1.0").replace('"vbd"', '"vbd"\nmedium = "paper"'),
            "[trial] exposure_s is of a device",
        ),
    ],
)
def test_limits_that_cannot_be_are_refused(toml, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(toml, "page.toml")
    assert says in str(refused.value)
