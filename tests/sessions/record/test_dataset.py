"""A dataset of sessions: who is in it, what is added to it, and what is refused."""

import csv
import json
import re
from dataclasses import replace

import pytest
from msgspec import structs

from tests.sessions.bidsvalid import complaints
from tests.sessions.running.test_adaptive import FORMS as DIFFERENCES
from tests.sessions.running.test_adaptive import SEEN, form_of
from tests.sessions.running.test_adjusting import ADJUST
from tests.sessions.running.test_intervals import FORMS
from tests.sessions.running.test_passages import PASSAGES
from tests.sessions.running.test_questionnaire import ALL
from tests.sessions.sittings import MINI, Session
from tests.tiers import by_tier, heavy
from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.planning.protocolfiles import builtin_names, builtin_text, load_protocol
from vbraille.sessions.record import bids
from vbraille.sessions.record.folder import alike, label_of


@pytest.fixture(scope="module")
def records(tmp_path_factory):
    """Two sessions of one participant."""
    room = tmp_path_factory.mktemp("dataset")
    first = Session(room / "s").sit().record
    return first, Session(room / "t", seed=2).sit().record


@pytest.fixture
def record(records):
    return records[0]


def people(folder):
    rows = csv.DictReader((folder / "participants.tsv").read_text().splitlines(), delimiter="\t")
    return {row["participant_id"]: row["pseudonym"] for row in rows}


def named(record, participant):
    """The session as if it were another's."""
    told = replace(record.journal, crcs=[hash(participant) & 0xFFFFFFFF])
    return replace(record, plan=structs.replace(record.plan, participant=participant), journal=told)


def test_a_dataset_takes_several_participants_and_several_sessions_of_each(records, tmp_path):
    first, second = records
    bids.write(first, tmp_path)
    about = (tmp_path / "dataset_description.json").read_bytes()
    assert json.loads(about)["BIDSVersion"] == "1.9.0"
    assert people(tmp_path) == {"sub-P1": "P1"}
    bids.write(named(first, "P-2"), tmp_path)
    bids.write(second, tmp_path)
    assert (tmp_path / "dataset_description.json").read_bytes() == about
    assert people(tmp_path) == {"sub-P1": "P1", "sub-P2": "P-2"}
    assert sorted(str(p.relative_to(tmp_path)) for p in tmp_path.glob("sub-*/ses-*")) == [
        "sub-P1/ses-01", "sub-P1/ses-02", "sub-P2/ses-01",
    ]  # fmt: skip
    assert complaints(tmp_path) == ""
    described = json.loads((tmp_path / "participants.json").read_text())
    assert described["pseudonym"]["Description"]


def test_a_session_is_added_once(records, tmp_path):
    for record in records:
        bids.write(record, tmp_path)
    before = {path: path.is_file() and path.read_bytes() for path in tmp_path.rglob("*")}
    for record, number in zip(records, ("01", "02"), strict=True):
        with pytest.raises(InputError, match=f"is there already, as .*_ses-{number}_task-mini_beh"):
            bids.write(record, tmp_path)
    assert {path: path.is_file() and path.read_bytes() for path in tmp_path.rglob("*")} == before


@pytest.mark.parametrize("other", ["p07", "P7", "P007", "P-07", "P_0-7", "p-7"])
def test_pseudonyms_that_could_be_taken_for_one_another_are_refused(record, tmp_path, other):
    bids.write(named(record, "P07"), tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(InputError, match=f"P07, who could not be told from {other}; give another"):
        bids.write(named(record, other), tmp_path)
    assert sorted(tmp_path.rglob("*")) == before


def test_what_is_alike_and_what_is_not():
    assert alike("P1-01", "P101")  # their labels are the same
    assert alike("A-B", "ab")
    for one, other in (("P7", "P70"), ("P1", "P10"), ("P100", "P10"), ("P1", "Q1"), ("1", "11")):
        assert not alike(one, other), (one, other)
    assert label_of("P-0_7") == "P07"


LONG = f"participant_id\tpseudonym\nsub-P1\t{'P' * 200_000}\n"


@pytest.mark.parametrize("table", ["", "a\tb\n1\t2\n", "\xff", LONG], ids=range(4))
def test_a_table_of_participants_that_is_not_one_is_refused(record, tmp_path, table):
    (tmp_path / "participants.tsv").write_text(table, "latin-1")
    with pytest.raises(InputError, match=r"participants.tsv is no table of participant_id and"):
        bids.write(record, tmp_path)


@pytest.mark.parametrize("fails", [1, 4, 9])
def test_a_dataset_that_cannot_be_finished_is_not_begun(record, tmp_path, monkeypatch, fails):
    done = []

    def full(_from, to):
        done.append(to)
        if len(done) == fails:
            raise OSError(28, "No space left on device")
        to.write_bytes(b"")

    monkeypatch.setattr("os.link", full)
    with pytest.raises(VbrailleError, match="could not be written: No space left on device"):
        bids.write(record, tmp_path / "new" / "set")
    assert list(tmp_path.iterdir()) == []


def test_without_times_no_file_tells_when_or_where(record, tmp_path):
    bids.write(record, tmp_path / "set", without_times=True)
    year = record.journal.events[0].wall[:4]
    for path in (tmp_path / "set").rglob("*"):
        if path.suffix in (".tsv", ".json") or path.name == "README":
            text = path.read_text()
            assert not re.search(rf"{year}-\d\d|\d\d:\d\d:\d\d", text), path
            assert str(record.folder) not in text
            assert "trace-001" not in text


# Those of chapter 6 are in tests/analysis/test_chapter6.py; two need paper, or another display.
SHIPPED = [
    name
    for name in builtin_names()
    if not load_protocol(name).pictures and not name.startswith("control")
]


def test_what_comes_with_the_program_is_a_valid_dataset(tmp_path):
    for name in by_tier(["detection"], SHIPPED, SHIPPED):
        text = re.sub(r"(?m)^limit_s = .*\n", "", builtin_text(name))
        text = text.replace("\n[session]\n", "\n[session]\nlimit_s = 60\n", 1)
        sat = Session(tmp_path / name, text).sit(noise=0.2)
        assert sat.progress.done
        bids.write(sat.record, tmp_path / "set")
    assert complaints(tmp_path / "set") == ""


@heavy
def test_each_paradigm_is_a_valid_dataset(tmp_path):
    limits = MINI + "[trial]\nexposure_s = 0.6\nanswer_s = 5.0\n"
    adaptive = (SEEN, *(form_of(form, trials=6) for form in DIFFERENCES))
    paradigms = (ALL, limits, *FORMS.values(), ADJUST, PASSAGES, *adaptive)
    for number, toml in enumerate(paradigms):
        named = re.sub('name = "[a-z-]+"', f'name = "task{number}"', toml, count=1)
        bids.write(Session(tmp_path / f"{number}", named).sit().record, tmp_path / "set")
    assert complaints(tmp_path / "set") == ""
