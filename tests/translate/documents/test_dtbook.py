"""DTBook: its names for what HTML has by others."""

import io

from tests.translate.documents.epubs import blocks, epub, opened
from vbraille.translate.documents.html import HtmlBook

BOOK = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE dtbook PUBLIC "-//NISO//DTD dtbook 2005-3//EN"
 "http://www.daisy.org/z3986/2005/dtbook-2005-3.dtd" [<!ENTITY % MATHML "INCLUDE">]>
<dtbook xmlns="http://www.daisy.org/z3986/2005/dtbook/" version="2005-3" xml:lang="en">
<head><meta name="dc:Title" content="The book"/></head>
<book><frontmatter><doctitle>The book</doctitle><docauthor>A. Writer</docauthor></frontmatter>
<bodymatter><level1 id="l"><pagenum id="p1" page="normal">1</pagenum><h1>One</h1>
<p>So<noteref idref="#n1">*</noteref> it <em>is</em>, <sent xml:lang="fr">voil&agrave;</sent>.
<pagenum id="p2">2</pagenum> On.</p>
<level2><h2>Deeper</h2><list type="ol" enum="a" start="3"><li>x</li><li><lic>y</lic></li></list>
<list type="pl"><li>1. z</li></list></level2>
<note id="n1" class="footnote"><p>Really.</p></note>
<poem><linegroup><line>a line</line><line>another</line></linegroup></poem>
<imggroup><img src="x.jpg" alt="A cat"/><caption>A cat</caption>
<prodnote render="optional">A cat that sits.</prodnote></imggroup></level1>
<level><hd>Flat</hd><level><hd>Inner</hd><blockquote><p>q</p></blockquote></level></level>
<level1><h1>T</h1><table><tr><th>A</th><th>B</th></tr><tr><td>1</td><td>2</td></tr></table></level1>
</bodymatter></book></dtbook>"""
EXPECTED = [
    ("heading1", "The book"),
    ("paragraph", "A. Writer"),
    ("page", "1"),
    ("heading1", "One"),
    ("paragraph", "So* it is, voilà."),
    ("page", "2"),
    ("line", "On."),
    ("heading2", "Deeper"),
    ("item1", "c. x"),
    ("item1", "d. y"),
    ("item1", "1. z"),
    ("note", "Really."),
    ("line", "a line"),
    ("line", "another"),
    ("paragraph", "A cat"),
    ("paragraph", "A cat that sits."),
    ("heading1", "Flat"),
    ("heading2", "Inner"),
    ("quote1", "q"),
    ("heading1", "T"),
    ("row", "A  B"),
    ("row", "1  2"),
]


def opened_dtbook(text):
    return HtmlBook.open(io.BytesIO(text.encode()), "b.xml", is_dtbook=True)


def outline(source):
    return [(f"{b.kind.value}{b.level or ''}", str(b.text)) for b in blocks(source)]


def test_a_book():
    book = opened_dtbook(BOOK)
    assert (book.title, book.language) == ("The book", "en")
    assert outline(book) == EXPECTED
    found = blocks(book)
    note = next(mark.target for mark in found[4].marks if mark.kind.value == "note")
    assert book.anchor(note[1:]) == int(found[11].text.places[0])
    assert [mark.target for mark in found[4].marks if mark.kind.value == "language"] == ["fr"]
    assert found[5].anchors == ("p2",)
    assert found[-1].headers == ("A", "B")


def test_a_book_that_is_no_whole_xml():
    book = opened_dtbook(BOOK.replace("</bodymatter>", ""))
    assert outline(book) == EXPECTED


def test_a_chapter_of_an_epub():
    items = '<item id="i0" href="b.xml" media-type="application/x-dtbook+xml"/>'
    content = epub({"b.xml": BOOK}, items="", order=["b.xml"])
    book = opened(content)
    assert ("heading2", "Inner") not in outline(book)
    book = opened(
        epub({}, items=items, order=[], **{"OPS/b.xml": BOOK, "OPS/p.opf": _package(items)})
    )
    assert outline(book) == EXPECTED


def _package(items):
    return (
        '<package xmlns="http://www.idpf.org/2007/opf"><metadata/>'
        f'<manifest>{items}</manifest><spine><itemref idref="i0"/></spine></package>'
    )
