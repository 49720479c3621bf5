"""Sessions of every kind: each checks, is exported and analysed, and is gone on with to its end."""

import csv
import io
import json
import re
import shutil
from hashlib import sha256

import pytest

from tests.cli.test_session_bad_input import contents
from tests.sessions.written import SESSIONS, written
from vbraille.sessions.record.folder import PLAN, load
from vbraille.sessions.record.journal import NAME, encode
from vbraille.sessions.record.progress import Progress


def progress_of(folder):
    record = load(folder)
    return Progress(record.plan, record.journal.events, record.procedure)


def rows(text):
    return list(csv.DictReader(io.StringIO(text)))


def test_there_is_of_every_kind():
    happened = {event.kind for name in SESSIONS for event in load(written(name)).journal.events}
    assert happened >= {
        "answer", "undo", "repeat", "fault", "pause", "go", "note", "stop", "end", "tuning",
        "break", "closed",
    }  # fmt: skip
    assert [name for name in SESSIONS if load(written(name)).journal.torn] == ["torn"]
    assert {progress_of(written(name)).ended for name in SESSIONS} == {True, False}


@pytest.mark.parametrize("name", SESSIONS)
def test_a_session_checks_and_is_exported_and_stays_as_it_was(call, name, tmp_path):
    folder = written(name)
    before = contents(folder)
    said = call("session", "check", folder)
    assert (said.code, said.err) == (0, "")
    assert "fault: " not in said.out
    said = call("session", "export", folder, "--out", tmp_path / "t.csv")
    assert (said.code, said.err) == (0, "")
    answered = [row["answered"] for row in rows((tmp_path / "t.csv").read_text())]
    assert sum(map(bool, answered)) == progress_of(folder).done > 0
    said = call("session", "export", folder, "--bids", "--out", tmp_path / "set")
    assert (said.code, said.err) == (0, "")
    assert contents(folder) == before


def test_sessions_are_analysed_together(call):
    folders = [written(name) for name in SESSIONS]
    said = call("analyse", *folders, "--json")
    assert (said.code, said.err) == (0, "")
    about = json.loads(said.out)["about"]
    for folder in folders:
        assert f", {progress_of(folder).done} of " in about[f"Session {folder.name}"]


@pytest.mark.parametrize("name", ["torn", "stopped"])
def test_a_session_that_has_not_ended_is_gone_on_with(call, name, tmp_path):
    folder = written(name)
    copy = shutil.copytree(folder, tmp_path / "s")
    how = ("--answers", "simulated", "--device", "sim", "--hand", "sweep:200", "--fast")
    said = call("session", "resume", copy, *how)
    assert (said.code, said.err) == (0, "")
    checked = call("session", "check", copy)
    assert checked.code == 0
    assert re.search(r"answers: (\d+) of \1; the session is ended", checked.out)
    then, now = (rows(call("session", "export", place).out) for place in (folder, copy))
    assert all(row["answered"] for row in now)
    for before, after in zip(then, now, strict=True):
        assert before["answered"] in ("", after["answered"])
    # What was there is there.
    for path in folder.iterdir():
        before, after = path.read_bytes(), (copy / path.name).read_bytes()
        if path.name == NAME:
            before = before[: before.rfind(b"\n") + 1]
            assert after.startswith(before)
        else:
            assert after == before


@pytest.mark.parametrize("name", ["ended", "compared"])
def test_a_session_that_has_ended_is_not_gone_on_with(call, name, tmp_path):
    copy = shutil.copytree(written(name), tmp_path / "s")
    said = call("session", "resume", copy)
    assert (said.code, said.out) == (2, "")
    assert said.err == f"vbraille: {copy} has ended; session export makes tables of it\n"
    kept, then = (contents(place).values() for place in (copy, written(name)))
    assert list(kept) == list(then)


@pytest.mark.parametrize("action", ["check", "export", "resume"])
@pytest.mark.parametrize("version", [1, 3])
def test_a_plan_of_another_version_is_refused_in_a_sentence(call, tmp_path, action, version):
    copy = shutil.copytree(written("stopped"), tmp_path / "s")
    plan = (copy / PLAN).read_bytes().replace(b'"format": 2', b'"format": %d' % version)
    (copy / PLAN).write_bytes(plan)
    with_sum(copy, PLAN, sha256(plan).hexdigest())
    said = call("session", action, copy)
    assert (said.code, said.out) == (2, "")
    assert f"the plan is of version {version}, and this vbraille knows version 2" in said.err


def with_sum(folder, name, sum_of):
    """Have a session's journal say that a file had another checksum when the session began."""
    content, crc = b"", 0
    for line in (folder / NAME).read_bytes().splitlines():
        event = json.loads(line)
        del event["crc"]
        if "sha256" in event:
            event["sha256"][name] = sum_of
        line, crc = encode(event, crc)
        content += line
    (folder / NAME).write_bytes(content)
