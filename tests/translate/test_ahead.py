"""A book that other processes translate: the same cells, notes and unknown characters."""

from dataclasses import replace

import pytest

from tests.tiers import heavy
from tests.translate.blocks import BlockList, block_of, text_of
from vbraille.errors import VbrailleError
from vbraille.layout.pages import Layout
from vbraille.translate import Block, BlockKind, Book, BrailleTable, Cells, Document, Undefined
from vbraille.translate.ahead import BookAhead
from vbraille.translate.source import Mark, MarkKind


def blocks_of_all_kinds(count: int) -> BlockList:
    """Blocks with marks, languages, ready cells, nothing in them, and unknown characters."""
    sentence = text_of("The être of the people, \u4e2d, and of x2.")
    russian = text_of("\u0434\u0430 \u043d\u0435\u0442")
    blocks, at = [], 0
    for n in range(count):
        text = russian if n == 7 else sentence
        text = replace(text, places=text.places + at, end=text.end + at + 1)
        marks = (
            Mark(MarkKind.ITALIC, at + 4, at + 8),
            Mark(MarkKind.LANGUAGE, at + 4, at + 8, "fr"),
        )
        match n % 5:
            case 0:
                block = Block(text)
            case 1:
                block = Block(text, marks=marks)
            case 2:
                block = Block(text, BlockKind.HEADING, 2, language="de")
            case 3:
                block = replace(block_of("", BlockKind.PAGE), text=text.empty(text.end))
            case _:
                block = Block(
                    text, cells=Cells(text.codes.astype("u1") & 63, text.places, text.end)
                )
        blocks.append(block)
        at = text.end
    return BlockList(*blocks)


def seen(book: Book) -> tuple[list[tuple], list[str], set[int]]:
    """All that somebody gets of a book who reads it in order."""
    found, notes, number = [], [], 0
    while (pair := book.block(number)) is not None:
        block, cells = pair
        known = str(block.text), block.kind, book.continues(number + 1)
        found.append((*known, cells.masks.tobytes(), cells.starts.tolist(), cells.end))
        notes += book.notes()
        number += 1
    assert book.table is not None
    return found, notes, book.table.undefined


def english(undefined: Undefined = Undefined.MARK) -> BrailleTable:
    return BrailleTable("en-ueb-g2.ctb", undefined)


def test_it_is_the_same_book(texts):
    long = " ".join((texts / "english.txt").read_text().split())
    text = "\n\n".join([(texts / "english.txt").read_text(), long, long] * 2)
    plain = seen(Book(Document.from_text(text), english()))
    with BookAhead(Book(Document.from_text(text), english()), 2, 4_000) as book:
        assert seen(book) == plain
        assert len(book.processes) == 1  # this one translates, too
        assert book.block(0)[1].masks.tobytes() == plain[0][0][3]  # once more, from the beginning
    assert book.processes == ()


def test_marks_languages_and_what_no_table_knows_are_the_same():
    source = blocks_of_all_kinds(500)
    plain = seen(Book(source, english(Undefined.NAME), grade=1))
    with BookAhead(Book(source, english(Undefined.NAME), grade=1), 2, 4_000) as book:
        found, notes, undefined = seen(book)
    assert found == plain[0]
    assert undefined == plain[2] != set()
    assert sorted(notes) == sorted(plain[1])
    assert len(notes) == 1


@heavy
def test_its_lines_are_the_same(texts):
    text = " ".join((texts / "english.txt").read_text().split() * 3)
    plain = Layout(Book(Document.from_text(text), english()), 26)
    wanted = [(line.masks.tobytes(), line.text) for line in plain.lines()]
    with BookAhead(Book(Document.from_text(text), english()), 2, 4_000) as book:
        lines = list(Layout(book, 26).lines())
    assert [(line.masks.tobytes(), line.text) for line in lines] == wanted


@pytest.mark.parametrize("processes", [0, 1, 2])
def test_a_short_book_needs_no_process(processes):
    source = blocks_of_all_kinds(20)
    with BookAhead(Book(source, english()), processes) as book:
        assert seen(book) == seen(Book(source, english()))
        assert book.processes == ()


@heavy
def test_who_stops_early_leaves_no_process(texts):
    text = "\n\n".join([(texts / "english.txt").read_text()] * 8)
    with BookAhead(Book(Document.from_text(text), english()), 2, 4_000) as book:
        book.block(0)
        assert book.processes
    assert book.processes == ()
    assert book.block(1) is not None  # translated here


def test_a_process_that_dies_is_told_in_a_sentence(texts):
    text = "\n\n".join([(texts / "english.txt").read_text()] * 9)
    with BookAhead(Book(Document.from_text(text), english()), 2, 4_000) as book:
        book.block(0)
        for process in book.processes:
            process.kill()
        with pytest.raises(VbrailleError, match="a process that translates text ended by itself"):
            seen(book)


def test_ready_cells_need_no_table():
    block = replace(block_of("#a"), cells=Cells.from_brf("#a"))
    with BookAhead(Book(BlockList(*[block] * 3)), 2) as book:
        assert book.block(2)[1].to_brf() == "#A"
        assert book.block(3) is None
