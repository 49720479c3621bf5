"""A session from its first trial to its end: what is typed, what is said, and what is kept."""

import pytest

from tests.sessions.sittings import HEAD, MINI, SURE, WIDTHS, Sat, made
from vbraille.errors import InputError
from vbraille.sessions.session import Session


def answered(sat):
    return [(e.trial, e.data["answer"]) for e in sat.of("answer") if not e.practice]


def shown(sat):
    """What each trial of the plan shows, as it is typed."""
    letters = {"⠁": "a", "⠉": "c", "⠛": "g", "⠕": "o"}
    trials = [trial for trial in sat.session.content.plan.trials if not trial.practice]
    return ["".join(letters[cell] for cell in trial.stimuli[0].cells) for trial in trials]


def test_a_simulated_reader_reads_all_of_it(tmp_path):
    sat = made(tmp_path).sit(answers="simulated")
    assert [row["answered"] for row in sat.session.trials] == [
        row["presented"] for row in sat.session.trials
    ]
    for trial in (1, 2, 3):
        kinds = [event.kind for event in sat.events if event.trial == trial]
        assert kinds == ["cue", "contact", "read", "answer"]
    assert [event.kind for event in sat.events][-2:] == ["closed", "end"]
    with pytest.raises(InputError, match="ended"):
        sat.sit(answers="simulated")


def test_answers_are_typed_at_any_time_and_said_back_once_they_are_in(tmp_path):
    sat = made(tmp_path).sit(
        ("read:", "ac"), ("read:", "zz top"), ("no answer", "1 14"), ("read:", "?c"), ("last", "")
    )
    assert answered(sat) == [(1, "⠁⠉"), (2, "⠁⠉"), (3, "?⠉")]
    assert sum(sentence.startswith("answer: ") for sentence in sat.said) == 3
    assert sat.of("end")


def test_nothing_of_a_stimulus_or_a_condition_is_said_before_its_answer(tmp_path):
    factors = "[[conditions]]\nname = 'flat'\ntexture = 0.0\n[[conditions]]\nname = 'rough'\n"
    sat = made(tmp_path, MINI + "blocks = 1\n" + factors).sit(*[("read:", "??")] * 6, ("last", ""))
    assert not [sentence for sentence in sat.said if "flat" in sentence or "rough" in sentence]
    assert not [sentence for sentence in sat.said if any(c in sentence for c in "⠁⠉")]


def test_an_answer_is_taken_back_and_typed_again(tmp_path):
    sat = made(tmp_path).sit(
        ("cue", "undo"), ("read:", "ac"), ("cue: trial 2", "undo"), ("undo: trial 1", "ca"),
        ("read:", "aa"), ("read:", "aa"), ("last", "undo"),
        ("undo: trial 3", "cc"), ("last", "stop"),
    )  # fmt: skip
    assert answered(sat)[:2] == [(1, "⠁⠉"), (1, "⠉⠁")]
    rows = sat.session.trials
    assert rows[0]["first_answer"] == "⠁⠉"
    assert rows[0]["answered"] == "⠉⠁"
    assert rows[2]["answered"] == "⠉⠉"


def test_a_trial_is_repeated_paused_and_noted(tmp_path):
    sat = made(tmp_path).sit(
        ("cue: trial 1", "repeat"), ("cue: trial 1", "note the phone rang"), ("note", "pause"),
        ("pause", ""), ("go", "note after"), ("note", "ac"), ("cue: trial 2", "stop"),
    )  # fmt: skip
    assert [event.attempt for event in sat.of("cue")] == [1, 2, 1]
    assert [event.data["text"] for event in sat.of("note")] == ["the phone rang", "after"]
    assert [event.kind for event in sat.of("pause", "go")] == ["pause", "go"]
    assert sat.of("stop")
    assert any(sentence.startswith("stop: ") for sentence in sat.said)


def test_a_session_goes_on_with_the_last_runs_device_and_answers_which_it_says(tmp_path):
    sat = made(tmp_path).sit(("read:", "ac"), ("cue", "stop"), rate_hz=500.0)
    sat.sit(("read:", "ca"), ("cue", "stop"))
    again = [sentence for sentence in sat.said if sentence.startswith("resume: ")]
    assert "device sim, answers typed" in again[0]
    assert "1 trials" in again[0]
    runs = [event.data["conditions"] for event in sat.of("run")]
    assert [run["rate_hz"] for run in runs] == [500.0, 500.0]
    assert runs[1]["hand"] == "sweep:150"
    assert [trial for trial, _ in answered(sat)] == [1, 2]


