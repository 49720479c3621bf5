"""``vbraille analyse``: what is printed and written, and what cannot be used."""

import json
import re
from pathlib import Path

import pytest

from tests.cli.test_bad_input import refused
from tests.sessions.sittings import MINI, Session
from tests.tiers import heavy

TRIALS = "participant,condition,presented,answered\n{}"
GOOD = TRIALS.format("A,x,ab,ab\nA,y,ab,a?\nB,x,ab,ac\nB,y,cd,cd\n")


@pytest.fixture
def room(tmp_path, monkeypatch):
    """A directory with tables in it."""
    (tmp_path / "good.csv").write_text(GOOD)
    (tmp_path / "none.csv").write_text(TRIALS.format(""))
    (tmp_path / "blank.csv").write_text("")
    (tmp_path / "cells.csv").write_text(TRIALS.format("A,x,ab,ab\nA,x,ab,a9\n"))
    (tmp_path / "columns.csv").write_text("subject,condition,presented,response\n1,x,a,a\n")
    (tmp_path / "short.csv").write_text(TRIALS.format("A,x,ab\n"))
    (tmp_path / "scores.csv").write_text("participant,t,score\nA,0,1\nA,1,2\nB,0,2\nB,1,4\n")
    (tmp_path / "words.csv").write_text("participant,t,score\nA,0,one\n")
    (tmp_path / "bare.csv").write_text("participant,score\nA,1\n")
    (tmp_path / "picture.csv").write_bytes(b"\x89PNG\r\n\x1a\n")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes").write_text("mine")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("room")
def test_results_are_printed_a_row_a_line(call):
    said = call("analyse", "good.csv")
    assert (said.code, said.err) == (0, "")
    lines = said.out.splitlines()
    assert lines[0] == "Legibility of strings by condition"
    assert any("Data; told 4 trials of 2 participants in 2 conditions" in line for line in lines)
    assert any(line.startswith("found: Of fewer than 3 participants") for line in lines)
    first = lines[
        lines.index("table legibility: Legibility and duration, by participant and condition") + 1
    ]
    assert first.startswith("participant A; condition x; trials 1; correct 1; legibility 100.0 %;")
    assert first.endswith("no duration is known")
    assert not any("no test has" in line for line in lines)


@pytest.mark.usefixtures("room")
def test_results_as_json(call):
    said = call("analyse", "good.csv", "--json")
    assert (said.code, said.err) == (0, "")
    found = json.loads(said.out)
    assert [row["correct"] for row in found["tables"]["legibility"]["rows"]] == [1, 0, 0, 1]


@pytest.mark.usefixtures("room")
def test_progress_counts_what_is_read_and_then_what_is_worked_out(call):
    (more := Path("more.csv")).write_text(TRIALS.format("C,x,ab,ab\n"))
    said = call("analyse", "good.csv", more, "--json", "--verbose")
    told = [line.split(",")[0] for line in said.err.splitlines() if "percent" in line]
    assert told == ["20 percent", "50 percent", "70 percent", "100 percent"]
    assert json.loads(said.out)["tables"]


@pytest.mark.parametrize(
    "data",
    [
        "--scores scores.csv",
        # Which figures there are is tested where they are made; to draw them takes seconds.
        pytest.param("good.csv --marks 0,1", marks=heavy),
    ],
)
def test_a_report_is_written(call, room, data):
    said = call("analyse", *data.split(), "--out", "new/report", "--seed", "7")
    assert (said.code, said.out, said.err) == (0, "written: new/report/report.html\n", "")
    page = (room / "new" / "report" / "report.html").read_text()
    assert page.count("<table") == 1
    sources = (room / "new" / "report" / "tables" / "sources.csv").read_text()
    assert ("random draws with seed 7" in sources) == ("--marks" in data)


@pytest.mark.usefixtures("room")
def test_scores(call):
    said = call("analyse", "--scores", "scores.csv", "--correction", "bonferroni")
    assert (said.code, said.err) == (0, "")
    assert "Bonferroni's correction" in said.out
    assert "nothing is tested" in said.out


