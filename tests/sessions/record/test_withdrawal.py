"""A participant who withdraws: all data of the person go, and nothing of anybody else."""

from shutil import copytree

import pytest

from tests.calling import as_before
from tests.sessions.sittings import MINI, Session
from vbraille.cli.app import main
from vbraille.errors import InputError
from vbraille.sessions.record import bids
from vbraille.sessions.record.export import encode, rows, to_csv
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.record.journal import Journal
from vbraille.sessions.record.withdrawal import withdrawal

ORDERS = "participant,first\nP1,all\nP11,all\n"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A study of two people: sessions, a table, a dataset, a plan, a report, a note."""
    room = tmp_path_factory.mktemp("made") / "study"
    room.mkdir()
    table = []
    for participant in ("P1", "P11"):
        session = Session(room / f"run-{participant}", MINI, participant=participant)
        record = session.sit().record
        table += rows(record)
        bids.write(record, room / "set")
    (room / "trials.csv").write_bytes(encode(to_csv(table)))
    (room / "plans").mkdir()
    for participant in ("P1", "P11"):
        head = f"protocol: mini, 4 trials, participant {participant}, seed 1\n"
        (room / "plans" / f"{participant}.txt").write_text(head)
    plan = (room / "run-P1" / "plan.json").read_bytes()
    (room / "plans" / "kept.json").write_bytes(plan)
    for name, person in (("report", "P1"), ("other", "P11")):
        (room / name).mkdir()
        (room / name / "report.html").write_text(f"<p>{person}</p>")
        (room / name / "trials.csv").write_text(f"participant\n{person}\n")
    (room / "notes.md").write_text("P1 was late. P-1 is another, and P1_b.")
    (room / "orders.csv").write_text(ORDERS)
    return room


@pytest.fixture
def study(made, tmp_path):
    return copytree(made, tmp_path / "study")


def everything(room):
    return {str(p.relative_to(room)): p.read_bytes() for p in room.rglob("*") if p.is_file()}


def test_all_of_one_person_is_removed_and_all_of_the_other_stays(study):
    before = everything(study)
    told = withdrawal([study], "P1")
    assert told.left == [study / "notes.md"]
    said = list(told.sentences())
    assert len(said) == len(set(said)) == 5 + 3
    told.remove()
    after = everything(study)
    gone = {name for name in before if name not in after}
    assert {name.split("/")[0] for name in gone} == {"run-P1", "report", "plans", "set"}
    assert {n for n in gone if n.startswith("plans")} == {"plans/P1.txt", "plans/kept.json"}
    assert {n.split("/")[1] for n in gone if n.startswith("set")} == {"sub-P1"}
    changed = {name for name in after if after[name] != before[name]}
    assert changed == {"trials.csv", "orders.csv", "set/participants.tsv"}
    for name in changed:
        lines = before[name].decode().splitlines()
        mine = [line for line in lines if "P1" in line.replace("P11", "")]
        assert mine
        assert after[name].decode().splitlines() == [line for line in lines if line not in mine]
    assert all(finding.good for finding in check_folder(study / "run-P11"))
    assert not withdrawal([study], "P1").found
    again = bids.write(Session(study / "new", MINI, participant="P1").sit().record, study / "set")
    assert again


def test_a_pseudonym_within_another_and_a_person_who_is_not_there_find_nothing(study):
    assert not withdrawal([study], "P").found
    assert not withdrawal([study], "P2").found
    with pytest.raises(InputError, match="there is no directory"):
        withdrawal([study / "nowhere"], "P1")


def test_nothing_goes_while_a_session_of_the_person_is_run(study):
    before = everything(study)
    with Journal(study / "run-P1"), pytest.raises(InputError, match="open in another console"):
        withdrawal([study], "P1").remove()
    assert everything(study) == before


def test_a_damaged_session_goes_too_and_anothers_file_is_only_named(study):
    (study / "run-P1" / "journal.jsonl").write_bytes(b"nothing")
    (study / "run-P1" / "session.json").unlink()
    (study / "run-P11" / "orders.csv").write_text(ORDERS)
    told = withdrawal([study / "run-P1", study / "run-P11"], "P1")
    assert list(told.whole) == [study / "run-P1"]
    assert told.left == [study / "run-P11" / "orders.csv"]
    told.remove()
    assert not (study / "run-P1").exists()
    assert (study / "run-P11" / "orders.csv").read_text() == ORDERS


@pytest.mark.parametrize(("answer", "code"), [("yes", 1), ("no", 2), ("", 2)])
def test_the_command_asks_before_and_says_what_it_removed(
    study, tmp_path, monkeypatch, capsys, answer, code
):
    typed = tmp_path / "typed"
    typed.write_text(f"{answer}\n")
    with typed.open() as lines, as_before():
        monkeypatch.setattr("sys.stdin", lines)
        assert main(["session", "withdraw", "P1", str(study)]) == code
    said = capsys.readouterr().out
    assert said.count("found: ") == 8
    assert (study / "run-P1").exists() is (answer != "yes")
    assert said.count("removed: ") == (8 if answer == "yes" else 0)
    assert ("left: " in said) is (answer == "yes")
