"""One little book by many writers: the same comes out of each, but for what its form cannot say."""

import io
import re
import zipfile
from pathlib import Path

import mammoth
import pytest
from lxml import etree

from vbraille.translate.formats import open_source
from vbraille.translate.source import BlockKind, MarkKind

FILES = Path(__file__).parent / "files"
FRENCH = "Les bateaux rentrent le soir."
# Kind, level and text of each block; a reference to a note is left out.
BOOK = (
    ("heading", 1, "The Harbour"),
    ("paragraph", 0, "The boats come in with the evening tide, and nobody counts them."),
    ("heading", 2, "What is brought"),
    ("item", 1, "1. herring"),
    ("item", 1, "2. nets"),
    ("item", 2, "• torn"),
    ("item", 2, "• mended"),
    ("item", 1, "3. salt"),
    ("row", 0, "Fish  Price"),
    ("row", 0, "cod  12"),
    ("row", 0, "herring  3"),
    ("quote", 1, "Count nothing on a Friday."),
    ("paragraph", 0, FRENCH),
    ("heading", 2, "The light"),
    ("paragraph", 0, "A lighthouse on a rock"),
    ("paragraph", 0, "See the harbour and the office."),
    ("paragraph", 0, "Water is H₂O."),
    ("line", 0, "tide = 12"),
    ("line", 0, "ebb = 6"),
)
NOTE = "Except the harbour master."
PICTURE = ("paragraph", 0, "[picture]")  # a writer that lost its text, and kept the caption
# What a writer does not write, or writes as something else.
OTHERWISE = {
    "libreoffice.docx": {"A lighthouse on a rock": [PICTURE, BOOK[14]]},
    "libreoffice.odt": {"A lighthouse on a rock": [PICTURE, BOOK[14]]},
    "libreoffice.rtf": {"A lighthouse on a rock": [PICTURE, BOOK[14]]},
    "libreoffice.html": {"A lighthouse on a rock": [PICTURE, BOOK[14]]},
    "pandoc.odt": {"A lighthouse on a rock": [PICTURE, BOOK[14]]},
    # Each list of its own, and no code.
    "pythondocx.docx": {
        "• torn": [("item", 1, "• torn")],
        "• mended": [("item", 1, "• mended")],
        "tide = 12": [],
        "ebb = 6": [],
    },
    # Lists and quotations are paragraphs, the picture has no text.
    "pandoc.rtf": {
        "1. herring": [("paragraph", 0, "1. herring")],
        "2. nets": [("paragraph", 0, "2. nets")],
        "• torn": [("paragraph", 0, "– torn")],
        "• mended": [("paragraph", 0, "– mended")],
        "3. salt": [("paragraph", 0, "3. salt")],
        "Count nothing on a Friday.": [("paragraph", 0, "Count nothing on a Friday.")],
        "A lighthouse on a rock": [PICTURE],
        "tide = 12": [("paragraph", 0, "tide = 12")],
    },
}
WRITERS = (
    "pandoc.docx",
    "libreoffice.docx",
    "pythondocx.docx",
    "pandoc.odt",
    "libreoffice.odt",
    "pandoc.rtf",
    "libreoffice.rtf",
    "pandoc.html",
    "libreoffice.html",
    "word.html",
    "hand.html",
    "harbour.md",
    "pandoc-2.epub",
    "pandoc-3.epub",
    "zipped.epub",
    "dtbook.xml",
)
NO_NOTE = ("pythondocx.docx",)
NO_LANGUAGE = ("pandoc.docx", "pandoc.rtf", "libreoffice.rtf")


