"""Search: one regular expression over the text."""

import unicodedata

from hypothesis import given
from hypothesis import strategies as st

from tests.reading.bench import Reading
from vbraille.reading.searching import hits, pattern_for

LETTERS = st.text("abcéÉàœ'’-–  .xX", min_size=1, max_size=6).filter(str.strip)


@given(LETTERS, st.text("abcéÉàœ'’-–  .xX\n", max_size=40), st.text("ab ", max_size=40))
def test_a_text_is_found_whatever_its_case_accents_quotes_and_blanks(wanted, before, after):
    there = unicodedata.normalize("NFD", wanted.upper()).replace("'", "’").replace(" ", " \n")
    if there.lower().casefold() != there.casefold():
        return
    pattern = pattern_for(wanted)
    text = f"{before}|{there.strip()}|{after}"
    assert hits(pattern, text, 0, len(text))[0] <= len(before) + 1


def test_each_hit_in_a_line_is_told_from_the_others():
    with Reading("hen and hen and hen again.\n\nA hen.", hand="sweep:1") as reading:
        reading.press("/")
        assert reading.type("hen") == ["'hen': cell 3, 1 of 3 in this line, line 1"]
        assert "2 of 3" in reading.press(".")[0]
        assert "3 of 3" in reading.press(".")[0]
        assert "line 3" in reading.press(".")[0]
        assert reading.press(".") == ["'hen': not found after here"]
        reading.press("\\")
        assert "3 of 3" in reading.type("")[0]
        assert reading.press("b", "b")[-1].startswith("back")


def test_a_search_is_given_up_by_escape_and_needs_a_text():
    with Reading("one", hand="sweep:1") as reading:
        assert reading.press(".") == ["no search is running; press slash to search"]
        assert reading.press("/", "o", "escape") == ["search for", "cancelled"]
        reading.press("/")
        assert reading.type("") == ["cancelled"]
        reading.press("/", "x")
        assert reading.press("pins:LNDN", "button:1") == ["finish typing first"] * 2


def test_a_hit_far_ahead_is_said_at_once_and_has_its_number_once_lines_are_counted():
    text = "\n\n".join(f"paragraph {n}" for n in range(400))
    with Reading(f"{text} needle", hand="sweep:1") as reading:
        reading.press("/")
        assert reading.type("needle")[0].endswith("at 100 percent")
        reading.until(lambda: reading.press("i")[0].startswith("line 400"))
