"""Lines of a page: all the text is on them, in order, and they say where they are."""

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.translate.reading import opened
from vbraille.layout import Layout
from vbraille.translate import Book, BrailleTable, Cells, choose_table, remarks, text_source

TEXTS = Path(__file__).parents[2] / "texts"
TABLES = {name: BrailleTable(name) for name in ("en-ueb-g2.ctb", "de-g2.ctb", "zh-tw.ctb")}
PIECES = [
    "the",
    " ",
    "  ",
    "\u00a0",
    "people",
    "123",
    "-",
    "(",
    "É",
    "10⁶",
    "☃",
    "天氣",
    "，",
    "\n\n",
    "unusually",
]


def layout(text, width, table="en-ueb-g2.ctb", **how):
    return Layout(Book(text_source(text, **how), TABLES[table]), width)


def cells(lines):
    return [Cells.bare(line.masks).to_unicode() for line in lines]


@given(
    text=st.lists(st.sampled_from(PIECES), min_size=1, max_size=40).map("".join),
    width=st.integers(1, 40),
    table=st.sampled_from(list(TABLES)),
    keep_lines=st.booleans(),
)
@settings(max_examples=150, deadline=None)
def test_lines_hold_all_the_text_once_and_each_leads_to_the_others(text, width, table, keep_lines):
    if not text.strip():
        return
    made = layout(text, width, table, keep_lines=keep_lines)
    lines = list(made.lines())
    by_block = {}
    for line in lines:
        by_block.setdefault(line.block.number, []).append(line.text)
        assert len(line) <= width
        assert line.block.start <= line.place <= line.block.end
    for number, parts in by_block.items():
        assert "".join(parts) == made.book.source.block(number).text
    assert [made.number(line) for line in lines] == list(range(1, len(lines) + 1))
    assert [made.line(number).id for number in range(1, len(lines) + 1)] == [x.id for x in lines]
    assert sorted({line.id for line in lines}) == [line.id for line in lines]
    for line, following in pairwise(lines):
        assert made.beside(line) == following
        assert made.beside(following, -1) == line
    assert made.beside(lines[-1]) is None
    assert made.beside(lines[0], -1) is None
    assert (made.line(1), made.last(), made.count()) == (lines[0], lines[-1], len(lines))
    assert made.line(0) is None
    assert made.line(len(lines) + 1) is None
    again = layout(text, width, table, keep_lines=keep_lines)
    assert cells(again.lines(2, 3)) == cells(lines[1:3])


@given(place=st.integers(0, 7_000), width=st.integers(4, 40))
@settings(max_examples=40, deadline=None)
def test_a_place_is_on_its_line(place, width):
    made = Layout(Book(ENGLISH, TABLES["en-ueb-g2.ctb"]), width)
    found = made.place(place)
    if place > ENGLISH.end:
        assert found is None
        return
    line, cell = found
    start, after = line.source(cell)
    assert start >= place or start <= place < after
    assert line.place <= max(place, start) < line.cells.end
    assert made.place(line.place)[0] == line
    assert made.place(start) == (line, cell)
    if ENGLISH.text[start].isalpha():
        assert ENGLISH.text[start] in line.word(cell)


ENGLISH = opened((TEXTS / "english.txt").read_bytes())
assert ENGLISH.text  # all of it is read


def test_a_line_far_away_needs_none_of_those_before():
    made = Layout(Book(text_source("one two three\n\n" * 500), TABLES["en-ueb-g2.ctb"]), 30)
    line, _ = made.place(14 * 400)
    assert line.text == "one two three"
    assert made.book.source.progress(line.place) > 0.7
    assert made.beside(line, 3).block.number == line.block.number + 3
    assert len(made._before) == 1  # nothing was counted
    assert made.number(line) == 401


@pytest.mark.parametrize(
    ("text", "width", "wanted"),
    [
        ("one two", 6, ["⠀⠀⠐⠕", "⠞⠺⠕"]),
        ("01632960123", 8, ["⠀⠀⠼⠚⠁⠋⠉⠐", "⠃⠊⠋⠚⠁⠃⠉"]),  # goes on as a number, by dot 5
        ("extraordinarily", 8, None),
    ],
)
def test_a_word_that_is_cut_says_so(text, width, wanted):
    made = cells(layout(text, width).lines())
    if wanted is None:
        assert made[0].endswith("⠤")
    else:
        assert made[-len(wanted) :] == wanted