@pytest.fixture(scope="module")
def zipped(tmp_path_factory):
    """The book as an EPUB 3 of another producer: chapters in folders, names with blanks, no NCX."""
    path = tmp_path_factory.mktemp("books") / "zipped.epub"
    body = (FILES / "hand.html").read_text()
    parser = etree.HTMLParser()
    tree = etree.fromstring(body, parser)
    note = tree.find(".//div")
    note.getparent().remove(note)
    chapters = {"one harbour.xhtml": tree.find("body"), "notes.xhtml": etree.Element("body")}
    chapters["notes.xhtml"].append(note)
    for link in tree.iter("a"):
        if link.get("href") == "#tide":
            link.set("href", "notes.xhtml#tide")
    container = (
        '<container xmlns="urn:oasis:names:tc:opendocument:xmlns:container" version="1.0">'
        '<rootfiles><rootfile full-path="My Book/opf/book.opf" '
        'media-type="application/oebps-package+xml"/></rootfiles></container>'
    )
    package = (
        '<package xmlns="http://www.idpf.org/2007/opf" version="3.0" unique-identifier="i">'
        '<metadata xmlns:dc="http://purl.org/dc/elements/1.1/"><dc:identifier id="i">x'
        "</dc:identifier><dc:title>The Harbour</dc:title><dc:language>en</dc:language></metadata>"
        '<manifest><item id="n" href="nav.xhtml" properties="nav" '
        'media-type="application/xhtml+xml"/><item id="a" href="../text/one%20harbour.xhtml" '
        'media-type="application/xhtml+xml"/><item id="b" href="../text/notes.xhtml" '
        'media-type="application/xhtml+xml"/></manifest>'
        '<spine><itemref idref="a"/><itemref idref="b" linear="no"/></spine></package>'
    )
    nav = (
        '<html xmlns="http://www.w3.org/1999/xhtml" xmlns:epub="http://www.idpf.org/2007/ops">'
        '<body><nav epub:type="toc"><ol><li><a href="../text/one%20harbour.xhtml">The Harbour</a>'
        "</li></ol></nav></body></html>"
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as out:
        out.writestr("mimetype", "application/epub+zip", zipfile.ZIP_STORED)
        out.writestr("META-INF/container.xml", container)
        out.writestr("My Book/opf/book.opf", package)
        out.writestr("My Book/opf/nav.xhtml", nav)
        for name, content in chapters.items():
            text = etree.tostring(content, encoding="unicode")
            head = "<head><title>The Harbour</title></head>"
            html = f'<html xmlns="http://www.w3.org/1999/xhtml" lang="en">{head}{text}</html>'
            out.writestr(f"My Book/text/{name}", html)
    return path


@pytest.fixture(params=WRITERS)
def book(request, zipped):
    """Name of a writer's file, its source, and its blocks from the first heading on."""
    name = request.param
    source = open_source(str(zipped if name == "zipped.epub" else FILES / name))
    blocks = blocks_of(source)
    first = max(n for n, b in enumerate(blocks) if said(b) == BOOK[0])
    return name, source, blocks[first:]


def blocks_of(source):
    blocks = []
    while (block := source.block(len(blocks))) is not None:
        blocks.append(block)
    return blocks


def marked(block, kind):
    """Texts that a block has marked in a way, with their targets."""
    text = str(block.text)
    return [
        (text[block.text.index(mark.start) : block.text.index(mark.end)], mark.target)
        for mark in block.marks
        if mark.kind is kind
    ]


def said(block):
    text = str(block.text)
    return block.kind.value, block.level, text.replace("them.[1]", "them.")


def test_the_blocks(book):
    name, source, blocks = book
    assert source.title == ("" if name == "pandoc.rtf" else "The Harbour")
    found = [said(b) for b in blocks if b.kind is not BlockKind.PAGE and NOTE not in str(b.text)]
    expected = []
    for kind, level, text in BOOK:
        expected += OTHERWISE.get(name, {}).get(text, [(kind, level, text)])
    after = found[len(expected) :]
    assert found[: len(expected)] == expected
    assert all(text in ("* * *", "1") for _, _, text in after)  # rules and footers of pages
    notes = [block for block in blocks if NOTE in str(block.text)]
    assert len(notes) == (name not in NO_NOTE)


def test_emphasis_links_and_headers(book):
    name, source, blocks = book
    second = blocks[1]
    assert marked(second, MarkKind.ITALIC) == [("evening", "")]
    assert marked(second, MarkKind.BOLD) == [("nobody", "")]
    see = next(block for block in blocks if str(block.text).startswith("See "))
    (inner, inner_target), (outer, outer_target) = marked(see, MarkKind.LINK)
    assert (inner, outer) == ("the harbour", "the office")
    assert outer_target == "https://example.org/office"
    if name not in ("pandoc.rtf", "harbour.md"):
        place = source.anchor(inner_target.removeprefix("#"))
        assert place is not None
        assert str(source.block(source.block_at(place)).text) == "The Harbour"
    rows = [block.headers for block in blocks if block.kind is BlockKind.ROW]
    assert rows == [(), ("Fish", "Price"), ("Fish", "Price")]
    water = next(block for block in blocks if str(block.text).startswith("Water"))
    assert marked(water, MarkKind.SUBSCRIPT) == [("₂", "")]


def test_the_passage_in_french(book):
    name, source, blocks = book
    if name in NO_LANGUAGE:
        return
    assert source.language.lower().startswith("en")
    block = next(block for block in blocks if str(block.text) == FRENCH)
    ((words, tag),) = marked(block, MarkKind.LANGUAGE) or [(FRENCH, block.language)]
    assert words == FRENCH
    assert tag.lower().startswith("fr")


def test_a_note_is_found_from_its_reference(book):
    name, source, blocks = book
    if name in NO_NOTE:
        return
    assert marked(blocks[1], MarkKind.LINK) == []
    ((_, target),) = marked(blocks[1], MarkKind.NOTE)
    place = source.anchor(target.removeprefix("#"))
    assert place is not None
    note = source.block(source.block_at(place))
    assert note.kind is BlockKind.NOTE
    assert re.fullmatch(rf"((\[1\]|1\.?|†|\*) )?{NOTE}.*", str(note.text))


def test_libreoffices_epub_has_texts_alone():
    """It writes neither headings nor lists, nor the head of a table, nor what is small."""
    source = open_source(str(FILES / "libreoffice.epub"))
    found = [said(block)[2] for block in blocks_of(source)]
    assert source.title == "The Harbour"
    texts = [text.split(" ", 1)[1] if kind == "item" else text for kind, _, text in BOOK]
    texts = [text.replace("₂", "2") for text in texts if text != "Fish  Price"]
    assert [text for text in found if text in texts][1:] == texts
    assert found[-1].endswith(NOTE)
    assert any(marked(block, MarkKind.NOTE) for block in blocks_of(source))


def test_a_page_that_the_author_begins():
    blocks = blocks_of(open_source(str(FILES / "pythondocx.docx")))
    after = next(n for n, block in enumerate(blocks) if str(block.text) == "The light")
    assert blocks[after - 1].kind is BlockKind.PAGE


@pytest.mark.parametrize("name", [name for name in WRITERS if name.endswith(".docx")])
def test_mammoth_reads_the_same_in_docx(name):
    content = (FILES / name).read_bytes()
    html = mammoth.convert_to_html(io.BytesIO(content)).value
    tree = etree.fromstring(html, etree.HTMLParser())
    blocks = blocks_of(open_source(str(FILES / name)))

    def texts(*tags):
        return ["".join(e.itertext()).strip() for e in tree.iter(*tags)]

    headings = [str(block.text) for block in blocks if block.kind is BlockKind.HEADING]
    # Mammoth takes a title for a paragraph.
    assert headings[-3:] == texts("h1", "h2")[-3:]
    rows = [str(block.text) for block in blocks if block.kind is BlockKind.ROW]
    assert "  ".join(rows).split("  ") == texts("td", "th")
    items = [str(block.text) for block in blocks if block.kind is BlockKind.ITEM]
    assert [item.split(" ", 1)[1] for item in items] == [item.text for item in tree.iter("li")][
        : len(items)
    ]
