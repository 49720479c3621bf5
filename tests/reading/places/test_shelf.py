"""Places: kept per content, found again after a move or a change; whatever fails, one reads."""

import os
import shutil
import sqlite3
import subprocess
import sys
from itertools import count
from random import Random

import pytest

from tests.conftest import SEED
from tests.reading.places.resumed import open_kept
from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.reading.places import (
    Bookmark,
    BookOptions,
    KeptPlace,
    KeptPlaces,
    last_book,
)
from vbraille.reading.places.anchoring import place_in
from vbraille.reading.places.identity import QUICK_BYTES
from vbraille.translate import Document

TEXT = "\n\n".join(f"Paragraph number {n} says {n * n} and no more." for n in range(200))


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    return tmp_path


def opened(folder):
    seconds = count(1_000_000)
    return KeptPlaces.open(folder / "kept" / "places.sqlite", now=lambda: float(next(seconds)))


def keep(folder, name="book.txt", place=None, **more):
    with opened(folder) as places:
        kept = places.book(folder / name)
        kept.keep(place or KeptPlace(1000, 20, 0.1))
        for method, value in more.items():
            getattr(kept, method)(value)
        assert places.note() is None
        return kept.number


def kept_place(folder, name="book.txt"):
    with opened(folder) as places:
        kept = places.book(folder / name)
        assert places.note() is None
        return None if kept.place is None else kept.place.character


class TestContent:
    def test_a_book_that_was_never_read_has_no_place(self, folder):
        assert kept_place(folder) is None

    def test_everything_is_there_the_next_time(self, folder):
        document = Document.open(folder / "book.txt")
        document.block(150)
        place = place_in(document, TEXT.index("number 100"))
        options = BookOptions(language="fr", keep_lines=True)
        keep(
            folder,
            place=place,
            keep_tuning={"texture": 0.5},
            keep_index=document.index(),
            keep_options=options,
            set_bookmark=Bookmark("b", 7, "text"),
        )
        with opened(folder) as places:
            kept = places.book(folder / "book.txt")
            assert kept.place == place
            assert kept.place.after.startswith("number 100 says 10000")
            assert kept.place.before.endswith("no more. Paragraph ")
            assert kept.tuning == {"texture": 0.5}
            assert kept.index == document.index()
            assert kept.options == options
            assert kept.bookmarks() == [Bookmark("b", 7, "text")]
            assert not kept.changed

    @pytest.mark.parametrize("size", [None, QUICK_BYTES + 1])
    def test_a_moved_or_copied_book_is_found(self, folder, size):
        if size:
            (folder / "book.txt").write_text("word " * (size // 5 + 1))
        keep(folder)
        (folder / "book.txt").rename(folder / "moved.txt")
        assert kept_place(folder, "moved.txt") == 1000
        shutil.copy(folder / "moved.txt", folder / "copy.txt")  # another inode and time
        assert kept_place(folder, "copy.txt") == 1000
        with opened(folder) as places:
            assert [book.path for book in places.listed()] == [str(folder / "copy.txt")]

    def test_other_content_is_another_book(self, folder):
        keep(folder)
        (folder / "other.txt").write_text(TEXT.replace("more", "less"))
        assert kept_place(folder, "other.txt") is None
        assert kept_place(folder) == 1000

    def test_what_the_system_says_is_the_same_is_not_read(self, folder):
        path = folder / "book.txt"
        keep(folder)
        times = path.stat()
        with path.open("r+") as file:
            file.write("p")
        os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns))
        with opened(folder) as places:
            assert not places.book(path).changed

    def test_standard_input_is_known_by_its_digest(self, folder):
        with opened(folder) as places:
            places.book(None, "ab" * 32).keep(KeptPlace(5))
            assert places.book(None, "cd" * 32).place is None
        with opened(folder) as places:
            assert places.book(None, "ab" * 32).place == KeptPlace(5)
            assert places.last_path() is None


def test_names_and_texts_that_are_no_text(folder):
    path = folder / os.fsdecode(b"b\xffk.txt")
    path.write_bytes("\ud800 and more".encode("utf-32-le", "surrogatepass"))
    with opened(folder) as places:
        options = BookOptions(encoding="utf-32-le")
        resumed = open_kept(places, str(path), options)
        resumed.kept.keep_at(resumed.source, 6)
        resumed.kept.set_bookmark(Bookmark("\udcff", 0, "\ud800"))
    with opened(folder) as places:
        assert places.last_path() == path
        assert [book.missing for book in places.listed()] == [False]
        resumed = open_kept(places, None)
        assert resumed.place.character == 6
        assert [mark.text for mark in resumed.kept.bookmarks()] == ["?"]
        resumed.kept.delete_bookmark("\udcff")
        assert resumed.kept.bookmarks() == []


