"""Marks in braille: emphasis by the table's own signs, and languages by their tables."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from tests.translate.blocks import BlockList, block_of
from vbraille.translate import Book, BrailleTable, Cells
from vbraille.translate.source import Block, BlockKind, Mark, MarkKind

table_of = cache(BrailleTable)
SENTENCE = "one two three four five"


def marked(text: str, *marks: tuple[MarkKind, str] | tuple[MarkKind, str, str], **of) -> Block:
    """Block in which parts of the text are marked."""
    found = []
    for kind, part, *target in marks:
        start = text.index(part)
        found.append(Mark(kind, start, start + len(part), *target))
    return replace(block_of(text), marks=tuple(found), **of)


def cells_of(block: Block, table: str = "en-ueb-g2.ctb", **how) -> Cells:
    book = Book(BlockList(block), table_of(table), **how)
    found = book.block(0)
    assert found is not None
    return found[1]


def brf(block: Block, table: str = "en-ueb-g2.ctb", **how) -> str:
    return cells_of(block, table, **how).to_brf()


class TestEmphasis:
    @pytest.mark.parametrize(
        ("table", "kind", "part", "written"),
        [
            ("en-ueb-g2.ctb", MarkKind.ITALIC, "two", '"O .1TWO ?REE F|R FIVE'),
            ("en-ueb-g2.ctb", MarkKind.BOLD, "two", '"O ^1TWO ?REE F|R FIVE'),
            ("en-ueb-g2.ctb", MarkKind.UNDERLINE, "two", '"O _1TWO ?REE F|R FIVE'),
            ("en-ueb-g2.ctb", MarkKind.ITALIC, "two three four", "\"O .7TWO ?REE F|R.' FIVE"),
            ("fr-bfu-comp6.utb", MarkKind.BOLD, "two", "ONE _TWO THREE FOUR FIVE"),
            ("it.tbl", MarkKind.ITALIC, "two", "ONE TWO THREE FOUR FIVE"),
            ("en-ueb-g2.ctb", MarkKind.LINK, "two", '"O TWO ?REE F|R FIVE'),
        ],
    )
    def test_is_written_as_the_table_does(self, table, kind, part, written):
        written = written.replace("|", "\\")
        assert brf(marked(SENTENCE, (kind, part)), table) == written

    def test_of_two_kinds_at_once(self):
        block = marked(SENTENCE, (MarkKind.ITALIC, "two"), (MarkKind.BOLD, "two"))
        assert {".1", "^1"} <= {brf(block)[n : n + 2] for n in range(10)}

    def test_superscripts_of_a_table_that_has_them(self):
        plain, raised = block_of("x2"), marked("x2", (MarkKind.SUPERSCRIPT, "2"))
        assert brf(raised, "no-no-g0.utb") != brf(plain, "no-no-g0.utb")

    def test_a_sign_stands_for_the_character_next_to_it(self):
        block = marked(SENTENCE, (MarkKind.ITALIC, "two"))
        cells = cells_of(block)
        at = cells.to_brf().index(".1")
        assert {cells.source(at)[0], cells.source(at + 1)[0]} <= {3, 4}
        first, after = cells.of_source(5)
        assert cells[first:after].to_brf() == "W"

    def test_is_right_where_a_character_is_replaced_by_several(self):
        block = marked("\u4e2d a b \u4e2d", (MarkKind.ITALIC, "b"))
        assert brf(block).replace(".", "").replace("1", "", 1) != brf(block)
        cells = cells_of(block)
        mark = cells.to_brf().index("B")
        assert cells.source(mark)[0] == 4

    def test_a_mark_that_ends_outside_the_block_counts_up_to_its_end(self):
        block = replace(block_of(SENTENCE), marks=(Mark(MarkKind.ITALIC, -50, 3_000),))
        assert brf(block).startswith(".7")


class TestLanguages:
    def test_a_block_in_another_language_has_its_table(self):
        block = replace(block_of("\xe9t\xe9 mondial"), language="fr")
        assert brf(block) == "^(=T= ^(MONDIAL"
        assert brf(block, switch=False) == brf(replace(block, language="")) != "=T= MONDIAL"
        assert brf(replace(block, language="tlh")) == brf(block, switch=False)

    @pytest.mark.parametrize("language", ["en", "EN", "en-GB", "en-US", ""])
    def test_the_book_s_own_language_said_otherwise_is_its_own(self, language):
        block = replace(block_of(SENTENCE), language=language)
        assert brf(block, "en-us-g2.ctb") == brf(block_of(SENTENCE), "en-us-g2.ctb")

    def test_what_the_source_calls_its_language_is_the_book_s_own(self):
        source = BlockList(replace(block_of(SENTENCE), language="fr"))
        source.language = "fr"
        book = Book(source, table_of("en-ueb-g2.ctb"), language="en")
        assert book.block(0)[1].to_brf().startswith('"O ')

    def test_a_passage_in_another_language_has_its_table(self):
        block = marked("the mondial for", (MarkKind.LANGUAGE, "mondial", "fr"))
        assert brf(block) == "! ^(MONDIAL ="
        inner = marked(
            "the for mondial for the",
            (MarkKind.LANGUAGE, "for mondial for the", "fr"),
            (MarkKind.LANGUAGE, "the", "en"),
        )
        inner = replace(inner, marks=(inner.marks[0], Mark(MarkKind.LANGUAGE, 20, 23, "en")))
        assert brf(inner) == '! "(FR\'FOR MONDIAL FOR,") !'

    def test_a_grade_holds_for_other_languages_where_they_have_it(self):
        german = replace(block_of("und nicht"), language="de")
        assert brf(german) != brf(german, grade=1) == "^(UND ^(NI?T"
        assert brf(german) == brf(german, grade=2)
        italian = replace(block_of("con tutti"), language="it")
        assert brf(italian, grade=2) == brf(italian)

    def test_six_dots_stay_six_dots(self):
        block = replace(block_of("tere"), language="et")  # there are eight dots and nothing else
        assert cells_of(block).masks.max() <= 0x3F
        assert cells_of(block, "fr-bfu-comp8.utb").masks.max() > 0

    def test_a_table_is_made_when_it_is_wanted_and_kept(self):
        blocks = [replace(block_of("oui"), language=tag) for tag in ("en", "fr", "fr-FR", "fr")]
        book = Book(BlockList(*blocks), table_of("en-ueb-g2.ctb"))
        assert book.translator is not None
        assert [table.name for table in book.translator.tables] == ["en-ueb-g2.ctb"]
        for n in range(4):
            book.block(n)
        names = [table.name for table in book.translator.tables]
        assert names == ["en-ueb-g2.ctb", "fr-bfu-comp6.utb"]

    @pytest.mark.parametrize(
        ("table", "part", "written"),
        [
            # Rules of Unified English Braille, 14.3: each word of two, a passage of three.
            ("en-ueb-g2.ctb", "bon", "⠘⠷⠃⠕⠝"),
            ("en-ueb-g2.ctb", "bon chat", "⠘⠷⠃⠕⠝⠀⠘⠷⠉⠓⠁⠞⠘⠾⠂"),
            ("en-ueb-g2.ctb", "un bon chat", "⠐⠷⠋⠗⠄⠥⠝⠀⠃⠕⠝⠀⠉⠓⠁⠞⠠⠐⠾⠂"),
            ("en-ueb-g2.ctb", " un bon ", "⠀⠘⠷⠥⠝⠀⠘⠷⠃⠕⠝⠀"),
            ("es.tbl", "bon", "⠷⠋⠗⠒⠃⠕⠝⠾"),
            ("de-g2.ctb", "bon", "⠠⠶⠋⠗⠒⠃⠕⠝⠠⠶"),
            ("he-IL.utb", "bon", "⠶⠋⠗⠒⠃⠕⠝⠾"),
            ("ur-pk-g1.utb", "bon", "⠿⠃⠕⠝⠿"),
        ],
    )
    def test_where_another_table_begins_and_ends_is_marked(self, table, part, written):
        block = marked("x un bon chat, x", (MarkKind.LANGUAGE, part, "fr-CA"))
        found = cells_of(block, table).to_unicode()
        if table.startswith("ur"):
            assert found.count("⠿") > cells_of(block, table, switch=False).to_unicode().count("⠿")
        else:
            assert written in found
        assert written not in cells_of(block, table, switch=False).to_unicode()

    def test_what_is_written_by_the_book_s_table_is_not_marked(self):
        block = marked("x bon x", (MarkKind.LANGUAGE, "bon", "tlh"))
        assert brf(block) == brf(replace(block, marks=()))
        empty = marked("x  x", (MarkKind.LANGUAGE, "  ", "fr"))
        assert brf(empty) == brf(replace(empty, marks=()))

    def test_a_note_is_given_for_each_table(self):
        block = replace(block_of("\u0434\u0430 \u043d\u0435\u0442"), language="fr")
        book = Book(BlockList(block), BrailleTable("en-ueb-g2.ctb"))
        book.block(0)
        assert ["fr-bfu-comp6.utb" in note for note in book.notes()] == [True]

    def test_an_empty_block_and_empty_marks(self):
        block = block_of("", BlockKind.LINE)
        block = replace(block, marks=(Mark(MarkKind.LANGUAGE, 0, 0, "fr"),), language="de")
        assert len(cells_of(block)) == 0


TAGS = ("fr", "ru", "en", "it", "tlh")
TABLES = ("en-ueb-g2.ctb", "fr-bfu-comp6.utb", "ru-litbrl.ctb", "ko-g2.ctb", "en-us-g2.ctb")
words = st.lists(
    st.sampled_from(
        ["the", "monde", " ", " ", "ABC", "12,5", "\u0434\u0430", "-", "\u4e2d", "\xe9", ".", "f"]
    ),
    min_size=1,
    max_size=20,
).map("".join)
emphasis = st.sampled_from([MarkKind.ITALIC, MarkKind.BOLD, MarkKind.UNDERLINE])


def spans(draw: st.DrawFn, size: int) -> tuple[int, int]:
    start, end = sorted((draw(st.integers(0, size)), draw(st.integers(0, size))))
    return start, end


letters = st.text("abcd\xe9AB ", min_size=1, max_size=30)  # nothing that is one sign together


@st.composite
def marked_blocks(draw: st.DrawFn, texts: st.SearchStrategy[str] = words) -> Block:
    block = block_of(draw(texts))
    size = block.text.end
    marks = [Mark(draw(emphasis), *spans(draw, size)) for _ in range(draw(st.integers(0, 3)))]
    tags = draw(st.lists(st.sampled_from(TAGS), max_size=3))
    marks += [Mark(MarkKind.LANGUAGE, *spans(draw, size), tag) for tag in tags]
    return replace(block, marks=tuple(marks), language=draw(st.sampled_from(["", "fr"])))


class TestPlaces:
    @examples(150)
    @given(marked_blocks(), st.sampled_from(TABLES))
    def test_they_lead_back_to_the_text_in_order(self, block, table):
        cells = cells_of(block, table)
        assert cells.end == block.text.end
        if len(cells):
            assert (np.diff(cells.starts) >= 0).all()
            assert set(cells.starts.tolist()) <= set(block.text.places.tolist())

    @examples(150)
    @given(marked_blocks(letters))
    def test_emphasis_takes_no_cell_from_its_place(self, block):
        """Without contractions the cells of the text are all there; signs stand between them."""
        block = replace(block, language="")
        plain = replace(block, marks=())
        block = replace(plain, marks=tuple(m for m in block.marks if not m.target))
        with_signs, without = (cells_of(b, "fr-bfu-comp6.utb") for b in (block, plain))
        masks, starts = with_signs.masks.tolist(), with_signs.starts.tolist()
        found = iter(zip(masks, starts, strict=True))
        wanted = zip(without.masks.tolist(), without.starts.tolist(), strict=True)
        assert all(pair in found for pair in wanted)

    @examples(100)
    @given(words, words, words)
    def test_a_passage_is_what_its_table_makes_of_it(self, before, foreign, after):
        text = f"x{before}.{foreign}.{after}x"
        start = len(before) + 2
        mark = Mark(MarkKind.LANGUAGE, start, start + len(foreign), "fr")
        block = replace(block_of(text), marks=(mark,))
        whole = cells_of(block)
        english, french = table_of("en-ueb-g2.ctb"), table_of("fr-bfu-comp6.utb")
        pieces = [
            (english, text[:start]),
            (french, foreign),
            (english, text[start + len(foreign) :]),
        ]
        if block.text.places.size != len(text):  # accents were composed: the parts are others
            return
        alone = [table.translate(block_of(part).text).masks.tolist() for table, part in pieces]
        if all(part == str(block_of(part).text) for _, part in pieces):
            found = whole.masks.tolist()
            end = len(found) - len(alone[2])
            assert (found[: len(alone[0])], found[end:]) == (alone[0], alone[2])
            within = iter(found[len(alone[0]) : end])
            assert all(cell in within for cell in alone[1])  # marks stand between them
