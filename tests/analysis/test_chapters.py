"""Whole analyses: of sessions, of tables of trials, of scores."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from tests.sessions.sittings import COMPARED, MINI, Session
from tests.tiers import heavy
from vbraille.analysis import analyse, analyse_scores
from vbraille.analysis.chapters import Options, analyse_study, compare_scores
from vbraille.analysis.input.study import load_scores, load_study
from vbraille.analysis.input.trials import written
from vbraille.analysis.report.totext import to_json
from vbraille.analysis.report.written import write_report
from vbraille.analysis.results import to_csv as frame_to_csv
from vbraille.errors import InputError
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.export import rows, to_csv
from vbraille.sessions.record.folder import load
from vbraille.sessions.session import Session as Sitting

CONDITIONS = """
[[conditions]]
name = "T0"
texture = 0.0
[[conditions]]
name = "T100"
texture = 1.0
"""
TRIALS = """participant,condition,presented,answered,duration_s,finger
A,T0,ab,ab,3,left
A,T0,cd,c?,4,left
A,T100,ab,ab,2,left
B,T0,ab,aa,5,right
B,T100,cd,cd,3,right
B,T100,ab,ab,4,right
C,T0,ab,,2,left
C,T0,cd,cd,2,left
C,T100,cd,ad,1,left
"""


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Two participants who read four characters in two conditions, one who compares widths."""
    folder = tmp_path_factory.mktemp("sessions")
    for number, who in enumerate(("P2", "P10"), 1):
        Session(folder / f"read-{who}", MINI + CONDITIONS, who, seed=number).sit(noise=0.6)
    Session(folder / "compared", COMPARED, "P2").sit()
    return folder


@pytest.fixture
def table(tmp_path):
    """A table of trials."""
    path = tmp_path / "trials.csv"
    path.write_text(TRIALS)
    return path


def tables(results):
    return {table.name: table for table in results.result_tables()}


def test_sessions_of_all_kinds_together(sessions):
    study = load_study([sessions / name for name in ("read-P10", "compared", "read-P2")])
    results = analyse_study(study, Options())
    found = tables(results)
    assert [chapter.title for chapter in results.chapters] == [
        "Other measures",
        "Legibility",
        "Characters and strings",
        "Confusions",
        "Errors",
        "Over time",
        "How strings were read",
        "Which of two was chosen",
        "Sources",
    ]
    assert results.shown is None
    assert "2 protocols" in results.question[1]
    assert all(len(table) for table in results.result_tables())
    rows = [(row["participant"], row["condition"]) for row in found["legibility"].records()]
    assert rows == [("P2", "T0"), ("P2", "T100"), ("P10", "T0"), ("P10", "T100")]
    assert all(row["timed"] == row["trials"] for row in found["legibility"].records())
    assert len(found["trajectories"].rows) == len(study.trials)
    assert {row["parameter"] for row in found["choices"].records()} == {"dot_width_mm"}
    about = dict(results.about)
    assert "seed 2, model vbd" in about["Session read-P10"]
    assert "numba" in about["Versions of compared, read-P2, read-P10"]
    assert results.excluded == ()
    assert any("no data about people" in warning for warning in results.warnings)
    names = [figure.name for figure in results.figures()]
    assert len(names) == len(set(names)) >= 8
    assert all(figure.table in found for figure in results.figures())


def test_intervals_of_ratings_end_where_the_protocols_scale_does(tmp_path):
    """Three people put all at an end, but for one of them: Student's interval would go beyond."""
    rating = '[question]\nkind = "rating"\nscale = "r"\nleast = 1\nmost = 7\n'
    toml = f"{MINI}{rating}confidence = {{ least = 1, most = 4 }}\n"
    protocol, paths = parse_protocol(toml, "test"), []
    for number, line in enumerate(("7; 1", "7; 1", "5; 2"), 1):
        folder, answers = tmp_path / f"s{number}", tmp_path / f"answers{number}"
        answers.write_text(f"{line}\n" * 4, encoding="utf-8")
        conditions = Conditions(fast=True, hand="sweep:150")
        Sitting.create(
            protocol, f"P{number}", folder=folder, seed=number, conditions=conditions
        ).run(str(answers))
        paths.append(folder)
    found = tables(analyse_study(load_study(paths), Options()))
    (row,) = found["ratings"].records()
    assert 1 < row["low"] < row["mean"] < row["high"] == 7
    (row,) = found["confidence"].records()
    assert row["low"] == 1 < row["mean"] < row["high"] < 4


