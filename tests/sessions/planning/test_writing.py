"""Texts whose cells braille tables make: as conditions, in answers, and in the record."""

import csv
import json
import re

import pytest

from tests.sessions.planning.test_bad_protocols import VBD_HEAD
from vbraille.braille.spelling import to_braille
from vbraille.errors import InputError
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.making import check_plan, make_plan
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.planning.spellings import cells_of, parse_text
from vbraille.sessions.record.bids import write
from vbraille.sessions.record.export import rows
from vbraille.sessions.record.folder import load
from vbraille.sessions.session import Session

G1, G2 = "en-ueb-g1.ctb", "en-ueb-g2.ctb"
HEAD = VBD_HEAD.replace("vbd", "stress2")
GRADES = (
    '[[factors]]\nname = "grade"\nlevels = [{ name = "g1", table = "en-ueb-g1.ctb" }, '
    '{ name = "g2", table = "en-ueb-g2.ctb" }]\n'
)
DESIGN = '[design]\nkind = "items"\nblocks = 1\ncatch = { every = 4 }\n'
ITEMS = '[items]\nfile = "items.csv"\n[practice]\ntrials = 1\nstrings = ["12 o\'clock"]\n'
FILE = "string,kind\nchat,word\nthe child,two\npeople,word\n"
TEXT = HEAD + DESIGN + GRADES + ITEMS


def parse(text, file=FILE):
    return parse_protocol(text, "mine.toml", beside=lambda _name: file)


def refusal(text, file=FILE):
    with pytest.raises(InputError) as caught:
        make_plan(parse(text, file), "P01", 1)
    return str(caught.value)


def test_each_condition_has_the_cells_of_its_table():
    protocol = parse(TEXT)
    plan = make_plan(protocol, "P01", 1)
    shown = {}
    for trial in plan.trials:
        if not trial.catch:
            (stimulus,) = trial.stimuli
            assert trial.asked == (0, len(stimulus.masks))
            shown[trial.condition, stimulus.text] = to_braille(stimulus.masks)
    assert shown == {
        ("g1", "chat"): "⠉⠓⠁⠞",
        ("g2", "chat"): "⠡⠁⠞",
        ("g1", "the child"): "⠞⠓⠑⠀⠉⠓⠊⠇⠙",
        ("g2", "the child"): "⠮⠀⠡",
        ("g1", "people"): "⠏⠑⠕⠏⠇⠑",
        ("g2", "people"): "⠏",
    }
    assert {t.condition: t.stimuli[0].table for t in plan.trials} == {"g1": G1, "g2": G2}
    again = Plan.from_json(plan.to_json())
    assert again == plan
    check_plan(protocol, again)
    assert [protocol.columns_of(t.item)["kind"] for t in plan.trials if t.catch] == ["", ""]


def test_a_plan_with_the_table_of_another_condition_is_refused():
    protocol = parse(TEXT)
    text = make_plan(protocol, "P01", 1).to_json().replace(G1, G2)
    with pytest.raises(InputError, match="trial 1 differs in its stimuli"):
        check_plan(protocol, Plan.from_json(text))


def test_groups_may_have_a_table_each():
    protocol = parse(TEXT.replace('"grade"', '"grade"\nbetween = true'))
    tables = {
        trial.stimuli[0].table
        for who in ("P01", "P02")
        for trial in make_plan(protocol, who, 1).trials
    }
    assert tables == {G1, G2}


