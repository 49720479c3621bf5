"""Places: when they are written; whatever fails or is killed meanwhile, one reads."""

import shutil
import sqlite3
import subprocess
import sys
from random import Random

import pytest

from tests.conftest import SEED
from tests.reading.places.shelved import keep, kept_place, opened
from tests.tiers import by_tier
from vbraille.reading.keptplace import Bookmark, KeptPlace, place_in
from vbraille.reading.library import KeptPlaces
from vbraille.translate import Document


class TestWriting:
    def test_places_are_written_every_half_second_and_at_the_end(self, folder):
        now = 0.0
        path = folder / "places.sqlite"
        with KeptPlaces.open(path, now=lambda: now) as places:
            kept = places.book(folder / "book.txt")
            other = sqlite3.connect(path)

            def written():
                (packed,) = other.execute("SELECT place FROM books").fetchone()
                return packed

            kept.keep(KeptPlace(1))
            first = written()
            now = 0.4
            kept.keep(KeptPlace(2))
            assert written() == first
            now = 0.6
            kept.keep(KeptPlace(2))
            second = written()
            assert second != first
            kept.keep(KeptPlace(3))
        assert written() not in (first, second)
        other.close()

    def test_the_last_of_many_places_is_kept_at_the_end(self, folder):
        document = Document.open(folder / "book.txt")
        with KeptPlaces.open(folder / "places.sqlite", now=lambda: 0.0) as places:
            kept = places.book(folder / "book.txt")
            kept.set_bookmark(Bookmark("a", 1))
            for character in range(100, 110):
                kept.keep_at(document, character)
        with KeptPlaces.open(folder / "places.sqlite") as places:
            assert places.book(folder / "book.txt").place == place_in(document, 109)

    def test_bookmarks_stand_by_their_place(self, folder):
        with opened(folder) as places:
            kept = places.book(folder / "book.txt")
            for name, at in (("x", 30), ("a", 40), ("m", 5)):
                kept.set_bookmark(Bookmark(name, at))
            kept.set_bookmark(Bookmark("a", 10))
            kept.delete_bookmark("x")
            kept.delete_bookmark("not there")
            assert [mark.name for mark in kept.bookmarks()] == ["m", "a"]

    def test_another_that_writes_holds_nobody_up_and_nothing_is_lost(self, folder):
        with opened(folder) as places:
            kept = places.book(folder / "book.txt")
            kept.keep(KeptPlace(1))
            other = sqlite3.connect(folder / "kept" / "places.sqlite", isolation_level=None)
            other.execute("BEGIN IMMEDIATE")
            kept.keep(KeptPlace(2))
            kept.set_bookmark(Bookmark("a", 1))
            assert kept.place == KeptPlace(2)
            assert kept.bookmarks() == [Bookmark("a", 1)]
            assert places.note() is None
            other.execute("ROLLBACK")
            other.close()
            kept.keep(KeptPlace(2))
        with opened(folder) as places:
            kept = places.book(folder / "book.txt")
            assert kept.place == KeptPlace(2)
            assert kept.bookmarks() == [Bookmark("a", 1)]

    def test_two_readers_at_once(self, folder):
        script = (
            "import sys\nfrom vbraille.reading.library import *\n"
            "from itertools import count\nclock = count()\n"
            "with KeptPlaces.open(sys.argv[1], now=lambda: float(next(clock))) as places:\n"
            "    kept = places.book(sys.argv[2])\n"
            "    for n in range(100):\n"
            "        kept.keep(KeptPlace(n))\n"
            "        kept.set_bookmark(Bookmark(sys.argv[3] + str(n % 9), n))\n"
            "    assert places.note() is None\n"
        )
        arguments = [str(folder / "places.sqlite"), str(folder / "book.txt")]
        both = [
            subprocess.Popen([sys.executable, "-c", script, *arguments, name], stderr=-1)
            for name in "ab"
        ]  # fmt: skip
        assert [reader.communicate()[1] for reader in both] == [b"", b""]
        with KeptPlaces.open(folder / "places.sqlite") as places:
            kept = places.book(folder / "book.txt")
            assert len(places.listed()) == 1
            assert kept.place == KeptPlace(99)
            assert len(kept.bookmarks()) == 18

    def test_a_book_that_another_forgets_meanwhile_is_kept_again(self, folder):
        with opened(folder) as places, opened(folder) as other:
            kept = places.book(folder / "book.txt")
            kept.keep(KeptPlace(1))
            assert other.forget(kept.digest)
            kept.keep(KeptPlace(2))
        assert kept_place(folder) == 2


