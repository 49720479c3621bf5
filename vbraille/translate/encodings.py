"""Bytes of a text file to text."""

from __future__ import annotations

import codecs
import re
import unicodedata
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.translate.source import Source

_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF32_LE: "utf-32",
    codecs.BOM_UTF32_BE: "utf-32",
    codecs.BOM_UTF16_LE: "utf-16",
    codecs.BOM_UTF16_BE: "utf-16",
}
_SAMPLE = 65_536
_TEXT_CONTROLS = frozenset(b"\t\n\v\f\r\b\x1a\x1b\0")
# Controls, where windows-1252 has characters that browsers read; what is only for typesetters.
_ODD = {code: bytes([code]).decode("cp1252", "ignore") for code in range(0x80, 0xA0)}
_ODD |= dict.fromkeys((0xAD, 0x200B, 0xFEFF), "")
_TAG = re.compile(rb"<[^<>]{1,1000}>")
_ACCENTED = re.compile("[^\u0300-\u036f\u3099\u309a][\u0300-\u036f\u3099\u309a]+")


def read_text_of(source: Source, encoding: str | None) -> str:
    """Text of a book's file, with a note on the book if the encoding is a guess."""
    text, note = decode(source.stream.read(), encoding)
    if note:
        source.note(f"{source.name} {note}")
    return text


def decode(content: bytes, encoding: str | None = None) -> tuple[str, str]:
    """Text of a file.

    A byte-order mark decides; else UTF-8, if it is that; else windows-1252, or what is likeliest
    where most bytes are not ASCII.

    Parameters
    ----------
    content
        Bytes of the file.
    encoding
        Name of an encoding that overrides what the bytes say.

    Returns
    -------
    text, note : str
        The text, and the end of a sentence on its encoding if that is a guess.

    Raises
    ------
    InputError
        If there is no such encoding.
    """
    marked = (name for mark, name in _MARKS.items() if content.startswith(mark))
    if encoding := encoding or next(marked, None):
        try:
            return content.decode(encoding, "replace").removeprefix("\ufeff"), ""
        except (LookupError, ValueError):
            raise InputError(
                f"unknown text encoding {encoding!r}; give one such as utf-8 or cp1252"
            ) from None
    try:
        return content.decode(), ""
    except UnicodeDecodeError as error:
        wrong = error.start
    text = content.decode("utf-8", "replace")
    if text.count("\ufffd") * 50 < len(text) - sum(map(str.isascii, text)):
        return text, f"is UTF-8 with wrong bytes, the first at {wrong}"
    sample = _TAG.sub(b" ", content)[:_SAMPLE]
    sample = sample.rpartition(b"\n")[0] or sample  # characters may have several bytes
    name = "cp1252"
    if sum(byte > 127 for byte in sample) * 3 > len(sample):
        import charset_normalizer

        found = charset_normalizer.from_bytes(sample).best()
        name = found.encoding if found else name
    return content.decode(name, "replace"), (
        f"is not UTF-8 at byte {wrong}, and is read as {name}; {setting('encoding')} names another"
    )


def is_binary(sample: bytes) -> bool:
    """Tell whether the beginning of a file shows that it is no text."""
    controls = sum(byte < 32 and byte not in _TEXT_CONTROLS for byte in sample) + sample.count(0)
    return controls > 1 + len(sample) / 20 and not sample.startswith(tuple(_MARKS))


def tidy(text: str) -> str:
    r"""Text as blocks have it: accents with their letters, without soft hyphens and C1 controls.

    >>> tidy("e\u0301te\u0301 Schiff\u00adfahrt \x93x\x94")
    'été Schifffahrt “x”'
    """
    return _ACCENTED.sub(lambda found: unicodedata.normalize("NFC", found[0]), text.translate(_ODD))
