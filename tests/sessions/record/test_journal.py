"""The journal: every event whole, or said not to be."""

import subprocess
import sys

import pytest

from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Answer, Cue, Note, Session
from vbraille.sessions.record.journal import Journal, decode, first_lines


@pytest.fixture
def folder(tmp_path):
    """A session's directory with a journal of one event."""
    (tmp_path / journal.NAME).write_bytes(first_lines(Session(format=2, sha256={}, t_s=0.0)))
    return tmp_path


def fill(folder, count=5):
    with Journal(folder) as book:
        for n in range(count):
            book.append(Note(text=f"é {n}\n", t_s=float(n)))
    return (folder / journal.NAME).read_bytes()


def test_what_was_appended_is_told_in_order(folder):
    told = decode(fill(folder))
    assert [event.text for event in told.events[1:]] == [*(f"é {n}\n" for n in range(5))]
    assert [event.n for event in told.events] == [1, 2, 3, 4, 5, 6]
    assert (told.torn, told.damage) == (b"", None)


def test_a_journal_goes_on_when_it_is_opened_again(folder):
    fill(folder)
    fill(folder)
    told = decode((folder / journal.NAME).read_bytes())
    assert len(told.events) == 11
    assert told.damage is None


@pytest.mark.no_cover
def test_cut_at_every_byte_everything_before_is_kept(folder):
    whole = fill(folder, 40)
    assert len(whole) > 4096
    ends = [n + 1 for n, byte in enumerate(whole) if byte == ord("\n")]
    for cut in range(len(whole) - 4096, len(whole)):
        told = decode(whole[:cut])
        kept = sum(end <= cut for end in ends)
        assert len(told.events) == kept, cut
        assert told.damage is None, cut
        assert told.torn == whole[:cut][([0, *ends])[kept] :], cut


def test_no_bit_flips_unseen(folder):
    whole = fill(folder, 3)
    lines = whole.splitlines(keepends=True)
    for bit in range(8 * len(whole)):
        flipped = bytearray(whole)
        flipped[bit // 8] ^= 1 << bit % 8
        told = decode(bytes(flipped))
        assert told.damage or told.torn, bit
        # What stands before the flipped byte is kept, and nothing else is.
        before = sum(len(b"".join(lines[: n + 1])) <= bit // 8 for n in range(len(lines)))
        assert len(told.events) == before, bit


def test_a_line_taken_out_put_in_or_moved_is_seen(folder):
    lines = fill(folder).splitlines(keepends=True)
    for changed in (
        lines[:2] + lines[3:],
        [*lines[:3], lines[2], *lines[3:]],
        [lines[0], lines[2], lines[1], *lines[3:]],
        lines[1:],
    ):
        assert "checksum" in decode(b"".join(changed)).damage


def test_a_torn_tail_is_set_aside_and_the_journal_goes_on(folder):
    whole = fill(folder)
    (folder / journal.NAME).write_bytes(whole[:-9])
    with Journal(folder) as book:
        assert len(book.contents.events) == 5
        length = book.set_torn_aside()
        book.append(Note(text="after", t_s=9.0))
    torn = whole[:-9].rpartition(b"\n")[2]
    assert length == len(torn) > 0
    assert (folder / journal.TORN).read_bytes() == torn + b"\n"
    told = decode((folder / journal.NAME).read_bytes())
    assert (told.events[-1].text, told.damage, told.torn) == ("after", None, b"")


def test_a_torn_tail_is_on_the_disk_elsewhere_before_it_is_cut_off_and_so_is_the_cut(
    folder, synced
):
    whole = fill(folder)
    (folder / journal.NAME).write_bytes(whole[:-9])
    torn = whole[:-9].rpartition(b"\n")[2]
    synced.clear()
    with Journal(folder) as book:
        book.set_torn_aside()
    before = {journal.NAME: len(whole) - 9, journal.TORN: len(torn) + 1}
    after = before | {journal.NAME: len(whole) - 9 - len(torn)}
    assert synced == [(journal.TORN, before), ("", before), (journal.NAME, after)]


def test_a_whole_journal_has_nothing_to_set_aside(folder):
    fill(folder)
    with Journal(folder) as book:
        assert book.set_torn_aside() == 0
    assert not (folder / journal.TORN).exists()


def test_a_damaged_journal_is_not_opened_nor_changed(folder):
    damaged = bytearray(fill(folder))
    damaged[200] ^= 4
    (folder / journal.NAME).write_bytes(damaged)
    with pytest.raises(VbrailleError, match=r"line \d does not match its checksum"):
        Journal(folder)
    assert (folder / journal.NAME).read_bytes() == damaged


def test_it_is_open_to_one_at_a_time(folder):
    with Journal(folder), pytest.raises(InputError, match="open in another console"):
        Journal(folder)
    Journal(folder).close()


def test_a_full_disk_is_said_and_the_event_is_not_in(folder):
    # A limit on the size of files stands in for the disk, in a process of its own.
    script = f"""
import resource, signal
from pathlib import Path
from vbraille.errors import VbrailleError
from vbraille.sessions.record.events import Note
from vbraille.sessions.record.journal import Journal
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
with Journal(Path({str(folder)!r})) as book:
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))
    done = 0
    try:
        while True:
            book.append(Note(text="x" * 100, t_s=0.0))
            done += 1
    except VbrailleError as error:
        print(done, error)
"""
    ran = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, encoding="utf-8", check=True
    )
    done, said = ran.stdout.split(" ", 1)
    assert "File too large; the note is not in, all before it is" in said
    told = decode((folder / journal.NAME).read_bytes())
    assert len(told.events) == 1 + int(done) > 5
    assert told.damage is None


def test_an_answer_is_synced_before_it_is_said_to_be_in(folder, synced):
    with Journal(folder) as book:
        book.append(Answer(trial=1, attempt=1, answer="⠁", t_s=0.0))
        whole = {journal.NAME: (folder / journal.NAME).stat().st_size}
        assert synced == [(journal.NAME, whole)]
        book.append(Cue(trial=1, t_s=0.0))
        assert len(synced) == 1