class TestChanged:
    @pytest.mark.parametrize(
        ("changed", "at"),
        [
            (TEXT.replace("number 3 ", "number 3, which is new, "), "number 100"),
            ("A foreword.\n\n" * 50 + TEXT, "number 100"),
            (TEXT.replace("\n\n", "\r\n\r\n").replace(" says ", "\r\nsays "), "number 100"),
            (TEXT.replace("says 9801", "told 9801"), "number 100"),
            (TEXT.replace("says 10000", "told 10000"), "number 100"),
            (TEXT[TEXT.index("Paragraph number 90 ") :], "number 100"),
        ],
    )  # fmt: skip
    def test_the_place_is_found_by_the_text_around_it(self, folder, changed, at):
        path = folder / "book.txt"
        document = Document.open(path)
        place = place_in(document, TEXT.index(at))
        keep(
            folder,
            place=place,
            set_bookmark=Bookmark("b", TEXT.index("number 120"), "number 120 says 14400"),
        )
        path.write_bytes(changed.encode())
        with opened(folder) as places:
            resumed = open_kept(places, str(path))
            assert resumed.note == (
                "the text has changed since it was read; the place was found again"
            )
            assert changed[resumed.place.character :].startswith(at)
            (mark,) = resumed.kept.bookmarks()
            assert changed[mark.character :].startswith("number 120")
        with opened(folder) as places:
            resumed = open_kept(places, str(path))
            assert resumed.note is None
            assert changed[resumed.place.character :].startswith(at)
            assert len(places.listed()) == 1
        path.write_text(TEXT)  # and back
        assert kept_place(folder) == place.character

    def test_the_nearest_of_equal_texts_is_taken(self, folder):
        path = folder / "book.txt"
        path.write_text("The same paragraph as all the others.\n\n" * 300)
        document = Document.open(path)
        keep(folder, place=place_in(document, 39 * 150))
        path.write_text("New.\n\n" + path.read_text())
        with opened(folder) as places:
            place = open_kept(places, str(path)).place
            assert abs(place.character - 39 * 150) <= 39

    def test_where_the_text_is_gone_the_share_is_kept(self, folder):
        path = folder / "book.txt"
        document = Document.open(path)
        keep(folder, place=place_in(document, TEXT.index("number 100")))
        path.write_text("Something else altogether.\n\n" * 300)
        with opened(folder) as places:
            resumed = open_kept(places, str(path))
            assert "the place is gone" in resumed.note
            assert resumed.place.share == pytest.approx(0.5, abs=0.05)


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
            other = sqlite3.connect(places.path, isolation_level=None)
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
            "import sys\nfrom vbraille.reading.places import *\n"
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
            assert other.forget(kept.number)
            kept.keep(KeptPlace(2))
        assert kept_place(folder) == 2


_KEEPING = """
import sys
from itertools import count
from vbraille.reading.places import KeptPlace, KeptPlaces
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
from vbraille.reading.places import Bookmark, KeptPlace, KeptPlaces
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
            f"places cannot be kept in {path}: Not a directory; reading goes on, and this reading "
            "is not kept"
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
        assert "a newer vbraille has written it" in self.reads(path, folder)
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


class TestList:
    def test_the_newest_first_and_what_is_missing(self, folder):
        keep(folder)
        (folder / "other.txt").write_text("Another text.")
        now = 2_000_000.0
        with KeptPlaces.open(folder / "kept" / "places.sqlite", now=lambda: now) as places:
            places.book(folder / "other.txt", title="Another")
            listed = places.listed()
            assert [book.title for book in listed] == ["Another", "book.txt"]
            assert [book.missing for book in listed] == [False, False]
            (folder / "book.txt").unlink()
            assert [book.missing for book in places.listed()] == [False, True]
            assert places.forget(listed[0].number)
            assert not places.forget(listed[0].number)
            with pytest.raises(InputError, match="is not there any more"):
                last_book(places)
            assert places.forget(listed[1].number)
            assert places.listed() == []
            with pytest.raises(InputError, match="give the name of a file"):
                open_kept(places, None)

    def test_nothing_of_a_forgotten_book_stays_in_the_files(self, folder):
        secret = "Whatever the Butler Saw"
        number = keep(folder, place=KeptPlace(1, before=secret, after=secret),
                      set_bookmark=Bookmark("a", 1, secret))  # fmt: skip
        kept = folder / "kept"
        assert any(secret.encode() in file.read_bytes() for file in kept.iterdir())
        with opened(folder) as places:
            assert places.forget(number)
            assert not any(secret.encode() in file.read_bytes() for file in kept.iterdir())

    def test_nobody_else_may_read_it(self, folder):
        keep(folder)
        assert (folder / "kept" / "places.sqlite").stat().st_mode & 0o077 == 0

    def test_the_last_book_opens_as_it_was_open(self, folder):
        with opened(folder) as places:
            options = BookOptions(encoding="latin-1", keep_lines=True, table="de-g1.ctb")
            resumed = open_kept(places, str(folder / "book.txt"), options)
            assert resumed.place is None
            resumed.kept.keep_at(resumed.source, 5000, line=77, width=26, table="de-g1.ctb")
        with opened(folder) as places:
            resumed = open_kept(places, None)
            assert resumed.options == options
            assert resumed.source.encoding.name == "iso8859-1"
            assert resumed.source.keep_lines
            assert resumed.place.character == 5000
            assert resumed.place.line == 77
            assert (resumed.place.width, resumed.place.table) == (26, "de-g1.ctb")

    def test_what_cannot_be_opened_is_not_kept(self, folder):
        (folder / "empty.txt").write_bytes(b"")
        with opened(folder) as places:
            with pytest.raises(InputError):
                open_kept(places, str(folder / "empty.txt"), BookOptions())
            assert places.listed() == []
