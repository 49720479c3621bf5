"""Questionnaires: when each question is asked, what is kept of it, and a participant who stops."""

import csv

import pytest

from tests.sessions.sittings import MINI, Session, gone_on, kill_often, of
from vbraille.errors import InputError
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import anonymous, rows
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.session import Session as Sitting

BEGIN = """
[[questionnaire]]
kind = "number"
name = "years"
when = "begin"
ask = "Years of braille?"
least = 0
most = 99
"""
TRIAL = """
[[questionnaire]]
kind = "choice"
name = "easy"
when = "trial"
ask = "Was it easy?"
choices = ["yes", "no"]
right = "yes"
"""
BLOCK = """
[[questionnaire]]
kind = "rating"
name = "tired"
when = "block"
ask = "How tired are you?"
least = 1
most = 7
labels = ["not at all", "very"]
"""
END = """
[[questionnaire]]
kind = "text"
name = "remarks"
when = "end"
ask = "Remarks?"
"""
TWO_BLOCKS = MINI.replace("length = 1", "length = 1\nblocks = 2")
ALL = TWO_BLOCKS + BEGIN + TRIAL + BLOCK + END


def test_each_question_is_asked_in_its_place_and_kept(tmp_path):
    session = Session(tmp_path / "s", ALL)
    asked = [("asked: Was it easy", "1"), ("^read:", "c"), ("asked: Was it easy", "no")]
    block = [("asked: How tired are you.*1 to 7: 1 is not at all", "VERY")]
    sat = session.sit(
        ("asked: Years .*from 0 to 99", "123"), ("no answer", "7,5"), ("^read:", "c"),
        *asked, *block, ("break", ""), ("^read:", "c"), *asked, ("asked: How", "2"),
        ("asked: Remarks", "answer stop"), ("last", ""),
    )  # fmt: skip
    assert sat.progress.ended
    replies = [(e["name"], e["answer"]) for e in of(sat.events, "reply")]
    trials = [("easy", "yes"), ("easy", "no")]
    assert replies == [
        ("years", "7.5"), *trials, ("tired", "7"), *trials, ("tired", "2"), ("remarks", "stop")
    ]  # fmt: skip
    table = rows(sat.record)
    assert [row["asked_easy"] for row in table] == ["yes", "no"] * 2
    assert [row["asked_easy_correct"] for row in table] == [1, 0, 1, 0]
    assert [row["asked_tired"] for row in table] == ["7", "7", "2", "2"]
    assert {row["asked_years"] for row in table} == {"7.5"}
    assert {row["asked_remarks"] for row in table} == {"stop"}
    assert "asked_remarks" not in anonymous(sat.record, table)[0]
    assert all(finding.good for finding in check_folder(session.folder))
    made = bids.files(sat.record)
    (described,) = (text for name, text in made.items() if name.endswith("_beh.json"))
    assert b"How tired are you?" in described
    hidden = bids.files(sat.record, without_times=True)
    assert not any(b"stop" in text for name, text in hidden.items() if name.endswith("tsv"))


def test_an_undo_asks_the_question_before_again_or_takes_back_the_answer(tmp_path):
    more = TRIAL.replace("easy", "other")
    sat = Session(tmp_path / "s", MINI + TRIAL + more).sit(
        ("^read:", "c"), ("asked: Was it easy", "yes"), ("asked: Was it other", "undo"),
        ("asked: Was it easy", "no"), ("asked: Was it other", "undo"),
        ("asked: Was it easy", "undo"), ("undo: trial 1", "a"),
        ("asked: Was it other", "yes"), ("cue: trial 2", "stop"),
    )  # fmt: skip
    row = rows(sat.record)[0]
    assert (row["answered"], row["first_answer"]) == ("⠁", "⠉")
    assert (row["asked_easy"], row["asked_other"]) == ("no", "yes")
    assert sat.progress.done == 1


def test_a_simulated_reader_answers_and_knows_what_is_right(tmp_path):
    sat = Session(tmp_path / "s", ALL).sit()
    assert sat.progress.ended
    assert len(of(sat.events, "reply")) == 8
    assert {row["asked_easy_correct"] for row in rows(sat.record)} == {1}


def test_killed_and_resumed_it_loses_no_answer(tmp_path):
    session = Session(tmp_path / "s", ALL)
    session.sit()
    kill_often(session, tmp_path / "killed", cuts=8)


