"""Which form a book is in, by what its bytes say and then by its name."""

import io
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from vbraille.errors import InputError
from vbraille.translate.formats import find_format

FILES = Path(__file__).parent / "documents" / "files"
OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(504)


def zip_of(*names, mimetype=None):
    kept = {} if mimetype is None else {"mimetype": mimetype}
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w") as out:
        for name, text in {**kept, **dict.fromkeys(names, "x")}.items():
            out.writestr(name, text)
    return packed.getvalue()


def kindle(lock):
    header = bytearray(120)
    header[60:68] = b"BOOKMOBI"
    header[78:82] = (90).to_bytes(4)
    header[102:104] = lock.to_bytes(2)
    return bytes(header)


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("harbour.md", "markdown"),
        ("pandoc-2.epub", "epub"),
        ("pandoc-3.epub", "epub"),
        ("libreoffice.epub", "epub"),
        ("pandoc.docx", "docx"),
        ("libreoffice.docx", "docx"),
        ("pythondocx.docx", "docx"),
        ("pandoc.odt", "odt"),
        ("libreoffice.odt", "odt"),
        ("pandoc.rtf", "rtf"),
        ("libreoffice.rtf", "rtf"),
        ("pandoc.html", "html"),
        ("libreoffice.html", "html"),
        ("word.html", "html"),
        ("hand.html", "html"),
        ("dtbook.xml", "dtbook"),
        ("brailleutils.pef", "pef"),
        ("file2brl.brf", "brf"),
    ],
)
def test_the_form_of_each_writers_book(name, form):
    content = (FILES / name).read_bytes()
    assert find_format(io.BytesIO(content), name).name == form
    if form not in ("markdown", "brf") and name != "hand.html":
        assert find_format(io.BytesIO(content), "standard input").name == form
        assert find_format(io.BytesIO(content), "misnamed.txt").name == form


@pytest.mark.parametrize(
    ("content", "name", "form"),
    [
        (b"", "book.epub", "text"),
        (b"# One\n", "book.txt", "text"),
        (b"# One\n", "standard input", "text"),
        (b"# One\n", "book.MARKDOWN", "markdown"),
        (b"One <b>two</b>", "book", "text"),
        (b"One <b>two</b>", "book.htm", "html"),
        (b"<p>One", "book.txt", "text"),
        (b"<htmlish>", "book.txt", "text"),
        (b"\n <!-- a -->\n<!DOCTYPE html>\n<p>One", "book.txt", "html"),
        (b"<HTML LANG=en><P>One", "book", "html"),
        (b"<?xml version='1.0'?><html xmlns='x'/>", "book", "html"),
        ("\ufeff<html>".encode(), "book", "html"),
        ("<html>".encode("utf-16"), "book", "html"),
        (b"<?xml version='1.0'?><dtb:dtbook xmlns:dtb='x'>", "book", "dtbook"),
        (b"<!DOCTYPE dtbook [<!ENTITY a 'b'>]><dtbook/>", "book", "dtbook"),
        (b"<?xml version='1.0'?><poem/>", "book.xml", "text"),
        (b",! ,h>b|r\n", "book.txt", "text"),
        (b",! ,h>b|r\n", "BOOK.BRL", "brf"),
        ("⠠⠮ ⠠⠓⠜⠃\n".encode(), "book.txt", "unicode-braille"),
        ("⠠⠮ ⠠⠓⠜⠃\n".encode("utf-16"), "book.brf", "unicode-braille"),
        ("The letter b is ⠃ in braille.\n".encode(), "book.txt", "text"),
        (b"CONTENTS\n", "book.txt", "text"),
        (zip_of("OEBPS/a.opf", "META-INF/container.xml"), "book", "epub"),
        (zip_of("package.opf", mimetype="application/wrong"), "book.ebrl", "epub"),
        (zip_of(mimetype="application/ebrl+zip"), "book", "epub"),
        (zip_of("notes.txt"), "book.docx", "text"),
    ],
)
def test_content_goes_before_the_name(content, name, form):
    assert find_format(io.BytesIO(content), name).name == form


