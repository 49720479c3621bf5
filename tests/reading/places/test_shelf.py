"""Places: kept per content, found again after a move or a change, and forgotten."""

import os
import shutil

import pytest

from tests.reading.places.resumed import open_kept
from tests.reading.places.shelved import TEXT, keep, kept_place, opened
from vbraille.errors import InputError
from vbraille.reading.keptplace import Bookmark, KeptPlace, place_in
from vbraille.reading.library import KeptPlaces, book_options, last_book
from vbraille.translate import Document


class TestContent:
    def test_a_book_that_was_never_read_has_no_place(self, folder):
        assert kept_place(folder) is None

    def test_everything_is_there_the_next_time(self, folder):
        document = Document.open(folder / "book.txt")
        document.block(150)
        place = place_in(document, TEXT.index("number 100"))
        options = book_options({"language": "fr", "keep_lines": True})
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

    @pytest.mark.parametrize("size", [None, 50_000_000])
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

    def test_a_book_that_takes_the_place_of_another_is_the_one_there(self, folder):
        keep(folder)
        (folder / "other.txt").write_text("Another text.")
        keep(folder, "other.txt", KeptPlace(3))
        (folder / "other.txt").replace(folder / "book.txt")
        assert kept_place(folder) == 3
        with opened(folder) as places:
            assert [book.path for book in places.listed()] == [str(folder / "book.txt")]

    def test_a_pipe_is_not_read_for_its_content(self, folder):
        os.mkfifo(folder / "pipe")
        keep(folder, "pipe", KeptPlace(3))
        assert kept_place(folder, "pipe") == 3


def test_names_and_texts_that_are_no_text(folder):
    path = folder / os.fsdecode(b"b\xffk.txt")
    path.write_bytes("\ud800 and more".encode("utf-32-le", "surrogatepass"))
    with opened(folder) as places:
        options = book_options({"encoding": "utf-32-le"})
        resumed = open_kept(places, str(path), options)
        resumed.kept.keep_at(resumed.source, 6)
        resumed.kept.set_bookmark(Bookmark("\udcff", 0, "\ud800"))
    with opened(folder) as places:
        assert places.listed()[0].path == str(path)
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
            assert places.forget(listed[0].digest)
            assert not places.forget(listed[0].digest)
            with pytest.raises(InputError, match="is not there any more"):
                last_book(places)
            assert places.forget(listed[1].digest)
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
            options = book_options(
                {"encoding": "latin-1", "keep_lines": True, "table": "de-g1.ctb"}
            )
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
                open_kept(places, str(folder / "empty.txt"), book_options({}))
            assert places.listed() == []