def test_words_are_drawn_by_their_length_in_print():
    rule = '[items]\nfile = "words.txt"\nrule = "words"\nlength = 4\n'
    text = HEAD + '[display]\ntable = "en-ueb-g2.ctb"\n' + DESIGN + rule
    trials = make_plan(parse(text, "chat\nthe\nmore\npeople\nthem\nbone\n"), "P01", 1).trials
    assert {t.stimuli[0].text for t in trials} - {""} == {"chat", "more", "them", "bone"}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ((G2, "en-ueb-g9.ctb"), "there is no braille table 'en-ueb-g9.ctb'; the nearest are"),
        ((G2, "../x.ctb"), "table is '../x.ctb'; it must be the name of a braille table"),
        (("blocks = 1", "reorder = true"), "reorder is of cells, and where table is given"),
        (("[practice]", '[keys]\n"#" = "3456"\n[practice]'), "keys. spell cells, and where"),
        (("[practice]", "[rules]\neach_letter = 1\n[practice]"), "each_letter counts cells"),
        (("12 o'clock", "ж"), "'ж' has 'ж', which the table en-ueb-g1.ctb does not know"),
        (("12 o'clock", " "), "a text is empty"),
        (("12 o'clock", "chat"), "strings have 'chat', which the test shows"),
        (("12 o'clock", "a" * 90), r"\[practice\] has a line of 91 cells, lead_cells"),
        ((GRADES, GRADES.replace(f', table = "{G1}"', f', table = "{G1}", dot_row = 1')), "same"),
        ((HEAD, VBD_HEAD), "the VBD's row 1 shows dots 1 and 4 only"),
        (
            (GRADES, f'[[conditions]]\nname = "a"\ntable = "{G1}"\n[[conditions]]\nname = "b"\n'),
            "number 2 has no table, and others have",
        ),
        (
            (DESIGN, '[design]\nkind = "combinations"\ncharacters = ["a"]\nlength = 1\n'),
            r"\[items\] is of kind = 'items'",
        ),
        (
            (ITEMS, '[items]\nrule = "strings"\ncharacters = ["a"]\nlength = 1\ncount = 1\n'),
            "rule is 'strings', which draws cells",
        ),
        (
            (
                DESIGN + GRADES + ITEMS,
                GRADES + '[design]\nkind = "combinations"\ncharacters = ["a"]\nlength = 1\n',
            ),
            "kind is 'combinations', which shows cells",
        ),
    ],
)
def test_what_does_not_go_with_a_table_is_refused_in_a_sentence(change, said):
    assert change[0] in TEXT
    sentence = refusal(TEXT.replace(*change))
    assert "\n" not in sentence
    assert re.search(said, sentence), sentence


@pytest.mark.parametrize(
    ("typed", "answer"),
    [
        ("the child", "⠮⠀⠡"),
        ("The  Child", "⠮⠀⠡"),
        ("the chat", "⠮⠀⠡⠁⠞"),
        ("?", "???"),
        ("the?", "⠮?"),
        ("⠮⠀⠉", "⠮⠀⠉"),
        ("⠮??", "⠮??"),
    ],
)
def test_answers_are_texts_or_cells(typed, answer):
    assert parse_text(typed, "the child", cells_of("the child", G2), G2) == answer


def test_a_question_mark_that_was_shown_is_read_as_such():
    cells = cells_of("what?", G1)
    assert parse_text("what?", "what?", cells, G1) == to_braille(cells)


@pytest.mark.parametrize(("typed", "said"), [("  ", "nothing was typed"), ("ж", "does not know")])
def test_what_is_no_answer_is_told(typed, said):
    with pytest.raises(ValueError, match=said):
        parse_text(typed, "chat", cells_of("chat", G2), G2)


def test_a_session_that_was_planned_needs_no_table_any_more():
    text = TEXT.replace(G2, "gone.ctb")
    assert parse_protocol(text, "mine.toml", planned=True, beside=lambda _name: FILE).written
    with pytest.raises(InputError, match=r"there is no braille table 'gone\.ctb'"):
        parse(text)


def test_a_session_is_scored_by_what_was_shown(tmp_path):
    (tmp_path / "mine.toml").write_text(TEXT)
    (tmp_path / "items.csv").write_text(FILE)
    plan = make_plan(parse(TEXT), "P01", 1)
    wrong = {"g1": "chit", "g2": "?"}
    lines = [
        wrong[t.condition] if t.stimuli[0].text == "chat" else t.stimuli[0].text or "?"
        for t in plan.trials
    ]
    fast = Conditions(fast=True, hand="sweep:200")
    folder = tmp_path / "S"
    session = Session.create(tmp_path / "mine.toml", "P01", folder=folder, seed=1, conditions=fast)
    session.run(lines)
    assert json.loads((folder / "session.json").read_text())["versions"]["liblouis"]
    found = {(r["condition"], r["text"]): r for r in rows(load(folder)) if r["catch"] == ""}
    assert found["g2", "people"]["presented"] == found["g2", "people"]["answered"] == "⠏"
    assert [r["correct"] for key, r in found.items() if key[1] != "chat"] == [1, 1, 1, 1]
    assert found["g1", "chat"]["answered"] == "⠉⠓⠊⠞"
    assert found["g2", "chat"]["answered"] == "???"
    assert {r["table"] for r in found.values()} == {G1, G2}
    assert {r["item_kind"] for r in found.values()} == {"word", "two"}
    write(load(folder), tmp_path / "set")
    (table,) = (tmp_path / "set").rglob("*_beh.tsv")
    with table.open() as file:
        texts = {row["text"] for row in csv.DictReader(file, delimiter="\t")}
    assert texts == {"chat", "people", "the child", "n/a"}
