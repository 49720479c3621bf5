"""Journal and traces tied: an ended session cannot be altered without a trace."""

import json
import re
import shutil

import pytest

from tests.cli import program
from tests.cli.test_session import words
from tests.cli.test_session_bad_input import contents
from tests.sessions.sittings import MINI, Session
from vbraille.sessions.record.events import Cue, Note
from vbraille.sessions.record.folder import check_folder, load
from vbraille.sessions.record.journal import Journal, Tie, encode
from vbraille.sessions.record.traces import TraceWriter, read_last_tie, read_trace

ANSWERS = "l\nc\nnote all is well\n?\nl\n"


@pytest.fixture(scope="module")
def ended(tmp_path_factory):
    """A session that was run to its end, and its last line, which has the sum."""
    room = tmp_path_factory.mktemp("ties")
    (room / "answers").write_text(ANSWERS)
    done = program.run(*words(room), "--answers", room / "answers")
    assert done.returncode == 0, done.stderr
    return room / "s", re.fullmatch(r"record: (\d+) events, SHA-256 (\w{64})",
                                    done.stdout.splitlines()[-1]).groups()  # fmt: skip


@pytest.fixture
def folder(ended, tmp_path):
    """A copy of it."""
    return shutil.copytree(ended[0], tmp_path / "s")


def cut(folder, count):
    """Take whole lines off the journal's end."""
    path = folder / "journal.jsonl"
    lines = path.read_bytes().splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:-count]))
    return lines


def faults(folder, *expected):
    return [found.text for found in check_folder(folder, *expected) if not found.good]


def since_answer(folder, trial):
    """How many lines there are from an answer to the end."""
    lines = (folder / "journal.jsonl").read_bytes().splitlines()
    events = [json.loads(line) for line in lines]
    at = next(n for n, e in enumerate(events) if e["event"] == "answer" and e["trial"] == trial)
    return len(lines) - at


@pytest.mark.parametrize("trial", [1, 4])
def test_lines_taken_off_an_ended_session_are_missed(call, folder, trial):
    assert faults(folder) == []
    count = since_answer(folder, trial)
    cut(folder, count)
    (found,) = (text for text in faults(folder) if "was answered" not in text and text)
    assert "it was written when journal.jsonl had" in found
    assert "events were lost or taken off its end" in found
    before = contents(folder)
    said = call("session", "resume", folder)
    assert (said.code, said.out.count("answer")) == (1, 0)
    assert said.err.count("\n") == 1
    assert "is not whole: of trace-001.gz, it was written when journal.jsonl had" in said.err
    assert contents(folder) == before


def test_and_lines_put_there_instead_are_seen(folder):
    # As one who knows the format would: every checksum of the journal is right.
    lines = cut(folder, 0 or since_answer(folder, 4))
    kept = (folder / "journal.jsonl").read_bytes()
    crc = int(re.search(rb'"crc":"(\w+)"', kept.splitlines()[-1])[1], 16)
    for line in lines[len(kept.splitlines()) :]:
        event = json.loads(line)
        del event["crc"]
        if event["event"] == "answer":
            event["answer"] = "⠉"
        line, crc = encode(event, crc)
        kept += line
    (folder / "journal.jsonl").write_bytes(kept)
    assert load(folder).journal.damage is None
    (found,) = faults(folder)
    assert found.startswith("trace-001.gz: it was written when event ")
    assert found.endswith("was another: events were taken off its end and replaced")


def test_a_trace_that_was_replaced_is_seen_by_the_sum_that_the_journal_has(folder):
    path = folder / "trace-001.gz"
    trace, size = read_trace(path), path.stat().st_size
    path.unlink()
    writer = TraceWriter(path, lambda: trace.ties[-1])
    ticks = trace.ticks.copy()
    ticks["vx_mm_s"] = 0.0
    writer.add(ticks)
    writer.close()
    with path.open("ab") as file:  # of the same length
        file.truncate(size) if file.tell() > size else file.write(b"")
    assert any(re.search("trace-001.gz: ", text) for text in faults(folder))


def test_the_sum_that_was_said_is_that_of_this_record_or_is_not(call, ended, folder):
    _, (count, kept) = ended
    said = call("session", "check", folder, "--expect", kept)
    assert said.code == 0
    assert f"expected: the sum is that of the first {count} events\n" in said.out
    assert call("session", "check", folder, "--expect", kept[:16].upper()).code == 0
    wrong = kept[:-1] + ("0" if kept[-1] != "0" else "1")
    said = call("session", "check", folder, "--expect", wrong)
    assert said.code == 1
    assert "fault: expected: the sum is not that of this journal; it was changed" in said.out
    said = call("session", "check", folder, "--expect", "abc")
    assert (said.code, said.out) == (2, "")
    assert "no SHA-256; give its 64 digits" in said.err


def test_a_session_on_paper_altered_at_its_end_is_seen_by_its_sum(call, tmp_path):
    (tmp_path / "answers").write_text("l\nc\n?\nl\n")
    paper = MINI.replace('model = "vbd"', 'model = "vbd"\nmedium = "paper"')
    arguments = [word for word in words(tmp_path, paper) if word != "--fast"]
    said = call(*arguments, "--answers", tmp_path / "answers")
    assert said.code == 0, said.err
    kept = said.out.split()[-1]
    assert call("session", "check", tmp_path / "s", "--expect", kept).code == 0
    cut(tmp_path / "s", since_answer(tmp_path / "s", 4))
    (tmp_path / "more").write_text("c\n")
    said = call("session", "resume", tmp_path / "s", "--answers", tmp_path / "more")
    assert (said.code, said.err) == (0, "")
    assert call("session", "check", tmp_path / "s").code == 0
    assert call("session", "check", tmp_path / "s", "--expect", kept).code == 1


def test_the_sum_of_a_stop_holds_for_what_was_before_it_when_the_session_went_on(call, tmp_path):
    (tmp_path / "answers").write_text("l\nc\nstop\n?\nl\n")
    said = call(*words(tmp_path), "--answers", tmp_path / "answers")
    assert said.code == 0
    kept = said.out.split()[-1]
    said = call("session", "resume", tmp_path / "s")
    assert (said.code, said.err) == (0, "")
    said = call("session", "check", tmp_path / "s", "--expect", kept)
    assert said.code == 0
    assert re.search(
        r"expected: the sum is that of the first \d+ events; \d+ events came", said.out
    )
    said = call("session", "export", tmp_path / "s", "--out", tmp_path / "t.csv")
    last = said.out.splitlines()[-1]
    assert re.fullmatch(r"record: \d+ events, SHA-256 \w{64}", last)
    said = call("session", "check", tmp_path / "s", "--expect", last.split()[-1])
    assert said.out.endswith("events\n")


def test_a_chunk_names_the_last_event_that_is_on_the_disk(tmp_path):
    session = Session(tmp_path / "s")
    session.sit()
    told = load(session.folder).journal
    trace = read_trace(session.folder / "trace-001.gz")
    assert trace.ties == tuple(dict.fromkeys(trace.ties))
    for number, crc in trace.ties:
        assert crc == (told.crcs[number - 1] if number else 0)
    assert told.events[trace.ties[-1].number - 1].kind == "end"
    assert read_last_tie(session.folder / "trace-001.gz") == trace.ties[-1]
    with Journal(session.folder) as journal:
        assert journal.durable == Tie(0, 0)  # of the others it is not known
        journal.append(Cue(trial=1, t_s=1.0))
        assert journal.durable == Tie(0, 0)
        journal.append(Note(text="", t_s=1.0))
        assert journal.durable.number == len(told.events) + 2
