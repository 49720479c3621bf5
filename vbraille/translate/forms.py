"""Which form a book is in: what its bytes say, and then what its name says."""

from __future__ import annotations

import re
from enum import Enum
from pathlib import PurePath
from typing import TYPE_CHECKING, BinaryIO

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import SAMPLE_BYTES, find_encoding

if TYPE_CHECKING:
    from collections.abc import Iterable
    from zipfile import ZipFile


class Form(Enum):
    """Forms that a book can be read in, by the names that an option has for them."""

    TEXT = "text"
    MARKDOWN = "markdown"
    HTML = "html"
    EPUB = "epub"
    """EPUB 2 and 3, and eBraille, which is made like one."""
    DTBOOK = "dtbook"
    DOCX = "docx"
    ODT = "odt"
    RTF = "rtf"
    BRF = "brf"
    UNICODE_BRAILLE = "unicode-braille"
    PEF = "pef"


_BY_SUFFIX = {
    ".md": Form.MARKDOWN,
    ".markdown": Form.MARKDOWN,
    ".html": Form.HTML,
    ".htm": Form.HTML,
    ".xhtml": Form.HTML,
    ".brf": Form.BRF,
    ".brl": Form.BRF,
    ".pef": Form.PEF,
}
_BY_ROOT = {"html": Form.HTML, "dtbook": Form.DTBOOK, "pef": Form.PEF}
# Roots of files that people take for a book in XML, some with the prefixes that their writers set.
_OTHER_ROOTS = {
    "office:document": "a flat OpenDocument file (FODT); save it as ODT",
    "w:wordDocument": "a Word document as XML; save it as DOCX",
    "pkg:package": "a Word document as XML; save it as DOCX",
    "FictionBook": "a FictionBook (FB2); save it as EPUB",
    "fulfillmentToken": "a ticket for a book that Adobe locks, not the book; "
    "get the book as EPUB without a lock",
}
_HTML_BEGINS = ("html", "head", "title", "body")  # a file may leave the first two out
_OTHER_ZIPS = (
    ("xl/", "an Excel workbook; save its table as HTML or text"),
    ("ppt/", "a PowerPoint presentation; save it as HTML or text"),
    ("Index/Document.iwa", "a document of Apple's Pages; save it as DOCX or EPUB"),
    ("ncc.html", "a zip archive of a DAISY book; unpack it and give the HTML file with the text"),
)
_PICTURE = "a picture, not a text; vbraille feel shows it to the finger"
# Roots of drawings, and of OpenLatero's files.
_PICTURE_ROOTS = ("svg", "laterographics_xml")
_PICTURE_SUFFIXES = (".scene", ".svg", ".svgz", ".gen", ".tx")
# A scene is TOML from its first statement on, and says how large it is.
_SCENE = re.compile(
    r"\A(?:[ \t\r]*(?:\#[^\n]*)?\n)*(?=[ \t]*(?:\w+[ \t]*=|\[)).*?^(?:\[canvas\]|canvas[ \t]*=)",
    re.MULTILINE | re.DOTALL,
)
# Beginnings of books that cannot be read here, and what to do.
_OTHER_BEGINS = (
    (
        b"%PDF-",
        "a PDF document, which does not say in what order it reads; get the book as EPUB or DOCX",
    ),
    (b"AT&TFORM", "a DjVu document, which is made of pictures; get the book as EPUB"),
    (b"ITSF\3\0", "a compiled help file (CHM); unpack it and give its HTML files"),
    (b"ITOLITLS", "a book for Microsoft Reader (LIT); get it as EPUB"),
    (b"CONT\1\0", "a Kindle book (KFX); get it as EPUB"),
    (b"CONT\2\0", "a Kindle book (KFX); get it as EPUB"),
    (
        b"\xeaDRMION\xee",
        "a Kindle book (KFX) with Amazon's lock; get it as EPUB without a lock",
    ),
    (b"TPZ0", "a Kindle book (Topaz); get it as EPUB"),
)
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_OLE_SEARCHED_BYTES = 64 << 20
_BEFORE_ROOT = re.compile(r"[ \t\r\n\f]+|<\?.*?\?>|<!--.*?-->", re.DOTALL)
_ROOT = re.compile(r"<(?:!doctype[ \t\r\n]+)?([\w.-]+:)?([\w.-]+)(?=[\s/>\[])", re.IGNORECASE)
_BRAILLE_SAMPLE = 4096  # characters


def find_form(stream: BinaryIO, name: str) -> Form:
    """Find the form of a book.

    Parameters
    ----------
    stream
        Bytes of the book; the stream must be able to seek.
    name
        Name of the file, by whose ending forms are told apart that look alike.

    Returns
    -------
    Form
        The form; plain text for all that is nothing else.

    Raises
    ------
    InputError
        If it is a book that cannot be read here, or cannot be read at all.
    """
    try:
        stream.seek(0)
        sample = stream.read(SAMPLE_BYTES)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None
    if sample.startswith((b"PK\3\4", b"PK\5\6")):
        return _zipped(stream, name)
    if sample.startswith(b"{\\rtf"):
        return Form.RTF
    refused = _refused(stream, sample)
    if refused is not None:
        raise InputError(f"{name} is {refused}")
    text = _beginning(sample)
    form = _marked_up(text, name)
    if form is not None:
        return form
    if _mostly_braille(text):
        return Form.UNICODE_BRAILLE
    suffix = PurePath(name).suffix.lower()
    if suffix in _PICTURE_SUFFIXES or (suffix not in _BY_SUFFIX and _SCENE.match(text)):
        raise InputError(f"{name} is {_PICTURE}")
    return _BY_SUFFIX.get(suffix, Form.TEXT)


