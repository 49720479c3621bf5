"""A word processor's file as a source."""

from __future__ import annotations

import hashlib
import io
from typing import TYPE_CHECKING, BinaryIO

from vbraille.translate.documents.html import HtmlBook, read_whole
from vbraille.translate.documents.markup.archive import Archive
from vbraille.translate.documents.office.docx import read_docx
from vbraille.translate.documents.office.odt import read_odt
from vbraille.translate.documents.office.rtf import read_rtf

if TYPE_CHECKING:
    from vbraille.translate.source import Source


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
        If the file is locked, damaged or too large.
    """
    content = read_whole(stream, name, LARGEST_BYTES)
    if form == "rtf":
        root, title, language = read_rtf(content, name)
    else:
        read = read_docx if form == "docx" else read_odt
        root, title, language = read(Archive(io.BytesIO(content), name))
    digest = hashlib.sha256(content).hexdigest()
    return HtmlBook(root, name, digest, title=title, language=language)


LARGEST_BYTES = 200_000_000  # with its pictures
