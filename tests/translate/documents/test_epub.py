"""EPUB and eBraille: order, links, what is missing, locked, broken or hostile."""

import hashlib
import io
import re
import struct
import zipfile
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tiers import examples, heavy
from tests.translate.documents.epubs import (
    CONTAINER,
    blocks,
    epub,
    opened,
    opf,
    packed,
    texts,
    xhtml,
)
from vbraille.errors import InputError
from vbraille.translate.documents.epub import EpubBook
from vbraille.translate.source import BlockKind, MarkKind

FILES = Path(__file__).parent / "files" / "small"
TWO = {
    "one.xhtml": '<h1 id="h">One</h1><p>See <a href="t%20wo.xhtml#x">there</a>.</p>',
    "t wo.xhtml": '<h1>Two</h1><p id="x">here&nbsp;it is, <a href="one.xhtml">back</a></p>',
}


def test_chapters_in_the_order_of_the_spine():
    book = opened(epub(TWO, order=["-one.xhtml", "t wo.xhtml"]))
    assert (book.title, book.language, book.in_cells) == ("A book", "en", False)
    assert texts(book) == ["Two", "here\u00a0it is, back", "One", "See there."]


def test_links_lead_from_chapter_to_chapter():
    content = epub(TWO)
    book = opened(content)
    (link,) = book.block(1).marks
    assert (link.kind, link.target) == (MarkKind.LINK, "#OPS/t wo.xhtml#x")
    assert book.anchor("OPS/t wo.xhtml#x") == int(book.block(3).text.places[0])
    (back,) = book.block(3).marks
    assert back.target == "#OPS/one.xhtml"
    assert book.anchor("OPS/one.xhtml") == 0
    assert book.anchor("OPS/t wo.xhtml#gone") == int(book.block(2).text.places[0])
    assert book.anchor("OPS/three.xhtml") is None
    assert book.sha256() == hashlib.sha256(content).hexdigest()


def test_only_the_chapters_read_are_parsed():
    names = [f"c{n}.xhtml" for n in range(30)]
    content = epub({name: f"<p>text of {name}" + "</p>" for name in names})
    first = opened(content)
    blocks(first)
    book = opened(content)
    book.adopt(first.index())
    read = []
    book._read_part = lambda part: read.append(part.member) or EpubBook._read_part(book, part)
    assert str(book.block(21).text) == "text of c21.xhtml"
    assert read == ["OPS/c21.xhtml"]


PAGED = {
    "one.xhtml": "<p>first <span id='p2'></span>and second</p><p id='p3'>third</p>",
    "two.xhtml": "<p>fourth</p><span epub:type='pagebreak' id='p5' title='5'/><p>fifth</p>"
    "<span epub:type='pagebreak' id='p6'/><p>sixth</p>",
}
PAGES = {
    "one.xhtml": "1",
    "one.xhtml#p2": "2",
    "one.xhtml#p3": "iii",
    "two.xhtml": "4",
    "two.xhtml#p5": "5",
    "two.xhtml#p6": "6",
    "gone.xhtml#p7": "7",
}


@pytest.mark.parametrize("form", ["nav", "ncx"])
def test_a_list_of_pages_says_where_they_begin(form):
    if form == "nav":
        items = "".join(f'<li><a href="{at}">{number}</a></li>' for at, number in PAGES.items())
        listed = xhtml(f'<nav epub:type="page-list"><ol>{items}</ol></nav>')
        item = '<item id="n" href="n" media-type="application/xhtml+xml" properties="nav"/>'
    else:
        items = "".join(
            f'<pageTarget><navLabel><text>{number}</text></navLabel><content src="{at}"/>'
            f"</pageTarget>"
            for at, number in PAGES.items()
        )
        listed = (
            f'<ncx xmlns="http://www.daisy.org/z3986/2005/ncx/"><pageList>{items}</pageList></ncx>'
        )
        item = '<item id="n" href="n" media-type="application/x-dtbncx+xml"/>'
    book = opened(epub(PAGED, items=item, **{"OPS/n": listed}))
    found = [(block.kind is BlockKind.PAGE, str(block.text)) for block in blocks(book)]
    pages = [text for is_page, text in found if is_page]
    assert pages == ["1", "2", "iii", "4", "5", "6"]
    assert found[0] == (True, "1")
    assert found[found.index((True, "iii")) + 1] == (False, "third")
    assert found[found.index((True, "4")) + 1] == (False, "fourth")
    assert found[found.index((True, "6")) + 1] == (False, "sixth")
    whole = " ".join(text for is_page, text in found if not is_page)
    assert whole == "first and second third fourth fifth sixth"


