"""A word processor's file as a source."""

from __future__ import annotations

import hashlib
import io
import locale
import re
import sys
from collections import Counter
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, BinaryIO, cast

from vbraille.errors import InputError
from vbraille.translate.documents.office.annotations import annotation
from vbraille.translate.documents.office.officehtml import written

if TYPE_CHECKING:
    from anydoc import Document, Format

    from vbraille.translate.source import Source

LARGEST_BYTES = 200 << 20
_RTF_USUAL = re.compile(rb"\\deflang(\d{1,5})\b")
_RTF_LANGUAGE = re.compile(rb"\\lang(\d{1,5})\b")
_RTF_TITLE = re.compile(rb"\{\\title ([^{}\\]*)\}")  # of no other letters than ASCII
_RTF_HEADER_BYTES = 65_536
# A group of nothing but a text and how it looks, which is what all writers make of a small number.
_RTF_TEXT = re.compile(
    rb"\{((?>\\(?!u-?\d)[a-z]++-?+\d*+[ \r\n]?+)++)((?>[^{}\\]|\\u-?\d++ ?+|\\'[0-9a-f]{2})++)\}"
)
_RTF_SMALL = re.compile(rb"\\(super|sub)(?![a-z0-9])")


def open_office(stream: BinaryIO, name: str, form: str) -> Source:
    """Open a DOCX, ODT or RTF file.

    Parameters
    ----------
    stream
        Bytes of the file. It is read to its end and closed.
    name
        Name of the source in messages.
    form
        "docx", "odt" or "rtf".

    Raises
    ------
    InputError
        If the file is locked, damaged or too large, or what reads such files is not installed.
    """
    with stream:
        stream.seek(0)
        content = stream.read(LARGEST_BYTES + 1)
    if len(content) > LARGEST_BYTES:
        raise InputError(
            f"{name} is larger than {LARGEST_BYTES >> 20} MB, which no text is; "
            f"save it as EPUB or without its pictures"
        )
    digest = hashlib.sha256(content).hexdigest()
    from vbraille.translate.documents.html import HtmlBook

    if form in ("docx", "odt"):
        from vbraille.translate.documents.markup.archive import Archive

        archive = Archive(io.BytesIO(content), name)
        if form == "docx":
            from vbraille.translate.documents.office.docx import read_docx

            root, title, language = read_docx(archive)
        else:
            from vbraille.translate.documents.office.odt import read_odt

            root, title, language = read_odt(archive)
        return HtmlBook(root, name, digest, title=title, language=language)
    title, language = _rtf_title(content), _rtf_language(content)
    content = _RTF_TEXT.sub(_rtf_level, content)
    document = _document(content, name, form)
    html = "".join(written(document, title, language)).encode("utf-8", "replace")
    from vbraille.translate.documents.markup.tree import read_tree

    root, _ = read_tree(html, name, xml=False, encoding="utf-8")
    return HtmlBook(root, name, digest, title=title, language=language)


def _document(content: bytes, name: str, form: str) -> Document:
    try:
        import anydoc
    except ImportError:
        raise InputError(
            f"{name} is in {form.upper()}, and what reads that is not installed; "
            f"{_installing()} installs it"
        ) from None
    try:
        return anydoc.to_document(content, cast("Format", form))
    except anydoc.EncryptedError:
        raise InputError(
            f"{name} is locked with a password; open it with that and save it without one"
        ) from None
    except anydoc.ResourceLimitError as error:
        raise InputError(
            f"{name} unpacks to more than any book holds ({error.limit}); it is not opened"
        ) from None
    except (anydoc.ConvertError, UnicodeError, ValueError):
        raise InputError(
            f"{name} is damaged or no {form.upper()} file; get it again, or open it in a word "
            f"processor and save it anew"
        ) from None


def _installing() -> str:
    """Command that installs what reads such files, into the Python that runs this one."""
    pip = Path(sys.prefix) / "bin" / "pip"
    return f"{quote(str(pip))} install firecrawl-anydoc"


def _rtf_level(found: re.Match[bytes]) -> bytes:
    """A group of RTF, with an annotation if its text is a superscript or subscript."""
    small = _RTF_SMALL.search(found[1])
    if small is None:
        return found[0]
    word = b"sup" if small[1] == b"super" else b"sub"
    begin, about, end = (b"\\u%d?" % (ord(mark) - 0x10000) for mark in annotation([]))
    return b"{%s%s%s%s%s%s}" % (found[1], begin, word, about, found[2], end)


def _rtf_title(content: bytes) -> str:
    """Title of an RTF file; empty if it has none, or one that is not plain ASCII."""
    found = _RTF_TITLE.search(content[:_RTF_HEADER_BYTES])
    return "" if found is None else " ".join(found[1].decode("ascii", "ignore").split())


def _rtf_language(content: bytes) -> str:
    """Tag of the language that an RTF file says its text is in; empty if it says none."""
    usual = _RTF_USUAL.search(content[:_RTF_HEADER_BYTES])
    named = _RTF_LANGUAGE.findall(content) if usual is None else [usual[1]]
    for number, _ in Counter(map(int, named)).most_common():
        # A number below 1024 is a language's without a country, which is added here.
        tag = locale.windows_locale.get(number if number >= 0x400 else number | 0x400)
        if tag is not None:
            return tag.replace("_", "-") if number >= 0x400 else tag.partition("_")[0]
    return ""