_KEEPING = """
import sys
from itertools import count
from vbraille.reading.keptplace import KeptPlace
from vbraille.reading.library import KeptPlaces
clock = count()
places = KeptPlaces.open(sys.argv[1], now=lambda: float(next(clock)))
kept = places.book(sys.argv[2])
for n in count(0 if kept.place is None else kept.place.character + 1):
    kept.keep(KeptPlace(n, after="text " * 40))
    print(n, flush=True)
"""


def test_a_kill_at_any_moment_loses_nothing_that_was_kept(folder):
    chance = Random(SEED)
    path = folder / "places.sqlite"
    told = -1
    for _ in range(by_tier(2, 30, 500)):
        child = subprocess.Popen(
            [sys.executable, "-c", _KEEPING, path, folder / "book.txt"], stdout=subprocess.PIPE
        )
        for _ in range(chance.randrange(1, 400)):
            told = int(child.stdout.readline())
        child.kill()
        rest = child.communicate()[0].split(b"\n")
        told = max([told, *(int(line) for line in rest[:-1])])
        with KeptPlaces.open(path) as places:
            kept = places.book(folder / "book.txt").place.character
            assert told <= kept <= told + 1
            assert places.note() is None
    connection = sqlite3.connect(path)
    assert connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    connection.close()


_FULL = """
import resource, sys
from itertools import count
from vbraille.reading.keptplace import Bookmark, KeptPlace
from vbraille.reading.library import KeptPlaces
clock = count()
places = KeptPlaces.open(sys.argv[1], now=lambda: float(next(clock)))
kept = places.book(sys.argv[2])
kept.keep(KeptPlace(1))
resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))
kept.keep(KeptPlace(2))
kept.set_bookmark(Bookmark("a", 2))
print(places.note())
assert kept.place == KeptPlace(2) and kept.bookmarks() == [Bookmark("a", 2)]
kept.keep(KeptPlace(3))
assert places.note() is None
if len(sys.argv) > 3:
    resource.setrlimit(resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
places.close()
"""


@pytest.mark.parametrize("room", [(), ("again",)])
def test_a_full_disk_is_one_sentence_and_the_file_stays_good(folder, room):
    path = folder / "places.sqlite"
    said = subprocess.run(
        [sys.executable, "-c", _FULL, path, folder / "book.txt", *room],
        capture_output=True, check=True, text=True,
    )  # fmt: skip
    assert said.stderr == ""
    (sentence,) = said.stdout.splitlines()
    assert sentence.startswith(f"places cannot be kept in {path} now: ")
    with KeptPlaces.open(path) as places:
        kept = places.book(folder / "book.txt")
        assert places.note() is None
        assert kept.place == KeptPlace(3 if room else 1)
        assert len(kept.bookmarks()) == len(room)


_FULL_AT_OPENING = """
import resource, sqlite3, sys
from itertools import count
from vbraille.reading.keptplace import Bookmark, KeptPlace
from vbraille.reading.library import KeptPlaces
clock = count()
unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
resource.setrlimit(resource.RLIMIT_FSIZE, (100, resource.RLIM_INFINITY))
places = KeptPlaces.open(sys.argv[1], now=lambda: float(next(clock)))
kept = places.book(sys.argv[2])
print(places.note())
kept.keep(KeptPlace(2))
kept.set_bookmark(Bookmark("a", 2))
print(kept.fault)
resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
while kept.fault is not None and next(clock) < 100:
    kept.keep(KeptPlace(2))
assert kept.bookmarks() == [Bookmark("a", 2)]
assert places.note() is None
print(*sqlite3.connect(sys.argv[1]).execute("SELECT name FROM bookmarks").fetchall())
"""


