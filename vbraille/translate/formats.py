"""Formats of books: one table of them, how a book's bytes show which it is in, and opening it."""

from __future__ import annotations

import io
import re
from dataclasses import dataclass
from pathlib import PurePath
from typing import TYPE_CHECKING, BinaryIO, NamedTuple

from vbraille.errors import InputError
from vbraille.translate.documents.document import Document
from vbraille.translate.documents.encodings import (
    SAMPLE_BYTES,
    find_encoding,
    keep_stream,
    open_file,
)
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable
    from zipfile import ZipFile

    from vbraille.translate.source import Source


class FormatOptions(NamedTuple):
    """Options of a user on how a file is read; see `open_source`."""

    encoding: str | None = None
    keep_lines: bool = False
    brf_table: str | None = None


@dataclass(frozen=True, slots=True)
class Format:
    """A format of books.

    Parameters
    ----------
    name
        Name by which an option calls it.
    read
        Function that opens a book: of its bytes, its name in messages, and options.
    suffixes
        Ends of files' names, for those whose bytes do not show it.
    root
        Name of the first element, where it is markup.
    has_lines, has_encodings
        Whether lines can be kept, and an encoding be named.
    """

    name: str
    read: Callable[[BinaryIO, str, FormatOptions], Source]
    suffixes: tuple[str, ...] = ()
    root: str = ""
    has_lines: bool = False
    has_encodings: bool = False


# Readers are loaded when a book needs them.


def _read_text(stream: BinaryIO, name: str, options: FormatOptions) -> Source:
    return Document(stream, name, options.encoding, keep_lines=options.keep_lines)


def _read_markdown(stream: BinaryIO, name: str, options: FormatOptions) -> Source:
    from vbraille.translate.documents.markdown import read_markdown

    return read_markdown(stream, name, encoding=options.encoding)


def _read_html(stream: BinaryIO, name: str, options: FormatOptions) -> Source:
    from vbraille.translate.documents.html import HtmlBook

    return HtmlBook.open(stream, name, encoding=options.encoding)


def _read_dtbook(stream: BinaryIO, name: str, options: FormatOptions) -> Source:  # noqa: ARG001
    from vbraille.translate.documents.html import HtmlBook

    return HtmlBook.open(stream, name, is_dtbook=True)


def _read_epub(stream: BinaryIO, name: str, options: FormatOptions) -> Source:  # noqa: ARG001
    from vbraille.translate.documents.epub import EpubBook

    return EpubBook.open(stream, name)


def _office(form: str) -> Callable[[BinaryIO, str, FormatOptions], Source]:
    def read(stream: BinaryIO, name: str, options: FormatOptions) -> Source:  # noqa: ARG001
        from vbraille.translate.documents.office.officebook import open_office

        return open_office(stream, name, form)

    return read


def _read_brf(stream: BinaryIO, name: str, options: FormatOptions) -> Source:
    from vbraille.translate.braillefiles.lines import open_brf

    if options.encoding is not None:
        return _read_unicode_braille(stream, name, options)
    return open_brf(stream, name, table=options.brf_table)


def _read_unicode_braille(stream: BinaryIO, name: str, options: FormatOptions) -> Source:
    from vbraille.translate.braillefiles.lines import open_unicode_braille

    return open_unicode_braille(stream, name, options.encoding)


def _read_pef(stream: BinaryIO, name: str, options: FormatOptions) -> Source:  # noqa: ARG001
    from vbraille.translate.braillefiles.pef import PefBook

    return PefBook.open(stream, name)