@pytest.mark.parametrize("name", ["a.scene", "a.SVG", "a.svgz", "a.gen", "a.tx"])
def test_a_picture_is_known_by_its_name(name):
    with pytest.raises(InputError, match=f"^{name} is a picture, not a text; vbraille feel"):
        find_format(io.BytesIO(b"not finished yet"), name)


def test_a_text_about_pictures_is_a_text():
    text = b"# How to draw\n\nBegin with\n\n[canvas]\nwidth_mm = 9\n"
    assert find_format(io.BytesIO(text), "drawing.txt").name == "text"
    assert find_format(io.BytesIO(b"[canvas]\nwidth_mm = 9\n"), "a.md").name == "markdown"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"%PDF-1.7\n", "a PDF document"),
        (OLE + "WordDocument".encode("utf-16-le"), "before 2007 (DOC); save it as DOCX or ODT"),
        (OLE + "EncryptedPackage".encode("utf-16-le"), "locked with a password"),
        (OLE, "an old Office document"),
        (kindle(0), "a Kindle book (MOBI); save it as EPUB"),
        (kindle(2), "a Kindle book with Amazon's lock; get it as EPUB without"),
        (b"\xeaDRMION\xee", "a Kindle book (KFX) with Amazon's lock"),
        (b"CONT\2\0", "a Kindle book (KFX)"),
        (b"<?xml version='1.0'?>\n<office:document xmlns:office='x'>", "a flat OpenDocument file"),
        (b"<?xml version='1.0'?><?mso-application?><pkg:package xmlns:pkg='x'>", "save it as DOCX"),
        (b"<?xml version='1.0'?><w:wordDocument xmlns:w='x'>", "save it as DOCX"),
        (b"<?xml version='1.0'?><FictionBook xmlns='x'>", "a FictionBook (FB2); save it as EPUB"),
        (b"<fulfillmentToken/>", "a ticket for a book that Adobe locks"),
        (b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg"/>', "a picture, not a"),
        (b'<laterographics_xml type="Generator">', "a picture, not a text; vbraille feel"),
        (b'# lines\ntitle = "A"\n\n[canvas]\nwidth_mm = 9\n', "a picture, not a text"),
        (b"canvas = {width_mm = 9, height_mm = 9}", "a picture, not a text"),
        (zip_of("xl/workbook.xml", "[Content_Types].xml"), "an Excel workbook"),
        (zip_of("ppt/presentation.xml", "[Content_Types].xml"), "a PowerPoint presentation"),
        (zip_of(mimetype="application/vnd.oasis.opendocument.spreadsheet"), "an OpenDocument file"),
        (zip_of("book/book.opf", "book/book.xml"), "a zip archive of a DAISY book; unpack it"),
        (zip_of("one.txt")[:-30], "a zip archive that is damaged or cut short"),
        (b"PK\3\4", "a zip archive that is damaged or cut short"),
    ],
    # An archive has the time in it, and a test's name must be the same everywhere.
    ids=lambda value: value if isinstance(value, str) else "content",
)
def test_books_that_cannot_be_read_are_called_by_name(content, said):
    with pytest.raises(InputError, match=r"^book is ") as caught:
        find_format(io.BytesIO(content), "book")
    assert said in str(caught.value)
    assert "; " in str(caught.value)  # it says what to do


def test_a_plain_text_loads_no_parser(tmp_path):
    path = tmp_path / "book.txt"
    path.write_text("One two three.\n")
    code = (
        "import sys\n"
        "from vbraille.translate.formats import open_source\n"
        f"assert open_source({str(path)!r}).block(0) is not None\n"
        "print([name for name in ('lxml', 'zipfile', 'markdown_it', 'sqlite3')"
        " if name in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout == "[]\n"
