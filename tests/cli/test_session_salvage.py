"""Damaged sessions: all that verifies is exported, what does not is named, once."""

import csv
import re
import shutil
from zlib import crc32

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.cli import program
from tests.cli.test_session import words
from tests.cli.test_session_bad_input import contents
from tests.sessions.sittings import MINI
from vbraille.sessions.record import events
from vbraille.sessions.record.folder import check_folder
from vbraille.sessions.record.journal import decode, first_lines, salvage
from vbraille.wording import spelled

LONG = MINI.replace("length = 1", "length = 2\nrepeats = 2")  # 32 trials
WHOLE = first_lines(
    events.Session(format=6, sha256={}, t_s=0.0),
    *(events.Note(text="x" * n, t_s=1.0 + n) for n in range(12)),
)


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A session that was run to its end."""
    room = tmp_path_factory.mktemp("salvage")
    done = program.run(*words(room, LONG))
    assert done.returncode == 0, done.stderr
    return room / "s"


@pytest.fixture
def folder(ended, tmp_path):
    """A copy of it."""
    return shutil.copytree(ended, tmp_path / "s")


def table(path):
    return list(csv.DictReader(path.read_text().splitlines()))


def damage(folder, pattern, by):
    """Change something in a line of the journal; the line's number."""
    path = folder / "journal.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    at = next(n for n, line in enumerate(lines) if re.search(pattern, line))
    lines[at] = re.sub(pattern, by, lines[at])
    path.write_bytes(b"".join(lines))
    return at + 1


def test_one_damaged_line_hides_no_other(call, ended, folder, tmp_path):
    line = damage(folder, rb'"event":"cue","trial":5,', rb'"event":"cut","trial":5,')
    before = contents(folder)
    said = call("session", "export", folder, "--salvage", "--out", tmp_path / "t.csv")
    assert said.code == 1
    assert said.err == (
        f"vbraille: exported is what is whole; of journal.jsonl, line {line} is not whole\n"
    )
    whole = tmp_path / "whole.csv"
    assert call("session", "export", ended, "--out", whole).code == 0
    for then, now in zip(table(whole), table(tmp_path / "t.csv"), strict=True):
        if then["trial"] == "5":
            assert now["answered"] == then["answered"]
            assert now["faults"] == f"events of the journal are lost: {line}"
            assert now["response_s"] == now["duration_s"] == now["paused_s"] == ""
        else:
            assert now == then
    # Without --salvage it is as it was: what comes before the damage.
    assert call("session", "export", folder, "--out", tmp_path / "u.csv").code == 1
    assert sum(row["answered"] != "" for row in table(tmp_path / "u.csv")) == 4
    assert call("session", "resume", folder).code == 1
    assert contents(folder) == before


@pytest.mark.parametrize(
    ("pattern", "by"),
    [
        (rb'"crc":"........"\}', b'"crc":"00000000"}'),
        (rb'"event":"answer","trial":3', rb'"event":"answer","trial":4'),
        (rb'"event":"run"', b'"event":"ran"'),
        (rb'^\{"n":9,.+\n', b""),
        (rb'^\{"n":9,.+\n', b"\0" * 300 + b"\n"),
        (rb'^\{"n":1,', b'{"n":7,'),
    ],
)
def test_one_damage_is_one_complaint(call, folder, tmp_path, pattern, by):
    damage(folder, pattern, by)
    faults = [spelled(found.text) for found in check_folder(folder) if not found.good]
    assert len(faults) == 1
    assert faults[0].startswith("journal.jsonl: damaged, line ")
    assert "after it, which session export --salvage has too" in faults[0]
    said = call("session", "export", folder, "--salvage", "--out", tmp_path / "t.csv")
    assert said.code == 1
    assert re.search(r"of journal.jsonl, lines? [\d-]+ (is|are) not whole\n", said.err)
    assert sum(row["answered"] != "" for row in table(tmp_path / "t.csv")) >= 31


def rewrite(folder, old, new):
    """Put something else into the first line of the journal that has it, with right checksums."""
    path, crc, made, at = folder / "journal.jsonl", 0, [], 0
    for n, line in enumerate(path.read_bytes().splitlines(), 1):
        told = line.rpartition(b',"crc"')[0]
        if not at and old in told:
            at, told = n, told.replace(old, new)
        crc = crc32(told, crc)
        made.append(b'%s,"crc":"%08x"}\n' % (told, crc))
    path.write_bytes(b"".join(made))
    return at


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        (b'"event":"cue","trial":5', b'"event":"fly","trial":5',
         "has an event of the kind 'fly', which this vbraille does not know"),
        (b'"event":"cue","trial":5', b'"event":"cue","flew":5,"trial":5',
         "has an event of the kind 'cue' with an unknown field, 'flew'"),
        (b'"event":"cue","trial":5', b'"event":"cue"',
         "has an event of the kind 'cue' that cannot be read: it is of no trial"),
        (b'"event":"cue","trial":5', b'"event":"cue","trial":"5"',
         "has an event of the kind 'cue' that cannot be read: Expected `int`, got `str`"),
    ],
)  # fmt: skip
def test_an_event_that_there_is_not_is_damage(call, folder, tmp_path, old, new, why):
    line = rewrite(folder, old, new)
    (folder / "trace-001.gz").unlink()  # it is tied to what was there
    before = contents(folder)
    said = call("session", "resume", folder)
    assert (said.code, said.out) == (1, "")
    assert said.err.startswith(f"vbraille: {folder} is damaged: of journal.jsonl line {line} {why}")
    assert said.err.count("\n") == 1
    said = call("session", "check", folder)
    assert said.code == 1
    assert f"fault: journal.jsonl: damaged, line {line} {why}" in said.out
    assert said.out.count("journal.jsonl: damaged") == 1
    said = call("session", "export", folder, "--out", tmp_path / "t.csv")
    assert said.code == 1
    assert f"journal.jsonl is damaged, line {line} {why}" in said.err
    assert sum(row["answered"] != "" for row in table(tmp_path / "t.csv")) == 4
    said = call("session", "export", folder, "--salvage", "--out", tmp_path / "u.csv")
    assert said.code == 1
    assert f"of journal.jsonl, line {line} is not whole" in said.err
    assert sum(row["answered"] != "" for row in table(tmp_path / "u.csv")) == 32
    assert contents(folder) == before