def test_a_question_that_has_no_answer_is_asked_again(tmp_path):
    session = Session(tmp_path / "s", MINI + BEGIN + BLOCK)
    session.sit(("asked", "3"), ("cue", "stop"))
    size = (session.folder / "journal.jsonl").read_bytes().index(b'{"n":3,"event":"reply"')
    sat, kept = gone_on(session, tmp_path / "t", size, ("asked: Years", "4"), ("cue", "stop"))
    assert kept == 0
    assert [e["answer"] for e in of(sat.events, "reply")] == ["4"]


@pytest.mark.parametrize("lines", ["7 c yes c yes 3 c yes c yes 3 none", "7 c maybe"])
def test_a_file_has_a_line_for_each_and_is_checked_before(tmp_path, lines):
    path = tmp_path / "answers.txt"
    path.write_text("\n".join(lines.split()))
    session = Session(tmp_path / "s", ALL)
    again = Sitting.resume(session.folder, fast=True, answers=str(path))
    if "maybe" in lines:
        with pytest.raises(InputError, match=r"answers\.txt line 3: 'maybe' is not an answer"):
            again.run()
        return
    again.run()
    assert again.progress.ended
    assert again.trials[0]["asked_tired"] == "3"


def test_a_question_may_come_from_the_items(tmp_path):
    toml = (
        MINI.partition("[keys]")[0]
        + """
[design]
kind = "items"
[items]
file = "items.csv"
[[questionnaire]]
kind = "choice"
name = "about"
when = "trial"
ask = "{question}"
choices = ["{one}", "{two}"]
right = "{one}"
"""
    )
    table = "string,question,one,two\nac,Which first?,a,c\nca,Which one?,c,a\n"
    (tmp_path / "items.csv").write_text(table)
    (tmp_path / "p.toml").write_text(toml)
    session = Sitting.create(
        tmp_path / "p.toml", "P01", folder=tmp_path / "s", seed=1, conditions=_fast()
    )
    said = []
    session.run("simulated", say=said.append)
    asked = {line for line in said if line.startswith("asked:")}
    assert asked == {"asked: Which first? (1 a, 2 c)", "asked: Which one? (1 c, 2 a)"}
    assert [row["asked_about_correct"] for row in session.trials] == [1, 1]
    given = {row["item_question"]: row["asked_about"] for row in session.trials}
    wanted = {row["question"]: row["one"] for row in csv.DictReader(table.splitlines())}
    assert given == wanted


def _fast():
    from vbraille.sessions.conditions import Conditions

    return Conditions(fast=True, hand="sweep:150")


def test_a_participant_stops_for_good_with_a_reason(tmp_path):
    session = Session(tmp_path / "s", ALL)
    sat = session.sit(
        ("asked", "3"), ("cue: trial 1", "quit"), ("quit: type the reason", "quit feels ill")
    )
    (end,) = of(sat.events, "end")
    assert (end["why"], end["reason"]) == ("the participant stopped", "feels ill")
    assert any("feels ill" in finding.text for finding in check_folder(session.folder))
    with pytest.raises(InputError, match="has ended"):
        Sitting.resume(session.folder)
    hidden = bids.files(sat.record, without_times=True)
    assert not any(b"feels ill" in text for text in hidden.values())
    assert any(b"feels ill" in text for text in bids.files(sat.record).values())


@pytest.mark.parametrize(
    ("toml", "says"),
    [
        (BEGIN + BEGIN, "number 2 name is 'years' again"),
        (BEGIN.replace("most = 99", "most = 0"), "least is not below most"),
        (TRIAL.replace('"no"]', '"yes"]'), "choices must be two or more"),
        (TRIAL.replace("it easy?", "{this} easy?"), "which is no column"),
        (TRIAL.replace('right = "yes"', 'right = "perhaps"'), "'perhaps' is not an answer"),
        (BLOCK.replace("most = 7", "most = 0"), "the scale is read backwards"),
        (END.replace("end", "then"), "when"),
    ],
)
def test_questions_that_cannot_be_are_refused(toml, says):
    with pytest.raises(InputError) as refused:
        parse_protocol(MINI + toml, "page.toml")
    assert says in str(refused.value)
