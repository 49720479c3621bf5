"""Places: one table, which damage, other versions and a full disk do not stop."""

import sqlite3
import stat

from hypothesis import given
from hypothesis import strategies as st

from tests.reading.bench import Reading
from vbraille.reading.places import Places, nearest
from vbraille.translate import text_source

TEXT = "\n\n".join(f"paragraph {n} has words of its own, {n * n}" for n in range(60))


def test_the_place_bookmarks_and_options_come_back(tmp_path):
    path = tmp_path / "p.sqlite"
    said = []
    with Reading(TEXT, places=Places(path, said.append), digest="a", hand="sweep:1") as reading:
        reading.press("n", "n", "M")
        reading.reader.kept.set_options(language="fr")
        line = reading.line
        reading.reader.keep()
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    with Reading(TEXT, places=Places(path, said.append), digest="a", hand="sweep:1") as reading:
        assert reading.line == line
        assert reading.press("B") == ["bookmarks: 1"]
        assert reading.reader.kept.options["language"] == "fr"
    assert not said


def test_a_changed_book_has_its_bookmarks_near_their_words(tmp_path):
    places = Places(tmp_path / "p.sqlite", print)
    with Reading(TEXT, places=places, digest="x", hand="sweep:1") as reading:
        reading.press("/")
        reading.type("paragraph 30")
        text = reading.reader.text
        reading.press("M")
        reading.reader.keep()
    book = places.listed()[0]
    changed = "another beginning\n\n" + TEXT.replace("paragraph 3 ", "chapter 3 ")
    kept = places.book("y", book.path, "book")
    assert kept.find(text_source(changed), print) == changed_place(changed, text)
    assert list(kept.bookmarks.values()) == [changed_place(changed, text)]


def changed_place(text, words):
    return text_source(text).text.index(words)


@given(st.text("ab c\n", min_size=1, max_size=80), st.integers(0, 80), st.floats(0, 1))
def test_some_place_of_the_text_is_always_found(text, place, share):
    if not text.strip():
        return
    source = text_source(text)
    for words in ("", "zzz", source.text[place : place + 20]):
        assert 0 <= nearest(source, words, place, share) <= len(source.text)


def test_a_damaged_file_is_set_aside(tmp_path):
    path = tmp_path / "p.sqlite"
    path.write_bytes(b"this is no database at all, whatever it was" * 100)
    said = []
    Places(path, said.append).book("a", tmp_path / "book", "book").keep(5, 0.5, "words")
    assert len(said) == 1
    assert list(tmp_path.glob("p.sqlite.damaged-*"))
    assert Places(path, said.append).listed()[0].share == 0.5


def test_a_file_of_another_version_is_left_as_it_is(tmp_path):
    path = tmp_path / "p.sqlite"
    db = sqlite3.connect(path)
    db.execute("PRAGMA user_version=99")
    db.close()
    before, said = path.read_bytes(), []
    Places(path, said.append).book("a", tmp_path / "book", "book").keep(5, 0.5, "words")
    assert len(said) == 1
    assert path.read_bytes() == before


def test_what_cannot_be_written_is_said_once_and_reading_goes_on(tmp_path):
    path, said = tmp_path / "p.sqlite", []
    places = Places(path, said.append)
    kept = places.book("a", tmp_path / "book", "book")
    other = sqlite3.connect(path, isolation_level=None)
    other.execute("BEGIN EXCLUSIVE")
    kept.keep(1, 0.1, "")
    kept.keep(2, 0.2, "")
    other.execute("ROLLBACK")
    kept.keep(3, 0.3, "")
    assert len(said) == 1
    assert places.listed()[0].share == 0.3


def test_a_book_that_is_forgotten_leaves_no_text(tmp_path):
    path = tmp_path / "p.sqlite"
    places = Places(path, print)
    places.book("a", tmp_path / "book", "book").keep(5, 0.5, "secret words of a book")
    places.forget("a")
    assert b"secret words" not in path.read_bytes()
