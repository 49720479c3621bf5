"""Ways through a book: headings, lists, tables, quotations, links, notes, pages, contents."""

import pytest

from tests.reading.bench import Reading
from vbraille.translate import open_source

BOOK = """# One

Alpha [beta](https://example.org) gamma.[^n] See [two](#two).

- first item
- second item

## Two

> a quotation
> of two lines

| Fish | Price |
|------|-------|
| cod  | 3     |

# Three

Last.

[^n]: Except the master.
"""


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    path = tmp_path_factory.mktemp("book") / "book.md"
    path.write_text(BOOK)
    return lambda: open_source(str(path))


def reading(source, **how):
    return Reading(source(), hand="sweep:1", **how)


WAYS = [
    ("e", "heading level 2: Two"), ("2", "heading level 2: Two"), ("1", "heading level 1: Three"),
    ("3", "no next heading of level 3"), ("l", "list: first item"), ("r", "table: Fish"),
    ("Q", "quotation: a quotation"), ("I", "item: first item"), ("a", "paragraph"),
    ("k", "link: beta"), (",", "no next figure or picture"), ("E", "no previous heading"),
]  # fmt: skip


@pytest.mark.parametrize(("key", "said"), WAYS)
def test_each_way_says_what_it_comes_to(source, key, said):
    with reading(source) as book:
        assert book.press(key)[0].startswith(said)


def test_the_way_back_is_the_way_there(source):
    with reading(source) as book:
        for way in "elraQkg":
            before = book.line
            book.press(way, *(["4", "0", "%", "enter"] if way == "g" else []), "b")
            assert book.line == before, way


def test_a_note_is_followed_and_left(source):
    with reading(source) as book:
        book.press("k")
        assert book.press("enter") == ["link: https://example.org"]
        assert book.press("k")[0].startswith("note: ")
        assert book.press("enter")[0].startswith("note ")
        assert "Except the master" in book.reader.line.block.text
        assert book.press("enter")[0].startswith("back at the text")


def test_contents_are_gone_to_by_number_and_by_words(source):
    with reading(source) as book:
        assert book.press("O") == [
            "1: One, level 1", "2: Two, level 2", "3: Three, level 1",
            "number or words of a heading",
        ]  # fmt: skip
        assert book.type("2")[0].startswith("heading level 2: Two")
        book.press("O")
        assert book.type("thr")[0].startswith("heading level 1: Three")
        book.press("O")
        assert book.type("zzz") == ["no heading 'zzz'"]
        book.press("O")
        assert book.type("9") == ["no heading '9'"]


def test_headers_are_those_of_the_table(source):
    with reading(source) as book:
        assert book.press("H") == ["this is not a row of a table"]
        book.press("r")
        assert book.press("H")[0].endswith("Fish, Price")


def test_places_by_percent_and_by_page(source):
    with reading(source) as book:
        book.press("g")
        assert book.type("100%")[0].startswith("100 percent")
        book.press("g")
        assert book.type("140%") == ["'140%' is not 0 to 100 percent"]
        assert book.press("i")[0].endswith("heading: Three")
        assert book.press("f") == ["no next page"]
        book.press("g")
        assert book.type("1")[0].startswith("page 1 in braille")


def test_where_the_finger_is(source):
    with reading(source) as book:
        assert book.press("u") == ["nothing under the finger"]
        book.press("n")
        pitch_mm = book.reader.style.geometry.cell_pitch_mm
        book.finger(4.5 * pitch_mm)
        assert book.press("w") == ["Alpha"]
        assert book.press("W") == ["A, l, p, h, a"]
        assert book.press("u")[0].startswith("dots ")
        book.press("route:9")
        book.run(0.2)
        assert book.reader.cell == 9
