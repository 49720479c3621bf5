"""The file of a session: what is in it is on the disk, and a change of it is seen."""

import os
import shutil
import sqlite3
import subprocess
import sys

import numpy as np
import pytest

from tests.sessions.sittings import MINI, SURE, made
from vbraille.sessions.record.checking import check, salvage, sum_of
from vbraille.sessions.record.record import Record, RecordError, read, reading
from vbraille.sessions.record.ticks import FIELDS, TICK, read_ticks


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A session that a simulated reader has ended, with ticks and confidences."""
    return made(tmp_path_factory.mktemp("ended"), MINI + SURE).sit(answers="simulated").session.path


def test_a_file_is_its_owners_and_stands_alone(ended):
    assert ended.stat().st_mode & 0o777 == 0o600
    assert sorted(path.suffix for path in ended.parent.iterdir()) == [".session", ".toml"]
    with sqlite3.connect(ended) as db:
        assert db.execute("PRAGMA journal_mode").fetchone() == ("delete",)
        strict = db.execute(
            "SELECT min(strict) FROM pragma_table_list WHERE type = 'table' "
            "AND name NOT LIKE 'sqlite%'"
        )
        assert strict.fetchone() == (1,)
        for change in ("DELETE FROM event", "UPDATE event SET kind = 'note'"):
            with pytest.raises(sqlite3.IntegrityError):
                db.execute(change)


def test_an_event_is_on_the_disk_when_it_is_in(tmp_path):
    """A copy of the file that is made while it is open has it."""
    path = made(tmp_path).session.path
    record = Record(path)
    for number in range(3):
        record.append("note", number + 0.5, text=f"no {number}")
        copy = shutil.copy(path, tmp_path / f"copy{number}.session")
        assert read(copy).events[-1].data == {"text": f"no {number}"}
    record.close()


def test_an_answer_and_its_ticks_are_one_transaction(tmp_path):
    sat = made(tmp_path)
    trial = sat.session.content.plan.trials[0]
    record = Record(sat.session.path)
    ticks = np.zeros(300, TICK)
    ticks["line"], ticks["tick"] = 1, np.arange(300)
    random = np.random.default_rng(1)
    ticks["x_mm"] = random.normal(0, 9, 300)
    ticks["time_ns"] = 10**15 + random.integers(0, 10**9, 300).cumsum()
    ticks["shown_s"] = random.integers(0, 10**9, 300).cumsum() / 1e9
    record.append("cue", 0.0, trial, 1, stimulus=0, line=1)
    record.add_ticks(ticks[:200])
    record.add_ticks(ticks[200:])
    record.append("answer", 1.0, trial, 1, answer="⠁⠉")
    copy = shutil.copy(sat.session.path, tmp_path / "copy.session")
    with reading(copy) as db:
        np.testing.assert_array_equal(read_ticks(db, 1, FIELDS), ticks)
    record.close()
    assert check(sat.session.path) == []


def test_a_second_console_and_what_is_no_session_are_told(tmp_path):
    path = made(tmp_path).session.path
    record = Record(path)
    for opened in (Record, read):
        with pytest.raises(RecordError, match="another console"):
            opened(path)
    record.close()
    with pytest.raises(RecordError, match="is there already"):
        made(tmp_path)
    other = tmp_path / "other.session"
    other.write_bytes(b"no file of SQLite at all " * 100)
    for what in (other, tmp_path / "missing.session"):
        with pytest.raises(RecordError):
            Record(what)
        assert check(what)


CHANGES = {
    "an answer": "UPDATE event SET data = replace(data, 'answer', 'Answer') WHERE n = "
    "(SELECT min(n) FROM event WHERE kind = 'answer')",
    "an event gone": "DELETE FROM event WHERE n = 9",
    "gone and renumbered": "DELETE FROM event WHERE n = 9; UPDATE event SET n = n - 1 WHERE n > 9",
    "two swapped": "UPDATE event SET n = -1 WHERE n = 9; UPDATE event SET n = 9 WHERE n = 10; "
    "UPDATE event SET n = 10 WHERE n = -1",
    "one more": "INSERT INTO event SELECT max(n) + 1, kind, t_s, wall, practice, trial, attempt, "
    "data, sum FROM event",
    "ticks changed": "UPDATE ticks SET fields = (SELECT fields FROM ticks LIMIT 1) "
    "WHERE rowid = (SELECT max(rowid) FROM ticks)",
    "ticks gone": "DELETE FROM ticks WHERE rowid = 2",
    "the last ticks gone": "DELETE FROM ticks WHERE rowid = (SELECT max(rowid) FROM ticks)",
    "the end gone": "DELETE FROM event WHERE n = (SELECT max(n) FROM event)",
    "the plan": "UPDATE trial SET item = 'x' WHERE number = 1",
    "the protocol": "UPDATE file SET content = CAST(content || '#' AS BLOB)",
    "the participant": "UPDATE session SET participant = 'P02'",
}


@pytest.mark.parametrize("what", CHANGES)
def test_every_change_is_seen(what, ended, tmp_path):
    assert check(ended) == []
    path = shutil.copy(ended, tmp_path / "changed.session")
    db = sqlite3.connect(path)
    db.executescript(
        "DROP TRIGGER events_do_not_change; DROP TRIGGER events_do_not_go;" + CHANGES[what]
    )
    db.close()
    assert check(path)


def test_a_sum_that_was_said_is_known_again(ended):
    assert check(ended, expect=sum_of(ended)) == []
    assert check(ended, expect="0" * 64)


def test_what_can_be_read_of_a_damaged_file_is_saved(ended, tmp_path):
    torn = tmp_path / "torn.session"
    data = bytearray(ended.read_bytes())
    data[len(data) // 2 : len(data) // 2 + 4096] = bytes(4096)
    torn.write_bytes(data)
    assert check(torn)
    said = salvage(torn, tmp_path / "saved.session")
    assert any("not whole" in sentence for sentence in said)
    with reading(tmp_path / "saved.session") as db:
        assert db.execute("SELECT count(*) FROM event").fetchone()[0] > 3
    with pytest.raises(RecordError, match="already"):
        salvage(torn, tmp_path / "saved.session")


def test_what_was_copied_of_a_file_that_was_cut_is_saved(ended, tmp_path):
    cut = tmp_path / "cut.session"
    cut.write_bytes(ended.read_bytes()[: -2 * 4096])
    assert check(cut)
    salvage(cut, tmp_path / "saved.session")
    with reading(tmp_path / "saved.session") as db:
        assert db.execute("SELECT count(*) FROM event").fetchone()[0] > 3


def test_the_view_of_answers_has_those_that_count(tmp_path):
    sat = made(tmp_path).sit(
        ("read:", "ac"), ("answer:", "undo"), ("undo:", "aa"), ("read:", "ca"),
        ("read:", "aa"), ("last", ""),
    )  # fmt: skip
    with sqlite3.connect(sat.session.path) as db:
        rows = db.execute("SELECT trial, answer FROM answers ORDER BY trial").fetchall()
    assert rows == [(1, "⠁⠁"), (2, "⠉⠁"), (3, "⠁⠁")]
    assert [row["answered"] for row in sat.session.trials] == [answer for _, answer in rows]
    assert [row["first_answer"] for row in sat.session.trials] == ["⠁⠉", "", ""]


DIES = """
import os, sys
from pathlib import Path
from vbraille.sessions.record.record import Record
record = Record(Path(sys.argv[1]))
record.append("note", 1.0, text="kept")
record._db.executescript('''PRAGMA cache_size = 2; BEGIN IMMEDIATE; INSERT INTO file
    WITH RECURSIVE c(v) AS (SELECT 1 UNION ALL SELECT v + 1 FROM c LIMIT 200)
    SELECT v, zeroblob(5000) FROM c;''')
os._exit(9)
"""


def test_a_hot_journal_is_taken_back(tmp_path):
    """A console that dies within a transaction leaves its journal beside the file."""
    path = made(tmp_path).session.path
    subprocess.run([sys.executable, "-c", DIES, path], check=False)
    assert path.with_name(f"{path.name}-journal").stat().st_size > 0
    assert read(path).events[-1].data == {"text": "kept"}
    assert check(path) == []


@pytest.mark.skipif(not os.geteuid(), reason="the superuser may write all")
def test_a_protected_file_is_read_and_not_run(tmp_path):
    path = made(tmp_path).session.path
    path.chmod(0o400)
    with pytest.raises(RecordError, match="may not be written"):
        Record(path)
    assert read(path).plan