def test_a_number_that_is_cut_has_its_sign_again_in_other_codes():
    made = cells(layout("12345678901", 8, "de-g2.ctb").lines())
    assert [line.strip("⠀")[0] for line in made] == ["⠼", "⠼"]
    assert made[0].endswith("⠤")


@pytest.mark.parametrize(
    ("language", "text"),
    [
        ("zh-TW", "我們今天去公園散步，天氣非常好，孩子們都很高興。「真的嗎？」"),
        ("ja", "きょうは、いい天気です。「そうですね」とかれはいった。がっこう"),
        ("km", "ប្រទេសកម្ពុជាមានទីតាំងស្ថិតនៅអាស៊ីអាគ្នេយ៍។"),
    ],
)
def test_lines_of_scripts_without_spaces_begin_where_they_may(language, text):
    for width in range(12, 24):
        made = Layout(Book(text_source(text), choose_table(language)), width)
        for line in list(made.lines())[1:]:
            assert line.text[:1] not in "，。」？、っ។"
            assert line.block.text[line.first - 1] not in "「\u17d2"


def test_kinds_of_blocks_have_their_indents():
    page = "<h1>a</h1><p>b b b b b<ul><li>c c c c c<ul><li>d</ul></ul><blockquote>e</blockquote>"
    made = Layout(Book(opened(f"<html>{page}", "a.html"), TABLES["en-ueb-g2.ctb"]), 12)
    indents = [(line.block.kind.value, line.indent) for line in made.lines()]
    assert indents == [
        ("heading", 4), ("paragraph", 2), ("paragraph", 0), ("item", 0), ("item", 2), ("item", 2),
        ("quote", 4),
    ]  # fmt: skip


def test_a_page_of_print_has_a_rule_before_its_number():
    page = "<html><p>a<p><span class=pagebreak title=7></span>b<span class=pagebreak></span>"
    made = Layout(Book(opened(page, "a.html"), TABLES["en-ueb-g2.ctb"]), 20)
    assert cells(made.lines())[1] == "⠤⠤⠤⠤⠼⠛"


def test_passages_in_other_languages_are_between_signs():
    page = "<html lang=en><p>the <span lang=fr>ça</span>, for"
    book = Book(opened(page, "a.html"), TABLES["en-ueb-g2.ctb"])
    assert cells(Layout(book, 40).lines()) == ["⠀⠀⠮⠀⠘⠷⠯⠁⠘⠾⠂⠀⠿"]
    own = Book(book.source, book.table, switch=False)
    assert "⠘⠷" not in cells(Layout(own, 40).lines())[0]
    german = Book(opened(page.replace("lang=en", "lang=de"), "a.html"), TABLES["de-g2.ctb"])
    assert "⠋⠗⠒" in cells(Layout(german, 60).lines())[0]


def test_what_cannot_be_shown_or_written_is_said_at_the_end():
    page = "<html lang=en><p>a \ue123 ‹b› <img src=x><p><img src=y> <video>"
    book = Book(opened(page, "a.html"), TABLES["en-ueb-g2.ctb"])
    assert remarks(book, []) == []
    assert Layout(book, 20).count()
    unknown, plain, unshown = remarks(book, book.source.blocks())
    assert "U+E123" in unknown
    assert "‹undefined›" in unknown
    assert "2 characters" in plain
    assert "3 things (2 pictures, 1 film)" in unshown


def test_a_script_that_the_table_does_not_know_is_named_once():
    book = Book(text_source("Все люди.\n\nИ равными."), TABLES["de-g2.ctb"])
    list(Layout(book, 20).lines())
    (note,) = book.source.notes()
    assert "Cyrillic" in note
    assert "‹language›" in note


def test_capitals_and_addresses_that_are_cut_go_on_as_such():
    capitals = cells(layout("INTERNATIONALIZATION", 8).lines())
    assert all(line.endswith("⠤") for line in capitals[:-1])
    assert all(line.strip("⠀").startswith("⠠⠠") for line in capitals)
    address = cells(layout("https://example.org/abc", 12).lines())
    assert address[0].endswith("⠸⠌")  # a line may end at a slash
    assert address[1].endswith("⠐")
