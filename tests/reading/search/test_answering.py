"""Kinds, shares, pages and lines, in sources with structure and in long plain texts."""

import io

import pytest

from vbraille.layout.pages import Layout
from vbraille.reading.search.questions import (
    Counted,
    CountLines,
    FindKind,
    FindLine,
    FindPage,
    FindShare,
    Found,
    Indexed,
    NotFound,
    Searched,
)
from vbraille.reading.search.seeker import Answering
from vbraille.translate import Book, BrailleTable, Document
from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.source import BlockKind, Mark, MarkKind

ROWS = 200


class Structured(ChapterSource):
    """A book of headings, a long table, pages, and a link."""

    def __init__(self):
        super().__init__("book", [1, 1], "0" * 64)

    def passages(self, part):
        return [
            Passage(str(part * 10 + 1), BlockKind.PAGE),
            Passage(f"Chapter {part}", BlockKind.HEADING, 1),
            Passage("Section", BlockKind.HEADING, 2),
            Passage("See there.", marks=(Mark(MarkKind.LINK, 4, 9, "#x"),)),
            *(Passage(f"Row {n}", BlockKind.ROW, group=1) for n in range(ROWS)),
            Passage("Afterwards."),
        ]


def final(source, query):
    *before, last = Answering(Book(source)).answer(query)
    assert all(isinstance(step, Searched) and 0 <= step.share <= 1 for step in before)
    return last


def text_at(source, found):
    assert isinstance(found, Found)
    block = source.block(source.block_at(found.character))
    return str(block.text)[block.text.index(found.character) :]


@pytest.mark.parametrize(
    ("query", "found"),
    [
        (FindKind("heading", 0), "Chapter 0"),
        (FindKind("heading", 2), "Chapter 1"),
        (FindKind("heading", 1, level=1), "Chapter 1"),
        (FindKind("heading", 10_000, backward=True), "Section"),
        (FindKind("row", 0), "Row 0"),
        (FindKind("row", 50), "Row 0"),
        (FindKind("row", 10_000, backward=True), "Row 0"),
        (FindKind("link", 0), "there."),
        (FindKind("page", 0), "11"),
        (FindPage(" 11 "), "11"),
        (FindShare(0.0), "1"),
    ],
)
def test_what_is_found(query, found):
    source = Structured()
    while query.__class__ is FindKind and query.block == 10_000:
        last = next(n for n in range(10_000) if source.block(n) is None)
        query = FindKind(query.kind, last, backward=True)
    assert text_at(source, final(source, query)) == found


@pytest.mark.parametrize(
    "query",
    [
        FindKind("heading", 0, backward=True),
        FindKind("item", 0),
        FindKind("row", 300),
        FindPage("12"),
    ],
)
def test_what_is_not_there(query):
    assert isinstance(final(Structured(), query), NotFound)


@pytest.mark.parametrize("known", [False, True])
def test_pages_of_a_braille_file_are_counted_in_all_its_parts(known):
    content = b"".join(b"PAGE %d\n\f" % (n % 10) for n in range(20_000))
    source = open_brf(io.BytesIO(content), "book.brf")
    if known:  # where its blocks are, from another time
        other = open_brf(io.BytesIO(content), "book.brf")
        assert other.block(50_000) is None
        source.adopt(other.index())
    found = final(source, FindPage("15678"))
    number = source.block_at(found.character)
    assert source.block(number).page_number == "15678"
    assert str(source.block(number + 1).text) == "PAGE 7"
    assert isinstance(final(source, FindPage("20001")), NotFound)


def test_a_long_row_of_rows_behind_is_entered_at_its_beginning():
    source = Structured()
    found = final(source, FindKind("row", ROWS + 6, backward=True))
    assert text_at(source, found) == "Row 0"
    assert source.block_at(found.character) == 4


def test_a_plain_text_has_no_structure_and_nobody_reads_it_for_that():
    document = Document(io.BytesIO(b"some words\n\n" * 50_000), "a", "utf-8")
    for query in (FindKind("heading", 0), FindKind("link", 0), FindPage("1")):
        assert isinstance(final(document, query), NotFound)
    assert len(document.index().rows) == 1
    assert isinstance(final(document, FindKind("paragraph", 7)), Found)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.9, 1.0])
def test_a_share_of_a_plain_text(share):
    text = b"some words\n\n" * 30_000
    document = Document(io.BytesIO(text), "a", "utf-8")
    found = final(document, FindShare(share))
    assert found.character == pytest.approx(share * len(text), abs=len(text) / 1000)
    again = Document(io.BytesIO(text), "a", "utf-8")
    again.adopt(found.index)
    assert again.block(again.block_at(found.character)) is not None
    assert share == 1.0 or len(again.index().rows) <= len(found.index.rows)


def test_lines_are_counted_as_the_layout_has_them_and_only_once():
    text = "\n\n".join(f"Paragraph {n} " + "and more words " * n for n in range(60))
    text += "\n\n" + "a very long paragraph " * 1000
    book = Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb"))
    layout = Layout(Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb")), 20)
    answering = Answering(book)
    for block in (0, 1, 40, 62, 20):
        *steps, counted = answering.answer(CountLines(20, block))
        assert isinstance(counted, Counted)
        assert (counted.width, counted.block) == (20, block)
        character = int(book.source.block(block).text.places[0])
        line, _ = layout.place(character)
        if not line.block.continues and block < 60:
            assert counted.lines == line.number - 1
        assert len(steps) == {0: 0, 1: 1, 40: 39, 62: 22, 20: 0}[block]
    *_, counted = answering.answer(CountLines(20, 10_000))
    assert counted.lines == layout.count()


def test_the_index_is_complete_at_the_end():
    document = Document(io.BytesIO(b"some words\n\n" * 30_000), "a", "utf-8")
    *steps, last = Answering(Book(document)).index()
    assert isinstance(last, Indexed)
    assert last.index.complete
    assert steps


@pytest.mark.parametrize("width", [20, 31])
def test_a_line_is_found_by_its_number_where_the_layout_has_it(width):
    text = "\n\n".join(f"Paragraph {n} " + "and more words " * n for n in range(40))
    book = Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb"))
    layout = Layout(book, width)
    answering = Answering(book)
    for number in (1, 2, 300, 17, layout.count()):
        *steps, found = answering.answer(FindLine(number, width, "en-ueb-g1.ctb"))
        assert isinstance(found, Found)
        assert layout.place(found.character)[0].number == number
        assert not steps or number != 17  # which was counted before
    for number in (0, layout.count() + 1):
        *_, last = answering.answer(FindLine(number, width, "en-ueb-g1.ctb"))
        assert isinstance(last, NotFound)
    *_, last = answering.answer(FindLine(3, width, "de-g1.ctb"))
    assert "en-ueb-g1.ctb" in last.sentence


def test_a_line_of_a_very_long_paragraph_is_found_near_it():
    text = "one more word " * 10_000
    book = Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb"))
    layout = Layout(Book(Document.from_text(text), BrailleTable("en-ueb-g1.ctb")), 20)
    number = layout.count() - 100
    *_, found = Answering(book).answer(FindLine(number, 20, "en-ueb-g1.ctb"))
    assert layout.place(found.character)[0].number == pytest.approx(number, abs=1)