_TEXT = Format("text", _read_text, has_lines=True, has_encodings=True)
_EPUB = Format("epub", _read_epub)  # EPUB 2 and 3, and eBraille, which is made like one
_DOCX, _ODT, _RTF = (Format(name, _office(name)) for name in ("docx", "odt", "rtf"))
_BRF = Format("brf", _read_brf, (".brf", ".brl"), has_lines=True, has_encodings=True)
_UNICODE_BRAILLE = Format(
    "unicode-braille", _read_unicode_braille, has_lines=True, has_encodings=True
)
_HTML = Format("html", _read_html, (".html", ".htm", ".xhtml"), "html", has_encodings=True)
FORMATS = (
    _TEXT,
    Format("markdown", _read_markdown, (".md", ".markdown"), has_encodings=True),
    _HTML,
    _EPUB,
    Format("dtbook", _read_dtbook, root="dtbook"),
    _DOCX,
    _ODT,
    _RTF,
    _BRF,
    _UNICODE_BRAILLE,
    Format("pef", _read_pef, (".pef",), "pef", has_lines=True),
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
    file: str,
    *,
    name: str = "",
    encoding: str | None = None,
    keep_lines: bool = False,
    brf_table: str | None = None,
    form: str | None = None,
    wishes: Collection[str] = (),
) -> Source:
    """Open a book of any form that can be read here.

    Parameters
    ----------
    file
        Name of the file.
    name
        Name of the book in messages; empty for that of the file.
    encoding
        Text encoding that overrides what the bytes say, for forms that are text.
    keep_lines
        Whether a plain text keeps its own line breaks.
    brf_table
        Display table of liblouis that says which character of a BRF file is which cell.
    form
        Name of the form that the book is in; None to find it out.
    wishes
        Options, of ``encoding`` and ``keep_lines``, that are passed over in a form that has no use
        for them.

    Raises
    ------
    InputError
        If there is no such file or form, the book cannot be read, or an option is not for it.
    """
    options = FormatOptions(encoding, keep_lines, brf_table)
    return _open(open_file(file), name or str(file), options, form, wishes)


def open_stream(
    stream: BinaryIO,
    name: str,
    *,
    encoding: str | None = None,
    keep_lines: bool = False,
    brf_table: str | None = None,
    form: str | None = None,
    wishes: Collection[str] = (),
) -> Source:
    """Open a book that a stream gives, such as standard input; it is read to its end first.

    Parameters
    ----------
    stream
        Bytes of the book. It must have a file number.
    name
        Name of the book in messages.
    encoding, keep_lines, brf_table, form, wishes
        As in `open_source`.

    Raises
    ------
    InputError
        If the stream or the book cannot be read, there is no such form, or an option is not for it.
    """
    options = FormatOptions(encoding, keep_lines, brf_table)
    return _open(keep_stream(stream, name), name, options, form, wishes)


def named_format(name: str) -> Format:
    """Format of a name; InputError with the nearest name if there is none."""
    found = {format_.name: format_ for format_ in FORMATS}
    if name.lower() not in found:
        known = nearest(name, list(found))
        raise InputError(f"there is no form of books {name!r}{known}")
    return found[name.lower()]


def _open(
    stream: BinaryIO, name: str, options: FormatOptions, form: str | None, wishes: Collection[str]
) -> Source:
    encoding, keep_lines, brf_table = options
    try:
        found = find_format(stream, name) if form is None else named_format(form)
        if _is_empty(stream):
            # What is empty is so in all formats, and the text's sentence says so.
            found = _TEXT
        elif found in (_BRF, _UNICODE_BRAILLE) and _is_blank(stream):
            raise InputError(f"{name} has no braille in it; give a file of braille")
        if "encoding" in wishes and (not found.has_encodings or found is _BRF):
            encoding = None
        keep_lines = keep_lines and (found.has_lines or "keep_lines" not in wishes)
        for given, fits, option in (
            (encoding is not None, found.has_encodings, "encoding"),
            (brf_table is not None, found is _BRF and encoding is None, "brf-table"),
            (keep_lines, found.has_lines, "keep-lines"),
        ):
            if given and not fits:
                raise InputError(
                    f"{name} is read as {found.name}, for which there is no {setting(option)}; "
                    f"leave it out"
                )
        return found.read(stream, name, FormatOptions(encoding, keep_lines, brf_table))
    except BaseException:
        stream.close()
        raise


def _is_empty(stream: BinaryIO) -> bool:
    """Tell whether a stream ends where it begins, as that of an empty file or of a device."""
    return not stream.seek(0, io.SEEK_END)


def _is_blank(stream: BinaryIO) -> bool:
    """Tell whether a stream of ASCII characters has nothing but blanks, as far as one looks."""
    stream.seek(0)
    return not stream.read(SAMPLE_BYTES).strip(b" \t\r\n\f\x1a\0")
