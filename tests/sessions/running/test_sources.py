"""Responses of a program: lines, or a function of the trial."""

import pytest

from tests.sessions.sittings import MINI
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.running.responses import PROGRAM, Responses
from vbraille.sessions.running.sources import ProgramResponses, parse_responses
from vbraille.sessions.session import Session

PROTOCOL = parse_protocol(MINI, "test")
PLAN = make_plan(PROTOCOL, "P1", 1)


def given(answers, *trials):
    return [answers.next(PLAN.trials[number], 1, []) for number in trials]


def test_lines_are_given_to_trials_one_by_one_and_end():
    answers = ProgramResponses(PROTOCOL, ["a", "note warm", "c"])
    assert isinstance(answers, Responses)
    assert given(answers, 0, 1, 1, 2) == [("a", 0), ("note warm", 0), ("c", 0), None]


def test_a_function_is_asked_once_for_each_showing_of_a_trial():
    asked = []
    answers = ProgramResponses(
        PROTOCOL, lambda trial: asked.append(trial.number) or trial.presented
    )
    assert given(answers, 0, 0, 1) == [
        (PLAN.trials[0].presented, 0), None, (PLAN.trials[1].presented, 0),
    ]  # fmt: skip
    assert asked == [1, 2]
    assert answers.next(PLAN.trials[1], 2, []) == (PLAN.trials[1].presented, 0)


def test_after_an_order_the_trial_is_asked_about_again():
    lines = iter(["note warm", "a"])
    answers = ProgramResponses(PROTOCOL, lambda _trial: next(lines))
    assert given(answers, 0, 0, 0) == [("note warm", 0), ("a", 0), None]


def test_a_line_that_is_no_answer_is_one_sentence():
    with pytest.raises(InputError, match=r"^'ab' for trial 1: "):
        ProgramResponses(PROTOCOL, lambda _trial: "ab").next(PLAN.trials[0], 1, [])


def test_a_record_that_a_program_answered_cannot_be_gone_on_with_without_it():
    with pytest.raises(InputError, match="the answers came from a program; give ‹answers› typed"):
        parse_responses(PROGRAM, PROTOCOL, PLAN)


def test_nothing_of_a_new_session_is_on_the_disk_before_it_is_run(tmp_path):
    session = Session.create(PROTOCOL, "P1", folder=tmp_path / "s", seed=1)
    assert session.plan == PLAN
    assert not list(tmp_path.iterdir())
    (tmp_path / "s").mkdir()
    (tmp_path / "s" / "other").touch()
    with pytest.raises(InputError, match="is there already"):
        Session.create(PROTOCOL, "P1", folder=tmp_path / "s")
