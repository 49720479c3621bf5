"""Files of HTML as sources: encodings, parts, hostile files, files that show nothing."""

import hashlib
import io
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest

from tests.tiers import by_tier, heavy
from tests.translate.documents.epubs import blocks, texts
from vbraille.errors import InputError
from vbraille.translate.documents import html
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.source import BlockKind, MarkKind

FILES = Path(__file__).parent / "files" / "small"


def opened(content, encoding=None):
    return HtmlBook.open(io.BytesIO(content), "b.html", encoding)


def test_title_language_and_digest():
    content = b"<html lang=fr-CA><title> A\nbook </title><p>x<p lang=fr>y<p lang=en>z"
    book = opened(content)
    assert (book.title, book.language, book.in_cells) == ("A book", "fr-CA", False)
    assert [block.language for block in blocks(book)] == ["", "", "en"]
    assert book.sha256() == hashlib.sha256(content).hexdigest()


@pytest.mark.parametrize(
    ("content", "encoding"),
    [
        ("é".encode(), None),
        ("\ufeffé".encode("utf-16"), None),
        ("\ufeffé".encode("utf-16-be"), None),
        (b"<meta charset=iso-8859-1>\xe9\x96", None),
        (b"<meta http-equiv=Content-Type content='text/html; charset=windows-1252'>\xe9\x96", None),
        (b"<?xml version='1.0' encoding='iso-8859-1'?><p>\xe9\x96</p>", None),
        (b"\xef\xbb\xbf<meta charset=iso-8859-1>\xc3\xa9", None),
        (b"<meta charset=utf-8>\xe9\x96", "cp1252"),
        (b"<meta charset=utf-16>\xc3\xa9", None),
    ],
)
def test_encodings(content, encoding):
    assert texts(opened(content, encoding))[0].rstrip("–") == "é"


def test_bytes_that_are_not_of_the_encoding_are_told_once():
    book = opened(b"<meta charset=utf-8><p>\xc3\xa9 \xe9")
    assert texts(book) == ["é é"]
    assert book.note() == (
        "b.html is not utf-8 at byte 26; such bytes are read as windows-1252, "
        "‹encoding› NAME says otherwise"
    )
    assert book.note() is None


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "b.html is empty"),
        (b"<script>text()</script>", "no text that can be read"),
        (b"<!-- text", "no text that can be read"),
        (b"<p hidden>text", "no text that can be read"),
        (b"<title>text</title>", "no text that can be read"),
    ],
)
def test_a_file_that_shows_nothing_is_an_error(content, message):
    with pytest.raises(InputError, match=message):
        texts(opened(content))


def test_an_unknown_encoding():
    with pytest.raises(InputError, match="there is no text encoding 'klingon'"):
        opened(b"a", "klingon")


LONG = "".join(f"<h2 id=h{n}>T {n}</h2><p>{'word ' * 100}<ul><li>x{n}</ul>" for n in range(900))


def test_a_long_file_is_read_in_chapters_in_any_order():
    content = LONG.encode()
    first = opened(content)
    assert first.chapters > 3
    expected = texts(first)
    assert len(expected) == 2700
    book = opened(content)
    assert not book.complete
    for number in (2699, 0, 1350, 2, 1351):
        assert str(book.block(number).text) == expected[number]
    again = opened(content)
    again.adopt(first.index())
    assert again.complete
    assert str(again.block(1500).text) == expected[1500]
    assert again.anchor("h500") == int(book.block(1500).text.places[0])


def test_a_long_file_without_text_is_an_error():
    with pytest.raises(InputError, match="no text"):
        opened(b"<!--" + b"x" * 400_000 + b"-->")


