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

_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_SAMPLE = 65_536
_TEXT_CONTROLS = frozenset(b"\t\n\v\f\r\b\x1a\x1b\0")
# Controls, where windows-1252 has characters that browsers read; what is only for typesetters.
_ODD = re.compile("[\x80-\x9f\u00ad\u200b\ufeff]")
_TAG = re.compile(rb"<[^<>]{1,1000}>")
_NOT_ASCII = re.compile(r"[^\x00-\x7f\ufffd]")
_LONE = re.compile("[\udc80-\udcff]")  # bytes that an encoding does not have
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
    if encoding is not None:
        try:
            codecs.lookup(encoding)
            text = content.decode(encoding, "replace")
        except (LookupError, ValueError):
            raise InputError(
                f"unknown text encoding {encoding!r}; give one such as utf-8 or cp1252"
            ) from None
        return text.removeprefix("\ufeff"), ""
    for mark, name in _MARKS:
        if content.startswith(mark):
            return content[len(mark) :].decode(name, "replace"), ""
    wide = _wide(content[:4096])
    if wide:
        return content.decode(wide, "replace"), ""
    try:
        return content.decode(), ""
    except UnicodeDecodeError as error:
        wrong = error.start
    text = content.decode("utf-8", "replace")
    sample = _TAG.sub(b" ", content)
    if len(sample) > _SAMPLE:
        sample = sample[: sample.rfind(b"\n", 0, _SAMPLE) + 1] or sample[:_SAMPLE]
    beyond = sum(byte > 127 for byte in sample)
    if text.count("\ufffd") * 50 < len(_NOT_ASCII.findall(text)):
        return text, f"is UTF-8 with wrong bytes, the first at {wrong}"
    name = "cp1252"
    if beyond * 3 > len(sample):
        import charset_normalizer

        found = charset_normalizer.from_bytes(sample).best()
        name = found.encoding if found else name
    text = content.decode(name, "surrogateescape" if name != "utf_16" else "replace")
    # A byte that the encoding does not have is taken as windows-1252.
    text = _LONE.sub(lambda found: bytes([ord(found[0]) & 0xFF]).decode("cp1252", "replace"), text)
    note = (
        f"is not UTF-8 at byte {wrong}, and is read as {name}; {setting('encoding')} names another"
    )
    return text, note


def _wide(sample: bytes) -> str:
    """UTF-16 if zeros stand where a mostly Western text has them; otherwise nothing."""
    odd, even = sample[1::2].count(0), sample[::2].count(0)
    if (odd + even) * 3 <= len(sample) or min(odd, even) * 10 > len(sample):
        return ""
    return "utf-16-le" if odd > even else "utf-16-be"


def is_binary(sample: bytes) -> bool:
    """Tell whether the beginning of a file shows that it is no text."""
    if sample.startswith(tuple(mark for mark, _ in _MARKS)) or _wide(sample):
        return False
    controls = sum(byte < 32 and byte not in _TEXT_CONTROLS for byte in sample) + sample.count(0)
    return controls > 1 + len(sample) / 20


def tidy(text: str) -> str:
    r"""Text as blocks have it: accents with their letters, without soft hyphens and C1 controls.

    >>> tidy("e\u0301te\u0301 Schiff\u00adfahrt \x93x\x94")
    'été Schifffahrt “x”'
    """
    if text.isascii():
        return text
    text = _ODD.sub(_evened, text)
    return _ACCENTED.sub(lambda found: unicodedata.normalize("NFC", found[0]), text)


def _evened(found: re.Match[str]) -> str:
    code = ord(found[0])
    return bytes([code]).decode("cp1252", "ignore") if code < 0xA0 else ""
