"""A session's directory: whole or not there."""

import os
from dataclasses import replace

import pytest

from tests.sessions.sittings import MINI, Session
from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.planning.making import make_plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record.events import Closed
from vbraille.sessions.record.folder import create, load, read_told_trace


@pytest.fixture
def put(tmp_path):
    """Put a session into a directory."""
    protocol = parse_protocol(MINI, "test")
    plan = make_plan(protocol, "P1", 1)
    head = {"fields": {"café": "\udcff"}}
    return lambda folder=tmp_path / "s": create(folder, protocol, plan, head)


def names(folder):
    return sorted(path.name for path in folder.rglob("*"))


def test_what_was_put_comes_back(tmp_path, put):
    put()
    record = load(tmp_path / "s")
    assert record.protocol == parse_protocol(MINI, "test")
    assert record.plan == make_plan(record.protocol, "P1", 1)
    assert record.head == {"fields": {"café": "\udcff"}}
    assert [event.kind for event in record.journal.events] == ["session"]
    assert (tmp_path / "s" / "protocol.toml").read_text() == MINI


def test_a_directory_that_is_empty_or_yet_to_be_made_is_taken(tmp_path, put):
    (tmp_path / "empty").mkdir()
    put(tmp_path / "empty")
    put(tmp_path / "new" / "deep" / "s")
    assert load(tmp_path / "empty").plan == load(tmp_path / "new" / "deep" / "s").plan


def test_it_is_whole_or_nothing_wherever_it_is_stopped(tmp_path, put, monkeypatch):
    real, left = os.fsync, 0

    def stop(file):
        nonlocal left
        left -= 1
        if left < 0:
            raise KeyboardInterrupt
        real(file)

    monkeypatch.setattr(os, "fsync", stop)
    folder = tmp_path / "new" / "s"
    for count in range(5):
        left = count
        with pytest.raises(KeyboardInterrupt):
            put(folder)
        assert names(tmp_path) == []
    left = 5  # its name may not be on the disk yet, but it is there
    with pytest.raises(KeyboardInterrupt):
        put(folder)
    assert load(folder).journal.damage is None


def test_what_a_killed_birth_left_is_removed_by_the_next(tmp_path, put):
    partial = tmp_path / ".s.partial"
    partial.mkdir()
    (partial / "protocol.toml").write_text("form")
    put()
    assert not partial.exists()
    load(tmp_path / "s")


def test_what_somebody_else_put_there_is_not_removed(tmp_path, put):
    partial = tmp_path / ".s.partial"
    partial.mkdir()
    (partial / "mine").write_text("mine")
    with pytest.raises(InputError, match="cannot be written: Directory not empty"):
        put()
    assert names(tmp_path) == [".s.partial", "mine"]


def test_a_full_disk_leaves_nothing(tmp_path, put, monkeypatch):
    def full(_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(VbrailleError, match="s cannot be written: No space left") as said:
        put()
    assert said.value.exit_code == 1
    assert names(tmp_path) == []


@pytest.mark.parametrize("name", ["session.json", "plan.json", "protocol.toml"])
def test_a_file_that_is_gone_or_another_is_said(tmp_path, put, name):
    put()
    path = tmp_path / "s" / name
    path.write_bytes(path.read_bytes() + b" ")
    with pytest.raises(VbrailleError, match=f"{name} is not what it was when the session began"):
        load(tmp_path / "s")
    path.unlink()
    with pytest.raises(VbrailleError, match=f"{name} cannot be read: No such file"):
        load(tmp_path / "s")


def test_a_trace_is_held_against_what_the_journal_tells_of_it(tmp_path):
    session = Session(tmp_path / "s")
    ended = session.sit().record.journal
    told = replace(ended, events=ended.events[:-1])  # before the trace was closed
    path = tmp_path / "s" / "trace-001.gz"
    whole = path.read_bytes()

    def damage(told=told):
        return read_told_trace(session.folder, "trace-001.gz", told).damage

    assert isinstance(ended.events[-1], Closed)
    assert (damage(), damage(ended)) == (None, None)
    path.write_bytes(whole[:-1])
    assert damage() is None  # as a crash leaves it
    assert (
        damage(ended) == f"it has {len(whole) - 1} bytes, and had {len(whole)} when it was closed"
    )
    last = whole.rindex(b"\x1f\x8b\x08\x04")
    longer = bytearray(whole)
    longer[last + 18] ^= 0x40  # the length of the last chunk
    path.write_bytes(longer)
    assert damage() == damage(ended) == "its last chunk has a wrong length"
    path.unlink()
    assert damage() == "it is gone"
