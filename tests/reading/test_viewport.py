"""What is near is found as what is far: one answer in each process; and no reader waits for it."""

from itertools import count

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.reading.chapters import linked
from tests.tiers import examples
from vbraille.reading.search.questions import CountLines, FindKind, FindPage, FindShare, FindText
from vbraille.reading.search.seeker import look, look_everywhere, steps
from vbraille.reading.search.structure import within
from vbraille.translate import Document
from vbraille.translate.documents.chapters import ChapterSource, Passage
from vbraille.translate.source import BlockKind

WORDS = ("one", "two", "One  two", "caf\u00e9", "cafe\u0301", "Stra\u00dfe", "x" * 9_000)
KINDS = [kind.value for kind in BlockKind] + ["link", "image", "each item", "start"]


class Pages(ChapterSource):
    """A book of these parts."""

    def __init__(self, parts):
        super().__init__("book", [1 + len(part) for part in parts], "0" * 64)
        self._parts = parts

    def passages(self, part):
        return self._parts[part]


PASSAGES = st.one_of(
    st.builds(Passage, st.sampled_from(("", *WORDS))),
    st.builds(Passage, st.sampled_from(WORDS), st.sampled_from((BlockKind.LINE, BlockKind.NOTE))),
    st.builds(Passage, st.sampled_from(WORDS), st.just(BlockKind.HEADING), st.integers(1, 3)),
    st.builds(Passage, st.sampled_from(WORDS), st.just(BlockKind.ITEM), st.just(1),
              group=st.integers(0, 2)),
    st.builds(Passage, st.sampled_from(WORDS), st.just(BlockKind.ROW), group=st.integers(1, 2)),
    st.builds(Passage, st.sampled_from(("", "1", "iv")), st.just(BlockKind.PAGE)),
    st.just(linked("one two", "two", "#x")),
)  # fmt: skip
PARTS = st.lists(st.lists(PASSAGES, max_size=6), min_size=1, max_size=5)
PIECES = st.sampled_from((*WORDS, " ", "\n", "\n\n", "\xad\n", "well-\n", "known", "- ", "1. "))
TEXTS = st.lists(PIECES, min_size=1, max_size=20).map("".join)
NEEDLES = ("ONE TWO", "two one", "cafe", "caf\u00e9", "strasse", "x", "wellknown", "nowhere", " ")
QUERIES = st.one_of(
    st.builds(FindText, st.sampled_from(NEEDLES), st.integers(0, 30_000) | st.integers(0, 40),
              st.booleans(), st.booleans()),
    st.builds(FindKind, st.sampled_from(KINDS), st.integers(0, 20), st.booleans(),
              st.integers(0, 2), st.sampled_from(((), ("#x",), ("#y",)))),
    st.builds(FindShare, st.floats(0, 1)),
    st.builds(FindPage, st.sampled_from(("1", " IV ", "2"))),
)  # fmt: skip


def near(source, query):
    """Place that is found in small steps, however many that takes."""
    return next((step for step in steps(source, query, near=True) if isinstance(step, int)), None)


class TestLaw:
    @examples(100)
    @given(parts=PARTS, query=QUERIES)
    def test_a_book_with_structure(self, parts, query):
        wanted = look_everywhere(Pages(parts), query)
        assert near(Pages(parts), query) == wanted
        assert look(Pages(parts), query) in (wanted, query)

    @examples(100)
    @given(text=TEXTS, query=QUERIES, keep_lines=st.booleans())
    def test_a_plain_text(self, text, query, keep_lines):
        first, second = (Document.from_text(text, keep_lines=keep_lines) for _ in range(2))
        wanted = look_everywhere(first, query)
        assert near(second, query) == wanted
        assert look(second, query) in (wanted, query)


@pytest.mark.parametrize("keep_lines", [False, True])
def test_a_phrase_over_two_blocks_or_a_kept_line_break(keep_lines):
    document = Document.from_text("One\n\ntwo\nthree", keep_lines=keep_lines)
    assert look(document, FindText("one two three", 0)) == 0
    assert look(document, FindText("two three", 14, backward=True)) == 5


def test_a_share_is_where_so_many_of_the_characters_stand_before():
    pages = Pages([[Passage(name)] for name in "abcd"])
    found = [look(pages, FindShare(share)) for share in (0, 0.24, 0.26, 0.5, 0.9, 1)]
    assert found == [0, 2, 2, 4, 6, 6]


def test_the_beginning_of_a_long_list_behind_is_not_taken_for_near():
    rows = [Passage(f"Row {n}", BlockKind.ROW, group=1) for n in range(3_000)]
    pages = Pages([[*rows, Passage("After.")]])
    query = FindKind("row", 3_000, backward=True)
    assert look(pages, query) is query
    assert look_everywhere(pages, query) == 0


@pytest.mark.parametrize(
    "query",
    [
        FindText("needle", 0),
        FindText("needle", 2_900_000, backward=True),
        FindShare(0.9),
        CountLines(20, 5),
        FindKind("line", 0),
    ],
)
def test_what_is_far_is_handed_over_within_a_moment(query):
    document = Document.from_text("nothing here\n\n" * 200_000 + "needle")
    document.block(100)
    known = len(document.index().rows)
    looks = count()
    assert look(document, query, lambda: next(looks) / 1000) is query  # a millisecond for each
    assert next(looks) <= 102  # of short blocks a hundred are looked at in any case
    assert len(document.index().rows) <= known + 12


def test_a_paragraph_begins_after_an_empty_line_or_a_long_one():
    document = Document.from_text("one\ntwo\n\nthree\nfour\n", keep_lines=True)
    assert look(document, FindKind("start", 0)) == 9
    assert look(document, FindKind("start", 4, backward=True)) == 9
    assert look(document, FindKind("start", 3, backward=True)) == 0
    assert look(document, FindKind("start", 3)) is None
    long = "word " * 5_000
    document = Document.from_text(f"{long}\n\nnext")
    assert look(document, FindKind("start", 0)) == len(long) + 2
    last = document.block_at(len(long) + 2)
    assert look(document, FindKind("start", last, backward=True)) == 0


def test_blocks_around_a_place():
    document = Document.from_text("\n\n".join("abcd"))
    assert [number for number, _ in within(document, 1)] == [1, 2, 3]
    assert [str(block.text) for _, block in within(document, 1, backward=True)] == ["b", "a"]
