import xml.etree.ElementTree as ET
from xml.sax.saxutils import escape

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.pictures.words import plain

ANY = st.text(st.characters(), max_size=20) | st.text("\0\t\r\n\x85\u2028\u202e\udc80\ufffe a<&")


@given(ANY)
def test_plain_text_is_one_line_that_pages_can_have(text):
    made = plain(text)
    assert ET.fromstring(f"<p>{escape(made)}</p>").text == (made or None)
    assert len(made.splitlines()) <= 1
    assert plain(made) == made


@pytest.mark.parametrize(
    ("text", "made"),
    [
        ("a\r\n\tb", "a b"),
        ("\0\x9b", "\\x00\\x9b"),
        ("\udc80\u202e", "\\udc80\\u202e"),
        ("\U0001ffff", "\\U0001ffff"),
        ("Zoë ⠵ 読む\u00a0x", "Zoë ⠵ 読む\u00a0x"),
    ],
)
def test_what_is_not_plain_is_spelled(text, made):
    assert plain(text) == made
