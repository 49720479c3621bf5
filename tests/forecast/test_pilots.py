"""Pilots: a whole study with the simulated reader, every file of it marked."""

import csv
import pickle

import pytest

from tests.tiers import heavy
from vbraille.analysis import analyse
from vbraille.errors import InputError
from vbraille.forecast.pilots import MARK, PilotTask, conduct, mark_rows, marked, pilot
from vbraille.forecast.workers import Workers
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.running.reader import ReaderHabits

TEXT = """format = 1
name = "two"
title = "Two"
source = "ours"
model = "vbd"
[design]
kind = "combinations"
characters = ["a", "c"]
length = 1
[[conditions]]
name = "T0"
texture = 0.0
[[conditions]]
name = "T100"
texture = 1.0
"""
TWO = parse_protocol(TEXT, "two.toml")
HEAD = TEXT.partition("[design]")[0]
BY_THE_ANSWERS = f"""{HEAD}
[design]
kind = "choice"
parameter = "dot_width_mm"
values = [0.5, 3.0]
string = "a"
repeats = 2
[procedure]
kind = "quest"
step = 0.5
spread = [0.2, 0.5]
"""
IN_GROUPS = f"""{HEAD}
[question]
kind = "rating"
ask = "How rough?"
scale = "roughness"
least = 1
most = 5
confidence = {{ least = 1, most = 3 }}
[[factors]]
name = "texture"
levels = [{{ name = "flat", texture = 0.0 }}, {{ name = "rough", texture = 1.0 }}]
[[factors]]
name = "gap"
between = true
levels = [{{ name = "near", cell_gap_mm = 3.0 }}, {{ name = "far", cell_gap_mm = 4.0 }}]
[design]
kind = "list"
strings = ["a"]
repeats = 1
blocks = 1
"""


def piloted(folder, **changed):
    given = {"habits": ReaderHabits(0.4), "seed": 3, "workers": Workers()} | changed
    protocol = given.pop("protocol", TWO)
    return pilot(protocol, given.pop("participants", 2), folder, **given)


def test_titles_and_rows_are_marked(tmp_path):
    table = tmp_path / "trials.csv"
    table.write_text("participant,condition,presented,answered\nP1,T0,ab,ab\nP1,T1,ca,c?\n")
    results = marked(analyse([table]))
    assert MARK in results.title
    assert all(MARK in table.title for table in results.result_tables())
    assert all(MARK in figure.chart.title for figure in results.figures())
    assert mark_rows('a,b\n1,"x, y"\n') == f'a,b,"{MARK}"\n1,"x, y",yes\n'


def test_a_task_has_the_files_that_stand_beside_its_protocol(tmp_path):
    text = TEXT.replace('kind = "combinations"', 'kind = "items"')
    text = text.replace('characters = ["a", "c"]\nlength = 1\n', "")
    text += '[items]\nfile = "items.csv"\n'
    files = {"items.csv": "string\na\nc\n"}
    task = PilotTask(
        text, "two", "SIM001", 1, "simulated:0", "sweep:150", str(tmp_path / "SIM001"), files
    )
    assert conduct(pickle.loads(pickle.dumps(task))) == 4
    assert (tmp_path / "SIM001" / "items.csv").read_text() == files["items.csv"]


@heavy
def test_a_pilot_has_all_sessions_and_a_report_that_is_marked(tmp_path):
    report = piloted(tmp_path / "pilot")
    files = [path for path in report.rglob("*") if path.is_file()]
    texts = [path for path in files if path.suffix in (".csv", ".md", ".html", ".svg", ".json")]
    assert len(texts) > 10
    assert [path for path in texts if MARK not in path.read_text()] == []
    with (report / "trials.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 4
    assert {row["participant"] for row in rows} == {"SIM001", "SIM002"}
    with pytest.raises(InputError, match="has this pilot already"):
        piloted(tmp_path / "pilot")
    with pytest.raises(InputError, match="is there already"):
        piloted(tmp_path / "pilot", seed=4)


@heavy
def test_a_pilot_that_was_ended_goes_on_and_is_the_same(tmp_path):
    def answers(report):
        with (report / "trials.csv").open() as file:
            return [(row["participant"], row["presented"], row["answered"])
                    for row in csv.DictReader(file)]  # fmt: skip

    def stop(done, _all):
        if done == 1:
            raise KeyboardInterrupt

    whole = answers(piloted(tmp_path / "whole"))
    with pytest.raises(KeyboardInterrupt):
        piloted(tmp_path / "ended", report=stop)
    assert answers(piloted(tmp_path / "ended")) == whole


@heavy
@pytest.mark.parametrize("text", [BY_THE_ANSWERS, IN_GROUPS], ids=["by the answers", "in groups"])
def test_two_workers_pilot_what_one_does(text, tmp_path):
    protocol = parse_protocol(text, "two.toml")
    one, two = (piloted(tmp_path / f"{n}", protocol=protocol, workers=Workers(n)) for n in (1, 2))
    tables = [path.relative_to(one) for path in one.rglob("*.csv")]
    assert len(tables) > 2
    assert [
        str(path) for path in tables if (one / path).read_text() != (two / path).read_text()
    ] == []


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"participants": 0}, "is 0; it must be 1 to 500"),
        ({"habits": ReaderHabits(101.0)}, "noise is 101; it must be 0 to 100"),
    ],
)
def test_what_cannot_be_piloted_leaves_nothing(changed, sentence, tmp_path):
    with pytest.raises(InputError, match=sentence):
        piloted(tmp_path / "pilot", **changed)
    assert not (tmp_path / "pilot").exists()
