"""Opening a book, whatever form it is in."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, BinaryIO

from vbraille.errors import InputError
from vbraille.translate.documents.document import Document
from vbraille.translate.documents.encodings import SAMPLE_BYTES
from vbraille.translate.documents.streams import keep_stream, open_file
from vbraille.translate.forms import Form, find_form
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Collection

    from vbraille.translate.source import Source

_HAVE_LINES = (Form.TEXT, Form.BRF, Form.UNICODE_BRAILLE, Form.PEF)
_HAVE_ENCODINGS = (Form.TEXT, Form.MARKDOWN, Form.HTML, Form.BRF, Form.UNICODE_BRAILLE)


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
    return _open(
        open_file(file), name or str(file), encoding, brf_table, form, wishes, keep_lines=keep_lines
    )


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
    kept = keep_stream(stream, name)
    return _open(kept, name, encoding, brf_table, form, wishes, keep_lines=keep_lines)


def named_form(name: str) -> Form:
    """Form of a name; InputError with the nearest name if there is none."""
    try:
        return Form(name.lower())
    except ValueError:
        known = nearest(name, [form.value for form in Form])
        raise InputError(f"there is no form of books {name!r}{known}") from None


def _open(
    stream: BinaryIO,
    name: str,
    encoding: str | None,
    brf_table: str | None,
    form: str | None,
    wishes: Collection[str],
    *,
    keep_lines: bool,
) -> Source:
    try:
        found = find_form(stream, name) if form is None else named_form(form)
        if _is_empty(stream):
            # What is empty is so in all forms, and the text's sentence says so.
            found = Form.TEXT
        elif found in (Form.BRF, Form.UNICODE_BRAILLE) and _is_blank(stream):
            raise InputError(f"{name} has no braille in it; give a file of braille")
        if "encoding" in wishes and (found not in _HAVE_ENCODINGS or found is Form.BRF):
            encoding = None
        keep_lines = keep_lines and (found in _HAVE_LINES or "keep_lines" not in wishes)
        for given, fits, option in (
            (encoding is not None, found in _HAVE_ENCODINGS, "encoding"),
            (brf_table is not None, found is Form.BRF and encoding is None, "brf-table"),
            (keep_lines, found in _HAVE_LINES, "keep-lines"),
        ):
            if given and not fits:
                raise InputError(
                    f"{name} is read as {found.value}, for which there is no {setting(option)}; "
                    f"leave it out"
                )
        return _read(found, stream, name, encoding, brf_table, keep_lines=keep_lines)
    except BaseException:
        stream.close()
        raise


def _is_empty(stream: BinaryIO) -> bool:
    """Whether a stream has no end but its beginning, as that of an empty file or of a device."""
    return not stream.seek(0, io.SEEK_END)


def _is_blank(stream: BinaryIO) -> bool:
    """Whether a stream of ASCII characters has nothing but blanks, as far as one looks."""
    stream.seek(0)
    return not stream.read(SAMPLE_BYTES).strip(b" \t\r\n\f\x1a\0")


def _read(
    form: Form,
    stream: BinaryIO,
    name: str,
    encoding: str | None,
    brf_table: str | None,
    *,
    keep_lines: bool,
) -> Source:
    """Open a book of a form. Readers are loaded when a book needs them."""
    match form:
        case Form.TEXT:
            return Document(stream, name, encoding, keep_lines=keep_lines)
        case Form.MARKDOWN:
            from vbraille.translate.documents.markdown import read_markdown

            return read_markdown(stream, name, encoding=encoding)
        case Form.HTML:
            from vbraille.translate.documents.html import HtmlBook

            return HtmlBook.open(stream, name, encoding=encoding)
        case Form.EPUB:
            from vbraille.translate.documents.epub import EpubBook

            return EpubBook.open(stream, name)
        case Form.DTBOOK:
            from vbraille.translate.documents.html import HtmlBook

            return HtmlBook.open(stream, name, is_dtbook=True)
        case Form.DOCX | Form.ODT | Form.RTF:
            from vbraille.translate.documents.office.officebook import open_office

            return open_office(stream, name, form.value)
        case Form.BRF if encoding is None:
            from vbraille.translate.braillefiles.lines import open_brf

            return open_brf(stream, name, table=brf_table)
        case Form.BRF | Form.UNICODE_BRAILLE:
            from vbraille.translate.braillefiles.lines import open_unicode_braille

            return open_unicode_braille(stream, name, encoding)
        case Form.PEF:
            from vbraille.translate.braillefiles.pef import PefBook

            return PefBook.open(stream, name)
