"""eBraille: each thing that its specification asks for, in a file that is read back."""

import io
import zipfile
from datetime import UTC, datetime
from pathlib import Path

import pytest
from lxml import etree

from vbraille.layout.embossed import blocks_of
from vbraille.translate import BlockKind, Book, BrailleTable
from vbraille.translate.braillefiles.ebraille import Edition, write_ebraille
from vbraille.translate.braillefiles.lines import open_brf
from vbraille.translate.braillefiles.writing import Imprint
from vbraille.translate.documents.epub import EpubBook
from vbraille.translate.documents.parted import PartedSource, Passage
from vbraille.translate.opening import open_source

FILES = Path(__file__).parents[1] / "documents/files"
NOW = datetime(2026, 11, 22, 10, 15, 1, tzinfo=UTC)
NAMES = {
    "o": "http://www.idpf.org/2007/opf",
    "dc": "http://purl.org/dc/elements/1.1/",
    "h": "http://www.w3.org/1999/xhtml",
    "c": "urn:oasis:names:tc:opendocument:xmlns:container",
}
EPUB_TYPE = "{http://www.idpf.org/2007/ops}type"
K = BlockKind


class Made(PartedSource):
    """A source of these passages."""

    def __init__(self, *made: Passage) -> None:
        super().__init__("made", [1], "0" * 64)
        self._made = made

    def passages(self, _part):
        return self._made


TEXT = (
    Passage("xi", K.PAGE),
    Passage("One & two", K.HEADING, 1),
    Passage("some  text"),
    Passage("a", K.ITEM, 1, group=1),
    Passage("b", K.ITEM, 2, group=1),
    Passage("c", K.ITEM, 3, group=1),
    Passage("d", K.ITEM, 1, group=1),
    Passage("deep", K.ITEM, 2, group=2),
    Passage("12", K.PAGE),
    Passage("Inner", K.HEADING, 3),
    Passage("quoted", K.QUOTE, 1, language="fr-CA"),
    Passage("noted", K.NOTE),
    Passage("  a  line", K.LINE),
    Passage("Mid", K.HEADING, 2),
    Passage("a row", K.ROW, group=1),
    Passage("Last", K.HEADING, 1),
    Passage("word " * 4_000),
)


def written(book, imprint=None, **edition):
    """Content of each file of the zip, by its name."""
    file = io.BytesIO()
    imprint = imprint or Imprint("A <Book>", "en-US", "urn:uuid:1")
    write_ebraille(file, blocks_of(book), imprint, Edition(book.table, NOW, **edition))
    with zipfile.ZipFile(file) as archive:
        assert archive.testzip() is None
        first = archive.infolist()[0]
        assert (first.filename, first.compress_type) == ("mimetype", zipfile.ZIP_STORED)
        assert first.extra == b""
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def files():
    return written(Book(Made(*TEXT), BrailleTable("en-ueb-g2.ctb")))


def xhtml(files, name):
    return etree.fromstring(files[name])


def metadata(files):
    root = etree.fromstring(files["package.opf"])
    found = {}
    for element in root.find("o:metadata", NAMES):
        name = element.get("property") or f"dc:{etree.QName(element).localname}"
        assert name not in found
        found[name] = element.text
    return found


def test_what_must_be_in_the_root_is_there(files):
    assert files["mimetype"] == b"application/epub+zip"
    container = etree.fromstring(files["META-INF/container.xml"])
    (rootfile,) = container.iterfind(".//c:rootfile", NAMES)
    assert dict(rootfile.attrib) == {
        "full-path": "package.opf",
        "media-type": "application/oebps-package+xml",
    }
    package = etree.fromstring(files["package.opf"])
    items = package.findall("o:manifest/o:item", NAMES)
    assert {item.get("href") for item in items} == {
        name for name in files if name not in ("mimetype", "package.opf", "META-INF/container.xml")
    }
    (nav,) = [item for item in items if item.get("properties") == "nav"]
    assert nav.get("href") == "index.html"
    ids = {item.get("id"): item.get("href") for item in items}
    spine = [ids[ref.get("idref")] for ref in package.iterfind("o:spine/o:itemref", NAMES)]
    assert spine == ["part0001.html", "part0002.html", "part0003.html"]
    unique = package.get("unique-identifier")
    assert package.find(f".//dc:identifier[@id='{unique}']", NAMES).text == "urn:uuid:1"


def test_the_metadata_that_it_asks_for(files):
    assert metadata(files) == {
        "dc:identifier": "urn:uuid:1",
        "dc:format": "eBraille 1.0",
        "dc:title": "A <Book>",
        "dc:creator": "unknown",
        "dc:language": "en-Brai-US",
        "dc:date": "2026-11-22",
        "dcterms:dateCopyrighted": "2026",
        "dcterms:modified": "2026-11-22T10:15:01Z",
        "a11y:brailleCellType": "6",
        "a11y:brailleSystem": "UEB grade2",
        "a11y:completeTranscription": "true",
        "a11y:producer": "vbraille",
        "a11y:tactileGraphics": "none",
    }