def test_contents_of_a_navigation_document_and_of_an_ncx():
    nav = xhtml(
        '<nav epub:type="toc"><ol><li><a href="one.xhtml#h">One</a><ol><li><a href="t%20wo.xhtml">'
        '<i>Tw</i>o</a></li></ol></li></ol></nav><nav epub:type="page-list"><ol/></nav>'
    )
    item = '<item id="n" href="n" media-type="{}" properties="{}"/>'
    expected = ((1, "One", "#OPS/one.xhtml#h"), (2, "Two", "#OPS/t wo.xhtml"))
    of_nav = epub(TWO, items=item.format("application/xhtml+xml", "nav"), **{"OPS/n": nav})
    assert opened(of_nav).outline() == expected
    point = '<navPoint><navLabel><text>{}</text></navLabel><content src="{}"/>{}</navPoint>'
    inner = point.format("Two", "t%20wo.xhtml", "")
    ncx = '<ncx xmlns="http://www.daisy.org/z3986/2005/ncx/"><navMap>{}</navMap></ncx>'
    ncx = ncx.format(point.format("One", "one.xhtml#h", inner))
    of_ncx = epub(TWO, items=item.format("application/x-dtbncx+xml", ""), **{"OPS/n": ncx})
    assert opened(of_ncx).outline() == expected
    assert opened(epub(TWO)).outline() == ()


def test_what_cannot_be_shown_is_told_in_its_place():
    extra = '<item id="i0" href="a.pdf" media-type="application/pdf"/>'
    book = opened(
        packed(
            {
                "META-INF/container.xml": CONTAINER,
                "OPS/p.opf": opf(["x.xhtml", "gone.xhtml", "y.xhtml"]).replace(
                    '<item id="i0" href="x.xhtml" media-type="application/xhtml+xml"/>', extra
                ),
                "OPS/a.pdf": b"%PDF",
                "OPS/y.xhtml": xhtml("<p>y</p>"),
            }
        )
    )
    assert texts(book) == ["[page: application/pdf]", "[missing chapter: OPS/gone.xhtml]", "y"]
    assert [mark.kind for mark in book.block(0).marks] == [MarkKind.UNSHOWN]


def test_a_fallback_that_goes_round_in_a_circle():
    item = '<item id="i{}" href="{}" media-type="{}" fallback="i{}"/>'
    package = opf([]).replace("<manifest>", "<manifest>" + item.format(0, "a", "x/y", 1))
    package = package.replace("</manifest>", item.format(1, "b", "x/z", 0) + "</manifest>")
    package = package.replace("<spine>", '<spine><itemref idref="i0"/>')
    book = opened(packed({"META-INF/container.xml": CONTAINER, "OPS/p.opf": package, "OPS/a": "b"}))
    assert texts(book) == ["[page: x/y]"]


@pytest.mark.parametrize(
    "body",
    [
        '<?xml version="1.0"?><html xmlns="http://www.w3.org/1999/xhtml"><title/><p>a<br>b</html>',
        '<?xml version="1.0"?><html>' + "<div>" * 300 + "a<br/>b" + "</div>" * 300 + "</html>",
        "<?xml version='1.0'?><html><title/><p>a\x01<br/>b</p></html>",
    ],
)
def test_a_chapter_that_is_no_xml_is_read_as_html(body):
    found = [text.replace("\x01", "") for text in texts(opened(epub({"a.xhtml": body})))]
    assert found == ["a", "b"]


def test_a_long_chapter_is_read_in_parts():
    body = "".join(f'<p id="p{n}">{"word " * 80}{n}</p>' for n in range(1_000))
    book = opened(epub({"a.xhtml": body, "b.xhtml": "<p>end</p>"}))
    assert book.block(0) is not None
    assert not book.complete
    assert str(book.block(1_000).text) == "end"
    assert str(book.block(17).text) == "word " * 80 + "17"
    assert book.anchored("OPS/a.xhtml#p999") == 0
    assert book.anchor("OPS/a.xhtml#p700") == int(book.block(700).text.places[0])


