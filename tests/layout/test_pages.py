"""Pages: every word whole, nothing lost, and from a place to its character and back."""

import random
import tracemalloc
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.conftest import SEED
from tests.laid import cuts_inside, laid_out, rebuilt
from tests.tiers import examples, heavy
from vbraille.braille.geometry import PRESETS, STRESS2, VBD
from vbraille.layout.pages import Layout, Line, locate, place_of
from vbraille.layout.wrapping import wrap
from vbraille.translate import Book, BrailleTable, Cells, Document

# Few values, so that blanks and long words both come.
runs_of_cells = st.lists(st.tuples(st.integers(0, 5), st.integers(0, 12)), max_size=12).map(
    lambda runs: b"".join(b"\0" * blanks + b"\1" * word for blanks, word in runs)
)


@pytest.fixture(scope="module")
def english(texts) -> str:
    return (texts / "english.txt").read_text()


@pytest.fixture(scope="module")
def table() -> BrailleTable:
    return BrailleTable("en-ueb-g2.ctb")


@pytest.fixture(scope="module")
def letters() -> BrailleTable:
    return BrailleTable("fr-bfu-comp6.utb")


def lay_out(text: str, table: BrailleTable, width: int = 26, *, keep_lines: bool = False) -> Layout:
    return Layout(Book(Document.from_text(text, keep_lines=keep_lines), table), width)


def brf(layout: Layout) -> list[str]:
    return [line.printed.to_brf() for line in layout.lines()]


