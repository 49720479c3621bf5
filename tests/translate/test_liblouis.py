"""Tables: found by language, exact, nothing left out, and one thread at a time."""

import random
import subprocess
import sys
import unicodedata
from concurrent.futures import ThreadPoolExecutor
from functools import cache

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.conftest import SEED
from vbraille.errors import InputError
from vbraille.translate import BrailleTable, Cells, Document

TABLES = ("en-ueb-g2.ctb", "fr-bfu-comp6.utb", "de-g2.ctb")
# What Unicode calls ignorable: no text, but how other text is put.
IGNORABLE = {0x34F, 0x61C, 0xFEFF}.union(
    range(0x180B, 0x1810),
    range(0x200B, 0x2010),
    range(0x202A, 0x202F),
    range(0x2060, 0x2070),
    range(0xFE00, 0xFE10),
    range(0xE0000, 0xE0200),
)


@pytest.fixture(scope="module", params=TABLES)
def table(request) -> BrailleTable:
    return BrailleTable(request.param)


def translate(table: BrailleTable, text: str) -> Cells:
    paragraph = Document.from_text(text, keep_lines=True).paragraph(0)
    assert paragraph is not None
    return table.translate(paragraph)


@cache
def sample_of_unicode() -> list[str]:
    """Some characters of every category, and all of the first few blocks."""
    chance = random.Random(SEED)
    categories: dict[str, list[int]] = {}
    for code in range(0x110000):
        categories.setdefault(unicodedata.category(chr(code)), []).append(code)
    found = set(range(0x180)) | {0x2028, 0x2029, 0xFFFD, 0x1F600, 0x10FFFF, 0xD800, 0xDFFF}
    for codes in categories.values():
        found.update(chance.sample(codes, min(len(codes), 12)))
    return [chr(code) for code in sorted(found)]


likely = st.deferred(lambda: st.sampled_from([*sample_of_unicode(), *"abc ABC 123 .,'-"]))


class TestTable:
    @pytest.mark.parametrize("name", ["hyph_fr_FR.dic", "hyph_en_US.dic,hyph_da_DK.dic"])
    def test_hyphenation_is_no_braille(self, name):
        with pytest.raises(
            InputError, match="has no braille in it, as tables for hyphenation have"
        ):
            BrailleTable(name)
        assert BrailleTable(f"en-ueb-g2.ctb,{name}").name

    @pytest.mark.parametrize(
        "name",
        [
            "",
            " ",
            "\0",
            "nonsense",
            "en-ueb-g2.ct",
            "en-ueb-g2.ctb\0",
            "a,b",
            ",",
            ".",
            "/",
            "%s%n",
            "\udcff",
            "x" * 300,
            "x" * 5_000,
            "x" * 100_000,
            "," * 3_000,
            "d/" * 600 + "x",
        ],
    )
    def test_no_such_table(self, name, capfd):
        with pytest.raises(InputError, match="there is no braille table"):
            BrailleTable(name)
        assert capfd.readouterr() == ("", "")

    def test_the_nearest_are_named(self):
        with pytest.raises(InputError, match=r"the nearest are en-ueb-g2\.ctb, en-ueb-g1\.ctb"):
            BrailleTable("en-ueb-g2")

    def test_a_file_that_is_no_table(self, texts, capfd):
        with pytest.raises(InputError, match=r"liblouis cannot use .* as a braille table"):
            BrailleTable(str(texts / "english.txt"))
        assert capfd.readouterr() == ("", "")

    def test_a_table_of_the_users_own(self, tmp_path):
        path = tmp_path / "mine.utb"
        path.write_text("space \\s 0\nlowercase a 1\nlowercase b 1278\n")
        assert translate(BrailleTable(str(path)), "a b").to_dots() == "1 0 1-2-7-8"

    def test_metadata(self):
        info = BrailleTable("en-ueb-g2.ctb").info
        assert info is not None
        assert (info.language, info.grade, info.kind) == ("en", "2", "literary")

    def test_known_cells(self):
        assert translate(BrailleTable("en-ueb-g2.ctb"), "The child can.").to_brf() == ",! * C4"
        assert translate(BrailleTable("en-ueb-g1.ctb"), "child").to_brf() == "CHILD"
        assert translate(BrailleTable("fr-bfu-comp6.utb"), "été").to_dots() == (
            "1-2-3-4-5-6 2-3-4-5 1-2-3-4-5-6"
        )

    def test_dots_7_and_8_come_through(self):
        cells = translate(BrailleTable("fr-bfu-comp8.utb"), "Aé")
        assert cells.to_dots().split()[0] == "1-7"
        assert Cells.from_unicode(cells.to_unicode()).masks.tolist() == cells.masks.tolist()

    def test_nothing_gives_nothing(self, table):
        paragraph = Document.from_text("a\n\nb", keep_lines=True).paragraph(1)
        assert paragraph is not None
        cells = table.translate(paragraph)
        assert (len(cells), cells.end) == (0, 1)