def test_durations_are_those_of_the_export(sessions):
    study = load_study([sessions / "read-P2"])
    row = tables(analyse_study(study, Options()))["legibility"].records()[0]
    (sitting,) = study.sessions
    own = [r["duration_s"] for r in sitting.rows if r["condition"] == row["condition"]]
    assert row["duration_mean_s"] == pytest.approx(sum(own) / len(own))


def test_the_order_in_which_things_are_given_is_of_no_matter(sessions, table):
    paths = [table, *(sessions / name for name in ("read-P10", "compared", "read-P2"))]
    texts = {"".join(to_json(analyse(order))) for order in (paths, paths[::-1])}
    assert len(texts) == 1


def test_a_table_has_what_a_table_can_tell(table):
    results = analyse_study(load_study([table]), Options())
    found = tables(results)
    assert "trajectories" not in found  # there is none
    about = dict(results.about)
    assert results.excluded == ("1 trial of trials.csv: no answer",)
    assert about["File trials.csv"].startswith("9 rows, SHA-256 ")
    json.loads("".join(to_json(results)))


def test_other_columns_are_kept_and_compared_by(table):
    study = load_study([table])
    lines = frame_to_csv(written(study.trials)).splitlines()
    assert lines[0].endswith("duration_s,finger")
    assert lines[1] == "A,trials.csv,,T0,,1,⠁⠃,,⠁⠃,1,3.0,left"
    assert len(lines) == 1 + 8
    found = tables(analyse_study(study, Options(factors=("finger",))))
    assert {"left", "right"} <= {row["of"] for row in found["primary"].records()}
    assert any(
        "not as planned" in sentence
        for sentence in analyse_study(study, Options(factors=("finger",))).question
    )
    with pytest.raises(InputError, match=r"no column 'fingre' to compare by; there are condition"):
        analyse_study(study, Options(factors=("fingre",)))


def test_trials_written_are_trials_read(table, tmp_path):
    study = load_study([table])
    again = tmp_path / "again.csv"
    again.write_text(frame_to_csv(written(study.trials)))
    first, second = (analyse([path]).tables for path in (table, again))
    for name in first.keys() - {"sources"}:
        of = first[name]
        pd.testing.assert_frame_equal(of, second[name])


def test_from_python_tables_are_data_frames(table):
    results = analyse([str(table)], exclude={"C": "fell asleep"}, factors=["finger"], marks=[2])
    frame = results.table("legibility")
    assert frame is results.tables["legibility"]
    assert frame["correct"].tolist() == [1, 1, 0, 2]
    assert [str(frame[name].dtype) for name in ("participant", "trials", "low")] == [
        "str", "Int64", "float64"
    ]  # fmt: skip
    assert results.trials is not None
    assert len(results.trials) == 6
    with pytest.raises(InputError, match=r"there is no table 'legible'; there are primary, "):
        results.table("legible")


def test_from_python_scores_are_compared(tmp_path):
    path = tmp_path / "scores.csv"
    lines = [
        "participant,texture,score",
        "A,T0,1",
        "A,T1,2",
        "B,T0,1",
        "B,T1,4",
        "C,T0,2",
        "C,T1,2",
    ]
    path.write_text("\n".join(lines))
    rows = analyse_scores(path, correction="none").table("primary").to_dict("records")
    (test,) = [row for row in rows if row["kind"] == "difference"]
    assert (test["participants"], test["value"]) == (3, pytest.approx(-4 / 3))
    with pytest.raises(ValueError, match="correction is 'tukey'"):
        analyse_scores(path, correction="tukey")


def test_who_is_left_out_is_named_with_the_reason(table):
    study = load_study([table], exclude={"C": "fell asleep"})
    results = analyse_study(study, Options())
    assert {row["participant"] for row in tables(results)["legibility"].records()} == {"A", "B"}
    assert "participant C: fell asleep" in results.excluded
    with pytest.raises(InputError, match="no participant 'D' with answered trials; there are A, B"):
        load_study([table], exclude={"D": "is not there"})


