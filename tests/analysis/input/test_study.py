"""Strings of one set, sessions of one name: what belongs together, and what does not."""

import shutil
from pathlib import Path

import pytest

from tests.analysis.making import levels, made, record, sheet
from tests.sessions.sittings import Session
from vbraille.analysis.chapters import Options, analyse_study
from vbraille.analysis.input.parsing import parse
from vbraille.analysis.input.study import distinct_names, load_study
from vbraille.analysis.input.trials import written
from vbraille.analysis.measures.legibility import strings
from vbraille.analysis.results import to_csv as frame_to_csv
from vbraille.errors import InputError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import builtin_text, parse_protocol
from vbraille.sessions.record.export import rows, to_csv
from vbraille.sessions.record.folder import load

ORDERS = """
format = 1
name = "orders"
title = "Letters in another order at each showing"
source = "ours"
model = "stress2"
[design]
kind = "list"
strings = ["abc", "def"]
reorder = true
repeats = 6
[practice]
trials = 0
"""


def tables(results):
    return {table.name: table for table in results.result_tables()}


def session(folder, seed=1, who="P01"):
    """A session that a simulated reader sat, at this moment."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    sat = Session(folder, ORDERS, who, seed=seed)
    sat.sit(noise=0.3)
    return folder


@pytest.fixture(scope="module")
def sites(tmp_path_factory):
    """Two folders with a session of one name and one participant's pseudonym."""
    room = tmp_path_factory.mktemp("sites")
    return [session(room / site / "P01-orders", seed=n) for n, site in enumerate("xy", 1)]


def shown_by(name, people):
    """Trials as six people would be shown them by one of our protocols, all read right."""
    protocol = parse_protocol(builtin_text(name), name)
    columns = "participant session protocol condition trial presented answered duration_s"
    lines = []
    for n in range(people):
        for trial in make_plan(protocol, f"P{n}", n).trials:
            cells = trial.presented
            lines.append(f"P{n} s{n} {name} {trial.condition} {trial.number} {cells} {cells} 3")
    return parse([sheet(*lines, columns=columns)]).trials


def test_strings_that_keep_their_order_are_themselves():
    trials = shown_by("legibility", 2)
    assert len(strings(trials).rows) == 16  # ac is not ca
    assert {row["orders"] for row in strings(trials).records()} == {1}
    assert len(strings(shown_by("words", 1)).rows) == 40


def test_a_table_tells_the_set_of_its_strings():
    columns = "participant condition presented string_set answered"
    lines = ["A T0 abc abc abc", "A T0 cab abc cab", "A T0 acb - bca", "B T0 bca abc ab?"]
    trials, _ = made(*lines, columns=columns)
    row = record(strings(trials), name="abc")
    assert (row["presented"], row["correct"], row["orders"]) == (3, 2, 3)
    assert len(strings(trials).rows) == 2
    with pytest.raises(InputError, match="string_set is 'abc', and presented, 'abd', is no order"):
        made("A T0 abd abc abd", columns=columns)


def test_a_session_and_its_export_know_their_sets(sites, tmp_path):
    study = load_study(sites[:1])
    table = tables(analyse_study(study, Options()))["strings"]
    assert [(row["name"], row["presented"]) for row in table.records()] == [("abc", 6), ("def", 6)]
    exported = tmp_path / "exported.csv"
    exported.write_text(to_csv(rows(load(sites[0]))), encoding="utf-8")
    assert tables(analyse_study(load_study([exported]), Options()))["strings"].rows == table.rows
    again = tmp_path / "again.csv"
    again.write_text(frame_to_csv(written(study.trials)))
    assert tables(analyse_study(load_study([again]), Options()))["strings"].rows == table.rows


def test_sessions_of_one_folder_name_are_told_apart(sites):
    study = load_study(sites)
    assert levels(study.trials.session) == ("x/P01-orders", "y/P01-orders")
    assert len(study.trials) == 24
    assert [sitting.name for sitting in study.sessions] == ["x/P01-orders", "y/P01-orders"]
    assert {word for word, _ in study.about} >= {"Session x/P01-orders", "Session y/P01-orders"}
    (warning,) = [w for w in study.warnings if "told apart" in w]
    assert "x/P01-orders and y/P01-orders" in warning
    assert "P01 is taken for one person." in warning
    slopes = tables(analyse_study(study, Options()))["slopes"]
    assert len(slopes.rows) == 2


def exports(sites, tmp_path):
    found = []
    for folder in sites:
        path = tmp_path / folder.parent.name / "trials.csv"
        path.parent.mkdir()
        path.write_text(to_csv(rows(load(folder))), encoding="utf-8")
        found.append(path)
    return found


def test_tables_that_name_two_sessions_alike_are_refused(sites, tmp_path):
    with pytest.raises(InputError, match=r"is there a second time; .* a name of its own"):
        load_study(exports(sites, tmp_path))


def test_tables_without_sessions_are_their_files(tmp_path):
    for site in "xy":
        (tmp_path / site).mkdir()
        (tmp_path / site / "t.csv").write_text(
            "participant,condition,presented,answered\nA,T0,ab,ab\n"
        )
    study = load_study([tmp_path / "x" / "t.csv", tmp_path / "y" / "t.csv"])
    assert levels(study.trials.session) == ("x/t.csv", "y/t.csv")


def test_a_copy_of_a_session_is_the_same_session(sites, tmp_path):
    copy = tmp_path / "backup" / "P01-orders"
    shutil.copytree(sites[0], copy)
    with pytest.raises(InputError, match=r"P01-orders are the same session; give it once"):
        load_study([sites[0], copy])
    (path,) = exports(sites[:1], tmp_path)
    with pytest.raises(InputError, match="is there a second time; give every trial once"):
        load_study([sites[0], path])


def test_names_have_as_much_of_the_path_as_they_need():
    paths = [Path(path) for path in ("/a/x/P1", "/b/x/P1", "/a/y/P1", "/a/x/P2")]
    assert distinct_names(paths) == ["a/x/P1", "b/x/P1", "y/P1", "P2"]
    assert distinct_names([Path("/P1"), Path("/a/P1")]) == ["//P1", "a/P1"]
    assert distinct_names([]) == []