def _refused(stream: BinaryIO, sample: bytes) -> str | None:
    """End of a sentence on a book that cannot be read here; None for others."""
    for beginning, said in _OTHER_BEGINS:
        if sample.startswith(beginning):
            return said
    if sample[60:68] in (b"BOOKMOBI", b"TEXtREAd"):
        first = int.from_bytes(sample[78:82])  # where the first record is, which tells of a lock
        locked = int.from_bytes(sample[first + 12 : first + 14])
        if locked:
            return "a Kindle book with Amazon's lock; get it as EPUB without a lock"
        return "a Kindle book (MOBI); save it as EPUB"
    if sample.startswith(_OLE):
        return _old_office(stream)
    return None


def _old_office(stream: BinaryIO) -> str:
    """What a compound file of Microsoft's is, by the names of its streams, and what to do."""
    stream.seek(0)
    content = stream.read(_OLE_SEARCHED_BYTES)
    for stored, said in (
        ("EncryptedPackage", "locked with a password; open it with that and save it without one"),
        ("WordDocument", "a Word document of before 2007 (DOC); save it as DOCX or ODT"),
    ):
        if stored.encode("utf-16-le") in content:
            return said
    return "an old Office document, not text; save it as DOCX or ODT"


def _zipped(stream: BinaryIO, name: str) -> Form:
    from zipfile import BadZipFile, ZipFile

    try:
        with ZipFile(stream) as archive:
            form = _packed(archive)
            if isinstance(form, Form):
                return form
            members = archive.namelist()
    except (BadZipFile, ValueError, NotImplementedError, OverflowError, OSError):
        raise InputError(
            f"{name} is a zip archive that is damaged or cut short, as a book can be; get it again"
        ) from None
    for beginning, said in _OTHER_ZIPS:
        if any(member.startswith(beginning) for member in members):
            raise InputError(f"{name} is {said}")
    if form is not None:
        raise InputError(f"{name} is {form}")
    return Form.TEXT  # which says that a zip archive is none


def _packed(archive: ZipFile) -> Form | str | None:
    """Form of a zip archive's book, or the end of a sentence on another; None if it has none."""
    members = frozenset(archive.namelist())
    kind = _member(archive, "mimetype") if "mimetype" in members else ""
    if kind in ("application/epub+zip", "application/ebrl+zip"):
        return Form.EPUB
    if kind.startswith("application/vnd.oasis.opendocument.text"):
        return Form.ODT
    if "META-INF/container.xml" in members or "package.opf" in members:
        return Form.EPUB  # a book without its mimetype is one nevertheless
    if "[Content_Types].xml" in members and _any_begins(members, "word/"):
        return Form.DOCX
    if kind.startswith("application/vnd.oasis.opendocument."):
        return "an OpenDocument file, not a text; save it as ODT, HTML or text"
    if any(member.lower().endswith(".opf") for member in members):
        return "a zip archive of a DAISY book; unpack it and give the XML file with the text"
    return None


def _any_begins(members: Iterable[str], beginning: str) -> bool:
    return any(member.startswith(beginning) for member in members)


def _member(archive: ZipFile, name: str) -> str:
    """Beginning of a small member as text; empty if it cannot be read."""
    import zlib
    from zipfile import BadZipFile

    try:
        with archive.open(name) as member:
            return member.read(100).decode("ascii", "replace").strip()
    except (BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError, OSError):
        return ""  # damaged, locked, or packed in a way that this Python does not know


def _beginning(sample: bytes) -> str:
    """Text of the first bytes of a file, whatever stands for the rest."""
    if 0 in sample[:64] or sample.startswith((b"\xff\xfe", b"\xfe\xff")):
        encoding = find_encoding(sample)
        return sample[encoding.skip :].decode(encoding.name, "replace")
    return sample.decode("utf-8", "replace").removeprefix("\ufeff")


def _marked_up(text: str, name: str) -> Form | None:
    """Form of a text that begins as XML or HTML does; None if it is neither."""
    at = 0
    while (passed := _BEFORE_ROOT.match(text, at)) is not None:
        at = passed.end()
    root = _ROOT.match(text, at)
    if root is None:
        return None
    found = root[2]
    if found.lower() in _PICTURE_ROOTS:
        raise InputError(f"{name} is {_PICTURE}")
    for other in (f"{root[1] or ''}{found}", found):
        if other in _OTHER_ROOTS:
            raise InputError(f"{name} is {_OTHER_ROOTS[other]}")
    if found.lower() in _HTML_BEGINS:
        return Form.HTML
    return _BY_ROOT.get(found.lower())


def _mostly_braille(text: str) -> bool:
    """Whether nearly all that is no blank is a pattern of braille."""
    printed = "".join(text[:_BRAILLE_SAMPLE].split())
    patterns = sum("\u2800" <= character <= "\u28ff" for character in printed)
    return patterns > 0.9 * len(printed)