class TestNothingLost:
    @pytest.mark.no_cover
    def test_every_kind_of_character_raises_dots(self, table):
        assert len({unicodedata.category(c) for c in sample_of_unicode()}) >= 29
        for c in sample_of_unicode():
            if c.isspace() or ord(c) in IGNORABLE or c in "\xad\u2800":
                continue
            alone = translate(table, c)
            assert alone.masks.any(), f"U+{ord(c):04X}"
            assert alone.source(0) == (0, 1)

    @pytest.mark.no_cover
    def test_nor_does_it_vanish_in_a_word(self, table):
        without = {translate(table, text).masks.tobytes() for text in ("ab", "a b")}
        for c in sample_of_unicode():
            if c.isspace() or ord(c) in IGNORABLE or c in "\xad\u2800":
                continue
            cells = translate(table, f"a{c}b")
            assert cells.masks.tobytes() not in without, f"U+{ord(c):04X}"
            low, high = cells.of_source(1)
            assert cells.masks[low:high].any()

    def test_what_is_no_text_leaves_no_trace(self, table):
        word = translate(table, "ab").masks.tobytes()
        for code in (0xFEFF, 0x200B, 0x2060, 0xFE0F, 0xE0061):
            assert translate(table, f"a{chr(code)}b").masks.tobytes() == word

    def test_every_space_is_a_blank(self, table):
        spaced = translate(table, "a b").masks.tobytes()
        for c in "\xa0\u2007\u202f\u2003\u3000\t\u1680":
            assert translate(table, f"a{c}b").masks.tobytes() == spaced

    def test_zero_does_not_cut_the_text(self, table):
        cells = translate(table, "go\0map\0\0sun")
        for character, letter in ((0, "G"), (3, "M"), (8, "S")):
            low, high = cells.of_source(character)
            assert cells[low:high].to_brf() == letter
        assert cells.masks.all()

    def test_ligatures_and_wide_letters_are_read_as_letters(self):
        table = BrailleTable("fr-bfu-comp6.utb")
        assert translate(table, "ﬁ").to_brf() == translate(table, "fi").to_brf()
        assert translate(table, "ｆ").to_brf() == translate(table, "f").to_brf()

    @settings(max_examples=100)
    @given(st.text(likely, min_size=1, max_size=20))
    def test_maps_hold_for_any_text(self, text):
        table = BrailleTable("en-ueb-g2.ctb")
        paragraph = Document.from_text(text).paragraph(0)
        if paragraph is None:
            return
        cells = table.translate(paragraph)
        places = set(paragraph.source.tolist())
        assert set(cells.starts.tolist()) <= places
        assert (cells.starts[1:] >= cells.starts[:-1]).all()
        assert cells.end == paragraph.end
        printed = any(
            not c.isspace() and ord(c) not in IGNORABLE and c != "\u2800" for c in paragraph.text
        )
        assert cells.masks.any() == printed

    def test_a_long_text_is_translated_whole(self, table):
        word = translate(table, "Wort").masks.tobytes()
        text = "Wort " * 1_600
        cells = translate(table, text)
        assert cells.masks.tobytes() == (word + b"\0") * 1_599 + word
        unknown = translate(table, "\U0001f600 " * 2_000)
        marked = set(unknown.starts[unknown.masks > 0].tolist())
        assert len(marked) >= 2_000


class TestThreads:
    def test_many_at_once_give_the_same_as_one(self, tmp_path):
        """Run apart: without the lock, the whole process would go down."""
        script = tmp_path / "threads.py"
        script.write_text(THREADS)
        done = subprocess.run(
            [sys.executable, str(script)], capture_output=True, text=True, timeout=60, check=False
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, "same\n", "")

    def test_one_table_in_many_threads(self, texts):
        table = BrailleTable("en-ueb-g2.ctb")
        lines = (texts / "english.txt").read_text().splitlines()
        lines = [f"{line} {c}" for line, c in zip(lines, sample_of_unicode(), strict=False) if line]
        expected = [translate(BrailleTable("en-ueb-g2.ctb"), line).to_unicode() for line in lines]
        with ThreadPoolExecutor(8) as pool:
            found = list(pool.map(lambda line: translate(table, line).to_unicode(), lines))
        assert found == expected


THREADS = f"""
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

from vbraille.translate import Document, BrailleTable

NAMES = {TABLES!r}
TEXT = "Words, numbers 123 and \\U0001f600 \\0 \\u0152uvre: " * 10
start = Barrier(8)

def work(n):
    start.wait()
    cells = []
    for m in range(6):
        table = BrailleTable(NAMES[(n + m) % 3])
        paragraph = Document.from_text(TEXT * (1 + m % 4)).paragraph(0)
        cells.append((table.name, m, table.translate(paragraph).to_unicode()))
    return cells

with ThreadPoolExecutor(8) as pool:
    found = list(pool.map(work, range(8)))
start = Barrier(1)
alone = list(map(work, range(8)))
print("same" if found == alone else "different")
"""
