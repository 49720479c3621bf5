"""Formats of books: one table of them, how a book's bytes show which it is in, and opening it."""

from __future__ import annotations

import io
import re
import tomllib
from functools import partial
from importlib import import_module
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

from vbraille.errors import InputError
from vbraille.translate.archive import MOST_BYTES, Archive
from vbraille.translate.encodings import decode, is_binary
from vbraille.translate.plain import text_blocks
from vbraille.translate.source import Source
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Collection


class Format(NamedTuple):
    """A format of books.

    Attributes
    ----------
    reader : str
        Function that reads its blocks, as a module of this package and a name in it. It is loaded
        when a book needs it.
    suffixes : tuple of str
        Ends of files' names, for those whose bytes do not show it.
    takes : tuple of str
        Options of `open_source` that the reader takes.
    """

    reader: str
    suffixes: tuple[str, ...] = ()
    takes: tuple[str, ...] = ()


_FORMATS = {
    "text": Format("plain:read_text", takes=("encoding", "keep_lines")),
    "markdown": Format("markdown:read_markdown", (".md", ".markdown"), ("encoding",)),
    "html": Format("html:read_html", (".html", ".htm", ".xhtml"), ("encoding",)),
    "epub": Format("epub:read_epub"),
    "dtbook": Format("html:read_html"),
    "docx": Format("docx:read_docx"),
    "odt": Format("odt:read_odt"),
    "rtf": Format("rtf:read_rtf"),
    "brf": Format("braillefiles:read_brf", (".brf", ".brl"), ("encoding", "brf_table")),
    "unicode-braille": Format("braillefiles:read_brf", takes=("encoding",)),
    "pef": Format("braillefiles:read_pef", (".pef",)),
}
_KEEP_LINES = ("brf", "unicode-braille", "pef")  # whatever is asked for
_ROOTS = {"html": "html", "head": "html", "title": "html", "body": "html"}
_ROOTS |= {"dtbook": "dtbook", "pef": "pef"}
_UNLIKE = tomllib.loads(Path(__file__).with_name("unlike.toml").read_text("utf-8"))
_PICTURE = _UNLIKE["roots"]["svg"]
_PICTURE_SUFFIXES = (".scene", ".svg", ".svgz", ".gen", ".tx")
# A scene is TOML that says how large its canvas is.
_SCENE = re.compile(r"\A(?:\s*#.*\n)*\s*[\w\[].*?^(?:\[canvas\]|canvas[ \t]*=)", re.M | re.S)
_OLE = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"
_BEFORE_ROOT = r"(?:\s+|<\?.*?\?>|<!--.*?-->)*"
_ROOT = re.compile(_BEFORE_ROOT + r"<(?:!doctype\s+)?([\w.:-]+)(?=[\s/>\[])", re.I | re.S)
_SAMPLE = 65_536


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
    """Open a book of any format that can be read here.

    Parameters
    ----------
    file
        Name of the file, or a stream such as standard input, which is read to its end first.
    name
        Name of the book in messages; empty for that of the file.
    form
        Name of the format that the book is in; None to find it out.
    wishes
        Options, of ``encoding`` and ``keep_lines``, that are passed over in a format that has no
        use for them.
    encoding
        Text encoding that overrides what the bytes say, for formats that are text.
    brf_table
        Display table of liblouis that says which character of a BRF file is which cell.
    keep_lines
        Whether a plain text keeps its own line breaks.

    Raises
    ------
    InputError
        If there is no such file or format, the book cannot be read, or an option is not for it.
    """
    name = name or str(file)
    stream = _stream(file, name)
    try:
        found = find_format(stream, name) if form is None else form.lower()
        if found not in _FORMATS:
            raise InputError(f"unknown file format {form!r}{nearest(found, _FORMATS)}")
        given = {"encoding": encoding, "brf_table": brf_table, "keep_lines": keep_lines or None}
        options = _fitting(found, name, given, wishes)
        stream.seek(0)
        module, _, function = _FORMATS[found].reader.partition(":")
        reader = getattr(import_module(f"vbraille.translate.{module}"), function)
        return Source(name, found, stream, partial(reader, **options))
    except BaseException:
        stream.close()
        raise


def text_source(text: str, *, keep_lines: bool = False, name: str = "the text") -> Source:
    """Make a source of a string; blank lines part its paragraphs.

    Raises
    ------
    InputError
        If there is nothing in it.
    """
    if not text.strip():
        raise InputError(f"{name} has nothing to read in it; give some")
    reader = partial(text_blocks, text=text, keep_lines=keep_lines)
    return Source(name, "text", io.BytesIO(text.encode("utf-8", "replace")), reader)


