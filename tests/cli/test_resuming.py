"""A book opened again: in which braille."""

import pytest

from tests.reading.test_reader import Bench
from vbraille.cli.old.build import open_to_resume
from vbraille.cli.old.parser import parse
from vbraille.config.settings import settle
from vbraille.reading.library import KeptPlaces
from vbraille.render import STRESS2

TEXT = "The people of this country read braille.\n"


@pytest.fixture
def book(tmp_path):
    path = tmp_path / "book.txt"
    path.write_text(TEXT)
    return path


def read(book, keys="", *options):
    """Open a book where it was left, press keys, and leave it; name of the table before that."""
    file = [] if book is None else [str(book)]
    arguments = parse(["read", *file, *options])
    settle(arguments)
    with KeptPlaces.open() as places:
        opened = open_to_resume(arguments, places)
        bench = Bench(book=opened.book)
        bench.press(keys)
        opened.leave(bench.reader, STRESS2, bench.reader.style)
    opened.book.source.close()
    return opened.book.table.name


@pytest.mark.parametrize("named", [True, False])
def test_a_book_opens_in_the_braille_that_keys_have_turned_to(book, named):
    again = book if named else None
    assert read(book, "x") == "en-ueb-g2.ctb"
    assert read(again, "yde\n") == "en-ueb-g1.ctb"
    german = read(again)
    assert german.startswith("de-")
    assert read(again) == german


def test_what_options_say_holds_and_what_keys_said_before_is_forgotten(book):
    read(book, "yde\n")
    assert read(book, "", "--grade", "2") == "de-g2.ctb"
    assert read(book, "", "--language", "fr").startswith("fr-")
    assert read(book) == "en-ueb-g2.ctb"
    read(book, "x")
    assert read(book, "", "--table", "fr-bfu-g2.ctb") == "fr-bfu-g2.ctb"
    assert read(None) == "fr-bfu-g2.ctb"
    assert read(None, "", "--language", "de").startswith("de-")


def test_what_keys_said_goes_before_the_settings_file(book, monkeypatch, tmp_path):
    settings = tmp_path / "settings.toml"
    monkeypatch.setenv("VBRAILLE_SETTINGS", str(settings))
    settings.write_text('[read]\ntable = "fr-bfu-g2.ctb"\n')
    assert read(book) == "fr-bfu-g2.ctb"
    read(book, "yde\n")
    assert read(book).startswith("de-")


def test_a_braille_file_is_read_whatever_its_text_was_read_in(book):
    read(book, "yde\n")
    book.write_text("⠁⠃⠉\n")
    arguments = parse(["read", str(book), "--form", "brf"])
    settle(arguments)
    with KeptPlaces.open() as places:
        opened = open_to_resume(arguments, places)
    assert opened.book.table is None
    opened.book.source.close()
