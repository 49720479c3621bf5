"""Layouts that begin deep in a book: the same lines, and no more of them than are looked at."""

import gc
from dataclasses import replace
from functools import cache
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.laid import laid_out
from tests.tiers import examples
from tests.translate.blocks import BlockList, text_of
from vbraille.layout.blocks import LaidBlock
from vbraille.layout.pages import NEAR, Layout, Line
from vbraille.translate import Block, BlockKind, Book, BrailleTable, Document, Text

FRENCH = BrailleTable("fr-bfu-comp6.utb")
FAR = NEAR // 1_000 + 20  # paragraphs of 1,000 characters


class Watched(BlockList):
    """A source that tells which blocks were asked for."""

    def __init__(self, *blocks: Block) -> None:
        super().__init__(*blocks)
        self.asked: set[int] = set()

    def block(self, number: int) -> Block | None:
        self.asked.add(number)
        return super().block(number)

    def block_at(self, character: int) -> int | None:
        return None if character >= self._blocks[-1].text.end else character // 1_000


def watched(count: int) -> Watched:
    """Source of paragraphs of 999 characters and a blank, the same words in each."""
    text = text_of(" ".join(["mots"] * 200)[:999])
    blocks = (
        Block(replace(text, places=text.places + 1_000 * n, end=1_000 * (n + 1)))
        for n in range(count)
    )
    return Watched(*blocks)


def shown(line: Line | None) -> tuple[int, bytes, str]:
    assert line is not None
    return line.number, line.masks.tobytes(), line.text


@cache
def lines_of(text: str, width: int = 12) -> list[tuple[int, bytes, str]]:
    layout = Layout(book_of(text), width)
    return [shown(line) for line in layout.lines()]


def book_of(text: str) -> Book:
    return Book(Document.from_text(text), FRENCH)


def lines_before(text: str, block: int, width: int = 12) -> int:
    layout = Layout(book_of(text), width)
    blocks = layout.blocks()
    return sum(len(next(blocks).bounds) for _ in range(block))


paragraphs = st.lists(
    st.lists(st.sampled_from(["un", "deux", "A", "12,5", "é", "trois-quatre"]), min_size=1).map(
        " ".join
    ),
    min_size=1,
    max_size=12,
)


class TestTheSameLines:
    @examples(100)
    @given(paragraphs, st.data())
    def test_backward_and_forward_from_any_block(self, parts, data):
        text = "\n\n".join(parts)
        wanted = lines_of(text)
        start = data.draw(st.integers(0, len(parts) - 1))
        before = lines_before(text, start)
        layout = Layout(book_of(text), 12, start=start, lines_before=before)
        assert layout.counted
        assert layout.first_line == before + 1
        for number in data.draw(st.permutations(range(1, len(wanted) + 1))):
            assert shown(layout.line(number)) == wanted[number - 1]
        assert layout.line(0) is None
        assert layout.line(len(wanted) + 1) is None
        assert layout.count() == len(wanted)

    @examples(60)
    @given(paragraphs, st.data())
    def test_numbers_follow_each_other_as_long_as_nobody_has_counted(self, parts, data):
        text = "\n\n".join(parts)
        wanted = lines_of(text)
        start = data.draw(st.integers(1, len(parts)).filter(lambda n: n < len(parts)) | st.just(0))
        layout = Layout(book_of(text), 12, start=start, lines_before=None)
        assert layout.counted == (start == 0)
        first = layout.first_line
        before = lines_before(text, start)
        for number in range(first - before, first - before + len(wanted)):
            line = layout.line(number)
            assert shown(line) == (number, *wanted[number - first + before][1:])
            assert 0 <= layout.progress(line) < 1
        assert layout.line(first - before - 1) is None
        assert layout.line(first - before + len(wanted)) is None

    def test_counting_gives_lines_their_numbers_and_the_old_ones_still_lead_to_them(self):
        text = "\n\n".join(["un deux trois quatre"] * 9)
        layout = Layout(book_of(text), 12, start=5, lines_before=None)
        first = layout.first_line
        line = layout.line(first + 1)
        layout.line(first - 2)
        layout.count_from(4, lines_before(text, 4))
        assert layout.counted
        assert layout.first_line == lines_before(text, 5) + 1
        assert layout.number_of(line) == layout.line(line.number).number
        again = layout.line(line.number)
        assert shown(again) == lines_of(text)[again.number - 1]
        assert again.text == line.text
        assert layout.block_of(line) == layout.block_of(again) == 5
        assert shown(layout.line(again.number + 1)) == lines_of(text)[again.number]
        assert shown(layout.line(1)) == lines_of(text)[0]


