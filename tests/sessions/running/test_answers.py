"""Answers of files, programs and simulated readers, and those that cannot be used."""

import pytest

from tests.sessions.sittings import MINI, SURE, made
from vbraille.errors import InputError


def typed(folder, *lines):
    path = folder / "answers.txt"
    path.write_text("\n".join(lines), "utf-8")
    return str(path)


def test_a_file_has_a_line_for_each_answer_and_goes_on_where_it_ended(tmp_path):
    sat = made(tmp_path, MINI + SURE)
    sat.sit(answers=typed(tmp_path, "# letters", "ac; 2", "note the door", "ca"))
    assert [event.kind for event in sat.events][-2:] == ["closed", "stop"]
    sat.sit(answers=typed(tmp_path, "# letters", "ac; 2", "note the door", "ca", "4", "aa;1"))
    assert [event.data["script_line"] for event in sat.of("answer")] == [2, 4, 6]
    assert [event.data["confidence"] for event in sat.of("confidence")] == [2, 4, 1]
    assert sat.of("note")
    assert sat.of("end")


def test_a_line_that_is_no_answer_is_named_and_nothing_is_lost(tmp_path):
    sat = made(tmp_path)
    with pytest.raises(InputError, match="line 2"):
        sat.sit(answers=typed(tmp_path, "ac", "acac"))
    assert len(sat.of("answer")) == 1
    sat.sit(answers=typed(tmp_path, "ac", "ca", "aa"))
    assert [event.trial for event in sat.of("answer")] == [1, 2, 3]


def test_a_program_answers_by_lines_or_by_a_function(tmp_path):
    asks = "[[questionnaire]]\nname = 'rem'\nask = 'Remarks?'\nwhen = 'end'\nkind = 'text'\n"
    asked = []

    def answer(what):
        asked.append(what)
        return "none" if hasattr(what, "ask") else "??"

    sat = made(tmp_path, MINI + asks).sit(answers=["ac"])
    sat.sit(answers=answer)
    assert [getattr(what, "number", "rem") for what in asked] == [2, 3, "rem"]
    assert [row["asked_rem"] for row in sat.session.trials] == ["none"] * 3
    with pytest.raises(InputError, match="ended"):
        sat.sit(answers=answer)


def test_the_same_seed_gives_the_same_answers(tmp_path):
    answers = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        sat = made(tmp_path / name).sit(answers="simulated:1.5")
        answers.append([row["answered"] for row in sat.session.trials])
    assert answers[0] == answers[1]
    assert sat.session.trials[0]["answers_from"] == "simulated:1.5"


def test_lapses_are_answered_by_chance_and_false_alarms_with_yes(tmp_path):
    caught = MINI.replace("strings", "catch = { every = 2, show = 'blank' }\nstrings")
    alarmed = made(tmp_path, caught + "[question]\nkind = 'detect'\n")
    alarmed.sit(answers="simulated:0,false-alarms=1")
    assert {event.data["answer"] for event in alarmed.of("answer")} == {"yes"}


@pytest.mark.parametrize(
    ("answers", "named"),
    [("simulatd:1", "simulated"), ("nowhere.txt", "nowhere.txt"), ("simulated:-1", "-1"),
     ("simulated:0.1,lapses=2", "lapses"), ("simulated:0,false-alarms=0.1", "false"),
     ("program", "program")],
)  # fmt: skip
def test_a_source_that_cannot_be_used_is_refused_before_anything_begins(tmp_path, answers, named):
    sat = made(tmp_path)
    with pytest.raises(InputError, match=named):
        sat.sit(answers=answers)
    assert not sat.of("run")


def test_paper_cannot_be_felt_by_a_simulated_reader(tmp_path):
    sat = made(tmp_path, 'medium = "paper"\n' + MINI)
    with pytest.raises(InputError, match="paper"):
        sat.sit(answers="simulated", fast=False)