LOCK = (
    '<encryption xmlns="urn:oasis:names:tc:opendocument:xmlns:container" '
    'xmlns:enc="http://www.w3.org/2001/04/xmlenc#"><enc:EncryptedData><enc:EncryptionMethod '
    'Algorithm="{}"/></enc:EncryptedData></encryption>'
)
AES = LOCK.format("http://www.w3.org/2001/04/xmlenc#aes256-cbc")


@pytest.mark.parametrize(
    ("members", "lock"),
    [
        ({"encryption.xml": AES, "license.lcpl": "{}"}, "Readium LCP"),
        ({"license.lcpl": "{}"}, "Readium LCP"),
        ({"encryption.xml": AES, "rights.xml": "<adept/>"}, "Adobe ADEPT"),
        ({"encryption.xml": AES, "sinf.xml": "<fairplay/>"}, "Apple FairPlay"),
        ({"encryption.xml": AES}, "a lock that it does not name"),
    ],
)
def test_a_locked_book_says_which_lock(members, lock):
    content = epub(TWO, **{f"META-INF/{name}": text for name, text in members.items()})
    with pytest.raises(InputError, match=f"b.epub is locked by {lock}"):
        opened(content)


@pytest.mark.parametrize(
    "method", ["http://www.idpf.org/2008/embedding", "http://ns.adobe.com/pdf/enc#RC"]
)
def test_garbled_fonts_are_no_lock(method):
    content = epub(TWO, **{"META-INF/encryption.xml": LOCK.format(method)})
    assert texts(opened(content))[0] == "One"


def test_a_password_of_the_archive_is_a_lock():
    content = bytearray(epub(TWO))
    for entry in re.finditer(rb"PK\x01\x02", bytes(content)):
        content[entry.start() + 8] |= 1
    with pytest.raises(InputError, match=r"b.epub is locked by a password of the ZIP archive"):
        opened(bytes(content))


BOMB = (
    "<?xml version='1.0'?><!DOCTYPE html [<!ENTITY a 'ha'>"
    + "".join(
        f"<!ENTITY {b} '{f'&{a};' * 10}'>" for a, b in zip("abcdefghi", "bcdefghij", strict=True)
    )
    + "]><html><p>&j;</p></html>"
)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"PK\x03\x04" + bytes(100), "not a whole ZIP archive"),
        (epub(TWO)[:300], "not a whole ZIP archive"),
        (packed({"a.txt": "b"}), "no META-INF/container.xml"),
        (packed({"META-INF/container.xml": CONTAINER}), "no package document"),
        (packed({"META-INF/container.xml": "<a>"}), "damaged part META-INF/container.xml"),
        (epub(TWO, order=["gone.xhtml"]), "none of its chapters"),
        (epub(TWO, order=["../../../etc/passwd"]), "none of its chapters"),
        (
            packed({"META-INF/container.xml": CONTAINER, "OPS/p.opf": opf([])}),
            "spine is empty",
        ),
        (epub({"a.xhtml": "<p></p>"}), "no text"),
        (epub({"a.xhtml": BOMB}), "entities by other entities"),
        (epub({"a.xhtml": "<p>x"}, **{"OPS/p.opf": BOMB}), "OPS/p.opf"),
    ],
)
@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_bad_book_is_one_sentence(content, message):
    with pytest.raises(InputError, match=message) as raised:
        texts(opened(content))
    assert "b.epub" in str(raised.value)
    assert "\n" not in str(raised.value)


def test_entities_are_never_looked_up_elsewhere():
    body = (
        '<?xml version="1.0"?><!DOCTYPE html [<!ENTITY own "mine&#33;"><!ENTITY out SYSTEM '
        '"file:///etc/hostname">]><html><p>&own; &out; &eacute;&hellip; &none; &lt;</p></html>'
    )
    assert texts(opened(epub({"a.xhtml": body}))) == ["mine! &out; é… &none; <"]


