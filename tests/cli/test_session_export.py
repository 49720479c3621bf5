"""``vbraille session export`` of several sessions: tables, codebooks and datasets."""

import csv
import io
import json
import shutil

import pytest

from tests.sessions.bidsvalid import complaints
from tests.sessions.sittings import MINI
from vbraille.devices import open_device
from vbraille.engine.batch import BatchEngine
from vbraille.sessions.conditions import Conditions
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.folder import create
from vbraille.sessions.session import Session, head_of

ASKS = MINI + '[[fields]]\nname = "day"\nask = "Which day"\n'
NAMES = ("a/s1", "a/s2", "b/s3", "b/s4")
OTHERS = "participant_id\tage\nsub-X9\t44\n"


@pytest.fixture(scope="module")
def sat(tmp_path_factory):
    """Four sessions of one participant, in two directories."""
    room = tmp_path_factory.mktemp("sessions")
    protocol = parse_protocol(ASKS, "test")
    for seed, (name, day) in enumerate(zip(NAMES, ("pre", "pre", "post", ""), strict=True), 1):
        plan = make_plan(protocol, "P01", seed)
        conditions = Conditions(hand="sweep:150", fast=True)
        (room / name).parent.mkdir(exist_ok=True)
        create(room / name, protocol, plan, head_of(protocol, plan, {"day": day}, conditions))
        engine = lambda spec, wanted: BatchEngine(open_device(spec, wanted), poll_ticks=100)  # noqa: E731
        Session.resume(room / name, fast=True, engine=engine).run("simulated")
    return room


@pytest.fixture
def room(sat, tmp_path, monkeypatch):
    shutil.copytree(sat, tmp_path, dirs_exist_ok=True)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def table(path, delimiter="\t"):
    return list(csv.DictReader(io.StringIO(path.read_text("utf-8")), delimiter=delimiter))


def valid(folder):
    return complaints(folder) == ""


def test_several_sessions_are_one_dataset(room, call):
    (room / "set").mkdir()
    (room / "set" / "README").write_text("mine")
    said = call("session", "export", "b/s3", "a/s2", "a/s1", "--bids", "--out", "set")
    assert said.code == 0, said.err
    people = [{"participant_id": "sub-P01", "pseudonym": "P01"}]
    assert table(room / "set" / "participants.tsv") == people
    assert json.loads((room / "set" / "participants.json").read_text())["pseudonym"]["Description"]
    sessions = sorted(path.name for path in (room / "set" / "sub-P01").iterdir())
    assert sessions == ["ses-01", "ses-02", "ses-03"]
    (first,) = (room / "set").glob("sub-P01/ses-01/beh/*_beh.tsv")
    assert {row["session"] for row in table(first)} == {"s1"}  # by time, not as they were given
    assert (room / "set" / "README").read_text() == "mine"
    assert valid(room / "set")
    assert said.out.count("record of ") == 3
    said = call("session", "export", "a/s1", "--bids", "--out", "set")
    assert (said.code, "is there already, as" in said.err) == (2, True)


@pytest.mark.parametrize("there", [OTHERS, "", "participant_id\tpseudonym\nsub-X9\n", "\0"])
def test_a_table_of_participants_of_others_is_left_alone(room, call, there):
    (room / "set").mkdir()
    (room / "set" / "participants.tsv").write_text(there)
    said = call("session", "export", "a/s1", "--bids", "--out", "set")
    assert (said.code, "is no table of participant_id and pseudonym alone" in said.err) == (2, True)
    assert [path.name for path in (room / "set").iterdir()] == ["participants.tsv"]
    assert (room / "set" / "participants.tsv").read_text() == there


def test_sessions_may_be_named_by_what_was_asked(room, call):
    words = ("--bids", "--session-by", "day", "--out", "set")
    assert call("session", "export", "a/s1", "b/s3", *words).code == 0
    assert {path.name for path in (room / "set" / "sub-P01").iterdir()} == {"ses-pre", "ses-post"}
    assert valid(room / "set")
    before = set((room / "set").rglob("*"))
    said = call("session", "export", "a/s2", *words)
    assert (said.code, "is there already, of another session; leave out" in said.err) == (2, True)
    assert set((room / "set").rglob("*")) == before


def test_a_table_of_several_sessions_and_its_codebook(room, call):
    words = ("--out", "all.csv", "--codebook", "book.csv")
    said = call("session", "export", "a/s1", "b/s3", *words)
    assert said.code == 0
    rows = table(room / "all.csv", ",")
    assert [row["participant"] for row in rows] == ["P01"] * 8
    book = table(room / "book.csv", ",")
    assert [row["column"] for row in book] == list(rows[0])
    assert {row["file"] for row in book} == {"all.csv"}
    assert all(row["meaning"] for row in book)
    assert book[-1]["meaning"] == "Which day"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("a/s1", "a/s1"), "is there twice; give it once"),
        (("a/s1", "--bids"), "--bids needs a directory; give one with --out"),
        (("a/s1", "--bids", "--out", "o", "--codebook", "c"), "leave out --codebook"),
        (("a/s1", "--session-by", "day"), "--session-by names sessions of a dataset; add --bids"),
        (("a/s1", "--key", "k.csv"), "--key is gone; pseudonyms are codes already"),
        (("a/s1", "--sites"), "--sites is gone; give participants pseudonyms"),
        (("a/s1", "--bids", "--out", "o", "--session-by", "hour"), "has no field 'hour'; its fiel"),
        (("b/s4", "--bids", "--out", "o", "--session-by", "day"), "has no answer that could name"),
        (("a/s1", "a/s2", "--bids", "--out", "o", "--session-by", "day"), "2 sessions of P01 have"),
        (("a/s1", "none"), "there is no directory none"),
    ],
)
@pytest.mark.usefixtures("room")
def test_what_does_not_go_together_is_refused(call, words, said):
    found = call("session", "export", *words)
    assert found.code == 2
    assert said in found.err
    assert found.err.count("\n") == 1


def test_methods_are_told_in_a_paragraph(room, call):
    said = call("session", "methods", "a/s1", "a/s2")
    assert (said.code, said.out.count("\n")) == (0, 1)
    assert said.out.startswith("1 simulated participant read 4 strings of 1 cell each, in 2 sess")
    (room / "t.csv").write_text("participant,condition,presented,answered\nA,x,ab,ab\n")
    said = call("session", "methods", "t.csv")
    assert (said.code, said.err) == (
        2, "vbraille: tables do not tell what was done; give directories of sessions\n",
    )  # fmt: skip
