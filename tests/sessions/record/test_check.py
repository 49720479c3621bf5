"""Whether a session is whole: what crashes leave is said, damage is a fault, nothing is mended."""

import shutil
from dataclasses import replace

import pytest

from tests.cli import program
from tests.sessions.sittings import MINI, Session, crash
from tests.tiers import by_tier
from vbraille.errors import VbrailleError
from vbraille.sessions.record import journal
from vbraille.sessions.record.export import Traces, rows
from vbraille.sessions.record.folder import check, check_folder, load, read_journal
from vbraille.sessions.record.journal import Journal, decode
from vbraille.sessions.record.progress import Progress

FILES = (
    "journal.jsonl", "journal.torn", "plan.json", "protocol.toml", "session.json",
    "trace-001.gz", "trace-002.gz",
)  # fmt: skip


@pytest.fixture(scope="module")
def sat(tmp_path_factory):
    """A session that the program ran, that lost its end in a crash and was resumed to its end."""
    room = tmp_path_factory.mktemp("check")
    (room / "mini.toml").write_text(MINI)
    folder = room / "s"
    options = ("--participant", "P1", "--seed", "1", "--answers", "simulated", "--fast")
    done = program.run(
        "session", "run", room / "mini.toml", "--hand", "sweep:150", *options, "--out", folder
    )
    assert done.returncode == 0, done.stderr
    path = folder / journal.NAME
    lines = path.read_bytes().splitlines(keepends=True)
    answers = [n for n, line in enumerate(lines) if b'"answer"' in line]
    crash(folder, len(b"".join(lines[: answers[1]])) + 50)
    done = program.run("session", "resume", folder)
    assert done.returncode == 0, done.stderr
    assert "torn: 50 bytes at the end of the journal are in journal.torn" in done.stdout
    assert sorted(path.name for path in folder.iterdir()) == sorted(FILES)
    return folder


@pytest.fixture
def folder(sat, tmp_path):
    """A copy of it."""
    return shutil.copytree(sat, tmp_path / "s")


def said(folder):
    """Findings, and whether all is good."""
    found = list(check_folder(folder))
    return "\n".join(finding.text for finding in found), all(finding.good for finding in found)


def faults(folder):
    """What is wrong, a line each; not empty if nothing can be said at all."""
    try:
        found = [finding.text for finding in check_folder(folder) if not finding.good]
    except VbrailleError as error:
        return str(error) if error.exit_code == 1 else ""
    return "\n".join(found)


def test_of_a_whole_session_all_is_said_to_be_whole(sat):
    text, good = said(sat)
    assert good
    for name in ("session.json, plan.json, protocol.toml: as they were",
                 "plan: 4 trials, as the seed makes them", "events, whole",
                 "trace-001.gz: ", "trace-002.gz: ", "answers: 4 of 4; ",
                 "journal.torn: 51 bytes set aside", "the session is ended"):  # fmt: skip
        assert name in text
    assert not [finding for finding in check(load(sat)) if not finding.good]


@pytest.mark.no_cover
@pytest.mark.parametrize("name", FILES)
def test_no_bit_flips_unseen_in_any_file(folder, rng, name):
    path = folder / name
    whole = path.read_bytes()
    events = read_journal(folder).events
    size = 8 * len(whole)
    for bit in [
        *rng.integers(0, size, by_tier(8, 40, 400)).tolist(),
        *range(8),
        *range(size - 8, size),
    ]:
        flipped = bytearray(whole)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        assert name in faults(folder), (name, bit)
        assert path.read_bytes() == flipped  # nothing was mended
        if name == journal.NAME:
            told = decode(bytes(flipped))
            assert told.events == events[: whole[: bit // 8].count(b"\n")], bit


@pytest.mark.no_cover
def test_nor_in_the_header_of_the_last_chunk_of_a_trace(folder):
    path = folder / "trace-001.gz"  # of which the journal does not tell how it was closed
    whole = path.read_bytes()
    last = whole.rindex(b"\x1f\x8b\x08\x04")
    for bit in range(8 * last, 8 * (last + 24), by_tier(11, 3, 1)):
        flipped = bytearray(whole)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        assert "trace-001.gz: damaged, " in faults(folder), bit


@pytest.mark.parametrize("name", FILES)
def test_a_file_that_is_gone_is_missed(folder, name):
    (folder / name).unlink()
    assert name in faults(folder)


def test_where_the_plan_is_gone_the_others_are_looked_at(folder):
    (folder / "plan.json").unlink()
    trace = folder / "trace-002.gz"
    trace.write_bytes(trace.read_bytes()[:-1000])
    text, good = said(folder)
    assert not good
    assert "plan.json cannot be read: No such file" in text
    assert "events, whole" in text
    assert "trace-001.gz: " in text
    assert "trace-002.gz: damaged, it has " in text


def test_a_trace_cut_where_a_chunk_ends_is_damaged_too(folder):
    path = folder / "trace-002.gz"
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.rindex(b"\x1f\x8b\x08\x04")])
    assert "trace-002.gz: damaged, it has " in faults(folder)