def large(size):
    """An EPUB that says that its chapter is of a size, without having it."""
    content = bytearray(epub({"a.xhtml": "<p>a</p>"}))
    entry = next(
        found.start()
        for found in re.finditer(rb"PK\x01\x02", bytes(content))
        if content[found.start() + 46 :].startswith(b"OPS/a.xhtml")
    )
    content[entry + 24 : entry + 28] = struct.pack("<I", size)
    return bytes(content)


def test_a_member_that_is_too_large_is_not_unpacked():
    with pytest.raises(InputError, match=r"b.epub has a part OPS/a.xhtml of 1500 MB"):
        texts(opened(large(1_500_000_000)))
    with pytest.raises(InputError, match=r"damaged in its part OPS/a.xhtml"):
        texts(opened(large(20)))


@heavy  # packs 250 MB
def test_a_member_that_unpacks_to_more_than_is_read():
    with pytest.raises(InputError, match="250 MB"):
        texts(opened(epub({"a.xhtml": "<p>" + "x" * 250_000_000})))


BRAILLE = "⠠⠓⠑⠇⠇⠕\u00a0⠸⠺ ⠁⠂\n ⠃"


@pytest.mark.parametrize("told", ["mimetype", "metadata"])
def test_ebraille_is_ready_cells(told):
    body = f'<h1>⠠⠞</h1><p>{BRAILLE}</p><ul><li>⠁</li></ul><img src="x"/><p>a — b</p>'
    meta = '<meta property="a11y:brailleSystem">UEB grade2</meta>'
    content = epub({"a.html": body}, metadata=meta if told == "metadata" else "")
    if told == "mimetype":
        with zipfile.ZipFile(io.BytesIO(epub({"a.html": body}))) as archive:
            members = {n: archive.read(n) for n in archive.namelist() if n != "mimetype"}
        content = packed(members, "application/ebrl+zip")
    book = opened(content)
    assert book.in_cells
    found = blocks(book)
    assert [block.cells.to_unicode() for block in found[:3]] == [
        "⠠⠞",
        "⠠⠓⠑⠇⠇⠕⠀⠸⠺⠀⠁⠂⠀⠃",
        "⠸⠲⠀⠁",
    ]
    assert found[2].kind is BlockKind.ITEM
    assert found[3].cells.to_unicode() == "⠨⠣⠏⠊⠉⠞⠥⠗⠑⠨⠜"
    for block in found:
        assert np.array_equal(block.cells.starts, block.text.places)
        assert block.cells.end == block.text.end
    assert found[4].cells.to_unicode() == "⠁⠀⠿⠀⠃"
    assert "1 other character" in book.note()
    assert book.note() is None


@pytest.mark.parametrize("version", [2, 3])
def test_a_book_by_pandoc(version):
    with (FILES / f"pandoc{version}.epub").open("rb") as stream:
        book = EpubBook(stream, "p.epub")
        found = blocks(book)
        outline = book.outline()
    assert (book.title, book.language) == ("A small book", "en-GB")
    kinds = {block.kind for block in found}
    assert kinds >= {BlockKind.HEADING, BlockKind.ITEM, BlockKind.ROW, BlockKind.QUOTE}
    assert kinds >= {BlockKind.NOTE, BlockKind.LINE}
    row = next(block for block in found if str(block.text) == "salt  2 g")
    assert row.headers == ("thing", "weight")
    note = next(block for block in found if block.kind is BlockKind.NOTE)
    assert str(note.text) == "1. Not the other one."
    text = next(block for block in found if str(block.text).startswith("Hello world"))
    marks = [mark for mark in text.marks if mark.kind is MarkKind.NOTE]
    assert [book.anchor(mark.target[1:]) for mark in marks] == [int(note.text.places[0])]
    assert [block for block in found if str(block.text) == "A cat"]
    french = [mark.target for block in found for mark in block.marks]
    assert "fr" in french
    titles = {title: target for _, title, target in outline}
    assert book.anchor(titles["Two"][1:]) == next(
        int(block.text.places[0])
        for block in found
        if str(block.text) == "Two" and block.kind is BlockKind.HEADING
    )


@examples(150)
@given(st.data())
def test_any_damage_is_one_sentence(data):
    content = bytearray(epub(TWO))
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at] = data.draw(st.integers(0, 255))
    with suppress(InputError):
        book = opened(bytes(content[: data.draw(st.integers(0, len(content)))] or b"x"))
        texts(book)
        book.outline()
