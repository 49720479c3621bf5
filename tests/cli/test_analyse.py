"""``vbraille analyse``: what is printed and written, and what cannot be used."""

import csv
import json
import subprocess

import pytest

from tests.analysis.making import CASES, to_csv, trials_of

SHARES = {
    "A": [20, 22, 25, 18, 24, 23],
    "B": [17, 21, 22, 18, 19, 22],
    "C": [15, 20, 21, 12, 20, 16],
}


@pytest.fixture
def room(tmp_path, monkeypatch):
    """A directory with tables in it."""
    (tmp_path / "good.csv").write_text(to_csv(trials_of(SHARES)))
    (tmp_path / "none.csv").write_text("participant,condition,presented,answered\n")
    (tmp_path / "open.csv").write_text("participant,condition,presented,answered\nA,x,a,\n")
    (tmp_path / "blank.csv").write_text("")
    (tmp_path / "columns.csv").write_text("subject,condition,presented,response\n1,x,a,a\n")
    (tmp_path / "long.csv").write_text("participant,presented,answered\nA,a,a\nA,a,a,a\n")
    (tmp_path / "scores.csv").write_text("participant,t,score\nA,0,1\nA,1,2\nB,0,2\nB,1,4\n")
    (tmp_path / "words.csv").write_text("participant,t,score\nA,0,one\n")
    (tmp_path / "bare.csv").write_text("participant,score\nA,1\n")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "notes").write_text("mine")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.usefixtures("room")
def test_a_line_for_each_thing(call):
    said = call("analyse", "good.csv")
    assert (said.code, said.err) == (0, "")
    title, *lines = said.out.splitlines()
    assert title == "Legibility of strings, 6 people"
    assert sum(line.startswith("Mean ") for line in lines) == 3
    assert sum("difference is shown" in line for line in lines) == 3


@pytest.mark.usefixtures("room")
def test_json_has_the_tables(call):
    said = call("analyse", "good.csv", "--json")
    tables = json.loads(said.out)["tables"]
    assert [row["correct"] for row in tables["legibility"]][:3] == [20, 17, 15]
    assert tables["legibility"][0]["duration_mean_s"] is None
    assert len(tables["primary_pairs"]) == 3


def test_a_report_is_written_whole(call, room):
    said = call("analyse", "good.csv", "--out", "new/report")
    assert (said.code, said.out) == (0, "report: new/report/report.html\n")
    folder = room / "new/report"
    tables = {path.stem for path in folder.glob("tables/*.csv")}
    assert {"legibility", "averages", "characters", "confusion_characters", "trials"} <= tables
    for path in folder.glob("figures/*.svg"):
        assert "<svg" in path.read_text()
    with (folder / "codebook.csv").open(encoding="utf-8") as file:
        told = {(row["table"], row["column"]): row["meaning"] for row in csv.DictReader(file)}
    for path in folder.glob("tables/*.csv"):
        header = path.read_text(encoding="utf-8").partition("\n")[0].split(",")
        assert all(told[path.stem, column] for column in header)
    assert json.loads((folder / "results.json").read_text())["sentences"]
    page = (folder / "report.html").read_text()
    assert "Every person is in the tests." in page
    assert '<img src="figures/means.svg" alt="Mean legibility' in page
    again = call("analyse", "good.csv", "--out", "new/other")
    assert again.code == 0
    for path in folder.rglob("*.*"):
        assert path.read_bytes() == (room / "new/other" / path.relative_to(folder)).read_bytes()


@pytest.mark.parametrize("file", ["thesis31.csv", "F25-left-out-dprime.csv", "name.csv"])
def test_a_report_is_two_pages_at_most(call, file, tmp_path):
    assert call("analyse", CASES / file, "--out", tmp_path / "report").code == 0
    printed = tmp_path / "report.pdf"
    chromium = ["chromium", "--headless", "--no-sandbox", "--no-pdf-header-footer"]
    page = tmp_path / "report/report.html"
    subprocess.run([*chromium, f"--print-to-pdf={printed}", page], check=True, capture_output=True)
    assert 1 <= printed.read_bytes().count(b"/Type /Page\n") <= 2


@pytest.mark.usefixtures("room")
def test_scores(call):
    said = call("analyse", "--scores", "scores.csv")
    assert said.code == 0
    assert "no test of fewer than 3 people" in said.out


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ("", "--scores"),
        ("good.csv --scores scores.csv", "--scores"),
        ("no.csv", "no.csv"),
        ("good.csv good.csv", "good.csv"),
        ("full", "full"),
        ("none.csv", "answer"),
        ("open.csv", "answer"),
        ("blank.csv", "blank.csv"),
        ("columns.csv", "participant"),
        ("long.csv", "line 3"),
        ("good.csv --factors textur", "textur"),
        ("good.csv --measure speed", "speed"),
        ("good.csv --exclude A", "A"),
        ("good.csv --exclude P01=", "P01"),
        ("good.csv --exclude C=late", "C"),
        ("good.csv --protocol x", "x"),
        ("good.csv --out full", "full"),
        ("good.csv --out good.csv/x", "good.csv/x"),
        ("--scores good.csv", "score"),
        ("--scores words.csv", "line 2"),
        ("--scores bare.csv", "bare.csv"),
        ("--scores scores.csv --factors t", "--factors"),
    ],
)
def test_what_cannot_be_used_is_one_sentence(call, room, arguments, named):
    before = sorted(room.rglob("*"))
    said = call("analyse", *arguments.split())
    assert (said.code, said.out, said.err.count("\n")) == (2, "", 1)
    assert said.err.startswith("vbraille: ")
    assert named in said.err
    assert sorted(room.rglob("*")) == before