def test_a_simulated_reader_is_told_of_when_its_trials_come_as_a_table(sessions, tmp_path):
    path = tmp_path / "exported.csv"
    path.write_text(to_csv(rows(load(sessions / "read-P2"))))
    (warning,) = load_study([path]).warnings
    assert warning.startswith("A simulated reader answered in exported.csv: that is no data")
    path.write_text(path.read_text().replace("simulated:0.6", "typed"))
    assert load_study([path]).warnings == ()
    path.write_text(path.read_text().replace("typed", "answers.txt"))
    assert load_study([path]).warnings == ("Answers came from a file in exported.csv.",)


def test_only_one_protocol(sessions):
    paths = [sessions / "read-P2", sessions / "compared"]
    study = load_study(paths, protocol="widths")
    assert study.trials is None
    assert [sitting.head["protocol"] for sitting in study.sessions] == ["widths"]
    results = analyse_study(study, Options())
    assert [chapter.title for chapter in results.chapters] == [
        "Primary analysis", "Which of two was chosen", "Sources"
    ]  # fmt: skip
    assert "protocols other than widths" in results.excluded[-1]
    with pytest.raises(InputError, match="no protocol 'letters'"):
        load_study(paths, protocol="letters")


def test_several_protocols_are_told_of_and_kept_apart(sessions, tmp_path):
    Session(tmp_path / "one", MINI, "P2").sit()
    study = load_study([tmp_path / "one", sessions / "read-P2"])
    assert not any("protocols" in warning for warning in study.warnings)
    other = Session(tmp_path / "other", MINI.replace('"mini"', '"other"'), "P2")
    with pytest.raises(InputError, match="other: no answered trial, and so nothing to analyse"):
        load_study([other.folder])
    other.sit()
    study = load_study([tmp_path / "one", other.folder])
    assert any("2 protocols, mini, other" in warning for warning in study.warnings)
    found = tables(analyse_study(study, Options()))
    for name in ("legibility", "trajectories", "patterns"):
        assert {row["condition"] for row in found[name].records()} == {"mini", "other"}


def test_a_session_broken_off_is_told_of(tmp_path):
    session = Session(tmp_path / "broken", MINI, "P1")
    session.sit(("read:", "a"), ("cue: trial 2", "stop"))
    study = load_study([session.folder])
    assert any("broken is not whole: broken off in trial 2" in w for w in study.warnings)
    assert len(study.trials) == 1
    assert "trials of broken: no answer" in study.left_out[0].what + ": " + study.left_out[0].reason
    assert tables(analyse_study(study, Options()))["legibility"].records()[0]["trials"] == 1


def test_a_duration_with_a_pause_in_it_is_not_used(tmp_path):
    session = Session(tmp_path / "paused", MINI, "P1")
    session.sit(("cue: trial 1", "pause"), ("pause", ""), ("read:", "a"), ("cue: trial 2", "stop"))
    study = load_study([session.folder])
    (told,) = [row for row in study.sessions[0].rows if row["answered"]]
    assert told["paused_s"] > 0
    assert told["duration_s"] > 0
    assert [left.reason for left in study.left_out] == [
        "no answer",
        "the trial was paused meanwhile",
    ]
    found = tables(analyse_study(study, Options()))
    (row,) = found["legibility"].records()
    assert (row["trials"], row["timed"]) == (1, 0)
    (row,) = found["trajectories"].records()
    assert row["note"].startswith("it was paused for ")
    assert row["duration_s"] is None


