"""Pages: every word is there, nothing is lost, and no paragraph is too long."""

import random
import tracemalloc
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.laid import cuts_inside, laid_out, rebuilt
from tests.layout.pages import brf, lay_out
from tests.tiers import examples, heavy
from vbraille.layout.blocks import wrap
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document

# Letters of several cells, symbols, hyphens, blanks of all kinds, and what tables do not know.
pieces_of_text = st.one_of(
    st.sampled_from(
        [
            "/",
            "\u2014",
            " -- ",
            "Ä",
            "É",
            "ABC",
            "12,5",
            "3/4",
            "\u4e2d\u6587",
            "\u0434\u0430",
            "\U0001f600",
            "\xa0",
            "\u2800",
            "\u200b",
            "e\u0301",
            "\n",
            "\n\n",
            "\t",
            "-\n",
            "\xad",
            "\ufeff",
            "\f",
            "_\bx",
            "https://example.org/a/b",
            "Tragödie. --",
            "McDonald",
            "...",
            "(",
            '"',
            "\0",
            "\x1c",
        ]
    ),
    st.text("abcdefghijklm .,-ABC123", max_size=12),
)
mixed_texts = st.lists(pieces_of_text, min_size=1, max_size=25).map("".join).filter(bool)
MIXED_TABLES = (
    "en-ueb-g2.ctb",
    "de-g2.ctb",
    "fr-bfu-comp6.utb",
    "ru-litbrl.ctb",
    "zh-tw.ctb",
    "ko-g2.ctb",
)
cached_table = cache(BrailleTable)


class TestText:
    """The lines' texts together are the text that was laid out."""

    @examples(150)
    @given(mixed_texts, st.sampled_from(MIXED_TABLES), st.integers(1, 40), st.booleans())
    def test_nothing_is_lost_or_doubled(self, text, table, width, keep_lines):
        layout = lay_out(text, cached_table(table), width, keep_lines=keep_lines)
        assert rebuilt(layout) == laid_out(layout)
        assert cuts_inside(layout) == 0

    def test_a_hyphen_at_the_end_of_a_line(self):
        layout = lay_out("Das ist die Tragödie. -- Und so", BrailleTable("de-g2.ctb"), 12)
        assert rebuilt(layout) == "Das ist die Tragödie. -- Und so"

    def test_a_slash_at_the_end_of_a_line(self, table):
        for width in range(3, 15):
            layout = lay_out("https://example.org/a/b/c", table, width)
            assert rebuilt(layout) == "https://example.org/a/b/c"

    def test_a_character_wider_than_a_line_is_on_the_first_of_its_lines(self, letters):
        layout = lay_out("a\u4e2db", letters, 2)
        assert [line.text for line in layout.lines()] == ["a", "\u4e2d", "", "b"]
        layout = lay_out("a\u4e2d\u4e2dbc", letters, 1)
        assert rebuilt(layout) == "a\u4e2d\u4e2dbc"
        assert [line.text for line in layout.lines()].count("") >= 2

    def test_a_blank_stands_at_the_end_of_the_line_that_it_ends(self, letters):
        layout = lay_out("un deux   trois", letters, 4)
        assert [line.text for line in layout.lines()] == ["un ", "deux ", "troi", "s"]
        layout = lay_out("  un\n    deux trois", letters, 8, keep_lines=True)
        assert [line.text for line in layout.lines()] == ["  un", "    deux ", "trois"]

    def test_of_a_long_paragraph_in_pieces(self, english, table, letters):
        text = " ".join(english.split() * 2)
        for chosen, width in ((table, 26), (letters, 7)):
            assert rebuilt(lay_out(text, chosen, width)) == text
        text = "\U0001f600/x" * 7_000
        assert rebuilt(lay_out(text, letters, 2)) == text


