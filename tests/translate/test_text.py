"""Text: runs of characters that keep their places when they are joined and cut."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vbraille.translate import Document, Text
from vbraille.translate.source import to_codes, to_text


def texts_of(string: str) -> list[Text]:
    document = Document.from_text(string)
    return [document.block(number).text for number in range(len(string.split("\n\n")))]


def test_joined_and_cut():
    one, two = texts_of("One two.\n\nThree.")
    both = one + two
    assert str(both) == "One two.Three."
    assert len(both) == 14
    assert both.places.tolist() == [*range(8), *range(10, 16)]
    assert both.end == two.end
    assert both.alphabet >= set(both.codes.tolist())
    assert [both.index(place) for place in (0, 7, 8, 10, 15, 16)] == [0, 7, 8, 8, 13, 14]
    rest = both.since(11)
    assert (str(rest), rest.places[0], rest.end) == ("hree.", 11, 16)
    assert str(both.since(16)) == ""


def test_a_part_keeps_nothing_of_the_whole():
    (whole,) = texts_of("a" * 5_000)
    rest = whole.since(4_990)
    assert rest.codes.base is None
    assert rest.places.base is None


def test_no_text_is_a_place_all_the_same():
    nothing = Text.empty(7)
    assert (len(nothing), str(nothing), nothing.end) == (0, "", 7)
    assert str(nothing + texts_of("a")[0]) == "a"


@given(st.text(st.characters(exclude_categories=()), max_size=30))
def test_codes_and_back(text):
    codes = to_codes(text)
    assert codes.dtype == np.uint32
    assert codes.tolist() == list(map(ord, text))
    assert to_text(codes) == text