def test_a_confidence_is_asked_alone_after_a_stop(tmp_path):
    sat = made(tmp_path, MINI + SURE)
    sat.sit(("read:", "ac"), ("confidence", "9"), ("no answer", "stop"))
    assert answered(sat) == [(1, "⠁⠉")]
    assert any("kept without" in sentence for sentence in sat.said)
    sat.sit(("confidence", "3"), ("read:", "ca; 2"), ("cue", "stop"))
    assert [event.data["confidence"] for event in sat.of("confidence")] == [3, 2]
    assert [event.trial for event in sat.of("cue")] == [1, 2, 3]


def test_quit_keeps_the_answer_whose_confidence_is_waited_for(tmp_path):
    sat = made(tmp_path, MINI + SURE).sit(("read:", "ac"), ("confidence", "quit"), ("quit: type",
                                          "quit the finger hurts"))  # fmt: skip
    assert answered(sat) == [(1, "⠁⠉")]
    (end,) = sat.of("end")
    assert end.data["reason"] == "the finger hurts"
    assert any("kept without" in sentence for sentence in sat.said)
    assert sat.session.trials[0]["answered"] == "⠁⠉"


def test_an_early_answer_is_marked(tmp_path):
    sat = made(tmp_path).sit(("cue: trial 1", "ac"), ("cue: trial 2", "stop"), hand="sweep:10")
    (answer,) = sat.of("answer")
    assert answer.data["early"]


def test_practice_goes_on_until_enough_are_right_and_tells_what_it_was(tmp_path):
    practice = "[practice]\nstrings = ['a', 'c']\nuntil = { right = 2, of = 2, most = 8 }\n"
    sat = made(tmp_path, MINI + practice)
    by_number = {t.number: t for t in sat.session.content.plan.trials if t.practice}
    letter = {"⠁": "a", "⠉": "c"}
    rights = [letter[by_number[number].stimuli[0].cells] for number in (1, 2, 3)]
    wrong = "c" if rights[0] == "a" else "a"
    sat.sit(("read:", wrong), ("read:", rights[1]), ("read:", rights[2]), ("cue: trial 1", "stop"))
    told = [sentence for sentence in sat.said if sentence.startswith("feedback: ")]
    assert ["wrong" in told[0], "right" in told[1]] == [True, True]
    assert rights[0] in told[0]
    untold = made(tmp_path, MINI + practice + "feedback = false\n", "P02").sit(answers="simulated")
    assert not any(sentence.startswith("feedback: ") for sentence in untold.said)


def test_the_gap_before_a_trial_is_drawn_and_kept(tmp_path):
    sat = made(tmp_path, MINI + "[trial]\ngap_s = [0.5, 1.5]\n").sit(answers="simulated")
    given = {trial.number: trial.gap_s for trial in sat.session.content.plan.trials}
    assert len(set(given.values())) > 1
    answers = {event.trial: event.t_s for event in sat.of("answer")}
    for cue in sat.of("cue")[1:]:
        assert cue.t_s - answers[cue.trial - 1] >= given[cue.trial]


def test_a_break_comes_when_it_is_due_and_when_it_is_wanted(tmp_path):
    sat = made(tmp_path, MINI + "[session]\nbreak_every = 1\nbreak_s = 1\n").sit(
        ("read:", "ac"), ("break: 1", "ac"), ("Enter goes on", "note still"), ("note", ""),
        ("cue: trial 2", "break"), ("after this", "ca"), ("break: 2", ""),
        ("cue: trial 3", "stop"),
    )  # fmt: skip
    assert len(sat.of("break")) == 2
    assert [trial for trial, _ in answered(sat)] == [1, 2]


def test_no_trial_begins_after_the_limit_and_the_last_questions_are_asked(tmp_path):
    last = "[[questionnaire]]\nname = 'rem'\nask = 'Remarks?'\nwhen = 'end'\nkind = 'text'\n"
    sat = made(tmp_path, MINI + "[session]\nlimit_s = 1\n" + last)
    sat.sit(("read:", "ac"), ("question", "none"), hand="sweep:20")
    assert [event.trial for event in sat.of("cue")] == [1]
    assert sat.of("reply")
    assert sat.of("end")


def test_questions_beside_the_trials_are_asked_once_and_taken_back(tmp_path):
    asks = (
        "[[questionnaire]]\nname = 'sure'\nask = 'Sure?'\nwhen = 'trial'\nkind = 'choice'\n"
        "choices = ['yes', 'no']\n"
    )
    sat = made(tmp_path, MINI + asks).sit(
        ("read:", "ac"), ("question", "perhaps"), ("no answer", "YES"), ("cue: trial 2", "undo"),
        ("question", "no"), ("cue: trial 2", "stop"),
    )  # fmt: skip
    assert [event.data["reply"] for event in sat.of("reply")] == ["yes", "no"]
    assert sat.session.trials[0]["asked_sure"] == "no"


