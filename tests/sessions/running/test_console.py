"""The console: what an experimenter types, and what comes of it."""

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, of
from vbraille.braille.spelling import say_cells
from vbraille.engine.batch import BatchEngine
from vbraille.engine.record import Flag
from vbraille.sessions.record.export import read_notes
from vbraille.sessions.running.console import COMMANDS

PRACTICE = '[practice]\ntrials = 2\nstrings = ["ac", "ca"]\n'
ALL = [("read:", "c")] * 4
STUDIED = MINI + "".join(f'[[conditions]]\nname = "c{n}"\ntexture = {n}\n' for n in (0, 1))


@pytest.fixture
def session(tmp_path):
    """A session of four trials."""
    return Session(tmp_path / "s")


def test_each_event_is_one_line_in_the_order_of_the_procedure(session):
    sat = session.sit(*ALL, ("last", ""))
    kinds = [sentence.split(":")[0] for sentence in sat.said]
    per_trial = [k for k in kinds if k != "read"]
    assert per_trial == ["ready", "cue", "answer"] * 4 + ["last", "end", "record"]
    assert not any("\n" in sentence for sentence in sat.said)
    assert [e["answer"] for e in of(sat.events, "answer")] == ["⠉"] * 4
    assert of(sat.events, "end")[0]["why"] == "all trials are done"
    assert sat.progress.ended


def test_what_is_said_tells_nothing_of_the_stimuli(tmp_path):
    said = []
    for seed in (1, 2):
        session = Session(tmp_path / str(seed), seed=seed)
        *told, record = session.sit(*ALL, ("last", "")).said  # whose sum is another each time
        assert record.startswith("record: ")
        said.append((told, session.plan.trials))
    assert said[0][0] == said[1][0]
    assert said[0][1] != said[1][1]


def test_the_cue_sounds_when_the_slider_is_at_the_left(session):
    sat = session.sit(*ALL, ("last", ""))
    assert sat.played == [session.protocol.sound.cue] * 4


def test_undo_keeps_both_answers_and_the_times_of_the_first(session):
    sat = session.sit(
        ("read:", "a"), ("answer: trial 1", "undo"), ("undo: trial 1", "4"), *ALL[1:], ("last", "")
    )
    answers = of(sat.events, "answer")
    assert [(e["trial"], e["answer"], e.get("corrects", False)) for e in answers] == [
        (1, "⠁", False), (1, "⠈", True), (2, "⠉", False), (3, "⠉", False), (4, "⠉", False),
    ]  # fmt: skip
    told = sat.progress.trials[1]
    assert (told.answer, told.first_answer, told.attempts) == ("⠈", "⠁", 1)
    assert told.t_s["answer"] == answers[0]["t_s"] < told.t_s["corrected"]
    assert [e["trial"] for e in of(sat.events, "presented")] == [1, 2, 3, 4]


def test_the_last_answer_of_all_may_be_taken_back(session):
    sat = session.sit(*ALL, ("last", "undo"), ("undo: trial 4", "4"), ("last", ""))
    assert sat.progress.trials[4].answer == "⠈"
    assert sat.progress.ended


def test_there_is_nothing_to_undo_at_first_nor_twice(session):
    sat = session.sit(
        ("ready", "undo"), ("nothing|no answer to take", "note x"), *ALL[:1],
        ("answer: trial 1", "undo"), ("undo: trial 1", "undo"), ("no answer to take", "c"),
        ("answer: trial 1", "stop"),
    )  # fmt: skip
    assert len(of(sat.events, "undo")) == 1


def test_repeat_shows_the_trial_again_as_its_next_attempt(session):
    sat = session.sit(("cue: trial 1", "repeat"), *ALL, ("last", ""))
    shown = [(e["trial"], e["attempt"], e["line"]) for e in of(sat.events, "presented")]
    assert shown == [(1, 1, 1), (1, 2, 2), (2, 1, 3), (3, 1, 4), (4, 1, 5)]
    assert "ready: trial 1 of 4, again" in sat.said
    assert of(sat.events, "answer")[0]["attempt"] == 2


