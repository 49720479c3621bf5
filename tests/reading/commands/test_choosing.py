"""Another table while reading, and lines that come by time."""

from io import BytesIO

import pytest

from tests.reading.commands.test_moving import finger_at
from tests.reading.test_reader import TEXT, Bench
from vbraille.reading.view import Cue
from vbraille.translate import Book, BrailleTable
from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markup.tree import read_tree


class Scroll:
    """Autoscroll of one line a second, as the reader sees it."""

    def __init__(self):
        self.on = False
        self.begun_s = None
        self.cells = []

    words = "8 cells a second"

    def begin(self, now_s):
        self.begun_s = now_s

    def turn(self, step):
        self.words = "9.6 cells a second" if step > 0 else "1 cell a second"
        return step > 0

    def due(self, line_cells, now_s):
        self.cells.append(line_cells)
        return now_s - self.begun_s >= 1


@pytest.mark.parametrize("key", ["x", "yfr\n"])
def test_another_table_shows_the_same_text_under_the_finger(key):
    text = "The people of this country have always been knowledgeable about braille."
    bench = Bench(text, width=24)
    bench.press("n")
    finger_at(bench, 7)
    before, cells = bench.reader.character, bench.reader.line.printed.to_unicode()
    said = bench.press(key)
    assert said[-1] == f"table: {bench.reader.layout.book.table.said}"
    assert ".ctb" not in said[-1]
    bench.run(0.05)
    first, after = bench.reader.line.source(bench.reader.cell)
    assert first <= before < after
    assert bench.reader.line.printed.to_unicode() != cells
    assert bench.engine.display is not None


def test_contracted_and_back_is_as_it_was():
    bench = Bench(TEXT)
    assert bench.press("x") == ["table: Unified English uncontracted braille, grade 1"]
    assert bench.press("x") == ["table: Unified English contracted braille, grade 2"]


def test_a_language_that_there_is_not_changes_nothing():
    bench = Bench(TEXT)
    said = bench.press("yxx\n")
    assert said[:2] == ["language: type its tag such as fr, Enter", "language: xx"]
    assert said[2].startswith("table: there is no table for language 'xx'; the nearest is xh")
    assert bench.reader.layout.book.table.name == "en-ueb-g2.ctb"
    assert (
        bench.press("yen\n")[2] == "table: Unified English contracted braille, grade 2, as before"
    )


def test_braille_that_is_read_as_it_is_has_no_table():
    braille = open_brf(BytesIO(b",read ,me"), "braille")
    bench = Bench(book=Book(braille))
    assert bench.press("xy") == ["table: the text is in braille already"] * 2


def test_lines_come_by_time_while_the_reader_wants_it_and_does_not_rest():
    scroll, cues = Scroll(), []
    bench = Bench(TEXT, cue=cues.append, stay=True)
    bench.reader.scroll = scroll
    bench.run(1.5)
    assert bench.reader.line.number == 1
    assert bench.press("v") == ["autoscroll: 8 cells a second"]
    bench.run(0.5)
    assert bench.press("+-") == [
        "autoscroll: 9.6 cells a second",
        "autoscroll: 1 cell a second, the slowest",
    ]
    assert cues == [Cue.LIMIT]
    assert bench.reader.line.number == 2  # the time was over when it was switched on
    assert set(scroll.cells) == {len(bench.layout.line(1)), len(bench.layout.line(2))}
    bench.press(" ")
    bench.run(2)
    assert bench.reader.line.number == 2
    bench.press(" ")
    bench.run(2.5)
    assert bench.said[-1] == "end of text; p goes back, q stops"
    assert not scroll.on
    assert bench.press("v") == ["autoscroll: 1 cell a second"]
    assert bench.press("v") == ["autoscroll: off"]


FRENCH = "<p>A word, <span lang='fr'>la forêt était très belle</span>, and on.</p>"


def french():
    """A book in English with a passage in French."""
    root, _ = read_tree(FRENCH.encode(), "book.html", xml=False, encoding="utf-8")
    return HtmlBook(root, "book.html", "0" * 64, language="en")


@pytest.mark.parametrize("grade", [None, 2])
def test_contracted_and_back_restores_a_passage_in_another_language(grade):
    source = french()
    book = Book(source, BrailleTable("en-ueb-g2.ctb"), grade=grade)
    bench = Bench(book=book, width=60)
    before = bench.reader.line.printed.to_unicode()
    bench.press("x")
    assert bench.reader.line.printed.to_unicode() != before
    bench.press("x")
    assert bench.reader.line.printed.to_unicode() == before
    bench.press("xyfr\nyen\nx")
    uncontracted = bench.reader.line.printed.to_unicode()
    bench.press("x")
    assert bench.reader.line.printed.to_unicode() != uncontracted


def test_contracted_again_after_the_book_was_closed_has_passages_as_is_usual():
    source = french()
    usual = Bench(book=Book(source, BrailleTable("en-ueb-g2.ctb")), width=60)
    turned = Book(source, BrailleTable("en-ueb-g1.ctb"), language="en", grade=1)
    bench = Bench(book=turned, width=60)
    bench.press("x")
    assert bench.reader.line.printed.to_unicode() == usual.reader.line.printed.to_unicode()
