"""Sessions as their records have them, analysed as their protocols plan."""

from functools import partial

import pytest

from tests.analysis.making import to_csv
from vbraille.analysis import analyse, methods_of
from vbraille.errors import InputError
from vbraille.sessions.planning.loading import load_protocol, parse_protocol
from vbraille.sessions.planning.plan import make_plan
from vbraille.sessions.record import record
from vbraille.sessions.record.trials import rows

TEXTURES = """
name = "textures"
title = "Two letters at two textures"
model = "stress2"
[[factors]]
name = "texture"
levels = [{ name = "flat", texture = 0.0 }, { name = "rough", texture = 1.0 }]
[design]
kind = "combinations"
characters = ["a", "b", "c"]
length = 2
repeats = 2
catch = { every = 9, show = "blank" }
[practice]
trials = 2
strings = ["de", "fg"]
[analysis]
measure = "legibility"
catch_right = 0.5
participants = 4
"""


def sat(folder, protocol, person, answer, seed=1):
    """The file of a session in which each trial was answered."""
    plan = make_plan(protocol, person, seed)
    head = {"protocol": protocol.name, "order": plan.order, "group": plan.group}
    head |= {"session": plan.session, "fields": {}}
    path = folder / f"{person}-{protocol.name}.session"
    record.create(path, head, protocol.files, plan)
    kept = record.Record(path)
    conditions = {"device": "serial", "hand": "device", "answers": "typed"}
    kept.append("run", 0.0, conditions=conditions, answers="typed", versions={"vbraille": "1"})
    for number, trial in enumerate(plan.trials):
        kept.append("cue", 3.0 * number, trial, 1, stimulus=0)
        kept.append("answer", 3.0 * number + 2, trial, 1, answer=answer(number, trial))
    kept.append("end", 3.0 * number + 3, why="done", reason="")
    kept.close()
    return path


@pytest.fixture(scope="module")
def textures():
    return parse_protocol({"protocol.toml": TEXTURES.encode()}, "textures.toml")


def reader(share, caught=True):
    """Answers of a person who reads the given shares, in thirteenths, of each condition."""

    def answer(number, trial):
        if trial.catch:
            return "??" if caught else "⠁⠁"
        good = number * 5 % 13 < share[trial.condition]
        return trial.stimuli[0].cells if good else "⠿⠿"

    return answer


@pytest.fixture(scope="module")
def sessions(textures, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sessions")
    shares = [(6, 9), (4, 10), (7, 8), (5, 12)]
    people = [
        sat(folder, textures, f"P{n}", reader({"flat": flat, "rough": rough}, caught=n != 4), n)
        for n, (flat, rough) in enumerate(shares, 1)
    ]
    return [*people, sat(folder, textures, "P5", reader({"flat": 6, "rough": 9}), 5)]


def test_the_protocol_says_what_is_compared_and_who_is_left_out(sessions):
    analysis = analyse(sessions)
    assert analysis.title == "Legibility of strings, 4 people"
    (pair,) = analysis.result.pairs.to_dict("records")
    assert (pair["factor"], pair["first"], pair["second"]) == ("factor_texture", "flat", "rough")
    (left,) = analysis.left_out
    assert left.startswith("P4: 0 % of catch trials right")
    assert analysis.tables["legibility"]["trials"].to_list() == [18] * 8
    assert not any("departs" in text or "not as planned" in text for text in analysis.warnings)


def test_what_is_compared_otherwise_is_told(sessions):
    warnings = analyse(sessions, measure="characters").warnings
    assert any("legibility" in text for text in warnings)


def test_a_session_and_its_table_are_not_counted_twice(sessions, tmp_path):
    path = tmp_path / "export.csv"
    path.write_text(to_csv(rows(sessions[0])), encoding="utf-8")
    with pytest.raises(InputError, match="P1"):
        analyse([*sessions, path])
    copy = tmp_path / "copy.session"
    copy.write_bytes(sessions[1].read_bytes())
    with pytest.raises(InputError, match="P2"):
        analyse([*sessions, copy])


def test_an_exported_table_gives_the_same_numbers(sessions, tmp_path):
    paths = []
    for session in sessions:
        paths.append(tmp_path / f"{session.stem}.csv")
        paths[-1].write_text(to_csv(rows(session)), encoding="utf-8")
    ours = analyse(sessions, exclude={"P4": "asleep"})
    theirs = analyse(paths, factors=["factor_texture"], exclude={"P4": "asleep"})
    for table in ("primary_pairs", "legibility", "characters", "confusion_pairs"):
        assert ours.tables[table].equals(theirs.tables[table])


def test_methods_are_counted_in_the_record(sessions):
    text = " ".join(methods_of(sessions))
    assert text.startswith("5 people answered 40 trials each in 5 sessions of the protocol texture")
    assert "Strings had 2 cells." in text
    assert "Sessions had 2 trials of practice and 0 breaks." in text


@pytest.mark.parametrize(
    ("protocol", "answer", "title"),
    [
        ("detection", lambda number, *_: "no" if number % 3 else "yes", "Threshold"),
        ("orientation-coarse", lambda _, trial, asks: asks.right_answer(trial), "Share of right"),
    ],
)
def test_each_kind_of_protocol(protocol, answer, title, tmp_path):
    loaded = load_protocol(protocol)
    answers = partial(answer, asks=loaded.asks) if "orientation" in protocol else answer
    paths = [sat(tmp_path, loaded, f"P{n}", answers, n) for n in (1, 2, 3)]
    analysis = analyse(paths)
    assert analysis.title.startswith(title)
    analysis.write(tmp_path / "report")
    assert (tmp_path / "report/report.html").exists()
