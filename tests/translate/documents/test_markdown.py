"""Markdown by way of HTML: what it has beyond paragraphs."""

import hashlib
import io
import time
from pathlib import Path

import pytest

from tests.tiers import by_tier
from tests.translate.documents.epubs import blocks, texts
from vbraille.errors import InputError
from vbraille.translate.documents.markdown import read_markdown
from vbraille.translate.outline import outline

FILES = Path(__file__).parent / "files" / "small"


def read(text, encoding=None):
    content = text if isinstance(text, bytes) else text.encode()
    return read_markdown(io.BytesIO(content), "b.md", encoding)


def test_a_book():
    content = (FILES / "book.md").read_bytes()
    book = read(content)
    assert (book.title, book.language) == ("A small book", "en-GB")
    assert book.sha256() == hashlib.sha256(content).hexdigest()
    found = blocks(book)
    assert [(f"{b.kind.value}{b.level or ''}", str(b.text)) for b in found] == [
        ("heading1", "One"),
        ("paragraph", "Hello world,[1] go to the next."),
        ("item1", "1. first"),
        ("item1", "2. second"),
        ("item2", "• inner"),
        ("quote1", "quoted"),
        ("line", "code  here"),
        ("heading1", "Two"),
        ("row", "thing  weight"),
        ("row", "salt  2 g"),
        ("paragraph", "A cat"),
        ("paragraph", "Bonjour, H₂O."),
        ("note", "1. Not the other one."),
    ]
    marks = {(mark.kind.value, mark.target) for block in found for mark in block.marks}
    assert {("italic", ""), ("note", "#fn1"), ("link", "#two"), ("image", "")} <= marks
    assert ("language", "fr") in marks
    assert book.anchor("fn1") == int(found[-1].text.places[0])
    assert book.anchor("two") == int(found[7].text.places[0])
    assert found[9].headers == ("thing", "weight")


def test_definitions_formulas_and_html():
    book = read("term\n:   meaning $x^2$\n\n$$\ny = 1\n$$\n\n<div hidden>no</div>\n\nyes ~~so~~")
    assert texts(book) == ["term", "meaning x^2", "y = 1", "yes so"]


def test_a_picture_without_words_is_marked_and_one_with_words_says_them():
    book = read(
        "a ![](x.png) b\n\n![](y.png \"title\")\n\n![A *cat*](z.png)\n\n<img alt='' src=d.png>e"
    )
    assert texts(book) == ["a [picture] b", "title", "A cat", "e"]
    assert outline(read("![](x.png) ![](y.png)")).unshown == {"picture": 2}
    assert texts(read("![](plan.svg)")) == ["figure: plan"]


def test_encodings_and_nothing():
    assert texts(read(b"\xe9t\xe9", "latin-1")) == ["été"]
    assert texts(read("\ufeffété".encode("utf-16"))) == ["été"]
    for text in ("\n \n", "---\ntitle: x\n---\n", "<!-- x -->"):
        with pytest.raises(InputError, match=r"b\.md holds no text"):
            read(text)


def test_quotations_in_quotations():
    assert texts(read("> " * 90 + "end")) == ["end"]


@pytest.mark.parametrize("sign", ["> ", ">"])
def test_what_is_nested_too_deep_is_read_all_the_same(sign):
    text = f"before\n\n{sign * 150}deep *words*\n{sign * 140}and more\n\nafter\n"
    assert texts(read(text)) == ["before", "deep words and more", "after"]


def test_lists_that_are_nested_too_deep_lose_no_item():
    text = "".join(f"{'  ' * n}- item {n}.\n" for n in range(120)) + "\nafter\n"
    found = " ".join(texts(read(text)))
    assert all(f"item {n}." in found for n in range(120))
    assert found.endswith("after")


@pytest.mark.parametrize(
    "sign", [">", "^", "~a", "[", "*a ", "x`", "[a](", "![", "- ", "<b>", "$", "[^1]"]
)
def test_many_signs_end_in_time(sign):
    begun = time.process_time()
    assert texts(read(sign * by_tier(1_000, 4_000, 10_000) + "end"))[-1].endswith("end")
    assert time.process_time() - begun < 30