@pytest.mark.usefixtures("room")
@pytest.mark.parametrize(
    ("correction", "title"), [((), "Holm's step-down"), (("none",), "no correction")]
)
def test_t_tests_are_corrected_unless_none_is_asked_for(call, room, correction, title):
    rows = [
        f"{who},{t},{len(who) + n * n + t * n}" for n, who in enumerate("ABCDE") for t in range(3)
    ]
    (room / "three.csv").write_text("participant,t,score\n" + "\n".join(rows) + "\n")
    chosen = ("--correction", *correction) if correction else ()
    said = call("analyse", "--scores", "three.csv", "--json", *chosen)
    found = json.loads(said.out)
    assert title in found["methods"]
    rows = found["tables"]["primary"]["rows"]
    (effect,) = [row for row in rows if row["kind"] == "effect"]
    tests = [row for row in rows if row["kind"] == "difference"]
    assert len(tests) == 3
    for row in tests:
        assert row["low"] < row["value"] < row["high"]
        assert row["p_corrected"] >= max(row["p"], effect["p_corrected"])
    most = max(tests, key=lambda row: row["p"])
    least = min(tests, key=lambda row: row["p"])
    if not correction:
        assert least["p_corrected"] == pytest.approx(max(3 * least["p"], effect["p"]))
        assert most["p_corrected"] >= most["p"]


def test_a_damaged_session_is_a_fault_that_is_told(call, tmp_path):
    session = Session(tmp_path / "hurt", MINI, "P1")
    session.sit()
    (session.folder / "trace-001.gz").unlink()
    said = call("analyse", session.folder)
    assert said.code == 1
    assert (
        said.err
        == "vbraille: analysed is what is whole; hurt: trace-001.gz is damaged, it is gone\n"
    )
    assert "warning: Damaged, and analysed as far as it is whole: hurt" in said.out
    assert "table legibility" in said.out


@pytest.mark.parametrize(
    ("arguments", "pattern"),
    [
        ("", "give directories of sessions, or a table of trials, or --scores with a table"),
        ("good.csv --scores scores.csv", "give directories of sessions, or a table of trials, or"),
        ("no.csv", r"there is no no\.csv; give the directory of a session or a CSV file"),
        ("good.csv good.csv", r"good\.csv is there twice; give it once"),
        ("full", "full is not the directory of a session"),
        ("picture.csv", r"picture\.csv is a PNG image; give a CSV file or"),
        ("none.csv", r"none\.csv: no answered trial, and so nothing to analyse"),
        ("blank.csv", r"blank\.csv is empty; its first line must have the names of the columns"),
        ("cells.csv", r"cells\.csv line 3: answered is 'a9', and '9' is no cell; give letters"),
        ("columns.csv", "there is no participant; there is no answered; rename"),
        ("short.csv", r"short\.csv line 2 has 3 values, and the first line has 4 columns; mend"),
        ("good.csv --factors textur", "no column 'textur' to compare by; there are condition,"),
        ("good.csv --factors a,a", "'a,a' is no list of different names"),
        ("good.csv --exclude A", "'A' is not NAME=VALUE"),
        ("good.csv --exclude A=", "--exclude A has no reason; give one: --exclude A=REASON"),
        ("good.csv --exclude C=late", "no participant 'C' with answered trials; there are A, B"),
        ("good.csv --protocol x", "there is no protocol 'x' with answered trials"),
        ("good.csv --marks 9,4", "'9,4' are no counts that grow, such as 4,9"),
        ("good.csv --marks=-1", "'-1' are no counts that grow, such as 4,9"),
        ("good.csv --correction best", "invalid choice: 'best'"),
        ("good.csv --out full", "full is there already; give a new directory with --out"),
        ("good.csv --out good.csv/x", "good.csv/x cannot be written: "),
        ("--scores good.csv", "there is no score; rename or add"),
        ("--scores words.csv", r"words\.csv line 2: score is 'one'; give a number, or nothing"),
        ("--scores bare.csv", r"bare\.csv has no column but participant and score; add one"),
        ("--scores scores.csv --factors t", "--factors is of trials, not of scores; leave it out"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(call, room, arguments, pattern):
    before = sorted(room.rglob("*"))
    assert re.search(pattern, refused(call("analyse", *arguments.split())))
    assert sorted(room.rglob("*")) == before
