"""Tactile pictures in texts: which images they are, and the line that stands for each."""

import io

import pytest

from tests.translate.documents.epubs import blocks, epub, opened, texts
from vbraille.errors import InputError
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markdown import read_markdown
from vbraille.translate.source import BlockKind, MarkKind


def markdown(text):
    return read_markdown(io.BytesIO(text.encode()), "b.md")


def html(text):
    return HtmlBook.open(io.BytesIO(text.encode()), "b.html")


def figures(book):
    """Text and file of each figure."""
    return [
        (str(block.text), mark.target)
        for block in blocks(book)
        for mark in block.marks
        if mark.kind is MarkKind.IMAGE and mark.target
    ]


def test_it_is_a_line_of_its_own_by_its_title_or_its_text_or_its_name():
    book = markdown(
        'So ![Water cycle](water.scene "The  cycle") it is.\n\n![Map](maps/m%20n.svg)\n\n'
        "![](a%20b.scene)\n"
    )
    assert texts(book) == ["So", "figure: The cycle", "it is.", "figure: Map", "figure: a b"]
    assert blocks(book)[1].kind is BlockKind.LINE
    assert figures(book) == [
        ("figure: The cycle", "water.scene"),
        ("figure: Map", "maps/m%20n.svg"),
        ("figure: a b", "a%20b.scene"),
    ]


@pytest.mark.parametrize(
    "address",
    [
        "https://example.org/water.scene",
        "//example.org/water.svg",
        "file:///etc/water.scene",
        "/water.scene",
        "C:water.scene",
        "data:image/svg+xml,x.svg",
        "water.png",
        "scene",
    ],
)
def test_nothing_but_a_file_beside_the_text_is_one(address):
    book = html(f'<p>a <img src="{address}" alt="Water"> b</p>')
    assert texts(book) == ["a Water b"]
    assert figures(book) == []


def test_a_drawing_for_looks_is_none():
    book = html('<p>a <img src="rule.svg" alt=""> b</p><p><img src="map.SVG?1#x"></p>')
    assert texts(book) == ["a b", "figure: map"]
    assert figures(book) == [("figure: map", "map.SVG")]


def test_a_caption_that_says_the_same_is_not_said_again():
    inside = '<img src="w.svg" alt="Water"><figcaption>{}</figcaption>'
    assert texts(html(f"<figure>{inside.format('Water')}</figure><p>b</p>")) == [
        "figure: Water",
        "b",
    ]
    assert texts(html(f"<figure>{inside.format('Seen')}</figure>")) == ["figure: Water", "Seen"]


def test_in_a_list_and_in_a_table():
    book = markdown("- ![w](w.scene)\n- two\n\n|a|b|\n|-|-|\n|![t](t.scene)|d|\n")
    assert texts(book)[:2] == ["• figure: w", "• two"]
    assert "figure: t d" in [" ".join(text.split()) for text in texts(book)]
    assert [target for _, target in figures(book)] == ["w.scene", "t.scene"]


def test_in_an_epub_it_is_a_file_of_the_container():
    content = epub(
        {"text/one.xhtml": '<p>a</p><p><img src="../img/w%20x.svg" alt="Water"/></p>'},
        **{"OPS/img/w x.svg": "<svg/>"},
    )
    book = opened(content)
    assert figures(book) == [("figure: Water", "#OPS/img/w x.svg")]
    assert book.member("OPS/img/w x.svg") == b"<svg/>"
    with pytest.raises(InputError, match="lacks its part"):
        book.member("OPS/img/none.svg")
