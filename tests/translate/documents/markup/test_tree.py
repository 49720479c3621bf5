"""Markup before it is a tree: what is before the first element, and entities."""

import pytest

from vbraille.errors import InputError
from vbraille.translate.documents.markup.tree import read_tree, without_entities


def resolved(markup):
    return without_entities(markup, "test")


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


@pytest.mark.parametrize("value", ["&b;&b;", "%b;", "x" * 300])
def test_entities_of_entities_are_refused(value):
    with pytest.raises(InputError, match="test defines entities by other entities"):
        resolved(f"<!DOCTYPE p [<!ENTITY b 'c'><!ENTITY a '{value}'>]><p>&a;</p>")


def test_a_document_that_never_begins():
    with pytest.raises(InputError, match="test declares too much"):
        resolved("<!DOCTYPE p [" + "<!ELEMENT a ANY>" * 100_000 + "]><p>x</p>")


@pytest.mark.parametrize("xml", [False, True])
def test_more_elements_than_a_tree_should_have(xml):
    with pytest.raises(InputError, match="test has more markup than any book"):
        read_tree(b"<" * 5_000_001, "test", xml=xml)


@pytest.mark.parametrize(
    "markup",
    ["a</html>b<p>c", "<html><p>a</body>b</HTML ><html><p>c</html>", "a</body>b<body><p>c"],
)
def test_nothing_is_lost_after_the_end_of_a_page(markup):
    root, _ = read_tree(markup.encode(), "test", xml=False)
    assert "".join(root.itertext()) == "abc"