class TestLongParagraphs:
    """Pieces of a paragraph that is longer than a piece may be."""

    TEXT = "un\n\n" + " ".join(f"mot{n}" for n in range(9_000)) + "\n\ndeux trois"

    def test_one_that_begins_nearby_is_laid_out_from_its_beginning(self):
        wanted = lines_of(self.TEXT)
        for start in (1, 2, 3):
            before = lines_before(self.TEXT, start)
            layout = Layout(book_of(self.TEXT), 12, start=start, lines_before=before)
            for number in (before + 1, before, before + 2):
                assert shown(layout.line(number)) == wanted[number - 1]

    def test_one_that_begins_far_back_is_entered_on_a_line_of_its_own(self):
        layout = Layout(book_of(self.TEXT), 12, start=6, lines_before=None)
        line = layout.line(layout.first_line)
        piece = layout.book.source.block(6)
        assert piece is not None
        assert piece.continues
        assert line.indent == 0
        assert str(piece.text).startswith(line.text)

    @pytest.mark.parametrize("start", [5, 6, 8])
    def test_nothing_is_lost_where_it_was_entered(self, start):
        layout = Layout(book_of(self.TEXT), 12, start=start, lines_before=None)
        texts, number = [], layout.first_line
        while (line := layout.line(number)) is not None:
            texts.append(line.text)
            number += 1
        number = layout.first_line - 1
        while (line := layout.line(number)) is not None:
            texts.insert(0, line.text)
            number -= 1
        assert "".join(texts) == laid_out(layout)


class TestFarAway:
    def test_what_is_between_is_not_laid_out(self):
        source = watched(5 * FAR)
        layout = Layout(Book(source, FRENCH), 26)
        layout.line(1)
        source.asked.clear()
        far = 3_000 * FAR
        found = layout.place(far + 7)
        assert found is not None
        assert found[0].source(found[1])[0] in (far + 7, far + 5)
        assert min(source.asked) >= far // 1_000 - 3
        assert not layout.counted
        # The lines where the book begins are still at hand, by their numbers.
        number = found[0].number
        assert layout.line(3).number == 3
        assert layout.counted
        assert layout.line(number - 1).number == number - 1
        assert len(source.asked) < 12

    def test_what_is_near_has_its_number(self):
        layout = Layout(Book(watched(FAR), FRENCH), 26)
        line, _ = layout.place(NEAR // 2)
        assert layout.counted
        assert shown(line) == shown(Layout(layout.book, 26).line(line.number))

    def test_what_is_near_before_the_beginning_too(self):
        layout = Layout(Book(watched(3 * FAR), FRENCH), 26, start=2 * FAR, lines_before=5_000)
        line, _ = layout.place(1_000 * (2 * FAR - 3))
        assert layout.counted
        assert 4_800 < line.number < 5_000

    def test_a_place_that_was_counted_has_its_number_at_once(self):
        layout = Layout(Book(watched(3 * FAR), FRENCH), 26)
        layout.count_from(2 * FAR, 7_000)
        line, _ = layout.place(2_000 * FAR)
        assert line.number == 7_001
        assert layout.line(1).number == 1

    def test_a_line_of_the_front_is_asked_for_by_its_number(self):
        source = watched(3 * FAR)
        layout = Layout(Book(source, FRENCH), 26, start=2 * FAR, lines_before=None)
        assert layout.line(1).number == 1
        assert not {n for n in source.asked if 3 < n < 2 * FAR - 3}

    def test_past_the_end(self):
        layout = Layout(Book(watched(FAR), FRENCH), 26)
        assert layout.place(1_000 * FAR) is None
        assert layout.line(1 << 41) is None

    @pytest.mark.parametrize("start", [3, 300])
    def test_a_beginning_past_the_end_is_an_error(self, start):
        with pytest.raises(ValueError, match=f"there is no block {start} in text"):
            Layout(book_of("un\n\ndeux"), 12, start=start, lines_before=None)

    def test_so_many_jumps_leave_no_more_than_the_last_few(self):
        source = watched(300 * FAR)
        layout = Layout(Book(source, FRENCH), 26)
        numbers = [layout.place(1_000 * FAR * n)[0].number for n in range(1, 300)]
        assert layout.line(numbers[0]) is None
        assert layout.line(numbers[-1]) is not None
        assert layout.line(1).number == 1
        assert all(b > a for a, b in pairwise(numbers))

    def test_of_what_is_laid_out_only_the_place_looked_at_last_is_kept(self):
        def kept():
            gc.collect()
            return sum(type(one) is LaidBlock for one in gc.get_objects())

        before = kept()
        layout = Layout(Book(watched(50 * FAR), FRENCH), 26)
        layout.line(1)
        once = kept() - before
        for jump in range(1, 20):
            layout.place(2_000 * FAR * jump)
            assert 0 < kept() - before <= once + 2
        layout.line(1)
        assert 0 < kept() - before <= once + 2


def test_a_page_without_a_number_at_the_beginning_has_no_line():
    text = text_of("un deux")
    source = BlockList(Block(text), Block(Text.empty(8), BlockKind.PAGE))
    layout = Layout(Book(source, FRENCH), 12, start=1, lines_before=None)
    assert layout.line(layout.first_line) is None
    assert layout.line(layout.first_line - 1).text == "un deux"