def test_exposure_is_limited_from_the_first_touch_and_late_answers_are_marked(tmp_path):
    limits = "[trial]\nexposure_s = 0.5\nexposure_from = 'contact'\nanswer_s = 2\n"
    sat = made(tmp_path, MINI + limits).sit(
        ("ended", "ac"), ("cue: trial 2", "note wait"), ("late", "ca"), ("cue: trial 3", "stop"),
        hand="sweep:20",
    )  # fmt: skip
    ended, contact = sat.of("ended")[0], sat.of("contact")[0]
    assert ended.data["by"] == "exposure"
    assert ended.t_s - contact.t_s >= 0.5
    assert [event.trial for event in sat.of("late")] == [2]
    assert [row["late"] for row in sat.session.trials] == [0, 1, 0]
    assert sat.session.trials[0]["ended_by"] == "exposure"


def test_a_trial_without_an_answer_in_time_is_missed(tmp_path):
    sat = made(tmp_path, MINI + "[trial]\nanswer_s = 1\nlate = 'missed'\n").sit(
        ("missed: trial 1", "note x"), ("read:", "stop"), hand="sweep:100"
    )
    assert sat.of("missed")[0].trial == 1
    assert [event.trial for event in sat.of("cue")][:2] == [1, 2]


def test_enter_ends_reading(tmp_path):
    sat = made(tmp_path, MINI + "[trial]\nend = 'key:enter'\n").sit(
        ("cue: trial 1", ""), ("ended", "ac"), ("cue: trial 2", "stop"), hand="sweep:20"
    )
    (ended,) = sat.of("ended")
    assert ended.data["by"] == sat.session.trials[0]["ended_by"] == "key:enter"
    assert not sat.of("read")


def test_a_word_that_is_a_command_and_a_string_is_a_command(tmp_path):
    protocol = MINI.replace('"ac", "ca", "aa"', '"go"').replace('"vbd"', '"stress2"')
    sat = made(tmp_path, protocol + "repeats = 2\n").sit(
        ("read:", "Go"), ("answer go", "answer go"), ("read:", "go on"), ("no answer", "stop")
    )
    assert shown(sat) == ["go", "go"]
    assert len(sat.of("answer")) == 1
    assert sat.of("stop")


def test_names_are_said_back_until_enter_or_the_same_key_takes_them(tmp_path):
    session = Session.create("orientation-coarse", "P01", path=tmp_path / "one.session", seed=1)
    sat = Sat(session).sit(
        ("cue: ", "3"), ("chosen: at-90", "1"), ("chosen: at-0", ""), ("cue: ", ""),
        ("name is missing", "3"), ("chosen: at-90", "3"), ("cue: ", "stop"),
    )  # fmt: skip
    assert [event.data["answer"] for event in sat.of("answer")] == ["at-0", "at-90"]


def test_two_are_compared_in_turn(tmp_path):
    sat = made(tmp_path, WIDTHS).sit(
        ("cue: trial 1", "1"), ("not been felt", "note x"), ("read:", "1"), ("cue: trial 2", "stop")
    )
    cues = [(event.trial, event.data["stimulus"]) for event in sat.of("cue")]
    assert cues[:3] == [(1, 0), (1, 1), (2, 0)]
    assert answered(sat) == [(1, "1")]


def test_a_value_is_turned_until_it_is_equal(tmp_path):
    adjust = WIDTHS.replace('string = "a"', 'string = "a"\nreference = 1.5\nform = "standard"')
    adjust += "[question]\nkind = 'adjust'\nstep = 0.1\nleast = 0.5\nmost = 3.0\n"
    sat = made(tmp_path, adjust).sit(
        ("read:", "++"), ("turned", "-"), ("turned", "equal"), ("cue: trial 2", "stop")
    )
    values = [event.data["value"] for event in sat.of("cue") if event.trial == 1]
    start = values[1]
    assert values[2:] == pytest.approx([start + 0.2, start + 0.1])
    assert float(sat.of("answer")[0].data["answer"]) == pytest.approx(start + 0.1)


def test_paper_is_timed_by_enter_and_answers_of_a_file_take_no_time(tmp_path):
    paper = MINI.replace(HEAD, HEAD + 'medium = "paper"\n')
    sat = made(tmp_path, paper).sit(
        ("ready", ""), ("cue: trial 1", ""), ("read:", "ac"), ("ready", "stop"), fast=False
    )
    assert [event.kind for event in sat.of("cue", "read", "answer")] == ["cue", "read", "answer"]
    script = tmp_path / "answers.txt"
    script.write_text("# the rest\nca\n\nnote typed later\naa\n")
    sat.sit(answers=str(script), fast=False)
    assert [trial for trial, _ in answered(sat)] == [1, 2, 3]
    assert sat.of("end")
