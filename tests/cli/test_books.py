"""``vbraille books``: one line each, opening and forgetting."""

import json
import subprocess
from datetime import UTC, datetime, timedelta

import pytest

from tests.cli import program
from vbraille.cli.old.commands.books import describe
from vbraille.reading.keptplace import KeptPlace
from vbraille.reading.library import KeptPlaces, ListedBook
from vbraille.reading.store import ENVIRONMENT


@pytest.fixture
def kept(tmp_path, monkeypatch):
    """Two books that were read, of which one is gone."""
    path = tmp_path / "kept" / "places.sqlite"
    monkeypatch.setenv(ENVIRONMENT, str(path))
    with KeptPlaces.open(now=lambda: 43_200.0) as places:
        for name in ("first.txt", "second.txt"):
            (tmp_path / name).write_text(f"The text of {name}.")
            book = places.book(tmp_path / name, title=name.removesuffix(".txt").title())
            book.keep(KeptPlace(10, share=0.434, page="xii" if name < "g" else ""))
    (tmp_path / "second.txt").unlink()
    return tmp_path


def test_a_line_for_each_book_the_newest_first(call, kept):
    said = call("books")
    assert (said.code, said.err) == (0, "")
    assert said.out.splitlines() == [
        f"1: Second, 43 %, 1970-01-01, {kept}/second.txt, missing",
        f"2: First, 43 %, page xii, 1970-01-01, {kept}/first.txt",
    ]


def test_for_another_program(call, kept):
    first = json.loads(call("books", "--json").out)[1]
    assert first == {
        "number": 2,
        "title": "First",
        "path": f"{kept}/first.txt",
        "missing": False,
        "read": "1970-01-01T12:00:00+00:00",
        "share": 0.434,
        "character": 10,
        "page": "xii",
    }


def test_forgetting(call, kept):
    assert call("books", "1", "--forget").out == "forgotten: Second\n"
    assert len(call("books").out.splitlines()) == 1
    for number in ("0", "2"):
        said = call("books", number, "--forget")
        assert (said.code, said.out) == (2, "")
        assert f"there is no book {number}; there is 1 book" in said.err
    assert call("books", "1", "--forget").code == 0
    assert call("books").out == "books: none\n"
    assert (kept / "first.txt").exists()


def test_no_database_is_one_sentence(call, tmp_path, monkeypatch):
    monkeypatch.setenv(ENVIRONMENT, str(tmp_path))
    said = call("books")
    assert (said.code, said.out) == (0, "books: none\n")
    assert said.err.startswith(f"places cannot be kept in {tmp_path}: ")
    assert said.err.count("\n") == 1


@pytest.mark.usefixtures("kept")
def test_what_cannot_be_written_is_not_said_to_be_forgotten(call):
    before = call("books").out
    limit = 'export PYTHONDONTWRITEBYTECODE=1; ulimit -f 0; exec "$@"'
    limited = ["sh", "-c", limit, "sh", *program.PROGRAM]
    done = subprocess.run(
        [*limited, "books", "1", "--forget"], check=False, capture_output=True, encoding="utf-8"
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert "could not be forgotten" in done.stderr
    assert call("books").out == before


@pytest.mark.parametrize(
    ("ago", "said"),
    [
        (timedelta(minutes=5), "today 11:55"),
        (timedelta(hours=13), "yesterday"),
        (timedelta(days=3), "3 days ago"),
        (timedelta(days=40), "2026-04-01"),
        (-timedelta(days=2), "2026-05-13"),
    ],
)
def test_days_as_people_say_them(ago, said):
    now = datetime(2026, 5, 11, 12, tzinfo=UTC)
    book = ListedBook("ab", "Title", "/t", (now - ago).timestamp(), None, missing=False)
    assert describe(book, now) == f"Title, {said}, /t"


FAST = ("--hand", "sweep:1000", "--echo", "text")


def test_a_book_is_opened_by_its_number_with_the_options_that_it_was_read_with(
    call, tmp_path, monkeypatch
):
    monkeypatch.setenv(ENVIRONMENT, str(tmp_path / "places.sqlite"))
    for name, keys in (("one", "x"), ("two", "n")):
        (tmp_path / f"{name}.txt").write_text(f"First of {name}.\n\nSecond of {name}.\n")
        with program.Terminal("read", tmp_path / f"{name}.txt", "--advance", "key") as terminal:
            terminal.until("h says the keys")
            terminal.type(f"n{keys}q")
            assert terminal.end() == 0
    said = call("read", "--book", "2", *FAST)
    assert said.code == 0
    assert said.err == program.line_width(26, program.UNCONTRACTED)
    assert "text: First" not in said.out
    assert "text: Second of one.\n" in said.out
    said = call("books", "2")  # the list begins with the last one read
    assert said.code == 0
    assert "text: Second of two.\n" in said.out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("books", "3"), "there is no book 3; there are 2 books, and vbraille books lists them"),
        (("read", "--book", "0"), "there is no book 0; there are 2 books"),
        (("books", "1"), "second.txt, is not there any more; give its file, or choose another"),
        (("read", __file__, "--book", "1"), "leave out either that or the file"),
        (("books", "1", "--json"), "a number alone opens its book"),
        (("books", "one"), "one"),
    ],
)
@pytest.mark.usefixtures("kept")
def test_a_number_that_opens_nothing_is_one_sentence(call, arguments, sentence):
    said = call(*arguments)
    assert (said.code, said.out) == (2, "")
    assert sentence in said.err
    assert said.err.count("\n") == 1
