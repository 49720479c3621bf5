"""Which form a book is in, by what its bytes say and then by its name."""

import io
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from vbraille.errors import InputError
from vbraille.translate.forms import Form, find_form

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
        ("harbour.md", Form.MARKDOWN),
        ("pandoc-2.epub", Form.EPUB),
        ("pandoc-3.epub", Form.EPUB),
        ("libreoffice.epub", Form.EPUB),
        ("pandoc.docx", Form.DOCX),
        ("libreoffice.docx", Form.DOCX),
        ("pythondocx.docx", Form.DOCX),
        ("pandoc.odt", Form.ODT),
        ("libreoffice.odt", Form.ODT),
        ("pandoc.rtf", Form.RTF),
        ("libreoffice.rtf", Form.RTF),
        ("pandoc.html", Form.HTML),
        ("libreoffice.html", Form.HTML),
        ("word.html", Form.HTML),
        ("hand.html", Form.HTML),
        ("dtbook.xml", Form.DTBOOK),
        ("brailleutils.pef", Form.PEF),
        ("file2brl.brf", Form.BRF),
    ],
)
def test_the_form_of_each_writers_book(name, form):
    content = (FILES / name).read_bytes()
    assert find_form(io.BytesIO(content), name) is form
    if form not in (Form.MARKDOWN, Form.BRF) and name != "hand.html":
        assert find_form(io.BytesIO(content), "standard input") is form
        assert find_form(io.BytesIO(content), "misnamed.txt") is form


@pytest.mark.parametrize(
    ("content", "name", "form"),
    [
        (b"", "book.epub", Form.TEXT),
        (b"# One\n", "book.txt", Form.TEXT),
        (b"# One\n", "standard input", Form.TEXT),
        (b"# One\n", "book.MARKDOWN", Form.MARKDOWN),
        (b"One <b>two</b>", "book", Form.TEXT),
        (b"One <b>two</b>", "book.htm", Form.HTML),
        (b"<p>One", "book.txt", Form.TEXT),
        (b"<htmlish>", "book.txt", Form.TEXT),
        (b"\n <!-- a -->\n<!DOCTYPE html>\n<p>One", "book.txt", Form.HTML),
        (b"<HTML LANG=en><P>One", "book", Form.HTML),
        (b"<?xml version='1.0'?><html xmlns='x'/>", "book", Form.HTML),
        ("\ufeff<html>".encode(), "book", Form.HTML),
        ("<html>".encode("utf-16"), "book", Form.HTML),
        (b"<?xml version='1.0'?><dtb:dtbook xmlns:dtb='x'>", "book", Form.DTBOOK),
        (b"<!DOCTYPE dtbook [<!ENTITY a 'b'>]><dtbook/>", "book", Form.DTBOOK),
        (b"<?xml version='1.0'?><poem/>", "book.xml", Form.TEXT),
        (b",! ,h>b|r\n", "book.txt", Form.TEXT),
        (b",! ,h>b|r\n", "BOOK.BRL", Form.BRF),
        ("⠠⠮ ⠠⠓⠜⠃\n".encode(), "book.txt", Form.UNICODE_BRAILLE),
        ("⠠⠮ ⠠⠓⠜⠃\n".encode("utf-16"), "book.brf", Form.UNICODE_BRAILLE),
        ("The letter b is ⠃ in braille.\n".encode(), "book.txt", Form.TEXT),
        (b"CONTENTS\n", "book.txt", Form.TEXT),
        (zip_of("OEBPS/a.opf", "META-INF/container.xml"), "book", Form.EPUB),
        (zip_of("package.opf", mimetype="application/wrong"), "book.ebrl", Form.EPUB),
        (zip_of(mimetype="application/ebrl+zip"), "book", Form.EPUB),
        (zip_of("notes.txt"), "book.docx", Form.TEXT),
    ],
)
def test_content_goes_before_the_name(content, name, form):
    assert find_form(io.BytesIO(content), name) is form


@pytest.mark.parametrize("name", ["a.scene", "a.SVG", "a.svgz", "a.gen", "a.tx"])
def test_a_picture_is_known_by_its_name(name):
    with pytest.raises(InputError, match=f"^{name} is a picture, not a text; vbraille feel"):
        find_form(io.BytesIO(b"not finished yet"), name)


def test_a_text_about_pictures_is_a_text():
    text = b"# How to draw\n\nBegin with\n\n[canvas]\nwidth_mm = 9\n"
    assert find_form(io.BytesIO(text), "drawing.txt") is Form.TEXT
    assert find_form(io.BytesIO(b"[canvas]\nwidth_mm = 9\n"), "a.md") is Form.MARKDOWN


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
        find_form(io.BytesIO(content), "book")
    assert said in str(caught.value)
    assert "; " in str(caught.value)  # it says what to do


def test_a_plain_text_loads_no_parser(tmp_path):
    path = tmp_path / "book.txt"
    path.write_text("One two three.\n")
    code = (
        "import sys\n"
        "from vbraille.translate.opening import open_source\n"
        f"assert open_source({str(path)!r}).block(0) is not None\n"
        "print([name for name in ('lxml', 'zipfile', 'markdown_it', 'sqlite3')"
        " if name in sys.modules])"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout == "[]\n"
