"""Whether a file that is looked at has changed, and when that is told."""

import os
import time

from vbraille.pictures.loading import FileWatch

SECOND_NS = 1_000_000_000


def write(path, text, *, ago_s):
    """Write a file that says that it was written so many seconds ago."""
    path.write_text(text)
    written_ns = time.time_ns() - round(ago_s * SECOND_NS)
    os.utime(path, ns=(written_ns, written_ns))


def test_a_change_is_told_once_at_the_first_look(tmp_path):
    path = tmp_path / "a.scene"
    write(path, "one", ago_s=9)
    watch = FileWatch(path)
    assert not watch.changed()
    write(path, "two", ago_s=8)
    assert [watch.changed() for _ in range(3)] == [True, False, False]


def test_what_is_just_being_written_is_told_when_it_is_whole(tmp_path):
    path = tmp_path / "a.scene"
    write(path, "one", ago_s=9)
    watch = FileWatch(path)
    for text in ("t", "tw", "two"):  # clocks of other machines may be ahead
        write(path, text, ago_s=-60)
        assert not watch.changed()
    assert [watch.changed() for _ in range(3)] == [True, False, False]


def test_an_empty_file_and_none_are_no_change(tmp_path):
    path = tmp_path / "a.scene"
    write(path, "one", ago_s=9)
    watch = FileWatch(path)
    write(path, "", ago_s=8)
    assert [watch.changed() for _ in range(3)] == [False] * 3
    path.unlink()
    assert [watch.changed() for _ in range(3)] == [False] * 3
    write(path, "two", ago_s=7)
    assert watch.changed()
