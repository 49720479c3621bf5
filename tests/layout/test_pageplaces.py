"""From a place on a page to its character, and back."""

import random
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.layout.pages import lay_out
from vbraille.braille.geometry import PRESETS, STRESS2, VBD
from vbraille.layout.pages import Line, locate, place_of
from vbraille.translate import Cells, Document


class TestPlace:
    @pytest.mark.parametrize("keep_lines", [False, True])
    @pytest.mark.parametrize("width", [3, 26])
    def test_there_and_back(self, english, table, width, keep_lines):
        text = english[:900]
        layout = lay_out(text, table, width, keep_lines=keep_lines)
        for line in layout.lines():
            for cell in range(line.indent, len(line)):
                first, end = line.source(cell)
                assert first < end
                place, at = layout.place(first)
                starts = place.source(at)
                assert starts == (first, end)
                assert (place.number, at) <= (line.number, cell)
        for character in range(len(text.rstrip())):
            line, cell = layout.place(character)
            first, end = line.source(cell)
            assert character < end
            if first > character:  # no cell stands for it: a blank at a wrap or between paragraphs
                assert text[character:first].isspace()

    def test_of_a_long_paragraph(self, english, table):
        text = " ".join(english.split() * 4)
        layout = lay_out(text, table)
        for character in random.Random(SEED).sample(range(len(text)), 60):
            line, cell = layout.place(character)
            first, end = line.source(cell)
            assert character < end
            assert first <= character or text[character:first] == " "
            again = layout.line(line.number)
            assert again.masks.tolist() == line.masks.tolist()

    def test_a_character_cut_in_two_begins_on_the_first_line(self, letters):
        layout = lay_out("ab\U0001f600c", letters, 3)
        line, cell = layout.place(2)
        assert (line.number, cell, line.source(cell)) == (2, 0, (2, 3))
        assert layout.line(3).source(0) == (2, 3)
        assert layout.line(3).cell_of(2) == 0

    def test_past_the_end(self, table):
        layout = lay_out("one\n\ntwo\n\n", table)
        assert layout.place(8) is None
        assert layout.place(10**9) is None
        line, cell = layout.place(4)
        assert (line.number, cell) == (2, 2)

    def test_a_line_of_nothing_is_no_place(self, table):
        layout = lay_out("one\n\ntwo", table, keep_lines=True)
        assert layout.line(2).text == ""
        line, cell = layout.place(4)
        assert (line.number, cell) == (3, 0)


class TestLine:
    def test_what_is_printed(self, letters):
        line = lay_out("un deux", letters).line(1)
        assert len(line) == 9
        assert line.masks.tolist() == line.printed.masks.tolist() == [0, 0, *line.cells.masks]
        assert line.printed.to_brf() == "  UN DEUX"

    def test_source_and_cell(self, letters):
        line = lay_out("un  deux", letters).line(1)
        assert [line.source(n) for n in range(-1, 10)] == [
            None, None, None, (0, 1), (1, 2), (2, 4), (4, 5), (5, 6), (6, 7), (7, 8), None,
        ]  # fmt: skip
        assert [line.cell_of(c) for c in range(8)] == [2, 3, 4, 4, 5, 6, 7, 8]
        with pytest.raises(IndexError):
            line.cell_of(8)

    def test_word(self, letters):
        layout = lay_out("un anticonstitutionnel\nmot", letters, 10)
        assert [line.word(len(line) - 1) for line in layout.lines()] == [
            "un",
            "anticonstitutionnel",
            "anticonstitutionnel",
            "mot",
        ]
        last = layout.line(3)
        assert last.word(0) == "anticonstitutionnel"
        assert [lay_out("a b", letters).line(1).word(n) for n in range(-1, 7)] == [
            "", "", "", "a", "", "b", "", "",
        ]  # fmt: skip


class TestLocate:
    @pytest.mark.parametrize("geometry", PRESETS.values())
    def test_there_and_back(self, letters, geometry):
        line = lay_out("un deux trois", letters).line(1)
        for cell in range(len(line)):
            assert locate(line, geometry, place_of(cell, geometry)) == cell

    def test_the_space_after_a_cell_is_the_cells(self, letters):
        line = lay_out("un", letters).line(1)
        assert len(line) == 4
        pitch = STRESS2.cell_pitch_mm
        places = (-0.01, 0.0, pitch - 0.01, pitch + 0.01, 4 * pitch - 0.01, 4 * pitch + 0.01)
        assert [locate(line, STRESS2, x) for x in places] == [None, 0, 0, 1, 3, None]

    def test_from_a_place_to_the_character_and_back(self, english, table):
        layout = lay_out(english, table, VBD.cells_per_line(7.7))
        for character in range(0, len(english.rstrip()), 7):
            line, cell = layout.place(character)
            found = locate(line, VBD, place_of(cell, VBD))
            assert found == cell
            first, end = line.source(found)
            assert character < end
            assert first <= character or english[character:first].isspace()

    @given(st.integers(0, 500), st.floats(0.1, 20.0), st.floats(0.1, 50.0), st.floats(0.1, 50.0))
    def test_any_geometry(self, cell, width_mm, spacing_mm, gap_mm):
        if width_mm > spacing_mm + gap_mm:
            return
        geometry = replace(VBD, cell_gap_mm=50.0, dot_width_mm=width_mm, dot_spacing_mm=spacing_mm)
        geometry = replace(geometry, cell_gap_mm=gap_mm)
        block = Document.from_text("x").block(0)
        line = Line(1, 0, Cells.bare(np.ones(501, np.uint8)), block, 0, 1)
        assert locate(line, geometry, place_of(cell, geometry)) == cell
