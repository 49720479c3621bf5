"""Pages by BANA's layout: where each kind of block stands, and that nothing is lost."""

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from tests.translate.braillefiles.test_ebraille import Made
from vbraille.layout.embossed import (
    BanaPages,
    blocks_of,
    cut_pages,
    kept_pages,
    numbers_by,
    rows_of,
)
from vbraille.layout.pages import Layout
from vbraille.translate import BlockKind, Book, BrailleTable, Cells
from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.documents.parted import Passage

K = BlockKind
TABLE = BrailleTable("en-ueb-g1.ctb")
LONG = "aaaa bbbb cccc dddd eeee ffff gggg hhhh iiii jjjj"


def pages(*passages, cells=20, lines=12, table=TABLE):
    """Pages as lists of lines in BRF, without blanks at their ends."""
    made = BanaPages(Book(Made(*passages), table), cells, lines)
    found = []
    for page in made:
        assert len(page) == lines
        assert all(row.size == cells for row in page)
        found.append([Cells.bare(row).to_brf().rstrip() for row in page])
    return found


def body(page):
    """Lines of a page down to the last before its number."""
    lines = [*page[:-1], page[-1].rpartition("#")[0].rstrip()]
    while lines and not lines[-1]:
        lines.pop()
    return lines


def test_a_paragraph_is_3_1_and_the_page_has_its_number():
    (page,) = pages(Passage(LONG))
    assert page == [
        "  AAAA BBBB CCCC",
        "DDDD EEEE FFFF GGGG",
        "HHHH IIII JJJJ",
        *[""] * 8,
        " " * 18 + "#A",
    ]


def test_a_page_number_has_three_blanks_before_it():
    first, second = pages(Passage(f"{LONG} {LONG} {LONG} {LONG}"), lines=8, cells=22)
    assert first[-1].endswith("   #A")
    assert len(first[-1]) == 22
    assert 10 < len(first[-1].removesuffix("#A").rstrip()) <= 22 - 2 - 3
    assert second[-1] == " " * 20 + "#B"


@pytest.mark.parametrize(
    ("level", "wanted"),
    [
        (1, ["AAAA", "", "        TITLE", "", "  BBBB"]),
        (2, ["AAAA", "", "    TITLE", "  BBBB"]),
        (3, ["AAAA", "", "      TITLE", "  BBBB"]),
        (6, ["AAAA", "", "      TITLE", "  BBBB"]),
    ],
)
def test_a_heading_stands_where_its_level_does(level, wanted):
    (page,) = pages(Passage("aaaa"), Passage("title", K.HEADING, level), Passage("bbbb"), cells=21)
    assert [line.lstrip() if line == "  AAAA" else line for line in body(page)] == wanted


def test_a_long_heading_is_centred_or_blocked_on_each_line():
    (page,) = pages(Passage(LONG[:24], K.HEADING, 1), Passage("a"))
    assert body(page) == ["   AAAA BBBB CCCC", "     DDDD EEEE", "", "  A"]
    (page,) = pages(Passage(LONG[:24], K.HEADING, 2), Passage("a"))
    assert body(page) == ["    AAAA BBBB CCCC", "    DDDD EEEE", "  A"]


@pytest.mark.parametrize("before", range(1, 14))
@pytest.mark.parametrize("levels", [(1,), (2,), (3,), (1, 2), (1, 2, 3), (2, 3)])
def test_no_heading_stands_at_a_pages_end_alone(before, levels):
    headings = [Passage("title", K.HEADING, level) for level in levels]
    found = pages(*[Passage("text")] * before, *headings, Passage("after"), lines=12)
    flat = [line.strip() for page in found for line in body(page)]
    assert [line for line in flat if line] == ["TEXT"] * before + ["TITLE"] * len(levels) + [
        "AFTER"
    ]
    for page in found:
        lines = body(page)
        assert lines[0], "no blank line at the top"
        if any("TITLE" in line for line in lines):
            assert lines[-1] == "  AFTER"
            at = next(n for n, line in enumerate(lines) if "TITLE" in line)
            assert at == 0 or lines[at - 1] == ""
            assert sum("TITLE" in line for line in lines) == len(levels)


def test_a_heading_that_ends_a_book_or_fills_a_page():
    (page,) = pages(Passage("title", K.HEADING, 1))
    assert body(page) == ["       TITLE"]
    found = pages(*[Passage("title", K.HEADING, 2)] * 20, Passage("end"), lines=6)
    assert sum(line.strip() == "TITLE" for page in found for line in body(page)) == 20


def test_lists_begin_by_level_and_run_over_beyond_the_deepest():
    (page,) = pages(Passage("aa"), Passage(LONG[:24], K.ITEM, 1, group=1), Passage("bb"), cells=20)
    assert body(page) == ["  AA", "", "AAAA BBBB CCCC DDDD", "  EEEE", "", "  BB"]
    (page,) = pages(
        Passage(LONG[:24], K.ITEM, 1, group=1),
        Passage(LONG[:24], K.ITEM, 2, group=1),
        Passage("z", K.ITEM, 1, group=2),
        cells=20,
    )
    assert body(page) == [
        *("AAAA BBBB CCCC DDDD", "    EEEE", "  AAAA BBBB CCCC", "    DDDD EEEE", "", "Z"),
    ]
    (page,) = pages(Passage("title", K.HEADING, 2), Passage("a", K.ITEM, 1, group=1))
    assert body(page) == ["    TITLE", "A"]


