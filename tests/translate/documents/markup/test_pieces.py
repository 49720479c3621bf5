"""Characters of markup piece by piece: what is before the first element, and entities."""

import io

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples
from vbraille.errors import InputError
from vbraille.translate.documents.markup.pieces import Pieces, without_entities


def resolved(*pieces):
    return "".join(without_entities(iter(pieces), "test"))


@pytest.mark.parametrize(
    ("markup", "expected"),
    [
        ("<p>&eacute;&amp;&lt;&#65;&none;& &</p>", "<p>&#233;&amp;&lt;&#65;&amp;none;& &</p>"),
        ("<?xml version='1.0'?>\n<!DOCTYPE p><p/>", "<p/>"),
        ("<!-- <p> --><?a b?><!DOCTYPE p [<!ENTITY a 'b>]'>]><p>&a;</p>", "<p>&#98;&#62;&#93;</p>"),
        ("<!DOCTYPE p PUBLIC 'a>' \"b\" [<!-- ]> --><!ENTITY a '&#x41;'>]><p>&a;", "<p>&#65;"),
        ("<p>&notin;&NotEqualTilde;", "<p>&#8713;&#8770;&#824;"),
    ],
)
def test_entities(markup, expected):
    assert resolved(markup) == expected


@examples(100)
@given(st.data())
def test_where_pieces_break_makes_no_difference(data):
    markup = "<?xml version='1.0'?><!DOCTYPE a [<!ENTITY b 'c'>]><p>x&b;y&eacute;&amp;z &q</p>"
    cuts = sorted(data.draw(st.lists(st.integers(0, len(markup)), max_size=6)))
    pieces = [markup[a:b] for a, b in zip([0, *cuts], [*cuts, len(markup)], strict=True)]
    assert resolved(*pieces) == "<p>x&#99;y&#233;&amp;z &q</p>"


@pytest.mark.parametrize("value", ["&b;&b;", "%b;", "x" * 300])
def test_entities_of_entities_are_refused(value):
    with pytest.raises(InputError, match="test defines entities by other entities"):
        resolved(f"<!DOCTYPE p [<!ENTITY b 'c'><!ENTITY a '{value}'>]><p>&a;</p>")


def test_a_document_that_never_begins():
    with pytest.raises(InputError, match="test declares too much"):
        resolved("<!DOCTYPE p [", *["<!ELEMENT a ANY>" * 10_000] * 10)


@pytest.mark.parametrize("size", [1, 3, 100_000, 131_071, 131_072, 300_000])
def test_pieces_are_the_text(size):
    text = "aé" * size
    assert "".join(Pieces(io.BytesIO(text.encode()))) == text
