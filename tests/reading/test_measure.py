"""One measure of places in a book, characters of its text, for every number that is told of one."""

import io
import re
import zipfile

import pytest

from tests.reading.test_reader import Bench
from tests.translate.documents.epubs import CONTAINER, opf, xhtml
from vbraille.reading.keptplace import place_in
from vbraille.reading.search.questions import FindShare
from vbraille.reading.search.seeker import steps
from vbraille.translate import Book, BrailleTable
from vbraille.translate.documents.epub import EpubBook
from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markdown import read_markdown
from vbraille.translate.outline import outline

TABLE = BrailleTable("en-ueb-g2.ctb")
BEFORE = [f"Some words of the first part, paragraph {n}." for n in range(30)]
AFTER = [f"Many more words of the second part, paragraph {n}." for n in range(200)]
SHARE = 100 * sum(len(p) + 1 for p in BEFORE) / sum(len(p) + 1 for p in [*BEFORE, "Two", *AFTER])


def html(paragraphs, padding=""):
    return "".join(f"<p {padding}>{paragraph}</p>" for paragraph in paragraphs)


def epub():
    """The first part is a small chapter of much markup, the second a large one of little."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w") as out:
        out.writestr("mimetype", "application/epub+zip")
        out.writestr("META-INF/container.xml", CONTAINER)
        out.writestr("OPS/p.opf", opf(["a.xhtml", "b.xhtml"]))
        out.writestr("OPS/a.xhtml", xhtml(html(BEFORE, f"class='{'x' * 900}'")))
        out.writestr("OPS/b.xhtml", xhtml(f"<h1>Two</h1>{html(AFTER)}"))
    return EpubBook(io.BytesIO(made.getvalue()), "b.epub")


def page():
    body = html(BEFORE) + "<h1>Two</h1>" + html(AFTER, f"class='{'x' * 9_000}'")
    return HtmlBook.open(io.BytesIO(body.encode()), "b.html")


def markdown():
    text = "\n\n".join([*BEFORE, "# Two", *AFTER])
    return read_markdown(io.BytesIO(text.encode()), "b.md")


@pytest.mark.parametrize("made", [epub, page, markdown])
def test_a_heading_is_at_the_same_percent_in_every_form_and_by_every_command(made):
    source = made()
    (heading,) = outline(source).headings
    assert heading.percent == pytest.approx(SHARE, abs=0.01)
    bench = Bench(book=Book(source, TABLE), width=26)
    bench.press("e")
    said = dict(sentence.split(": ") for sentence in bench.press("i"))
    assert said["heading"] == "Two"
    assert said["percent"] == f"{SHARE:.0f}"
    words = [len(p.split()) for p in (*BEFORE, "Two", *AFTER)]
    left = sum(words[len(BEFORE) :])
    assert abs(int(re.sub(r"\D", "", said["words left"])) - left) < 0.02 * sum(words)
    assert 100 * place_in(source, bench.reader.character).share == pytest.approx(SHARE, abs=0.01)


@pytest.mark.parametrize("percent", [1, 13, 50, 66, 80, 99])
def test_a_percentage_that_is_gone_to_is_the_one_that_is_told(percent):
    bench = Bench(book=Book(markdown(), TABLE), width=26)
    bench.press(f"g{percent}%\n")
    assert f"percent: {percent}" in bench.press("i")


def test_a_book_that_is_not_read_to_its_end_is_told_about():
    # More than is looked through for what is said of a place, however quick the machine.
    long = html(BEFORE * 400, f"class='{'x' * 2_000}'")
    source = HtmlBook.open(io.BytesIO(long.encode()), "b.html")
    assert not source.complete
    bench = Bench(book=Book(source, TABLE), width=26)
    assert "percent: 0" in bench.press("i")
    bench.press("nn")
    assert any(said.startswith("percent: about ") for said in bench.press("i"))
    assert place_in(source, bench.reader.character).about
    list(steps(source, FindShare(1.0)))
    assert not any("percent: about" in said for said in bench.press("i"))
