"""Cells: every spelling is exact, and the maps to the source hold both ways."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.braille.spelling import spell
from vbraille.translate import Cells

SIX_DOTS = bytes(range(64))
ALL = bytes(range(256))


def bare(masks) -> Cells:
    return Cells.bare(np.frombuffer(bytes(masks), np.uint8))


@st.composite
def runs(draw) -> Cells:
    """Cells whose sources come in any order that does not decrease."""
    steps = draw(st.lists(st.integers(0, 3), min_size=1, max_size=30))
    starts = np.cumsum(steps).astype(np.int64)
    masks = np.array(draw(st.lists(st.integers(0, 255), min_size=len(steps), max_size=len(steps))))
    return Cells(masks.astype(np.uint8), starts, int(starts[-1]) + draw(st.integers(1, 3)))


class TestSpellings:
    def test_every_six_dot_cell_has_its_own_brf_character(self):
        text = bare(SIX_DOTS).to_brf()
        assert len(set(text)) == 64
        assert all(0x20 <= ord(c) <= 0x5F for c in text)
        assert Cells.from_brf(text).masks.tobytes() == SIX_DOTS

    def test_brf_is_the_north_american_table(self):
        table = " A1B'K2L@CIF/MSP\"E3H9O6R^DJG>NTQ,*5<-U8V.%[$+X!&;:4\\0Z7(_?W]#Y)="
        assert bare(SIX_DOTS).to_brf() == table

    def test_brf_in_lower_case_is_the_same(self):
        lower = "".join(chr(ord(c) + 32) if ord(c) >= 0x40 else c for c in bare(SIX_DOTS).to_brf())
        assert "a" in lower
        masks = Cells.from_brf(lower.replace("\x7f", "_")).masks
        assert masks.tobytes() == SIX_DOTS

    def test_unicode_is_the_mask_after_u2800(self):
        assert bare(ALL).to_unicode() == "".join(map(chr, range(0x2800, 0x2900)))
        assert Cells.from_unicode(bare(ALL).to_unicode()).masks.tobytes() == ALL

    def test_dots_are_exact_for_all_eight(self):
        for mask, dots in enumerate(bare(ALL).to_dots().split(" ")):
            raised = [d for d in range(1, 9) if mask >> d - 1 & 1]
            assert dots == ("-".join(map(str, raised)) or "0")

    @given(st.binary(max_size=50))
    def test_spellings_come_back(self, masks):
        cells = bare(masks)
        assert Cells.from_unicode(cells.to_unicode()).masks.tobytes() == masks
        assert bytes(spell(cells.to_dots(), {})) == masks
        six = bare(m & 0x3F for m in masks)
        assert Cells.from_brf(six.to_brf()).masks.tobytes() == six.masks.tobytes()

    @pytest.mark.parametrize("mask", [0x40, 0x80, 0xC1])
    def test_brf_has_no_dots_7_and_8(self, mask):
        with pytest.raises(ValueError, match=r"BRF has six dots .* dots .*[78]"):
            bare([1, mask]).to_brf()

    @pytest.mark.parametrize("text", ["A\x7f", "é", "A\n", "\x1f", "\U0001f600", "\udc80", "⤀"])
    def test_what_is_no_brf(self, text):
        with pytest.raises(ValueError, match="is not a braille pattern"):
            Cells.from_brf(text)

    @pytest.mark.parametrize("text", ["⠁a", "\u27ff", "\u2900", " ", "\ud800"])
    def test_what_is_no_pattern(self, text):
        with pytest.raises(ValueError, match="is not a braille pattern"):
            Cells.from_unicode(text)


class TestMaps:
    def test_bare_cells_stand_for_themselves(self):
        assert [bare([7, 8]).source(n) for n in (0, 1)] == [(0, 1), (1, 2)]

    def test_one_character_in_two_cells_and_two_in_one(self):
        cells = Cells(np.array([1, 2, 3], np.uint8), np.array([5, 5, 6]), 8)
        assert [cells.source(n) for n in range(3)] == [(5, 6), (5, 6), (6, 8)]
        assert [cells.of_source(c) for c in (5, 6, 7)] == [(0, 2), (2, 3), (2, 3)]

    @pytest.mark.parametrize("character", [4, 8, -1])
    def test_characters_of_others(self, character):
        cells = Cells(np.array([1, 2], np.uint8), np.array([5, 6]), 8)
        with pytest.raises(IndexError, match=f"character {character} is not in these cells"):
            cells.of_source(character)

    @given(runs())
    def test_there_and_back(self, cells):
        for n in range(len(cells)):
            first, end = cells.source(n)
            assert cells.starts[0] <= first < end <= cells.end
            for character in range(first, end):
                low, high = cells.of_source(character)
                assert low <= n < high
        spans = sorted({cells.source(n) for n in range(len(cells))})
        assert spans[0][0] == cells.starts[0]
        assert spans[-1][1] == cells.end
        assert all(one[1] == two[0] for one, two in itertools.pairwise(spans))

    @given(runs(), st.data())
    def test_a_part_says_the_same_of_its_cells(self, cells, data):
        start = data.draw(st.integers(0, len(cells)))
        stop = data.draw(st.integers(start, len(cells)))
        part = cells[start:stop]
        assert part.masks.tolist() == cells.masks[start:stop].tolist()
        # A character whose cells are cut in two belongs to both parts.
        for n in range(len(part)):
            assert part.source(n) == cells.source(start + n)
        if not part.masks.size:
            assert part.end >= cells.starts[0]

    def test_runs_only(self):
        with pytest.raises(ValueError, match="step"):
            bare([1, 2, 3])[::2]