def test_other_tables_and_none():
    german = BrailleTable("de-g1.ctb")
    found = metadata(
        written(Book(Made(Passage("ja")), german), Imprint("", "", "u"), complete=False)
    )
    assert found["a11y:brailleSystem"].endswith("grade1")
    assert found["dc:language"] == "und-Brai"
    assert found["a11y:completeTranscription"] == "false"
    eight = BrailleTable("fr-bfu-comp8.utb")
    found = metadata(written(Book(Made(Passage("OUI")), eight)))
    assert found["a11y:brailleCellType"] == "8"
    ready = open_brf(io.BytesIO("⠁⠁⣿\n".encode()), "x")
    made = written(Book(ready))
    found = metadata(made)
    assert found["a11y:brailleCellType"] == "6, 8"
    assert found["a11y:brailleSystem"] == "unknown no-grade"
    (entry,) = xhtml(made, "index.html").iterfind(".//h:a", NAMES)
    assert entry.text == "⠁⠀⠃⠕⠕⠅".replace("⠀", " ")
    assert entry.get("href") == "part0001.html"


def test_all_text_is_braille(files):
    for name in (name for name in files if name.endswith(".html")):
        root = xhtml(files, name)
        assert root.get("lang") == "en-Brai-US"
        text = "".join(root.itertext())
        assert {c for c in text if not 0x2800 <= ord(c) < 0x2900} <= set(" \n")
        for label in root.xpath("//@aria-label[not(contains(., 'e'))]"):
            assert all(0x2800 <= ord(c) < 0x2900 for c in label)
        assert not root.xpath("//h:script | //h:form | //@src", namespaces=NAMES)


def test_the_primary_page_leads_to_headings_and_print_pages(files):
    root = xhtml(files, "index.html")
    (link,) = root.iterfind(".//h:link[@rel='publication']", NAMES)
    assert (link.get("href"), link.get("type")) == ("package.opf", "application/oebps-package+xml")
    contents, pages = root.iterfind(".//h:nav", NAMES)
    assert (contents.get(EPUB_TYPE), contents.get("role")) == ("toc", "doc-toc")
    assert (pages.get(EPUB_TYPE), pages.get("role")) == ("page-list", "doc-pagelist")

    def nested(ol):
        return [
            (item.find("h:a", NAMES).text, *map(nested, item.findall("h:ol", NAMES)))
            for item in ol.findall("h:li", NAMES)
        ]

    table = BrailleTable("en-ueb-g2.ctb")
    one, inner, mid, last = map(Edition(table, NOW).braille, ("One & two", "Inner", "Mid", "Last"))
    assert nested(contents.find("h:ol", NAMES)) == [(one, [(inner,), (mid,)]), (last,)]
    listed = pages.findall(".//h:a", NAMES)
    assert [entry.get("title") for entry in listed] == ["xi", "12"]
    assert listed[1].text == "⠼⠁⠃"
    for entry in root.iterfind(".//h:a", NAMES):
        name, _, place = entry.get("href").partition("#")
        target = xhtml(files, name).find(f".//*[@id='{place}']")
        assert target is not None
        if entry in listed:
            assert (target.get("role"), target.get("aria-label")) == ("doc-pagebreak", entry.text)
        else:
            assert target.text == entry.text


def test_blocks_are_what_they_were(files):
    bodies = [xhtml(files, f"part000{n}.html").find("h:body", NAMES) for n in (1, 2, 3)]
    assert [element.tag.partition("}")[2] for element in bodies[0]] == ["div"]
    tags = [element.tag.partition("}")[2] for element in bodies[1]]
    assert tags == ["h1", "p", "ul", "ul", "div", "h3", "blockquote", "aside", "pre", "h2", "table"]
    first, second = bodies[1].findall("h:ul", NAMES)
    for items, wanted in ((first, [1, 2, 3, 1]), (second, [1, 2])):
        assert [len(list(li.iterancestors("{*}ul"))) for li in items.iter("{*}li")] == wanted
    quote = bodies[1].find("h:blockquote/h:p", NAMES)
    assert quote.get("lang") == "fr-Brai-CA"
    assert bodies[1].find("h:pre", NAMES).text == "  ⠁  ⠇⠔⠑"
    (cell,) = bodies[1].iterfind("h:table/h:tr/h:td", NAMES)
    assert cell.text == "⠁ ⠗⠪"
    (paragraph,) = bodies[2].findall("h:p", NAMES)
    assert paragraph.text.split() == ["⠘⠺"] * 4_000


def read_back(book):
    """Kind, level and cells of each block, from the file that is written of a book, and its own."""
    file = io.BytesIO()
    imprint = Imprint("A book", "en", "urn:uuid:1")
    write_ebraille(file, blocks_of(book), imprint, Edition(book.table, NOW))
    return kept(Book(EpubBook.open(io.BytesIO(file.getvalue()), "x.ebrl"))), kept(book)


def kept(book):
    found = []
    for block, cells in blocks_of(book):
        text = cells.to_unicode()
        if block.kind not in (K.LINE, K.ROW):
            text = "⠀".join(text.replace("⠀", " ").split())
        row = (block.kind, block.level, text)
        if block.continues:
            row = (block.kind, block.level, f"{found.pop()[2]}⠀{text}")
        found.append(row)
    return found


def test_our_own_reader_reads_the_same_cells():
    again, own = read_back(Book(Made(*TEXT), BrailleTable("en-ueb-g2.ctb")))
    assert again == own
    assert {kind for kind, _, _ in own} == set(K)


@pytest.mark.parametrize("name", ["pandoc-3.epub", "dtbook.xml", "hand.html", "libreoffice.html"])
def test_our_own_reader_reads_the_same_cells_of_books_of_others(name):
    book = Book(open_source(str(FILES / name)), BrailleTable("en-ueb-g2.ctb"))
    again, own = read_back(book)
    assert again == own
    assert {K.HEADING, K.ITEM, K.ROW, K.NOTE, K.LINE} <= {kind for kind, _, _ in own}
