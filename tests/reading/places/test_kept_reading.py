"""What a reader keeps, kept for the next reading."""

from tests.reading.places.resumed import open_kept
from vbraille.layout.pages import Layout
from vbraille.reading.library import KeptPlaces, book_options
from vbraille.reading.reader import PlaceKeeper
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.source import BlockKind

TEXT = "\n\n".join(f"Paragraph number {n} says {n * n} and no more." for n in range(3000))


def read(folder, then):
    """Open a book where it was left, and do something with what is kept of it."""
    with KeptPlaces.open(folder / "places.sqlite") as places:
        resumed = open_kept(places, str(folder / "book.txt"), book_options({}))
        book = Book(resumed.source, BrailleTable("en-ueb-g2.ctb"))
        start, before, line = 0, 0, None
        if resumed.place is not None:
            start = resumed.place.block
            before = resumed.place.lines_before_for(20, "en-ueb-g2.ctb")
            line = resumed.place.line
        layout = Layout(book, 20, start=start, lines_before=before)
        then(PlaceKeeper(resumed.kept), layout)
        resumed.kept.keep_index(resumed.source.index())
        return resumed.place, line


def leave_at(at):
    """Read on to a character, and leave."""

    def leave(keeping, layout):
        keeping.moved(layout, layout.place(at)[0])
        keeping.leave()

    return leave


def test_a_place_and_its_line(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    at = TEXT.index("Paragraph number 30 ")
    read(tmp_path, leave_at(at))
    seen = []
    place, line = read(tmp_path, lambda _, layout: seen.append(layout.place(at)[0].number))
    assert place.character == at
    assert place.after.startswith("Paragraph number 30 says 900")
    whole = Layout(Book(Document.open(tmp_path / "book.txt"), BrailleTable("en-ueb-g2.ctb")), 20)
    assert seen == [line] == [whole.place(at)[0].number]


def test_a_place_whose_line_nobody_counted(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    at = TEXT.index("Paragraph number 2900 ")

    def leave(keeping, layout):
        leave_at(at)(keeping, layout)
        assert not layout.counted

    read(tmp_path, leave)
    place, line = read(tmp_path, leave_at(at))
    assert place.character == at
    assert line is None
    assert 0.9 < place.share < 1


class Paged(ChapterSource):
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
        book = places.book(tmp_path / "book.txt")
        keeping = PlaceKeeper(book)
        pages = []
        for number in (1, 2, 4, 5):
            keeping.moved(layout, layout.place(int(source.block(number).text.places[3]))[0])
            keeping.leave()
            pages.append(book.place.page)
        assert pages == ["xii", "xii", "13", "13"]


def test_a_book_that_was_read_to_its_end_begins_anew(tmp_path):
    (tmp_path / "book.txt").write_text(TEXT)
    read(tmp_path, leave_at(TEXT.index("number 40 ")))
    read(tmp_path, lambda keeping, layout: keeping.start_over(layout))
    place, line = read(tmp_path, lambda *_: None)
    assert (place.character, line) == (0, 1)
