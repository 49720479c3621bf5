"""What a reader keeps, kept for the next reading."""

from vbraille.layout.pages import Layout
from vbraille.reading.places import BookOptions, KeptPlaces, KeptReading, open_kept
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.documents.parted import PartedSource, Passage
from vbraille.translate.source import BlockKind

TEXT = "\n\n".join(f"Paragraph number {n} says {n * n} and no more." for n in range(3000))


def read(folder, then):
    """Open a book where it was left, and do something with what is kept of it."""
    with KeptPlaces.open(folder / "places.sqlite") as places:
        resumed = open_kept(places, str(folder / "book.txt"), BookOptions())
        book = Book(resumed.source, BrailleTable("en-ueb-g2.ctb"))
        start, before, line = 0, 0, None
        if resumed.place is not None:
            start = resumed.place.block
            before = resumed.place.lines_before_for(20, "en-ueb-g2.ctb")
            line = resumed.place.line_for(20, "en-ueb-g2.ctb")
        layout = Layout(book, 20, start=start, lines_before=before)
        then(KeptReading(resumed.kept, layout), layout)
        resumed.kept.keep_index(resumed.source.index())
        return resumed.place, line


def test_a_place_and_its_line(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    at = TEXT.index("number 30 ")
    read(tmp_path, lambda kept, _: kept.keep(at))
    seen = []
    place, line = read(tmp_path, lambda _, layout: seen.append(layout.place(at)[0].number))
    assert place.character == at
    assert place.after.startswith("number 30 says 900")
    whole = Layout(Book(Document.open(tmp_path / "book.txt"), BrailleTable("en-ueb-g2.ctb")), 20)
    assert seen == [line] == [whole.place(at)[0].number]


def test_a_place_whose_line_nobody_counted(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    at = TEXT.index("number 2900 ")

    def keep(kept, layout):
        layout.place(at)
        assert not layout.counted
        kept.keep(at)

    read(tmp_path, keep)
    place, line = read(tmp_path, lambda kept, _: kept.keep(at))
    assert place.character == at
    assert line is None
    assert 0.9 < place.share < 1


def test_bookmarks_are_found_again_by_more_than_the_reader_is_told(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    at = TEXT.index("Paragraph number 700 ")

    def mark(kept, _):
        kept.mark("a", at, "Paragraph number")
        kept.mark("b", 0, "gone")
        kept.delete_bookmark("b")
        assert [mark.name for mark in kept.bookmarks()] == ["a"]

    read(tmp_path, mark)
    changed = "A foreword. " + TEXT
    (tmp_path / "book.txt").write_text(changed)
    seen = []
    read(tmp_path, lambda kept, _: seen.extend(kept.bookmarks()))
    assert [(m.name, m.character, m.text) for m in seen] == [("a", at + 12, "Paragraph number")]


class Paged(PartedSource):
    """A book with pages of print."""

    def __init__(self):
        super().__init__("book", [1], "0" * 64)

    def passages(self, part):  # noqa: ARG002 - it has one
        for page in ("xii", "13"):
            yield Passage(page, BlockKind.PAGE)
            yield Passage(f"The first words of page {page}.")
            yield Passage(f"The last words of page {page}.")


def test_the_page_of_print(tmp_path):
    source = Paged()
    layout = Layout(Book(source, BrailleTable("en-ueb-g2.ctb")), 20)
    with KeptPlaces.open(tmp_path / "places.sqlite") as places:
        book = places.book(None, source.sha256())
        kept = KeptReading(book, layout)
        pages = []
        for number in (1, 2, 4, 5):
            kept.keep(int(source.block(number).text.places[3]))
            pages.append(book.place.page)
        assert pages == ["xii", "xii", "13", "13"]
