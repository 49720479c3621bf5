"""Answers that come while the trial is paused, or before it was read: what then counts of them."""

import pytest

from tests.sessions.sittings import COMPARED, MINI, Session, of
from vbraille.sessions.record.export import rows

PAPER = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')


def trial(sat, number=1):
    """Row of a trial."""
    return rows(sat.record)[number - 1]


def test_a_pause_that_an_answer_ends_is_kept(tmp_path):
    sat = Session(tmp_path / "s").sit(("read:", "pause"), ("pause", "c"), ("cue: trial 2", "stop"))
    pause, answer = of(sat.events, "pause")[0], of(sat.events, "answer")[0]
    waited_s = answer["t_s"] - pause["t_s"]
    assert waited_s > 0
    assert trial(sat)["paused_s"] == pytest.approx(waited_s, abs=1e-6)
    assert sat.live.trials[1].paused_s == sat.progress.trials[1].paused_s
    cue_s = of(sat.events, "cue")[0]["t_s"]
    assert trial(sat)["response_s"] == pytest.approx(pause["t_s"] - cue_s, abs=2e-6)
    assert trial(sat, 2)["paused_s"] == 0


def test_several_pauses_of_a_trial_are_all_kept(tmp_path):
    sat = Session(tmp_path / "s").sit(
        ("cue", "pause"), ("pause", ""), ("read:", "pause"), ("pause", "c"), ("cue", "stop")
    )
    first, second = of(sat.events, "pause")
    went_on, answer = of(sat.events, "go")[0], of(sat.events, "answer")[0]
    paused_s = went_on["t_s"] - first["t_s"] + answer["t_s"] - second["t_s"]
    assert trial(sat)["paused_s"] == pytest.approx(paused_s, abs=2e-6)


def test_a_pause_goes_on_while_the_answer_before_is_mended(tmp_path):
    sat = Session(tmp_path / "s").sit(
        ("read:", "c"), ("cue: trial 2", "pause"), ("pause", "undo"), ("undo", "a"),
        ("answer: trial 1", ""), ("read:", "c"), ("cue: trial 3", "stop"),
    )  # fmt: skip
    pause, went_on = of(sat.events, "pause")[0], of(sat.events, "go")[0]
    assert trial(sat)["paused_s"] == 0
    assert trial(sat, 2)["paused_s"] == pytest.approx(went_on["t_s"] - pause["t_s"], abs=1e-6)


@pytest.mark.parametrize(
    ("notes", "why"), [(0, "nothing was read yet"), (9, "it was not read to its end yet")]
)
def test_an_answer_before_it_was_read_is_asked_about_once_and_marked(tmp_path, notes, why):
    # With each note go some tenths of a second, in which the hand goes on by some mm.
    session = Session(tmp_path / "s", hand="sweep:10")
    sat = session.sit(
        ("cue: trial 1", "note x"), *[("note", "note y")] * notes, ("note", "c"),
        ("no answer", "c"), ("read:", "c"), ("answer: trial 2", "stop"),
    )  # fmt: skip
    assert [line for line in sat.said if line.startswith("no answer")] == [
        f"no answer: {why}; the same answer again is taken"
    ]
    first, second = of(sat.events, "answer")
    assert first["early"] is True
    assert "early" not in second
    assert [trial(sat, n)["early"] for n in (1, 2, 3)] == [1, 0, 0]
    assert [trial(sat, n)["answered"] for n in (1, 2)] == ["⠉", "⠉"]


def test_another_answer_is_asked_about_anew_and_one_after_the_reading_is_not(tmp_path):
    sat = Session(tmp_path / "s", hand="sweep:10").sit(
        ("cue", "c"), ("no answer", "a"), ("no answer", "note x"), ("read:", "a"), ("cue", "stop")
    )
    assert sum(line.startswith("no answer") for line in sat.said) == 2
    assert "early" not in of(sat.events, "answer")[0]


def test_a_repeated_trial_is_asked_about_again(tmp_path):
    sat = Session(tmp_path / "s", hand="sweep:10").sit(
        ("cue", "c"), ("no answer", "repeat"), ("cue", "c"), ("no answer", "c"), ("cue", "stop")
    )
    assert sum(line.startswith("no answer") for line in sat.said) == 2
    assert of(sat.events, "answer")[0]["attempt"] == 2


def test_mending_an_early_answer_leaves_it_early(tmp_path):
    sat = Session(tmp_path / "s", hand="sweep:10").sit(
        ("cue", "c"), ("no answer", "c"), ("answer: trial 1", "undo"), ("undo", "a"),
        ("answer: trial 1", "stop"),
    )  # fmt: skip
    assert (trial(sat)["answered"], trial(sat)["first_answer"]) == ("⠁", "⠉")
    assert trial(sat)["early"] == 1


def test_the_second_of_two_must_be_read_too(tmp_path):
    sat = Session(tmp_path / "s", COMPARED, hand="sweep:10").sit(
        ("cue: .*second", "2"), ("no answer", "2"), ("answer: trial 1", "stop")
    )
    assert [trial(sat, n)["early"] for n in (1, 2)] == [1, 0]


def test_on_paper_enter_says_that_it_was_read(tmp_path):
    sat = Session(tmp_path / "s", PAPER).sit(
        ("ready", ""), ("cue", "c"), ("no answer: Enter has not said yet", "c"),
        ("ready", ""), ("cue", ""), ("read:", "c"), ("answer: trial 2", "stop"),
    )  # fmt: skip
    assert [trial(sat, n)["early"] for n in (1, 2)] == [1, 0]


def test_answers_of_a_simulated_reader_are_never_early(tmp_path):
    sat = Session(tmp_path / "s").sit()
    assert [row["early"] for row in rows(sat.record)] == [0, 0, 0, 0]
