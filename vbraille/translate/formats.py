"""Formats of books: one table of them, how a book's bytes show which it is in, and opening it."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass, field
from importlib import import_module
from operator import attrgetter
from pathlib import PurePath
from typing import TYPE_CHECKING, BinaryIO

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import (
    SAMPLE_BYTES,
    find_encoding,
    keep_stream,
    open_file,
)
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping
    from zipfile import ZipFile

    from vbraille.translate.source import Source


@dataclass(frozen=True, slots=True)
class Format:
    """A format of books.

    Parameters
    ----------
    name
        Name by which an option calls it.
    reader
        Function that opens a book, as a module of this package and a name in it. It is loaded when
        a book needs it, and is given the book's bytes, its name in messages, and options.
    suffixes
        Ends of files' names, for those whose bytes do not show it.
    root
        Name of the first element, where it is markup.
    takes
        Options of `open_source` that the reader takes.
    keeps_lines
        Whether lines are kept in any case, so that the option for that is right and needless.
    given
        What the reader is given beside options.
    """

    name: str
    reader: str
    suffixes: tuple[str, ...] = ()
    root: str = ""
    takes: tuple[str, ...] = ()
    keeps_lines: bool = False
    given: Mapping[str, object] = field(default_factory=dict)

    def read(self, stream: BinaryIO, name: str, **options: object) -> Source:
        """Open a book of this format by its bytes."""
        module, _, path = self.reader.partition(":")
        read = attrgetter(path)(import_module(f"vbraille.translate.{module}"))
        return read(stream, name, **self.given, **options)


_TEXT = Format("text", "documents.document:Document", takes=("encoding", "keep_lines"))
_HTML = Format(
    "html",
    "documents.html:HtmlBook.open",
    (".html", ".htm", ".xhtml"),
    "html",
    takes=("encoding",),
)
# EPUB 2 and 3, and eBraille, which is made like one.
_EPUB = Format("epub", "documents.epub:EpubBook")
_DOCX, _ODT, _RTF = (
    Format(name, "documents.office.officebook:open_office", given={"form": name})
    for name in ("docx", "odt", "rtf")
)
_BRF = Format(
    "brf",
    "braillefiles.lines:open_brf",
    (".brf", ".brl"),
    takes=("encoding", "brf_table"),
    keeps_lines=True,
)
_UNICODE_BRAILLE = Format(
    "unicode-braille",
    "braillefiles.lines:open_unicode_braille",
    takes=("encoding",),
    keeps_lines=True,
)
FORMATS = (
    _TEXT,
    Format(
        "markdown",
        "documents.markdown:read_markdown",
        (".md", ".markdown"),
        takes=("encoding",),
    ),
    _HTML,
    _EPUB,
    Format("dtbook", "documents.html:HtmlBook.open", root="dtbook", given={"is_dtbook": True}),
    _DOCX,
    _ODT,
    _RTF,
    _BRF,
    _UNICODE_BRAILLE,
    Format("pef", "braillefiles.pef:PefBook.open", (".pef",), "pef", keeps_lines=True),
)
_BY_SUFFIX = {suffix: format_ for format_ in FORMATS for suffix in format_.suffixes}
_BY_ROOT = {format_.root: format_ for format_ in FORMATS if format_.root}
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


def find_format(stream: BinaryIO, name: str) -> Format:
    """Find the format of a book.

    Parameters
    ----------
    stream
        Bytes of the book; the stream must be able to seek.
    name
        Name of the file, by whose ending formats are told apart that look alike.

    Returns
    -------
    Format
        The format; plain text for all that is nothing else.

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
        return _RTF
    refused = _refused(stream, sample)
    if refused is not None:
        raise InputError(f"{name} is {refused}")
    text = _beginning(sample)
    form = _marked_up(text, name)
    if form is not None:
        return form
    if _mostly_braille(text):
        return _UNICODE_BRAILLE
    suffix = PurePath(name).suffix.lower()
    if suffix in _PICTURE_SUFFIXES or (suffix not in _BY_SUFFIX and _SCENE.match(text)):
        raise InputError(f"{name} is {_PICTURE}")
    return _BY_SUFFIX.get(suffix, _TEXT)


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
    """Tell what a compound file of Microsoft's is, by the names of its streams, and what to do."""
    stream.seek(0)
    content = stream.read(_OLE_SEARCHED_BYTES)
    for stored, said in (
        ("EncryptedPackage", "locked with a password; open it with that and save it without one"),
        ("WordDocument", "a Word document of before 2007 (DOC); save it as DOCX or ODT"),
    ):
        if stored.encode("utf-16-le") in content:
            return said
    return "an old Office document, not text; save it as DOCX or ODT"