def test_a_trace_without_a_stimulus_that_was_answered_is_a_fault(tmp_path):
    sat = Session(tmp_path / "s").sit()
    book = tmp_path / "s" / journal.NAME
    book.write_bytes(b"".join(book.read_bytes().splitlines(keepends=True)[:-1]))  # not "closed"
    path = tmp_path / "s" / "trace-001.gz"
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.rindex(b"\x1f\x8b\x08\x04", 0, len(whole) * 2 // 3)])
    assert "trace-001.gz: stimulus 4 was answered and is not in it" in faults(tmp_path / "s")
    path.unlink()
    assert "trace-001.gz: damaged, it is gone" in faults(tmp_path / "s")
    assert sat.progress.done == 4


def test_a_trace_of_a_run_that_the_journal_does_not_tell_of_is_said(folder):
    shutil.copy(folder / "trace-001.gz", folder / "trace-003.gz")
    text, good = said(folder)
    assert good
    assert "trace-003.gz: of a run that the journal does not tell of" in text


def test_what_a_crash_set_aside_and_could_not_tell_of_is_clean(folder):
    with (folder / "journal.torn").open("ab") as file:
        file.write(b'{"n":99,"eve\n')
    text, good = said(folder)
    assert good
    assert "journal.torn: 64 bytes set aside" in text


@pytest.mark.no_cover
def test_cut_at_every_byte_of_its_last_4_kb_a_journal_is_a_state_to_go_on_from(folder):
    path = folder / journal.NAME
    whole = path.read_bytes()
    record = load(folder)
    traces = Traces(record)
    ends = [n + 1 for n, byte in enumerate(whole) if byte == ord("\n")]
    least = max(len(whole) - 4096, ends[0])
    kept = {trace.name: trace.read_bytes() for trace in folder.glob("trace-*.gz")}
    cuts = {*range(least, len(whole), by_tier(6, 1, 1)), *ends}
    for cut in sorted(cut for cut in cuts if least <= cut < len(whole)):
        told = decode(whole[:cut])
        assert told.events == record.journal.events[: sum(end <= cut for end in ends)], cut
        assert told.damage is None
        progress = Progress(record.plan, told.events)
        answers = sum(e.kind == "answer" for e in told.events)
        assert progress.done == answers
        if (cut - least) % by_tier(192, 48, 1) and cut not in ends:
            continue
        for name, trace in kept.items():
            (folder / name).write_bytes(trace)
        path.write_bytes(whole)
        crash(folder, cut)
        text, good = said(folder)
        assert good, (cut, text)
        assert ("its last line was cut short" in text) == bool(told.torn), cut
        assert f"answers: {answers} of 4" in text
        table = rows(replace(record, journal=told), traces)
        assert sum(row["answered"] != "" for row in table) == answers


@pytest.mark.no_cover
def test_and_whatever_the_cut_it_goes_on_to_the_end(tmp_path, rng):
    session = Session(tmp_path / "s")
    session.sit()
    path = session.folder / journal.NAME
    for cut in sorted(rng.integers(1, 4096, 8).tolist()):
        whole = path.read_bytes()
        crash(session.folder, max(len(whole) - cut, whole.index(b"\n") + 1))
        before = load(session.folder).journal.events
        sat = session.sit()
        assert sat.events[: len(before)] == before
        assert sat.progress.done == 4
        assert sat.progress.ended
        assert faults(session.folder) == ""


def test_nothing_is_mended_in_passing(folder):
    path = folder / journal.NAME
    damaged = bytearray(path.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    path.write_bytes(damaged)
    before = {p.name: p.read_bytes() for p in folder.iterdir()}
    assert "journal.jsonl: damaged, line " in faults(folder)
    rows(load(folder))
    with pytest.raises(VbrailleError, match="does not match its checksum"):
        Journal(folder)
    assert {p.name: p.read_bytes() for p in folder.iterdir()} == before