def wrapped(breaks: bytes, width: int, indent: int, runover: int) -> list[bytes]:
    """Lines as words that find room, one after the other; the twin of `wrap`."""
    lines: list[bytes] = []
    line, room = b"", width - indent
    at = 0
    while at < len(breaks):
        start = at + len(breaks[at:]) - len(breaks[at:].lstrip(b"\0"))
        gap = start - at
        word = breaks[start:].split(b"\0", 1)[0]
        at = start + len(word)
        if not word:
            break
        if not lines and not line:
            line = b"\0" * max(0, min(gap, width // 2, room - len(word)))
            fits = True
        else:
            fits = len(line) + gap + len(word) <= room
            if fits:
                line += b"\0" * gap
        if not fits:
            lines.append(line)
            line, room = b"", width - runover
        while len(line) + len(word) > room:
            lines.append(word[:room])
            word, room = word[room:], width - runover
        line += word
    return [*lines, line] if line else lines or [b""]


class TestWrap:
    @pytest.mark.parametrize(
        ("text", "width", "lines"),
        [
            ("", 5, [""]),
            ("   ", 5, [""]),
            ("one two", 7, ["one two"]),
            ("one two", 6, ["one", "two"]),
            ("one  two", 7, ["one", "two"]),
            ("one two ", 7, ["one two"]),
            ("a seven-and-more b", 6, ["a", "seven-", "and-mo", "re b"]),
            ("  one", 6, ["  one"]),
            ("      one", 6, ["   one"]),
            ("    words", 6, [" words"]),
            ("   all-of-it", 6, ["all-of", "-it"]),
        ],
    )
    def test_words(self, text, width, lines):
        breaks = text.replace(" ", "\0").encode()
        found = [text[start:stop] for start, stop, _ in wrap(breaks, width)]
        assert [line.rstrip() for line in found] == lines

    def test_indents(self):
        assert wrap(b"aa\0bb\0cc\0dd", 6, 2, 1) == [(0, 2, 2), (3, 8, 1), (9, 11, 1)]
        assert wrap(b"aa\0bb\0cc", 6, 0, 4) == [(0, 5, 0), (6, 8, 4)]

    @examples(150)
    @given(runs_of_cells | st.binary(max_size=60), st.integers(1, 14), st.data())
    def test_laws(self, breaks, width, data):
        indent = data.draw(st.integers(0, width - 1))
        runover = data.draw(st.integers(0, width - 1))
        bounds = wrap(breaks, width, indent, runover)
        cells = [breaks[start:stop] for start, stop, _ in bounds]
        # Nothing is lost, in order; what is left out is blank.
        assert b"".join(cells).replace(b"\0", b"") == breaks.replace(b"\0", b"")
        # No line is too long, and each has its indent.
        assert [i for _, _, i in bounds[1:]] == [runover] * (len(bounds) - 1)
        assert bounds[0][2] in (indent, 0)
        assert all(i + stop - start <= width for start, stop, i in bounds)
        # Every line but the first begins with a word, and ends with one.
        assert all(line[:1] != b"\0" for line in cells[1:])
        assert all(line[-1:] != b"\0" for line in cells[:-1])
        for (start, stop, i), (following, _, _) in pairwise(bounds):
            word = breaks[following:].split(b"\0", 1)[0]
            if following == stop:  # a word is cut only where it fills a line, from its beginning
                assert stop - start == width - i
                assert b"\0" not in breaks[start:stop].lstrip(b"\0")
                assert len(breaks[start:].lstrip(b"\0").split(b"\0", 1)[0]) > width - i
            else:  # greedy: the next word would not have found room
                assert not breaks[stop:following].strip(b"\0")
                assert following + len(word) - start > width - i

    @examples(150)
    @given(runs_of_cells, st.integers(1, 14), st.data())
    def test_as_its_twin(self, breaks, width, data):
        indent = data.draw(st.integers(0, width - 1))
        runover = data.draw(st.integers(0, width - 1))
        found = [breaks[start:stop] for start, stop, _ in wrap(breaks, width, indent, runover)]
        found[-1] = found[-1].rstrip(b"\0")
        assert found == wrapped(breaks, width, indent, runover)


class TestWholeSymbols:
    """Lines end where a character of the source ends."""

    @pytest.mark.parametrize(
        ("starts", "width", "lines"),
        [
            ("aabbccdd", 5, ["aabb", "ccdd"]),
            ("abbb", 3, ["a", "bbb"]),
            ("abbbbb", 3, ["a", "bbb", "bb"]),
            ("aaaaab", 3, ["aaa", "aab"]),
            ("a b b c", 4, ["a", "b b", "c"]),
            ("aa c c dd", 4, ["aa", "c c", "dd"]),
            ("a b bbb b", 3, ["a", "b b", "bb", "b"]),
        ],
    )
    def test_cells_of_one_character_stay_together(self, starts, width, lines):
        breaks = starts.replace(" ", "\0").encode()
        # A blank between two cells of one character is a part of it.
        owners = [ord(c) for c in starts]
        for n in range(1, len(starts) - 1):
            if (starts[n] == " " and starts[n - 1] == starts[n + 1]) or starts[n] == " ":
                owners[n] = owners[n - 1]
        found = [starts[start:stop] for start, stop, _ in wrap(breaks, width, starts=owners)]
        assert found == lines

    def test_a_symbol_takes_the_indent_if_it_needs_it(self):
        assert wrap(b"\1\1\1\1\1\0\1", 5, 2, 0, list(b"aaaaabc")) == [(0, 5, 0), (6, 7, 0)]
        assert wrap(b"\1\1\1\1\1\1", 5, 2, 0, list(b"aaaabb")) == [(0, 4, 1), (4, 6, 0)]

    def test_a_symbol_of_two_cells_goes_to_the_next_line(self, table):
        # The slash of UEB is two cells; so is a capital with its sign.
        assert brf(lay_out("abcdefgh/klm", table, 9)) == ["  ABCDEF<", "_/KLM"]
        assert brf(lay_out("abcdefg/klm", table, 10)) == ["  ABCDEFG", "_/KLM"]
        assert brf(lay_out("xxxxxxX", table, 9)) == ["  XXXXXX", ",X"]
        assert [line.text for line in lay_out("xxxxxxX", table, 9).lines()] == ["xxxxxx", "X"]

    @pytest.mark.parametrize(("language", "table"), [("cmn", "zh-tw.ctb"), ("ko", "ko-g2.ctb")])
    def test_real_text_in_syllables_of_several_cells(self, texts, language, table):
        text = (texts / "declaration" / f"{language}.txt").read_text().replace(" ", "")
        layout = lay_out(text, BrailleTable(table))
        assert layout.count() > 20
        assert cuts_inside(layout) == 0


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
# None of German: liblouis 3.24 never returns from some lines of dashes and addresses with those.
MIXED_TABLES = ("en-ueb-g2.ctb", "fr-bfu-comp6.utb", "ru-litbrl.ctb", "zh-tw.ctb", "ko-g2.ctb")
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
        layout = lay_out("a\U0001f600b", letters, 2)
        assert [line.text for line in layout.lines()] == ["a", "\U0001f600", "", "b"]
        layout = lay_out("a\U0001f600\U0001f600bc", letters, 1)
        assert rebuilt(layout) == "a\U0001f600\U0001f600bc"
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
