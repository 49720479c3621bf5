"""How blocks of each kind are laid out."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.translate.blocks import BlockList, block_of
from vbraille.layout.blocks import indents
from vbraille.layout.pages import Layout
from vbraille.translate import BlockKind, Book, BrailleTable, Cells

FRENCH = BrailleTable("fr-bfu-comp6.utb")
KINDS = [
    (kind, level)
    for kind in BlockKind
    for level in (
        (1, 2, 3) if kind in (BlockKind.HEADING, BlockKind.ITEM, BlockKind.QUOTE) else (0,)
    )
]


@pytest.mark.parametrize(
    ("kind", "level", "lines"),
    [
        (BlockKind.PARAGRAPH, 0, ["  UN DEUX", "TROIS QUATRE"]),
        (BlockKind.HEADING, 1, ["    UN DEUX", "    TROIS", "    QUATRE"]),
        (BlockKind.HEADING, 3, ["    UN DEUX", "    TROIS", "    QUATRE"]),
        (BlockKind.ITEM, 1, ["UN DEUX", "  TROIS", "  QUATRE"]),
        (BlockKind.ITEM, 2, ["  UN DEUX", "    TROIS", "    QUATRE"]),
        (BlockKind.ROW, 0, ["UN DEUX", "  TROIS", "  QUATRE"]),
        (BlockKind.LINE, 0, ["UN DEUX", "  TROIS", "  QUATRE"]),
        (BlockKind.PAGE, 0, ["UN DEUX", "TROIS QUATRE"]),
        (BlockKind.NOTE, 0, ["  UN DEUX", "TROIS QUATRE"]),
        (BlockKind.QUOTE, 1, ["    UN DEUX", "  TROIS", "  QUATRE"]),
        (BlockKind.QUOTE, 2, ["    UN DEUX", "    TROIS", "    QUATRE"]),
    ],
)
def test_indents_by_kind(kind, level, lines):
    source = BlockList(block_of("un deux trois quatre", kind, level))
    layout = Layout(Book(source, FRENCH), 12)
    assert [line.printed.to_brf() for line in layout.lines()] == lines
    assert {line.block.kind for line in layout.lines()} == {kind}


@given(st.sampled_from(KINDS), st.integers(1, 60))
def test_indents_leave_more_than_half_of_a_line(kind, width):
    for indent in indents(block_of("a", *kind), width):
        assert indent % 2 == 0
        assert indent == 0 or 2 * indent < width


def test_a_page_of_no_number_is_no_line_and_an_empty_line_is_one():
    blocks = [
        block_of("un"),
        block_of("", BlockKind.PAGE),
        block_of("", BlockKind.LINE),
        block_of("deux"),
    ]
    layout = Layout(Book(BlockList(*blocks), FRENCH), 12)
    assert [line.printed.to_brf() for line in layout.lines()] == ["  UN", "", "  DEUX"]
    assert [line.number for line in layout.lines()] == [1, 2, 3]


@pytest.mark.parametrize(
    ("width", "line"), [(26, "----#AB"), (7, "----#AB"), (5, "--#AB"), (3, "#AB")]
)
def test_a_page_s_number_stands_after_a_row_of_dots(width, line):
    block = block_of("12", BlockKind.PAGE)
    layout = Layout(Book(BlockList(block), BrailleTable("en-ueb-g2.ctb")), width)
    (only,) = layout.lines()
    assert only.printed.to_brf() == line
    assert only.text == "12"
    assert only.cell_of(1) == len(line) - 1
    assert [only.source(cell)[0] for cell in range(len(line))] == [0] * (len(line) - 1) + [1]


def test_a_page_of_a_braille_book_is_as_the_book_has_it():
    block = replace(block_of("#ab", BlockKind.PAGE), cells=Cells.from_brf("#ab"))
    (line,) = Layout(Book(BlockList(block)), 26).lines()
    assert line.printed.to_brf() == "#AB"


def test_columns_of_a_row_are_as_far_apart_as_the_text_has_them():
    layout = Layout(Book(BlockList(block_of("un  deux", BlockKind.ROW)), FRENCH), 12)
    assert [line.printed.to_brf() for line in layout.lines()] == ["UN  DEUX"]