def test_what_comes_after_a_damaged_chunk_of_a_trace_is_used_too(call, ended, folder, tmp_path):
    path = folder / "trace-001.gz"
    trace = bytearray(path.read_bytes())
    trace[len(trace) // 4] ^= 8
    path.write_bytes(trace)
    for name, folder_ in (("whole", ended), ("damaged", folder)):
        call("session", "export", folder_, "--out", tmp_path / f"{name}.csv")
    said = call("session", "export", folder, "--salvage", "--out", tmp_path / "t.csv")
    assert said.code == 1
    assert re.search(r"trace-001.gz is damaged, chunk \d+ of trace-001.gz does not", said.err)
    whole, damaged, now = (table(tmp_path / f"{name}.csv") for name in ("whole", "damaged", "t"))
    missing = [n for n, row in enumerate(now) if row["duration_s"] == ""]
    assert 1 <= len(missing) <= 3 < sum(row["duration_s"] == "" for row in damaged)
    for n, row in enumerate(now):
        if n not in missing:
            assert row == whole[n]
    faults = [spelled(found.text) for found in check_folder(folder) if not found.good]
    assert len(faults) == 1


@given(st.integers(0, 8 * len(WHOLE) - 1))
def test_a_bit_costs_two_events_at_most_and_what_is_kept_is_what_was_written(bit):
    flipped = bytearray(WHOLE)
    flipped[bit // 8] ^= 1 << bit % 8
    told = salvage(bytes(flipped))
    assert told.damage is not None
    kept = [event for event in told.events if event.kind != "lost"]
    written = decode(WHOLE).events
    first = bool(told.bad) and told.bad[0] == 1
    assert all(event in written for event in kept[first:])
    assert len(kept) >= len(written) - 2
    assert told.bad
    lost = {event.n for event in told.events if event.kind == "lost"}
    assert lost | {event.n for event in kept} == set(range(1, len(written) + 1))


def test_of_a_whole_journal_salvage_is_all(call, ended, tmp_path):
    assert salvage(WHOLE) == decode(WHOLE)
    for options in ((), ("--salvage",)):
        said = call("session", "export", ended, *options, "--out", tmp_path / f"{options}.csv")
        assert (said.code, said.err) == (0, "")
    one, other = (path.read_bytes() for path in tmp_path.glob("*.csv"))
    assert one == other


def test_trials_after_a_lost_answer_by_which_they_were_chosen_are_exported(call, tmp_path):
    folder = tmp_path / "s"
    how = ("--seed", "1", "--answers", "simulated", "--hand", "sweep:300", "--fast")
    run = ("session", "run", "tuning-width-adaptive", "--participant", "P07", *how)
    assert program.run(*run, "--out", folder).returncode == 0
    call("session", "export", folder, "--out", tmp_path / "whole.csv")
    whole = table(tmp_path / "whole.csv")
    line = damage(
        folder, rb'"trial":4,"attempt":1,"answer":"', b'"trial":4,"attempt":1,"answer":"x'
    )
    said = call("session", "check", folder)
    assert said.code == 1
    assert f"line {line} does not match its checksum" in said.err + said.out
    assert f"answers: {len(whole) - 1}" in said.out
    said = call("session", "export", folder, "--salvage", "--out", tmp_path / "salvaged.csv")
    assert said.code in (0, 1)
    salvaged = table(tmp_path / "salvaged.csv")
    fourth = salvaged.pop(3)
    assert (fourth["presented"], fourth["answered"]) == (whole.pop(3)["presented"], "")
    assert fourth["faults"] == f"events of the journal are lost: {line}"
    names = ("trial", "condition", "presented", "answered", "dot_width_mm")
    assert [[row[n] for n in names] for row in salvaged] == [
        [row[n] for n in names] for row in whole
    ]


def test_a_last_line_that_was_taken_away_is_told(call, folder):
    path = folder / "journal.jsonl"
    assert "not closed" not in call("session", "check", folder).out
    *lines, closed = path.read_bytes().splitlines(keepends=True)
    assert b'"event":"closed"' in closed
    path.write_bytes(b"".join(lines))
    assert "its last run was not closed" in call("session", "check", folder).out
