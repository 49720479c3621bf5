"""Blocks, and sources of ready cells."""

import hashlib
import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.laid import cuts_inside, laid_out, rebuilt
from tests.translate.blocks import BlockList, block_of
from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.translate import BlockKind, Book, BrailleTable, Cells, Document, Source
from vbraille.translate.braillefiles.lines import BrailleLines, open_brf, open_unicode_braille

VERSE = """\
  ,! 9vi*t]

,TY,I LIKE
    6
"""
ASCII = " A1B'K2L@CIF/MSP\"E3H9O6R^DJG>NTQ,*5<-U8V.%[$+X!&;:4\\0Z7(_?W]#Y)="


def braille(text: str) -> BrailleLines:
    return open_unicode_braille(io.BytesIO(text.encode()), "text")


class TestBlock:
    @pytest.mark.parametrize(
        ("kind", "level", "wanted"),
        [
            (BlockKind.HEADING, 0, "level of kind heading is 0; it must be 1 or more"),
            (BlockKind.ITEM, -1, "level of kind item is -1; it must be 1 or more"),
            (BlockKind.PARAGRAPH, 1, "level of kind paragraph is 1; it must be 0"),
            (BlockKind.ROW, -1, "level of kind row is -1; it must be 0"),
        ],
    )
    def test_levels_are_of_headings_and_items(self, kind, level, wanted):
        with pytest.raises(ValueError, match=wanted):
            block_of("a", kind, level)


class TestReadyCells:
    def test_the_lines_of_a_brf_file_are_what_they_were(self):
        layout = Layout(Book(braille(VERSE)), 40)
        assert [line.printed.to_brf() for line in layout.lines()] == [
            "  ,! 9VI*T]",
            "",
            ",TY,I LIKE",
            "    6",
        ]
        assert [line.text for line in layout.lines()] == VERSE.splitlines()

    def test_each_cell_stands_for_the_character_that_writes_it(self):
        layout = Layout(Book(braille(VERSE)), 9)
        found = {}
        for line in layout.lines():
            for cell in range(line.indent, len(line)):
                first, after = line.source(cell)
                found[first] = line.masks[cell]
                assert after > first
                assert layout.place(first)[0].number == line.number
        raised = {place: mask for place, mask in found.items() if mask}
        expected = {
            place: mask
            for place, mask in enumerate(Cells.from_brf(VERSE.replace("\n", " ")).masks)
            if mask
        }
        assert raised == expected

    def test_a_word_is_what_stands_between_blank_cells(self):
        patterns = Cells.from_brf("ab  cd").to_unicode()
        line = Layout(Book(braille(patterns)), 9).line(1)
        assert line.text == patterns
        assert [line.word(cell) for cell in range(len(line))] == [
            *[patterns[:2]] * 2, "", "", *[patterns[4:6]] * 2,
        ]  # fmt: skip

    @given(
        st.lists(st.text(st.sampled_from(ASCII + "⠀⠁⣿"), max_size=30), max_size=8),
        st.integers(1, 30),
    )
    def test_nothing_is_lost_whatever_the_width(self, lines, width):
        text = "\n".join(lines)
        if not text:
            return
        layout = Layout(Book(braille(text)), width)
        assert rebuilt(layout) == laid_out(layout)
        assert cuts_inside(layout) == 0
        raised = np.concatenate([np.zeros(0, np.uint8), *(line.masks for line in layout.lines())])
        codes = "".join(lines)
        expected = [
            Cells.from_unicode(c).masks[0] if ord(c) > 127 else Cells.from_brf(c).masks[0]
            for c in codes
        ]
        assert [mask for mask in raised if mask] == [mask for mask in expected if mask]

    def test_a_line_in_pieces_is_laid_out_as_one(self):
        line = "abcde fgh " * 2_000
        layout = Layout(Book(braille(line)), 10)
        assert layout.book.source.block(1).continues
        lines = [line.printed.to_brf() for line in layout.lines()]
        assert lines[0] == "ABCDE FGH"
        assert " ".join(" ".join(lines).split()) == line.upper().rstrip()

    def test_it_is_the_file_that_it_was_read_from(self, tmp_path: Path):
        path = tmp_path / "book.brf"
        path.write_bytes(b",A B\r\nC\r\n\x0cD\r\n")
        source: Source = open_brf(path.open("rb"), str(path))
        assert [line.text for line in Layout(Book(source), 20).lines()] == [",A B", "C", "D"]
        assert source.sha256() == hashlib.sha256(path.read_bytes()).hexdigest()
        assert [source.block_at(place) for place in (0, 6, 20)] == [1, 2, None]
        assert source.progress(0) == 0
        assert source.note() is None

    def test_what_is_no_braille_is_named(self):
        with pytest.raises(InputError, match=r"^text is not all braille: 'é' is neither"):
            Layout(Book(braille("caf\xe9")), 20).line(1)


class TestBook:
    def test_ready_cells_and_text_side_by_side(self):
        table = BrailleTable("fr-bfu-comp6.utb")
        ready = braille("K").block(0)
        book = Book(BlockList(block_of("a"), ready), table)
        assert [book.block(n)[1].to_brf() for n in range(2)] == ["A", "K"]

    def test_text_wants_a_table(self):
        with pytest.raises(
            ValueError, match="blocks has text in it; give its book a braille table"
        ):
            Book(BlockList(block_of("a"))).block(0)

    def test_what_is_to_be_said_of_both(self):
        document = Document.from_text("\u0434\u0430 \u0434\u0430")
        book = Book(document, BrailleTable("en-ueb-g2.ctb"))
        assert list(book.notes()) == []
        book.block(0)
        (note,) = book.notes()
        assert "Cyrillic letters" in note
        assert list(book.notes()) == []