def _stream(file: str | BinaryIO, name: str) -> BinaryIO:
    """Stream that can seek; a file that may be large stays on the disk if it is an archive."""
    try:
        if not isinstance(file, str):
            content = file.read(MOST_BYTES + 1)
        else:
            path = Path(file)
            if path.is_dir() or path.is_char_device():
                what = "directory; give a file in it" if path.is_dir() else "device; give a file"
                raise InputError(f"{name} is a {what}")
            with path.open("rb") as stream:
                content = stream.read(4)
                if path.is_file() and content.startswith(b"PK"):
                    return path.open("rb")
                content += stream.read(MOST_BYTES)
    except FileNotFoundError:
        raise InputError(f"there is no file {name}; check the name") from None
    except (OSError, ValueError) as error:
        said = getattr(error, "strerror", None) or error
        raise InputError(f"{name} cannot be read: {said}") from None
    if len(content) > MOST_BYTES:
        raise InputError(f"{name} has more than {MOST_BYTES / 1e6:.0f} MB; give a part of it")
    if not content:
        raise InputError(f"{name} is empty; give a file with text in it")
    return io.BytesIO(content)


def _fitting(
    form: str, name: str, given: dict[str, Any], wishes: Collection[str]
) -> dict[str, Any]:
    """Options for a reader, of those that are given.

    Raises
    ------
    InputError
        If an option is not for the format.
    """
    options = {option: value for option, value in given.items() if value is not None}
    if form in _KEEP_LINES:
        options.pop("keep_lines", None)
    for option in list(options):
        fits = option in _FORMATS[form].takes
        if option in wishes and (not fits or form == "brf"):
            del options[option]
        elif not fits:
            raise InputError(
                f"{name} is read as {form}, for which there is no "
                f"{setting(option.replace('_', '-'))}; leave it out"
            )
    return options


def find_format(stream: BinaryIO, name: str) -> str:
    """Name of the format of a book; plain text for all that is nothing else.

    Parameters
    ----------
    stream
        Bytes of the book; the stream must be able to seek.
    name
        Name of the file, by whose ending formats are told apart that look alike.

    Raises
    ------
    InputError
        If it is a book that cannot be read here, or no text at all.
    """
    stream.seek(0)
    sample = stream.read(_SAMPLE)
    if sample.startswith(b"PK"):
        return _zipped(stream, name)
    if sample.startswith(b"{\\rtf"):
        return "rtf"
    refused = _refused(stream, sample)
    if refused:
        raise InputError(f"{name} is {refused}")
    text, _ = decode(sample)
    root = _ROOT.match(text)
    if root is not None:
        for found in (root[1].lower(), root[1].lower().rpartition(":")[2]):
            if found in _UNLIKE["roots"]:
                raise InputError(f"{name} is {_UNLIKE['roots'][found]}")
            if found in _ROOTS:
                return _ROOTS[found]
    printed = "".join(text[:4096].split())
    if sum("\u2800" <= character <= "\u28ff" for character in printed) > 0.9 * len(printed):
        return "unicode-braille" if printed else "text"
    suffix = PurePath(name).suffix.lower()
    by_suffix = [form for form, row in _FORMATS.items() if suffix in row.suffixes]
    if suffix in _PICTURE_SUFFIXES or (not by_suffix and _SCENE.match(text)):
        raise InputError(f"{name} is {_PICTURE}")
    kind = _unlike("binary", sample) or ("binary data" if is_binary(sample) else "")
    if kind and not by_suffix:
        raise InputError(f"{name} is {kind}, not text; give a book or a text file")
    return [*by_suffix, "text"][0]


def _unlike(where: str, sample: bytes) -> str:
    """End of a sentence on a file whose bytes begin so; empty for others."""
    for beginning, said in _UNLIKE[where].items():
        if sample.startswith(beginning.encode("latin-1")):
            return said
    return ""


def _refused(stream: BinaryIO, sample: bytes) -> str:
    """End of a sentence on a book that cannot be read here; empty for others."""
    said = _unlike("beginnings", sample)
    if said:
        return said
    if sample[60:68] in (b"BOOKMOBI", b"TEXtREAd"):
        return "a Kindle book (MOBI); save it as EPUB, without Amazon's lock if it has one"
    if not sample.startswith(_OLE):
        return ""
    stream.seek(0)
    content = stream.read()
    names = _UNLIKE["ole"].items()
    return next(said for name, said in names if name.encode("utf-16-le") in content)


def _zipped(stream: BinaryIO, name: str) -> str:
    """Name of the format of a zip archive's book.

    Raises
    ------
    InputError
        If it holds none that can be read here.
    """
    archive = Archive(stream, name)
    members = archive.members
    kind = archive.read_if("mimetype").decode("ascii", "replace").strip()
    if kind in ("application/epub+zip", "application/ebrl+zip"):
        return "epub"
    if kind.startswith("application/vnd.oasis.opendocument.text"):
        return "odt"
    if "META-INF/container.xml" in members or "package.opf" in members:
        return "epub"  # a book without its mimetype is one nevertheless
    if "[Content_Types].xml" in members and any(each.startswith("word/") for each in members):
        return "docx"
    for beginning, said in _UNLIKE["zips"].items():
        if any(member.startswith(beginning) for member in members):
            raise InputError(f"{name} is {said}")
    if kind.startswith("application/vnd.oasis.opendocument."):
        raise InputError(f"{name} is an OpenDocument file, not a text; save it as ODT or HTML")
    if any(member.lower().endswith(".opf") for member in members):
        raise InputError(
            f"{name} is a zip archive of a DAISY book; unpack it and give its XML file"
        )
    raise InputError(f"{name} is a zip archive, not text; unpack it and give the file in it")