def test_pause_rests_the_array_at_once_and_enter_goes_on(session):
    sat = session.sit(
        ("cue: trial 1", "pause"), ("pause", ""), ("read:", "c"), *ALL[1:], ("last", "")
    )
    assert [e.kind for e in sat.events if e.kind in ("pause", "go")] == ["pause", "go"]
    told = sat.progress.trials[1]
    assert told.paused_s == pytest.approx(
        of(sat.events, "go")[0]["t_s"] - of(sat.events, "pause")[0]["t_s"]
    )
    assert told.paused_s > 0


def test_a_break_comes_after_the_open_trial_and_waits_for_enter(session):
    sat = session.sit(
        ("cue: trial 1", "break"),
        ("read:", "c"),
        ("break: 1 trials", ""),
        *ALL[1:],
        ("last", ""),
    )
    order = [e.kind for e in sat.events if e.kind in ("break", "answer", "presented")]
    assert order[:4] == ["presented", "answer", "break", "presented"]


def test_breaks_of_the_protocol_and_between_blocks(tmp_path):
    session = Session(tmp_path / "s", STUDIED + "[session]\nbreak_every = 3\n")
    script = [("read:", "c")] * 3 + [("break: 3", "")] + [("read:", "c")] + [("break: 4", "")]
    script += [("read:", "c")] * 3 + [("break: 7", "")] + [("read:", "c"), ("last", "")]
    sat = session.sit(*script)
    assert sat.progress.ended
    assert len(of(sat.events, "break")) == 3


def test_the_end_of_a_planned_break_is_said(tmp_path):
    session = Session(tmp_path / "s", STUDIED + "[session]\nbreak_every = 3\nbreak_s = 5\n")
    script = [("read:", "c")] * 3 + [("break: its time is over", "")] + [("read:", "c")]
    sat = session.sit(*script, ("break: 4 trials are done; 5 s are planned, Enter goes on", "stop"))
    assert "break: 3 trials are done; 5 s are planned, Enter goes on" in sat.said
    (begun, *_), (gone_on, *_) = of(sat.events, "break"), of(sat.events, "go")
    assert 5 <= gone_on["t_s"] - begun["t_s"] < 6


def test_stop_leaves_the_open_trial_to_be_shown_again(session):
    session.sit(*ALL[:2], ("cue: trial 3", "stop"))
    sat = session.sit(*ALL[2:], ("last", ""))
    shown = [(e["trial"], e["attempt"], e["line"]) for e in of(sat.events, "presented")]
    assert shown == [(1, 1, 1), (2, 1, 2), (3, 1, 3), (3, 2, 4), (4, 1, 5)]
    assert [run.trace for run in sat.progress.runs] == ["trace-001.gz", "trace-002.gz"]
    assert len(of(sat.events, "answer")) == 4


def test_an_undo_that_was_not_done_is_asked_for_when_the_session_goes_on(session):
    session.sit(*ALL[:1], ("answer: trial 1", "undo"))
    sat = session.sit(("undo: trial 1", "4"), *ALL[1:], ("last", ""))
    assert sat.progress.trials[1].answer == "⠈"
    assert sat.progress.done == 4


def test_notes_go_to_the_open_trial_or_to_the_session(session):
    sat = session.sit(
        ("ready", "note before"), ("cue", "note within, é"), ("read:", "c"), ("answer", "stop")
    )
    notes = [(note.text, note.before, note.trial, note.after) for note in read_notes(sat.events)]
    assert notes == [("before", 0, 0, 1), ("within, é", 1, 1, 1)]