@pytest.mark.parametrize("around", ["", "<div lang=en><section>", "<article><div><div>"])
@pytest.mark.parametrize("between", ["", "<hr>", "<a name=z></a>", "z<br>", "<p><a id=z></a></p>"])
def test_where_chapters_are_cut_makes_no_difference(around, between, monkeypatch):
    parts = [
        f"<h2 id=h{n}>T {n}</h2>{between}<p lang=fr>{'word ' * 30}<ol start=3><li>x{n}<li>y</ol>"
        "<div><p>a<table><tr><th>b<th>c<tr><td>d<td>e</table><b>f</div>"
        for n in range(40)
    ]
    content = (f"<html><title>t</title><body>{around}" + "".join(parts)).encode()
    whole = opened(content)
    assert whole.chapters == 1
    monkeypatch.setattr(html, "_CHAPTER_CHARACTERS", 200)
    cut = opened(content)
    assert cut.chapters > 10
    for one, other in zip(blocks(whole), blocks(cut), strict=True):
        assert str(one.text) == str(other.text)
        for what in ("kind", "level", "marks", "language", "anchors", "group", "headers"):
            assert getattr(one, what) == getattr(other, what)
        assert one.text.places.tolist() == other.text.places.tolist()


N = by_tier(20_000, 200_000, 1_000_000)
HOSTILE = {  # what makes each, and how many characters of text it has; 0 if it may be refused
    "nested": (lambda: b"<div>" * N + b"end", 0),
    "nested emphasis": (lambda: b"<b><i>" * (N // 2) + b"end", 0),
    "nested tables": (lambda: b"<table><tr><td>" * (N // 3) + b"end", 0),
    "nested lists": (lambda: b"<ol><li>" * (N // 3) + b"end", 0),
    "nested quotations": (lambda: b"<blockquote>x" * (N // 8) + b"end", 0),
    "nested languages": (lambda: b"<i lang=fr><a href=x>" * (N // 8) + b"end", 0),
    "nested drawings": (lambda: b"<svg><p>" * (N // 10) + b"end", 0),
    "nested and hidden": (lambda: b"end" + b"<p hidden><b>" * (N // 2), 0),
    "misnested": (lambda: b"<b><p>" * (N // 50) + b"end", 3),
    "misnested, quadratic": (lambda: b"<b>" * 3_000 + b"<i>" * 3_000 + b"x</b>" * 3_000, 0),
    "attributes": (lambda: b"<p " + b" ".join(b"a%d=1" % n for n in range(N * 3 // 10)) + b">x", 0),
    "names": (lambda: b"<a id=x>" * (N // 3) + b"end", 0),
    "cells": (lambda: b"<table><tr>" + b"<td>x" * (N // 10) + b"</table>end", 0),
    "a paragraph": (lambda: b"<p>" + b"words and " * (N * 5) + b"end", N * 50 + 3),
    "a word": (lambda: b"<p>" + b"x" * (N * 50) + b"end", N * 50 + 3),
    "marks in a word": (lambda: b"<p>" + b"<b>x</b>" * (N // 4) + b"end", N // 4 + 3),
    "lines": (lambda: b"<pre>" + b"abc\n" * (N // 8) + b"end", N // 8 * 3 + 3),
    "entities": (lambda: b"&amp;x" * (N // 2) + b"end", N // 2 * 2 + 3),
    "blanks": (lambda: b" \n" * (N * 10) + b"end", 3),
}


def read_hostile(case):
    """Read a hostile file, and tell its number of characters and its last text, or the refusal."""
    try:
        book = opened(HOSTILE[case][0]())
    except InputError as error:
        return 0, str(error)
    number = found = 0
    last = ""
    while (block := book.block(number)) is not None:
        last = str(block.text) or last
        found += len(block.text)
        number += 1
    return found, last


@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_files_give_all_their_text_or_none(case):
    found, last = read_hostile(case)
    if last.startswith("b.html has "):
        assert not HOSTILE[case][1]
        assert "which no book has; " in last
    else:
        assert found == HOSTILE[case][1] or not HOSTILE[case][1]
        assert last.endswith(("end", "x", "[drawing]"))


@heavy  # a process for each file, since memory once taken is not given back
@pytest.mark.parametrize("case", HOSTILE)
def test_hostile_files_take_little_memory(case):
    told = subprocess.run(
        [sys.executable, "-c", MEASURED.format(case)],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[3],
        env=os.environ,
    )
    assert int(told.stdout) < 150_000 + 2 * len(HOSTILE[case][0]()) // 1_000  # kB


# The kernel's own word: `ru_maxrss` would begin with what this process has.
MEASURED = """
from pathlib import Path
from tests.translate.documents.test_html import read_hostile
read_hostile({!r})
print(Path("/proc/self/status").read_text().partition("VmHWM:")[2].split()[0])
"""
SOUP = """<p>|</p>|<ul>|<ol start=-5>|<li value=99999999999>|</li>|<table>|<tr>|<td colspan=9999>
|<th rowspan=x>|</td>|</table>|<a href='#x'>|</a>|<svg>|<title>|</svg>|<math>|<mi>|</math>|<pre>|\n
|</pre>|<br>|<hr>|<b>|</b>|<h1>|</h1>|<div hidden>|</div>|<span epub:type=pagebreak title=1>|</span>
|<aside epub:type=footnote id=x>|</aside>|<a role=doc-backlink>|<i lang=fr>|</i>|<!--|-->|<![CDATA[
|]]>|<?|&|&#x;|&lt;|<|>|\0|\v| |x|y z|é|漢|\ufffe|<figure>|<img alt=x>|<figcaption>|</figure>|"|='
|<dl>|<dt>|<dd>|</dl>|<blockquote>|</blockquote>|<section class=footnotes>|<select>|<option>
|<noscript>|<script>|</script>|<ruby>|<rt>|<q>|</q>|<p id=a name=b>
|<template>|<caption>|<thead>
""".replace("\n|", "|").split("|")


@pytest.mark.parametrize("seed", range(by_tier(10, 100, 1000)))
def test_any_file_is_read_or_refused_in_a_sentence(seed):
    random = Random(seed)
    for _ in range(20):
        pieces = random.choices(SOUP, k=random.randrange(1, 60))
        content = bytearray("".join(pieces).encode())
        for _ in range(random.randrange(4)):
            content[random.randrange(len(content))] = random.randrange(256)
        with suppress(InputError):
            for block in blocks(opened(bytes(content))):
                first = int(block.text.places[0]) if len(block.text) else block.text.end - 1
                for mark in block.marks:
                    assert first <= mark.start < mark.end <= first + len(block.text)


@pytest.mark.parametrize("file", ["pandoc.html", "pandoc4.html"])
def test_a_page_by_pandoc(file):
    with (FILES / file).open("rb") as stream:
        book = HtmlBook.open(stream, file)
        found = blocks(book)
    assert (book.title, book.language) == ("A small book", "en-GB")
    assert [(b.kind.value, b.level, str(b.text)) for b in found] == [
        ("heading", 1, "A small book"),
        ("heading", 1, "One"),
        ("paragraph", 0, "Hello world,[1] go to the next."),
        ("item", 1, "1. first"),
        ("item", 1, "2. second"),
        ("item", 2, "• inner"),
        ("quote", 1, "quoted"),
        ("line", 0, "code  here"),
        ("heading", 1, "Two"),
        ("row", 0, "thing  weight"),
        ("row", 0, "salt  2 g"),
        ("paragraph", 0, "A cat"),
        ("paragraph", 0, "Bonjour, H₂O."),
        ("note", 0, "1. Not the other one."),
    ]
    targets = {mark.kind: mark.target[1:] for mark in found[2].marks if mark.target}
    assert book.anchor(targets[MarkKind.NOTE]) == int(found[-1].text.places[0])
    assert book.anchor(targets[MarkKind.LINK]) == int(found[8].text.places[0])
    assert found[10].headers == ("thing", "weight")
    assert found[-1].kind is BlockKind.NOTE
