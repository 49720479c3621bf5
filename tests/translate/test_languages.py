"""Tables of languages, as the page of them says."""

import re
from pathlib import Path

import pytest

from vbraille.errors import InputError
from vbraille.translate import BrailleTable, find_table, list_tables, table_of

PAGE = Path(__file__).parents[2] / "docs" / "languages.md"
ROWS = re.findall(r"^\| ([\w-]+) \| `(.+?)` \| .* \| (\d) \|$", PAGE.read_text(), re.MULTILINE)


def test_the_page_has_each_language_of_liblouis_with_the_table_it_takes():
    assert {tag for tag, _, _ in ROWS} == {
        t.language for t in list_tables() if "-" not in t.language
    } - {""} | {tag for tag, _, _ in ROWS if "-" in tag}
    assert [(tag, find_table(tag)) for tag, _, _ in ROWS] == [(tag, name) for tag, name, _ in ROWS]


def test_the_page_says_which_have_no_six_dots():
    eight = {tag for tag, name, dots in ROWS if dots == "8"}
    assert eight == {tag for tag, name, _ in ROWS if BrailleTable(name).eight_dots}


@pytest.mark.parametrize(
    ("language", "grade", "table"),
    [
        ("en", 1, "en-ueb-g1.ctb"),
        ("en_GB", None, "en-ueb-g2.ctb"),
        ("de", 0, "de-g0.utb"),
        ("fr-CA", 2, "fr-bfu-g2.ctb"),
        ("ger", None, "de-g2.ctb"),
        ("nb", None, "no-no-g0.utb"),
        ("zh-TW", None, "zh-tw.ctb"),
        ("iw", None, "he-IL.utb"),
    ],
)
def test_a_tag_and_a_grade_lead_to_a_table(language, grade, table):
    assert find_table(language, grade) == table


def test_what_is_not_there_names_what_is():
    with pytest.raises(InputError, match="no grade 2 for language 'it'; there is"):
        find_table("it", 2)
    with pytest.raises(InputError, match="no braille table for language 'tlh'"):
        find_table("tlh")
    assert table_of("tlh") is table_of("") is table_of("it", 2) is None