def test_quotes_verse_rows_and_notes():
    (page,) = pages(
        Passage("aa"),
        Passage(LONG[:24], K.QUOTE, 1),
        Passage("deeper", K.QUOTE, 2),
        Passage("verse", K.LINE),
        Passage(LONG[:24], K.LINE),
        Passage("row", K.ROW, group=1),
        Passage(LONG[:24], K.NOTE),
        lines=25,
    )
    assert body(page) == [
        *("  AA", "", "  AAAA BBBB CCCC", "DDDD EEEE", "    DEEPER", "", "VERSE"),
        *("AAAA BBBB CCCC DDDD", "  EEEE", "", "ROW", "", "      AAAA BBBB CCCC", "    DDDD EEEE"),
    ]


def test_print_pages_are_told_in_the_text_and_at_the_top():
    found = pages(
        *(Passage("1", K.PAGE), Passage("aa"), Passage("2", K.PAGE), Passage("bb")),
        *(Passage("3", K.PAGE), Passage("title", K.HEADING, 2)),
        *[Passage("cc")] * 20,
        cells=20,
        lines=10,
    )
    assert found[0] == [
        *("  AA              #A", "------------------#B", "  BB", "------------------#C", ""),
        *("    TITLE", "  CC", "  CC", "  CC", "  CC" + " " * 14 + "#A"),
    ]
    assert found[1][0] == "  CC" + " " * 13 + "A#C"
    assert found[2][0] == "  CC" + " " * 13 + "B#C"


@pytest.mark.parametrize(("before", "told"), [(7, True), (8, False), (9, False), (10, False)])
def test_a_print_page_that_begins_at_a_pages_end_is_told_at_the_next_top(before, told):
    found = pages(*[Passage("aa")] * before, Passage("xi", K.PAGE), Passage("bb"), lines=10)
    lines = [line for page in found for line in page]
    assert any("-----" in line for line in lines) is told
    if not told:
        assert len(found) == 2
        assert found[1][0].endswith("   XI")
        assert found[1][0].startswith("  BB")


def test_print_pages_without_number_or_with_an_endless_one():
    found = pages(Passage("aa"), Passage("", K.PAGE), Passage("bb"), Passage("x" * 60, K.PAGE))
    assert [body(page)[0] for page in found] == ["  AA", "  BB"]
    many = pages(Passage("7", K.PAGE), *[Passage("a")] * 6 * 30, lines=6)
    tops = [page[0].rpartition(" ")[2] for page in many]
    assert tops[:3] == ["#G", "A#G", "B#G"]
    assert tops[26:29] == ["Z#G", "AA#G", "BB#G"]


def test_numbers_are_written_by_the_books_table():
    french = Book(Made(Passage("a")), BrailleTable("fr-bfu-comp6.utb"))
    assert Cells.bare(numbers_by(french)(12)).to_dots() == "6 1-6 1-2-6"
    ready = Book(open_brf(io.BytesIO(b"A\n"), "x"))
    assert Cells.bare(numbers_by(ready)(120)).to_brf() == "#ABJ"


def test_a_page_that_is_too_small_is_refused():
    book = Book(Made(Passage("a")), TABLE)
    with pytest.raises(ValueError, match="cells is 19; the layout needs at least 20"):
        BanaPages(book, 19, 25)
    with pytest.raises(ValueError, match="lines is 5; the layout needs at least 6"):
        BanaPages(book, 40, 5)


def test_a_book_without_text_has_no_page():
    assert pages(Passage(""), Passage("   ")) == []


KINDS = st.sampled_from(
    [
        *((K.PARAGRAPH, 0), (K.HEADING, 1), (K.HEADING, 2), (K.HEADING, 4), (K.ITEM, 1)),
        *((K.ITEM, 3), (K.ITEM, 30), (K.QUOTE, 2), (K.LINE, 0), (K.ROW, 0), (K.NOTE, 0)),
    ]
)
WORDS = st.text(st.sampled_from("ab  "), max_size=90) | st.just("ab" * 5_000)


@examples(60)
@given(st.lists(st.tuples(KINDS, WORDS), max_size=12), st.integers(20, 45), st.integers(6, 27))
def test_no_cell_is_lost_or_doubled(blocks, cells, lines):
    passages = [
        Passage(text, kind, level, group=1 if level and kind is K.ITEM else 0)
        for (kind, level), text in blocks
    ]
    found = pages(*passages, cells=cells, lines=lines)
    shown = "".join("".join(body(page)).replace(" ", "") for page in found)
    wanted = "".join(
        Cells.bare(masks.masks).to_brf() for _, masks in blocks_of(Book(Made(*passages), TABLE))
    )
    assert shown == wanted.replace(" ", "")


def test_it_tells_of_each_block():
    seen = []
    book = Book(Made(Passage("a"), Passage("b", K.ITEM, 1)), TABLE)
    list(BanaPages(book, 20, 6, seen.append))
    assert [str(block.text) for block in seen] == ["a", "b"]


def test_kept_pages_are_those_of_the_file():
    book = Book(open_brf(io.BytesIO(b"AAAA BBBB\n\n\fC\n\f"), "x"))
    assert [[Cells.bare(r).to_brf() for r in page] for page in kept_pages(book)] == [
        ["AAAA BBBB", ""],
        ["C"],
    ]
    assert [[Cells.bare(r).to_brf() for r in page] for page in kept_pages(book, 6)] == [
        ["AAAA", "  BBBB", ""],
        ["C"],
    ]


def test_laid_lines_are_cut_in_pages():
    layout = Layout(Book(Made(Passage(LONG)), TABLE), 20)
    rows = list(rows_of(layout.lines()))
    assert [row.tolist() for row in rows] == [line.masks.tolist() for line in layout.lines()]
    assert [len(page) for page in cut_pages(rows, 2)] == [2, 1]
    assert np.concatenate([row for page in cut_pages(rows, 2) for row in page]).any()
