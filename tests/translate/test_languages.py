"""Which table a language takes, and the page that says so."""

from pathlib import Path

import pytest

from vbraille.errors import InputError
from vbraille.translate import BrailleTable, find_table, list_tables, six_dot_table, tables_of

DOCUMENT = Path("docs/languages.md").read_text(encoding="utf-8")
LANGUAGES = sorted({table.language for table in list_tables() if table.language})
# liblouis 3.24 has nothing else for these.
EIGHT_DOTS = {"bo", "cop", "et", "gd", "hy", "ja", "mt", "ro"}


@pytest.mark.parametrize(
    ("language", "grade", "name"),
    [
        ("en", None, "en-ueb-g2.ctb"),
        ("en", 0, "en-ueb-g1.ctb"),
        ("en", 1, "en-ueb-g1.ctb"),
        ("EN", 2, "en-ueb-g2.ctb"),
        ("en-GB", None, "en-ueb-g2.ctb"),
        ("fr", None, "fr-bfu-comp6.utb"),
        ("fr", 0, "fr-bfu-comp6.utb"),
        ("fr", 2, "fr-bfu-g2.ctb"),
        ("fr-FR", None, "fr-bfu-comp6.utb"),
        ("fr_CA", None, "fr-bfu-comp6.utb"),
        ("de", None, "de-g2.ctb"),
        ("de", 0, "de-g0.utb"),
        ("de", 1, "de-g1.ctb"),
        ("it", 1, "it.tbl"),
        ("es", None, "es.tbl"),
        ("pt-BR", None, "pt-pt-g1.utb"),
        ("hu", None, "hu.tbl"),
        ("ar", None, "ar.tbl"),
        ("tr", None, "tr-g1.ctb"),
        ("tr", 2, "tr-g2.ctb"),
        ("ko", None, "ko-g2.ctb"),
        ("da", None, "da-dk-g26.ctb"),
        ("da", 1, "da-dk-g16.ctb"),
        ("mn", None, "mn-MN-g1.utb"),
        ("nb", None, "no-no-g0.utb"),
        ("nn-NO", None, "no-no-g0.utb"),
        ("no", 3, "no-no-g3.ctb"),
        ("iw", None, "he-IL.utb"),
        ("zh", None, "zhcn-cbs.ctb"),
        ("zh-CN", None, "zhcn-cbs.ctb"),
        ("zh_Hans_CN", None, "zhcn-cbs.ctb"),
        ("zh-TW", None, "zh-tw.ctb"),
        ("zh-HK", None, "zh_HK.tbl"),
        ("eo", None, "eo.tbl"),
        ("sw", None, "sw-ke-g1.utb"),
    ],
)
def test_what_readers_expect(language, grade, name):
    assert find_table(language, grade) == name


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_has_a_table_of_six_dots_unless_there_is_none(language):
    name = find_table(language)
    assert BrailleTable(name).eight_dots == (language in EIGHT_DOTS)
    assert (six_dot_table(language) is None) == (language in EIGHT_DOTS)
    info = BrailleTable(name).info
    # One has no metadata, and of the Dravidian languages together there is nothing else.
    if info is not None and language not in EIGHT_DOTS | {"dra"}:
        assert info.kind != "computer"


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_document_names_it(language):
    titles = {table.name: table.title for table in list_tables()}
    name = find_table(language)
    dots = "8" if BrailleTable(name).eight_dots else "6"
    assert f"| {language} | `{name}` | {titles.get(name, '')} | {dots} |" in DOCUMENT


@pytest.mark.parametrize(
    ("language", "grade", "sentence"),
    [
        ("tlh", None, r"there is no table for language 'tlh' .vbraille tables lists all"),
        ("", None, "the language is empty; give a tag such as fr, or leave ‹language› out"),
        ("en", 7, r"there is no grade 7 for language 'en'; there is 1, 2 \(vbraille tables"),
        ("it", 2, "there is no grade 2 for language 'it'; there is 1 "),
        ("ms", 1, "there is no grade 1 for language 'ms'; there is 2 "),
    ],
)
def test_what_there_is_not(language, grade, sentence):
    with pytest.raises(InputError, match=f"^{sentence}"):
        find_table(language, grade)


def test_what_a_sentence_offers_can_be_had():
    for language in LANGUAGES:
        for grade in range(4):
            try:
                BrailleTable(find_table(language, grade))
            except InputError as refused:
                there = str(refused).partition("there is ")[2].partition("there is ")[2]
                for other in there.partition(" (")[0].split(", "):
                    BrailleTable(find_table(language, int(other)))


def test_tables_of_a_language_are_found_by_any_spelling_of_it():
    french = tables_of("fr")
    assert french[0] == "fr"
    assert len(french[1]) >= 3
    assert tables_of("FR") == tables_of("fr_FR") == tables_of("fr-CA") == french
    assert {table.language for table in tables_of("zh")[1]} == {"cmn", "cmn-Hans"}
