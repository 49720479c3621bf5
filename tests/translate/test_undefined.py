"""Characters that a table does not know: marked, named, numbered or dropped, in six dots."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples, heavy
from tests.translate.test_liblouis import sample_of_unicode
from vbraille.translate import BrailleTable, Cells, Document, Undefined, find_table, list_tables
from vbraille.translate.languages import table_note
from vbraille.translate.scripts import script_of
from vbraille.translate.substitutes import describe, likenesses

SIX_DOT_TABLES = ("en-ueb-g2.ctb", "fr-bfu-comp6.utb", "ru-litbrl.ctb", "ko-g2.ctb", "bh.tbl")


def translate(table: BrailleTable, text: str) -> Cells:
    block = Document.from_text(text).block(0)
    assert block is not None
    return table.translate(block.text)


class TestSpelling:
    @pytest.mark.parametrize(
        ("how", "instead"),
        [
            (Undefined.MARK, "hi [grinning face] there"),
            (Undefined.NAME, "hi [grinning face] there"),
            (Undefined.CODE, "hi [U+1F600] there"),
        ],
    )
    @pytest.mark.parametrize("name", ["en-ueb-g2.ctb", "fr-bfu-comp6.utb"])
    def test_it_is_written_by_the_tables_own_rules(self, name, how, instead):
        found = translate(BrailleTable(name, how), "hi \U0001f600 there")
        written = translate(BrailleTable(name), instead)
        assert found.to_brf() == written.to_brf()

    def test_dropped_it_leaves_nothing(self):
        dropped = translate(BrailleTable("en-ueb-g2.ctb", Undefined.DROP), "hi\U0001f600 there")
        assert dropped.to_brf() == translate(BrailleTable("en-ueb-g2.ctb"), "hi there").to_brf()

    def test_one_marker_stands_for_a_run(self):
        table = BrailleTable("en-ueb-g2.ctb")
        run = translate(table, "a \u0434\u0430\u4e2d b")
        assert run.to_brf() == translate(table, "a [?] b").to_brf()
        assert run.source(2) == (2, 5)

    @pytest.mark.parametrize("text", ["\U0001f44d", "\u2764\ufe0f", "\u2b50", "\u23f0"])
    def test_emoji_are_named_unless_something_else_is_wanted(self, text):
        usual = translate(BrailleTable("en-ueb-g2.ctb"), text).to_brf()
        assert usual == translate(BrailleTable("en-ueb-g2.ctb", Undefined.NAME), text).to_brf()
        assert usual != translate(BrailleTable("en-ueb-g2.ctb", Undefined.CODE), text).to_brf()

    def test_a_fraction_is_no_digit_of_the_number_before_it(self):
        table = BrailleTable("el.ctb")
        assert translate(table, "10\u2155").to_brf() == translate(table, "10 1/5").to_brf()
        assert translate(table, "a \u2155 b").to_brf() == translate(table, "a 1/5 b").to_brf()

    def test_what_has_no_name_is_numbered(self):
        table = BrailleTable("en-ueb-g2.ctb", Undefined.NAME)
        assert translate(table, "\ue000").to_brf() == translate(table, "[U+E000]").to_brf()

    def test_a_table_without_brackets_or_letters_crosses_out(self):
        for how in (Undefined.MARK, Undefined.NAME, Undefined.CODE):
            assert translate(BrailleTable("bh.tbl", how), "\U0001f600").to_brf() == "==="

    @pytest.mark.parametrize("how", Undefined)
    @pytest.mark.parametrize(
        "name",
        [SIX_DOT_TABLES[0], *(pytest.param(name, marks=heavy) for name in SIX_DOT_TABLES[1:])],
    )
    def test_six_dots_are_enough_for_every_kind_of_character(self, name, how):
        table = BrailleTable(name, how)
        for c in sample_of_unicode():
            if not c.isspace() and c not in "\xad\ufeff":
                translate(table, f"{c}a").to_brf()

    def test_the_dash_of_a_table_that_writes_it_in_eight_dots(self):
        table = BrailleTable("zh-tw.ctb")
        assert translate(table, "\u2014").to_brf() == translate(table, "--").to_brf()
        assert translate(table, "\u4e2d\u2014A").to_brf().strip()
        assert not table.undefined

    def test_likenesses(self):
        assert list(likenesses("\ufb01")) == ["fi"]
        assert list(likenesses("\u201c")) == ['"']
        assert list(likenesses("a")) == []

    @examples(60)
    @given(st.text(st.sampled_from("abc \U0001f600\u0434\u4e2d\x01,"), min_size=1, max_size=20))
    def test_maps_hold_in_every_manner(self, text):
        for how in Undefined:
            table = BrailleTable("en-ueb-g2.ctb", how)
            block = Document.from_text(text).block(0)
            if block is None:
                return
            cells = table.translate(block.text)
            assert set(cells.starts.tolist()) <= set(block.text.places.tolist())
            assert (cells.starts[1:] >= cells.starts[:-1]).all()
            assert cells.end == block.text.end


class TestEightDots:
    @pytest.mark.parametrize(
        ("name", "eight"),
        [
            ("en-ueb-g2.ctb", False),
            ("fr-bfu-comp8.utb", True),
            ("en-us-comp8-ext.utb", True),
            ("et-g0.utb", True),
            ("ja-kantenji.utb", True),
            ("zh-tw.ctb", False),
            ("mn-MN-g1.utb", False),  # its metadata say eight
            ("fa-ir-g1.utb", False),  # but for Latin letters
            ("bh.tbl", False),
        ],
    )
    def test_which_tables_have_them(self, name, eight):
        assert BrailleTable(name).eight_dots is eight


class TestForeign:
    @pytest.mark.parametrize(
        ("text", "noted"),
        [("ab\u0434\u0430", False), ("a\u0434\u0430", True), ("abc\u0434\u0430", False)],
    )
    def test_it_is_most_of_a_passage_and_not_the_half(self, text, noted):
        table = BrailleTable("en-ueb-g2.ctb")
        translate(table, text)
        assert (table_note(table) is not None) is noted

    @pytest.mark.parametrize(
        ("text", "script", "language"),
        [
            ("Привет, как дела?", "Cyrillic letters", "ru (Russian, "),
            ("שלום עולם", "Hebrew letters", "he (Hebrew, "),
            ("नमस्ते दुनिया", "Devanagari letters", "hi (Hindi, "),
            ("中文漢字", "Chinese characters", "cmn (Chinese, "),
            ("日本語のテキスト", "Japanese characters", "ja (Japanese, "),
            ("안녕 하세요", "Hangul", "ko (Korean, "),
        ],
    )
    def test_it_is_said_once_with_its_languages(self, text, script, language):
        table = BrailleTable("en-ueb-g2.ctb")
        translate(table, text)
        note = table_note(table)
        assert script in note
        assert "en-ueb-g2.ctb does not know" in note
        assert f"‹language› {language}" in note
        translate(table, text)
        assert table_note(table) is None

    def test_latin_in_a_table_of_another_script(self):
        table = BrailleTable("bh.tbl")
        translate(table, "English words")
        assert "‹language› en (English, en-ueb-g2.ctb)" in table_note(table)

    def test_a_script_without_a_table(self):
        table = BrailleTable("en-ueb-g2.ctb")
        translate(table, "สวัสดี")
        assert table_note(table).endswith("liblouis has no table for Thai letters")

    @pytest.mark.parametrize("text", ["a word in да Russian", "\U0001f600 \U0001f600", "1 + 1"])
    def test_nothing_is_said_of_a_few(self, text):
        table = BrailleTable("en-ueb-g2.ctb")
        translate(table, text)
        assert table_note(table) is None

    @pytest.mark.no_cover
    @pytest.mark.parametrize(
        "letter", ["ж", "λ", "א", "ع", "क", "ক", "ਕ", "ક", "ଓ", "க", "క", "ಕ", "ക", "ა", "ա", "한"]
    )
    def test_the_tables_that_are_named_write_the_script(self, letter):
        script = script_of(letter)
        there = {table.language for table in list_tables()}
        languages = [tag for tag in script.languages if tag in there]
        assert languages
        for language in languages:
            table = BrailleTable(find_table(language))
            translate(table, letter)
            assert not table.undefined, language


def test_describe():
    assert describe("\U0001f600") == "U+1F600 grinning face"
    assert describe("\x08") == "U+0008"