def _zipped(stream: BinaryIO, name: str) -> Format:
    from zipfile import BadZipFile, ZipFile

    try:
        with ZipFile(stream) as archive:
            form = _packed(archive)
            if isinstance(form, Format):
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
    return _TEXT  # which says that a zip archive is none


def _packed(archive: ZipFile) -> Format | str | None:
    """Form of a zip archive's book, or the end of a sentence on another; None if it has none."""
    members = frozenset(archive.namelist())
    kind = _member(archive, "mimetype") if "mimetype" in members else ""
    if kind in ("application/epub+zip", "application/ebrl+zip"):
        return _EPUB
    if kind.startswith("application/vnd.oasis.opendocument.text"):
        return _ODT
    if "META-INF/container.xml" in members or "package.opf" in members:
        return _EPUB  # a book without its mimetype is one nevertheless
    if "[Content_Types].xml" in members and _any_begins(members, "word/"):
        return _DOCX
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


def _marked_up(text: str, name: str) -> Format | None:
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
        return _HTML
    return _BY_ROOT.get(found.lower())


def _mostly_braille(text: str) -> bool:
    """Tell whether nearly all that is no blank is a pattern of braille."""
    printed = "".join(text[:_BRAILLE_SAMPLE].split())
    patterns = sum("\u2800" <= character <= "\u28ff" for character in printed)
    return patterns > 0.9 * len(printed)


def open_source(
    file: str | BinaryIO,
    *,
    name: str = "",
    form: str | None = None,
    wishes: Collection[str] = (),
    encoding: str | None = None,
    brf_table: str | None = None,
    keep_lines: bool = False,
) -> Source:
    """Open a book of any form that can be read here.

    Parameters
    ----------
    file
        Name of the file, or a stream such as standard input, which is read to its end first and
        must have a file number.
    name
        Name of the book in messages; empty for that of the file.
    form
        Name of the form that the book is in; None to find it out.
    wishes
        Options, of ``encoding`` and ``keep_lines``, that are passed over in a form that has no use
        for them.
    encoding
        Text encoding that overrides what the bytes say, for forms that are text.
    brf_table
        Display table of liblouis that says which character of a BRF file is which cell.
    keep_lines
        Whether a plain text keeps its own line breaks.

    Raises
    ------
    InputError
        If there is no such file or form, the book cannot be read, or an option is not for it.
    """
    name = name or str(file)
    stream = open_file(file) if isinstance(file, str) else keep_stream(file, name)
    options = {"encoding": encoding, "brf_table": brf_table, "keep_lines": keep_lines or None}
    try:
        found = find_format(stream, name) if form is None else named_format(form)
        if _is_empty(stream):
            # What is empty is so in all formats, and the text's sentence says so.
            found = _TEXT
        elif found in (_BRF, _UNICODE_BRAILLE) and _is_blank(stream):
            raise InputError(f"{name} has no braille in it; give a file of braille")
        return found.read(stream, name, **_fitting(found, name, options, wishes))
    except BaseException:
        stream.close()
        raise


def _fitting(
    form: Format, name: str, options: Mapping[str, str | bool | None], wishes: Collection[str]
) -> dict[str, str | bool]:
    """Options for a reader, of those that are not None, without wishes that it has no use for.

    Raises
    ------
    InputError
        If an option is not for the format.
    """
    fits = {*form.takes, "keep_lines"} if form.keeps_lines else {*form.takes}
    passed_over = {"encoding", "keep_lines"}.intersection(wishes) - fits
    if form is _BRF and "encoding" in wishes:
        passed_over.add("encoding")  # which is that of texts
    given = {
        option: value
        for option, value in options.items()
        if value is not None and option not in passed_over
    }
    if "encoding" in given:
        fits.discard("brf_table")
    for option in given:
        if option not in fits:
            raise InputError(
                f"{name} is read as {form.name}, for which there is no "
                f"{setting(option.replace('_', '-'))}; leave it out"
            )
    return {option: value for option, value in given.items() if option in form.takes}


def named_format(name: str) -> Format:
    """Format of a name; InputError with the nearest name if there is none."""
    found = {format_.name: format_ for format_ in FORMATS}
    if name.lower() not in found:
        known = nearest(name, list(found))
        raise InputError(f"there is no form of books {name!r}{known}")
    return found[name.lower()]


def _is_empty(stream: BinaryIO) -> bool:
    """Tell whether a stream ends where it begins, as that of an empty file or of a device."""
    return not stream.seek(0, io.SEEK_END)


def _is_blank(stream: BinaryIO) -> bool:
    """Tell whether a stream of ASCII characters has nothing but blanks, as far as one looks."""
    stream.seek(0)
    return not stream.read(SAMPLE_BYTES).strip(b" \t\r\n\f\x1a\0")