def test_a_damaged_session_is_analysed_as_far_as_it_is_whole(tmp_path):
    session = Session(tmp_path / "hurt", MINI, "P1")
    session.sit()
    trace = next(session.folder.glob("trace-*.gz"))
    content = bytearray(trace.read_bytes())
    content[len(content) // 2] ^= 1
    trace.write_bytes(content)
    study = load_study([session.folder])
    assert len(study.faults) == 1
    assert "does not match its checksum" in study.faults[0]
    found = tables(analyse_study(study, Options()))
    assert found["legibility"].records()[0]["trials"] == len(study.trials)
    assert found["trajectories"].records()[-1]["note"].endswith("is damaged before the end of it")


def test_nothing_is_given_twice(table):
    with pytest.raises(InputError, match="is there twice; give it once"):
        load_study([table, table])


def test_scores(tmp_path):
    path = tmp_path / "scores.csv"
    path.write_text(
        "participant,texture,score\nA,0,1\nA,1,2\nB,0,3\nB,1,5\nC,0,2\nC,1,\nD,0,1\nD,1,1.5\n"
    )
    scores, about = load_scores(path)
    results = compare_scores(scores, about, Options(correction="holm"))
    assert list(tables(results)) == ["primary", "sources"]
    assert results.excluded == ("participant C, where it needs all: nothing in 1",)
    assert "Holm's step-down" in results.methods
    rows = tables(results)["primary"].records()
    (effect,) = [row for row in rows if row["kind"] == "effect"]
    (test,) = [row for row in rows if row["kind"] == "difference"]
    assert effect["statistic"] == pytest.approx(test["statistic"] ** 2)  # two levels
    assert test["participants"] == 3


def test_options_check_themselves():
    with pytest.raises(ValueError, match="correction is 'bonferoni'"):
        replace(Options(), correction="bonferoni")


@heavy  # all of two reports; that tables and figures are the same again is tested of each
@pytest.mark.no_cover
def test_the_same_input_gives_the_same_bytes(sessions, tmp_path):
    """Here, and in a process whose sets have another order, with the sessions given in another."""
    paths = [sessions / "read-P2", sessions / "compared"]
    here, there = tmp_path / "here", tmp_path / "there"
    again = subprocess.Popen(
        [sys.executable, "-m", "vbraille", "analyse", *reversed(paths), "--out", there],
        stdout=subprocess.DEVNULL,
        env={**os.environ, "PYTHONHASHSEED": "1"},
    )
    study = load_study(paths)
    write_report(analyse_study(study, Options()), here)
    assert again.wait() == 0
    written = [
        {path.relative_to(out): path.read_bytes() for path in out.rglob("*") if path.is_file()}
        for out in (here, there)
    ]
    assert written[0] == written[1]
    assert {path.suffix for path in written[0]} == {".html", ".json", ".csv", ".svg"}
    assert Path("trials.csv") in written[0]


def test_a_duration_of_an_early_answer_is_not_used(tmp_path):
    session = Session(tmp_path / "early", MINI, "P1", hand="sweep:10")
    notes = [("note", "note x")] * 9
    session.sit(
        ("cue: trial 1", "note x"), *notes, ("note", "c"), ("no answer", "c"),
        ("read:", "c"), ("cue: trial 3", "stop"),
    )  # fmt: skip
    study = load_study([session.folder])
    first, second = [row for row in study.sessions[0].rows if row["answered"]]
    assert (first["early"], second["early"]) == (1, 0)
    assert first["duration_s"] > 0
    assert [left.reason for left in study.left_out] == [
        "no answer",
        "it was answered before it was read to its end",
    ]
    found = tables(analyse_study(study, Options()))
    (row,) = found["legibility"].records()
    assert (row["trials"], row["timed"]) == (2, 1)
    early, timed = found["trajectories"].records()
    assert early["note"] == "it was answered before it was read to its end"
    assert (early["duration_s"], timed["note"]) == (None, "")


def test_a_cell_of_a_key_is_named_by_it(tmp_path):
    toml = MINI.replace("[keys]", '[keys]\n"é" = "4"\nr = "0"')
    toml = toml.replace('["a", "c", "4", "0"]', '["a", "é", "c"]')
    session = Session(tmp_path / "s", toml)
    session.sit()
    found = tables(analyse_study(load_study([session.folder]), Options()))
    named = [(row["name"], row["braille"]) for row in found["characters"].records()]
    assert named == [("a", "⠁"), ("c", "⠉"), ("é (dot 4)", "⠈")]
    assert {row["name"] for row in found["strings"].records()} == {"a", "é", "c"}
    assert "é (dot 4)" in found["confusion_characters"].frame["presented"].tolist()
    assert "é" in found["trajectories"].frame["presented"].tolist()