@pytest.mark.parametrize(
    ("typed", "why"),
    [
        ("xyz", "has dots 1, 3, 4 and 6"),
        ("b", "has dots 1 and 2"),
        ("14 14", "2 places typed"),
        ("9", "9"),
        ("é", "é"),
    ],
)
def test_what_is_no_answer_is_said_and_not_written(session, typed, why):
    sat = session.sit(("read:", typed), ("no answer", "c"), ("answer: trial 1", "stop"))
    said = next(sentence for sentence in sat.said if sentence.startswith("no answer"))
    assert why in said
    assert [e["answer"] for e in of(sat.events, "answer")] == ["⠉"]


def test_answers_are_letters_dot_numbers_keys_or_not_read(session):
    sat = session.sit(
        ("read:", "l"), ("read:", "1-4"), ("read:", "0"), ("read:", "?"), ("last", "")
    )
    assert [e["answer"] for e in of(sat.events, "answer")] == ["⠁", "⠉", "⠀", "?"]
    assert [s for s in sat.said if s.startswith("answer")] == [
        "answer: trial 1 of 4, l",
        "answer: trial 2 of 4, c",
        "answer: trial 3 of 4, blank",
        "answer: trial 4 of 4, ?",
    ]


def test_an_answer_that_is_also_an_order_is_typed_after_answer(tmp_path):
    toml = """
format = 1
name = "five"
title = "One word"
source = "ours"
model = "stress2"
[design]
kind = "list"
strings = ["pause"]
"""
    sat = Session(tmp_path / "s", toml).sit(
        ("cue", "pause"), ("pause", ""), ("read:", "answer pause"), ("last", "")
    )
    assert len(of(sat.events, "pause")) == 1
    assert of(sat.events, "answer")[0]["answer"] == "⠏⠁⠥⠎⠑"


def test_no_answer_is_taken_before_the_cue(session):
    sat = session.sit(("ready", "c"), ("no answer is waited for", "stop"))
    assert not of(sat.events, "answer")


def test_contrast_may_be_set_where_the_plan_does_not_study_it(session):
    sat = session.sit(("cue", "contrast 0.5"), ("read:", "c"), *ALL[1:], ("last", ""))
    event = of(sat.events, "tuning")[0]
    assert (event["tuning"], event["line"], event["trial"]) == ({"contrast": 0.5}, 2, 1)
    assert [e.get("tuning") for e in of(sat.events, "presented")] == [
        None, {"contrast": 0.5}, {"contrast": 0.5}, {"contrast": 0.5},
    ]  # fmt: skip
    assert sat.progress.trials[1].tuning == {"contrast": 0.5}


def test_contrast_out_of_range_or_studied_is_refused(tmp_path, session):
    sat = session.sit(("cue", "contrast 2"), ("number from 0 to 1", "contrast"), ("number", "stop"))
    assert not of(sat.events, "tuning")
    sat = Session(tmp_path / "t", STUDIED).sit(("cue", "texture 0.5"), ("the plan sets it", "stop"))
    assert not of(sat.events, "tuning")


def test_practice_tells_what_it_was_and_begin_ends_it(tmp_path):
    session = Session(tmp_path / "s", MINI + PRACTICE)
    sat = session.sit(("read:", "ca"), ("practice: ", "begin"), *ALL, ("last", ""))
    told = [sentence for sentence in sat.said if sentence.startswith("practice: ")]
    shown = session.plan.practice[0].presented
    assert told == [f"practice: {'right' if shown == '⠉⠁' else 'wrong'}, it was "
                    f"{say_cells(shown, session.protocol.keys)}"]  # fmt: skip
    assert sat.progress.practice[1].answer == "⠉⠁"
    assert sat.progress.done == 4


def test_practice_goes_over_into_the_trials(tmp_path):
    session = Session(tmp_path / "s", MINI + PRACTICE)
    sat = session.sit(*[("read:", "ca")] * 2, *ALL, ("last", ""))
    assert sat.progress.done == 4