class TestLayout:
    def test_a_paragraph_is_indented_and_runs_over_to_the_margin(self, letters):
        layout = lay_out("un deux trois quatre\ncinq\n\nsix", letters, 12)
        assert brf(layout) == ["  UN DEUX", "TROIS QUATRE", "CINQ", "  SIX"]
        assert [line.text for line in layout.lines()] == [
            "un deux ",
            "trois quatre ",
            "cinq",
            "six",
        ]

    def test_lines_kept_begin_at_the_margin_and_run_over_indented(self, letters):
        text = "un deux\n  trois quatre\n\n\nsix"
        layout = lay_out(text, letters, 8, keep_lines=True)
        assert brf(layout) == ["UN DEUX", "  TROIS", "  QUATRE", "", "SIX"]

    def test_a_word_longer_than_the_line_is_cut_and_goes_on(self, letters):
        layout = lay_out("un anticonstitutionnellement mot", letters, 10)
        assert brf(layout) == ["  UN", "ANTICONSTI", "TUTIONNELL", "EMENT MOT"]

    def test_no_break_spaces_hold_words_together(self, letters):
        layout = lay_out("dit tout bas\xa0: oui", letters, 12)
        assert brf(layout) == ["  DIT TOUT", "BAS 3 OUI"]

    @pytest.mark.parametrize("width", [1, 2, 3, 4, 5])
    def test_narrow_lines(self, english, letters, width):
        layout = lay_out(english[:200], letters, width)
        assert all(len(line) <= width for line in layout.lines())
        assert {line.indent for line in layout.lines()} == ({0, 2} if width > 4 else {0})

    @pytest.mark.parametrize("width", [0, -1])
    def test_no_width(self, table, width):
        with pytest.raises(ValueError, match=f"width is {width} cells; it must be at least 1"):
            lay_out("a", table, width)

    @pytest.mark.no_cover
    @pytest.mark.parametrize("keep_lines", [False, True])
    @pytest.mark.parametrize(
        "width",
        # Lines of 28 cells are the twins of those of 26.
        [5, 26, pytest.param(28, marks=heavy)],
    )
    @pytest.mark.parametrize("file", ["english.txt", "francais.txt"])
    def test_the_lines_are_the_translation(self, texts, table, letters, file, width, keep_lines):
        text = (texts / file).read_text()
        layout = lay_out(text, table if file[0] == "e" else letters, width, keep_lines=keep_lines)
        shown = [line.cells for line in layout.lines()]
        book, translated, n = layout.book, [], 0
        while (found := book.block(n)) is not None:
            translated.append(found[1])
            n += 1
        for part in ("masks", "starts"):
            one, other = (
                np.concatenate([getattr(cells, part)[cells.masks > 0] for cells in run])
                for run in (shown, translated)
            )
            assert one.tolist() == other.tolist()
        assert max(len(line) for line in layout.lines()) <= width
        assert [line.number for line in layout.lines()] == list(range(1, layout.count() + 1))

    @pytest.mark.no_cover
    def test_in_any_order(self, english, table):
        text = english + " ".join(english.split() * 3) + "\n\n" + english
        one = lay_out(text, table)
        expected = [(line.masks.tobytes(), line.text) for line in one.lines()]
        assert one.count() == len(expected)
        other = lay_out(text, table)
        chance = random.Random(SEED)
        for n in chance.choices(range(1, len(expected) + 1), k=15):
            for layout in (one, other):
                line = layout.line(n)
                assert line is not None
                assert line.number == n
                assert (line.masks.tobytes(), line.text) == expected[n - 1]
        assert one.line(0) is None
        assert one.line(-3) is None
        assert one.line(len(expected) + 1) is None

    def test_a_range_of_lines(self, english, table):
        layout = lay_out(english, table)
        assert [line.number for line in layout.lines(3, 5)] == [3, 4, 5]
        assert [line.number for line in layout.lines(-1, 2)] == [1, 2]
        assert list(layout.lines(5, 4)) == []
        assert len(list(layout.lines(layout.count()))) == 1

    def test_only_what_is_looked_at_is_laid_out(self, english, table):
        class Counting(Book):
            asked = 0

            def block(self, number):
                self.asked = max(self.asked, number)
                return super().block(number)

        book = Counting(Document.from_text(english), table)
        assert Layout(book, 26).line(2) is not None
        assert book.asked <= 1

    def test_progress(self, english, table):
        layout = lay_out(english * 10, table)
        shares = [layout.progress(line) for line in layout.lines()]
        assert shares == sorted(shares)
        assert shares[0] == 0
        assert shares[-1] > 0.9


class TestLongParagraphs:
    """A paragraph that comes in pieces is laid out as if it had come whole."""

    @pytest.mark.no_cover
    @pytest.mark.parametrize("keep_lines", [False, True])
    @pytest.mark.parametrize("kind", ["words", "letters", "one letter", "no-break", "full lines"])
    def test_as_one(self, english, letters, kind, keep_lines):
        text = {
            "words": " ".join(english.split() * 3),
            "letters": "abcdefghijklmnopqrstuvwxyz" * 700,
            "one letter": "x" * 8_300,
            "no-break": "un\xa0deux trois\xa0 quatre " * 900,
            # Five words a line; the first piece ends with one.
            "full lines": "abcd " * 1_634 + "abc. " + "abcd " * 1_000,
        }[kind].strip()
        layout = lay_out(text, letters, keep_lines=keep_lines)
        block, cells = layout.book.block(0)
        whole = block.text
        n = 1
        while (found := layout.book.block(n)) is not None:
            whole, cells = whole + found[0].text, cells + found[1]
            n += 1
        assert n > 1
        solid = np.isin(cells.starts, whole.places[whole.codes == 0xA0])
        breaks = np.where(solid, 0xFF, cells.masks).astype(np.uint8).tobytes()
        indents = (0, 2) if keep_lines else (2, 0)
        bounds = wrap(breaks, 26, *indents)
        found = list(layout.lines())
        assert [line.indent for line in found] == [indent for _, _, indent in bounds]
        for line, (start, stop, _) in zip(found, bounds, strict=True):
            assert line.cells.starts.tolist() == cells.starts[start:stop].tolist()
            assert line.cells.masks.tolist() == cells.masks[start:stop].tolist()

    @pytest.mark.parametrize("blank", ["\u200b", "\u2800", "\u2800\u200b"])
    def test_of_nothing_but_blanks(self, letters, blank):
        layout = lay_out(f"un {blank * 30_000} deux", letters)
        assert " ".join(brf(layout)).split() == ["UN", "DEUX"]
        assert layout.count() <= 2
        assert lay_out(blank * 30_000, letters).count() <= 1
        ends = lay_out(f"un{blank * 30_000}", letters)
        assert brf(ends)[0].rstrip() == "  UN"
        assert ends.count() == 1
        begins = lay_out(f"{blank * 30_000}un", letters)
        assert [line.strip() for line in brf(begins)] == ["UN"]

    def test_little_memory(self, english, letters):
        text = " ".join(english.split() * 30)
        layout = lay_out(text, letters)
        tracemalloc.start()
        try:
            assert layout.line(5_500) is not None  # all that is remembered at once is
            before, _ = tracemalloc.get_traced_memory()
            assert layout.count() > 9_000
            after, _ = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
        assert after - before < 300_000
