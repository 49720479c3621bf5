"""How blocks of each kind are laid out."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.translate.blocks import BlockList, block_of
from vbraille.layout.indents import indents
from vbraille.layout.pages import Layout
from vbraille.translate import BlockKind, Book, BrailleTable

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
    ],
)
def test_indents_by_kind(kind, level, lines):
    source = BlockList(block_of("un deux trois quatre", kind, level))
    layout = Layout(Book(source, BrailleTable("fr-bfu-comp6.utb")), 12)
    assert [line.printed.to_brf() for line in layout.lines()] == lines
    assert {line.block.kind for line in layout.lines()} == {kind}


@given(st.sampled_from(KINDS), st.integers(1, 60))
def test_indents_leave_more_than_half_of_a_line(kind, width):
    for indent in indents(block_of("a", *kind), width):
        assert indent % 2 == 0
        assert indent == 0 or 2 * indent < width


def test_a_page_of_no_number_is_no_line_and_an_empty_line_is_one():
    table = BrailleTable("fr-bfu-comp6.utb")
    blocks = [
        block_of("un"),
        block_of("", BlockKind.PAGE),
        block_of("", BlockKind.LINE),
        block_of("deux"),
    ]
    layout = Layout(Book(BlockList(*blocks), table), 12)
    assert [line.printed.to_brf() for line in layout.lines()] == ["  UN", "", "  DEUX"]
    assert [line.number for line in layout.lines()] == [1, 2, 3]
    assert layout.progress(layout.line(3)) == 0.75