def test_two_stimuli_come_one_after_the_other_before_the_answer(tmp_path):
    session = Session(tmp_path / "s", COMPARED)
    sat = session.sit(
        ("cue: trial 1", "2"), ("second has not been felt", "note x"), ("read:", "2"),
        ("read:", "first"), ("last", ""),
    )  # fmt: skip
    assert [(e["trial"], e["stimulus"]) for e in of(sat.events, "presented")] == [
        (1, 0), (1, 1), (2, 0), (2, 1),
    ]  # fmt: skip
    assert [e["answer"] for e in of(sat.events, "answer")] == ["2", "1"]
    assert len(sat.played) == 4


def test_the_warning_comes_once_in_a_trial_that_takes_long(tmp_path):
    session = Session(tmp_path / "s", MINI + "[trial]\nwarning_s = 2\n")
    sat = session.sit(("warning: trial 1", "c"), ("warning: trial 2", "stop"))
    assert len(of(sat.events, "warning")) == 2
    warned, cue = of(sat.events, "warning")[0], of(sat.events, "cue")[0]
    assert 2.0 <= warned["t_s"] - cue["t_s"] < 2.2
    assert sat.played.count(session.protocol.sound.warning) == 2


def test_the_session_ends_at_its_limit_after_the_open_trial(tmp_path):
    session = Session(tmp_path / "s", MINI + "[session]\nlimit_s = 10\n", hand="sweep:10")
    sat = session.sit()
    assert 0 < sat.progress.done < 4
    assert of(sat.events, "end")[0]["why"] == "the limit of 10 s is over"
    before, last = (e["t_s"] for e in of(sat.events, "answer")[-2:])
    assert before < 10 <= last


class Unplugged(BatchEngine):
    """A device that is silent for some time."""

    def poll(self):
        ticks = super().poll()
        ticks["flags"][(ticks["tick"] >= 800) & (ticks["tick"] < 1200)] |= int(Flag.SILENT)
        return ticks


@pytest.mark.parametrize("repeats", [True, False])
def test_a_trial_in_which_the_device_was_silent(tmp_path, repeats):
    toml = MINI + f"[faults]\nrepeat = {str(repeats).lower()}\n"
    sat = Session(tmp_path / "s", toml, hand="sweep:60").sit(engine=Unplugged)
    assert sat.progress.ended
    attempts = [sat.progress.trials[number].attempts for number in (1, 2, 3, 4)]
    assert attempts == ([2, 1, 1, 1] if repeats else [1, 1, 1, 1])
    assert sat.progress.trials[1].faults == ["the device is silent"]
    assert len(of(sat.events, "well")) == (not repeats)
    if repeats:  # once it is back
        assert of(sat.events, "presented")[1]["t_s"] >= of(sat.events, "fault")[0]["t_s"] + 0.2


class UnpluggedAtOnce(BatchEngine):
    """A device that is silent while its carriage still is at the left stop."""

    def poll(self):
        ticks = super().poll()
        ticks["flags"][(ticks["tick"] >= 650) & (ticks["tick"] < 1200)] |= int(Flag.SILENT)
        ticks["x_mm"][ticks["tick"] < 1200] = -7.7
        return ticks


def test_a_trial_is_not_begun_while_the_device_is_silent(tmp_path):
    sat = Session(tmp_path / "s", hand="sweep:60").sit(engine=UnpluggedAtOnce)
    assert [sat.progress.trials[number].attempts for number in (1, 2, 3, 4)] == [2, 1, 1, 1]


def test_help_says_every_order(session):
    sat = session.sit(("ready", "help"), ("help:", "stop"))
    for order in COMMANDS:
        assert f"{order.word}: {order.help}" in sat.said


def test_paper_is_timed_by_key(tmp_path):
    toml = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')
    session = Session(tmp_path / "s", toml)
    script = [("ready", ""), ("cue", ""), ("read: .* s; type", "c")] * 4
    sat = session.sit(*script, ("last", ""))
    kinds = [e.kind for e in sat.events if getattr(e, "trial", 0) == 1]
    assert kinds == ["presented", "cue", "read", "answer"]
    assert not list(session.folder.glob("trace*"))
    assert sat.progress.done == 4
