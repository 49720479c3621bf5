"""A book: cells only for what is read, and the same whatever the order."""

import io
import random
import re

import pytest

from tests.conftest import SEED
from vbraille.translate import Book, BrailleTable, Cells, Document


class Counting(BrailleTable):
    """A table that keeps what it was asked for."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.asked: list[str] = []

    def translate(self, text, marks=()) -> Cells:
        self.asked.append(str(text))
        return super().translate(text, marks)


@pytest.fixture(scope="module")
def english(texts) -> str:
    return (texts / "english.txt").read_text()


@pytest.fixture(scope="module")
def table() -> BrailleTable:
    return BrailleTable("en-ueb-g2.ctb")


class TestLazy:
    def test_a_block_is_translated_when_it_is_read(self, english):
        table = Counting("en-ueb-g2.ctb")
        book = Book(Document.from_text(english), table)
        assert table.asked == []
        block, _ = book.block(3)
        assert table.asked == [str(block.text)]
        book.block(3)
        assert len(table.asked) == 1

    def test_no_more_is_kept_than_a_few(self):
        table = Counting("en-ueb-g2.ctb")
        book = Book(Document.from_text("\n\n".join("abcdefghijklmnopqrstuvwxyz")), table)
        for n in (*range(26), 0, 25):
            assert book.block(n) is not None
        assert table.asked == [*"abcdefghijklmnopqrstuvwxyz", "a"]
        assert book.block(26) is None


class TestCells:
    def test_in_any_order(self, english, table):
        expected = Book(Document.from_text(english), table)
        count = len(english.strip().split("\n\n"))
        cells = [expected.block(n)[1].to_unicode() for n in range(count)]
        book = Book(Document(io.BytesIO(english.encode("utf-16"))), table)
        chance = random.Random(SEED)
        for n in chance.choices(range(count), k=100):
            assert book.block(n)[1].to_unicode() == cells[n]

    def test_hard_wrapped_lines_are_one_text(self, english, table):
        wrapped = Book(Document.from_text(english), table)
        items = re.sub(r"\n(?=\d\. |- )", "\n\n", english)  # each of a list is a paragraph
        lines = [" ".join(paragraph.split()) for paragraph in items.split("\n\n")]
        joined = Book(Document.from_text("\n\n".join(lines)), table)
        n = 0
        while (found := wrapped.block(n)) is not None:
            assert found[1].to_unicode() == joined.block(n)[1].to_unicode()
            n += 1
        assert n > 20

    def test_the_cells_of_the_pieces_are_those_of_the_whole(self, english, table):
        """liblouis sees a paragraph too long to hold in pieces; its reader cannot tell."""
        long = " ".join(english.split() * 5)
        book = Book(Document.from_text(long), table)
        block, cells = book.block(0)
        text = block.text
        n = 1
        while (found := book.block(n)) is not None:
            assert found[0].continues
            text, cells = text + found[0].text, cells + found[1]
            n += 1
        assert n > 4
        assert str(text) == long
        whole = table.translate(text)
        assert cells.to_unicode() == whole.to_unicode()
        assert cells.starts.tolist() == whole.starts.tolist()
        assert cells.end == whole.end == len(long)

    @pytest.mark.no_cover
    @pytest.mark.parametrize("file", ["english.txt", "francais.txt", "deutsch.txt"])
    def test_every_cell_stands_for_characters_of_its_paragraph(self, texts, file):
        text = (texts / file).read_text()
        name = {"e": "en-ueb-g2.ctb", "f": "fr-bfu-comp6.utb", "d": "de-g2.ctb"}[file[0]]
        book = Book(Document.from_text(text), BrailleTable(name))
        n = 0
        while (found := book.block(n)) is not None:
            own, cells = found[0].text, found[1]
            spans = sorted({cells.source(cell) for cell in range(len(cells))})
            assert spans[0][0] == own.places[0]
            assert spans[-1][1] == own.end
            source = "".join(text[first:end] for first, end in spans)
            assert source == text[own.places[0] : own.end]
            for character in own.places.tolist():
                low, high = cells.of_source(character)
                first, end = cells.source(low)
                assert low < high
                assert first <= character < end
            n += 1
        assert n > 5