@pytest.mark.parametrize("known", [False, True])
def test_a_disk_that_is_full_at_opening_keeps_all_once_there_is_room(folder, known):
    path = folder / "kept" / "places.sqlite"
    if known:
        keep(folder)
    else:
        path.parent.mkdir()
    said = subprocess.run(
        [sys.executable, "-c", _FULL_AT_OPENING, path, folder / "book.txt"],
        capture_output=True, check=True, text=True,
    )  # fmt: skip
    assert said.stderr == ""
    note, fault, written = said.stdout.splitlines()
    assert str(path) in note
    assert fault != "None"
    assert fault in note
    assert written == "('a',)"
    with opened(folder) as places:
        assert len(places.listed()) == 1
        kept = places.book(folder / "book.txt")
        assert kept.place == KeptPlace(2)
        assert [mark.name for mark in kept.bookmarks()] == ["a"]


class TestNoFile:
    """Where the file is no use, reading goes on, one sentence says so, and nothing is deleted."""

    def reads(self, path, folder):
        with KeptPlaces.open(path) as places:
            note = places.note()
            kept = places.book(folder / "book.txt")
            kept.keep(KeptPlace(9))
            kept.set_bookmark(Bookmark("a", 9))
            assert kept.place == KeptPlace(9)
            assert kept.bookmarks() == [Bookmark("a", 9)]
            assert len(places.listed()) >= 1
            assert places.note() is None
            return note

    def test_no_folder_can_be_made(self, folder):
        path = folder / "book.txt" / "places.sqlite"
        note = self.reads(path, folder)
        assert note == (
            f"places cannot be kept in {path}: Not a directory; reading goes on, and it is tried "
            "again"
        )

    def test_the_path_is_a_folder(self, folder):
        assert "Is a directory" in self.reads(folder, folder)

    def test_a_newer_version_wrote_it(self, folder):
        path = folder / "places.sqlite"
        connection = sqlite3.connect(path)
        connection.execute("CREATE TABLE future (x)")
        connection.execute("PRAGMA user_version = 99")
        connection.close()
        before = path.read_bytes()
        assert "another version of vbraille has written it" in self.reads(path, folder)
        assert path.read_bytes() == before

    @pytest.mark.parametrize(
        "junk", [b"no database at all " * 500, b"SQLite format 3\0" + b"x" * 9000]
    )
    def test_a_damaged_file_is_set_aside(self, folder, junk):
        path = folder / "places.sqlite"
        path.write_bytes(junk)
        note = self.reads(path, folder)
        (aside,) = folder.glob("places.sqlite.damaged-*")
        assert aside.name in note
        assert aside.read_bytes() == junk
        assert self.reads(path, folder) is None

    def test_damage_that_is_found_late(self, folder):
        path = folder / "kept" / "places.sqlite"
        keep(folder)
        raw = path.read_bytes()
        path.write_bytes(raw[:4096] + b"\xff" * (len(raw) - 4096))
        with opened(folder) as places:
            kept = places.book(folder / "book.txt")
            assert "are damaged; the file is now" in places.note()
            kept.keep(KeptPlace(7))
        assert kept_place(folder) == 7
        assert len(list(path.parent.glob("*.damaged-*"))) == 1

    def test_what_can_only_be_read_is_read(self, folder):
        keep(folder)
        path = folder / "kept" / "places.sqlite"
        path.chmod(0o400)
        if chattr := shutil.which("chattr"):  # root may write in spite of that
            subprocess.run([chattr, "+i", path], check=False, capture_output=True)
        try:
            try:
                path.open("r+b").close()
            except OSError:
                with KeptPlaces.open(path) as places:
                    assert places.note() is not None
                    assert places.book(folder / "book.txt").place == KeptPlace(1000, 20, 0.1)
            else:
                pytest.skip("this file system or user has no file that can only be read")
        finally:
            if chattr:
                subprocess.run([chattr, "-i", path], check=False, capture_output=True)
