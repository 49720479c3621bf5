"""Formats of books: one table of them, how a book's bytes show which it is in, and opening it."""

from __future__ import annotations

import io
import re
import tomllib
from functools import partial
from importlib import import_module
from pathlib import Path, PurePath
from typing import TYPE_CHECKING, Any, BinaryIO

from vbraille.errors import InputError
from vbraille.translate.archive import MOST_BYTES, Archive
from vbraille.translate.encodings import decode, is_binary
from vbraille.translate.plain import text_blocks
from vbraille.translate.source import Source
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Collection

# The function that reads a format's blocks, as a module of this package and a name in it, which is
# loaded when a book needs it; and the options of `open_source` that it takes.
_READERS = {
    "text": "plain:read_text encoding keep_lines",
    "markdown": "markdown:read_markdown encoding",
    "html": "html:read_html encoding",
    "epub": "epub:read_epub",
    "dtbook": "html:read_html",
    "docx": "docx:read_docx",
    "odt": "odt:read_odt",
    "rtf": "rtf:read_rtf",
    "brf": "braillefiles:read_brf encoding",
    "unicode-braille": "braillefiles:read_brf encoding",
    "pef": "braillefiles:read_pef",
}
_SHOWN_BY = tomllib.loads(Path(__file__).with_name("formats.toml").read_text("utf-8"))
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
        if found not in _READERS:
            raise InputError(f"unknown file format {form!r}{nearest(found, _READERS)}")
        reader, *takes = _READERS[found].split()
        given = {"encoding": encoding, "keep_lines": keep_lines or None}
        options: dict[str, Any] = {}
        for option, value in given.items():
            if option in takes and value is not None:
                options[option] = value
            elif value is not None and option not in wishes:
                raise InputError(
                    f"{name} is read as {found}, for which there is no "
                    f"{setting(option.replace('_', '-'))}; leave it out"
                )
        stream.seek(0)
        module, _, function = reader.partition(":")
        read = getattr(import_module(f"vbraille.translate.{module}"), function)
        return Source(name, found, stream, partial(read, **options))
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
        archive = Archive(stream, name)
        kind = archive.read_if("mimetype").decode("ascii", "replace")
        return _shown("zips", name, kind, *archive.members)
    text, _ = decode(sample)
    root = _ROOT.match(text)
    names = (root[1].lower(), root[1].lower().rpartition(":")[2]) if root else ()
    whole = sample + stream.read() if sample.startswith(_OLE) else sample
    head = whole.decode("latin-1").replace("\0", "")
    found = _shown("beginnings", name, head, *(f"<{each}>" for each in names))
    printed = "".join(text[:4096].split())
    braille = sum("\u2800" <= character <= "\u28ff" for character in printed)
    if not found and braille > 0.9 * len(printed):
        found = "unicode-braille"
    found = found or _shown("endings", name, PurePath(name).suffix.lower())
    found = found or _shown("others", name, head)
    if not found and is_binary(sample):
        raise InputError(f"{name} is binary data, not text; give a book or a text file")
    return found or "text"


def _shown(by: str, name: str, *texts: str) -> str:
    """Name of the format that something about a file shows; empty if it shows none.

    Raises
    ------
    InputError
        If it shows that the file cannot be read here.
    """
    for pattern, told in _SHOWN_BY[by].items():
        if any(re.match(pattern, text, re.S) for text in texts):
            if told in _READERS:
                return told
            raise InputError(f"{name} is {told}")
    return ""
