"""Characters of a file of markup, piece by piece: its encoding, its beginning, its entities."""

from __future__ import annotations

import re
from html.entities import html5
from typing import TYPE_CHECKING, Protocol

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import (
    SAMPLE_BYTES,
    Encoding,
    TextDecoder,
    find_encoding,
    named_encoding,
)
from vbraille.wording import printable, setting

if TYPE_CHECKING:
    from collections.abc import Iterator

PART_BYTES = 131_072  # what is read at a time, and makes a part of a long text
_LONGEST_BEGINNING = 1_048_576  # characters before the first element
_LONGEST_NAME = 40  # characters of an entity's name
_DECLARED = re.compile(
    rb"""(?:<\?xml[^>]*?encoding|<meta[^>]*?charset)\s*=\s*["']?\s*([\w.:-]+)""", re.I
)
_ENTITY = re.compile(r"&([A-Za-z_][\w.-]*);")
_PLAIN = frozenset(("amp", "lt", "gt", "quot", "apos"))
_DECLARATION = re.compile(
    r"<!ENTITY\s+(?P<name>[\w.:-]+)\s+(?:(?P<outside>SYSTEM|PUBLIC)|(?P<quote>[\"'])"
    r"(?P<value>.*?)(?P=quote))",
    re.S,
)
_BEFORE_ROOT = re.compile(r"\s*(?:<\?.*?\?>|<!--.*?-->)", re.S)
_STRING = re.compile(r"\"[^\"]*\"|'[^']*'|<!--.*?-->|[\[\]>]", re.S)
_SURROGATE = re.compile("[\ud800-\udfff]")


class Readable(Protocol):
    """Bytes that are read from the first on."""

    def read(self, size: int, /) -> bytes:
        """Read so many bytes, or fewer; none only at the end."""
        ...


def markup_encoding(sample: bytes, named: str | None = None) -> Encoding:
    """Encoding of markup that begins with these bytes.

    A name that is given decides, then a byte-order mark, then what the markup declares, then what
    a plain text with these bytes would be in.

    Raises
    ------
    InputError
        If the name that is given is of no encoding.
    """
    if named is not None:
        encoding = named_encoding(named, sample)
        if encoding is None:
            raise InputError(
                f"there is no text encoding {printable(named)!r}; try windows-1252, latin-1 or "
                f"utf-16"
            )
        return encoding
    found = find_encoding(sample)
    declared = _DECLARED.search(sample[:4096])
    if found.skip or found.name.startswith(("utf-16", "utf-32")) or declared is None:
        return found
    encoding = named_encoding(declared[1].decode("ascii", "replace"), sample)
    if encoding is None or encoding.name.startswith(("utf-16", "utf-32")):
        return found  # the bytes could be read so far, which that encoding would not allow
    # The two names mean the larger one in every browser.
    return Encoding("cp1252") if encoding.name in {"iso8859-1", "ascii"} else encoding


class Pieces:
    """Characters of a stream, read once from its start.

    Parameters
    ----------
    stream
        Bytes, of which as many are read as are asked for.
    named
        Name of the encoding, if the user gives one.

    Attributes
    ----------
    encoding : Encoding
        How the bytes are read.
    first_bad : int or None
        Offset of the first byte that could not be read so.

    Raises
    ------
    InputError
        If the name is of no encoding.
    """

    def __init__(self, stream: Readable, named: str | None = None) -> None:
        self._stream = stream
        self._sample = _read(stream, max(SAMPLE_BYTES, PART_BYTES))
        self.encoding = markup_encoding(self._sample[:SAMPLE_BYTES], named)
        self._decoder = TextDecoder(self.encoding.name)
        self._offset = 0

    def __iter__(self) -> Iterator[str]:
        piece = self._sample
        while True:
            following = _read(self._stream, PART_BYTES) if piece else b""
            skip = self.encoding.skip if not self._offset else 0
            text = self._decoder.decode(piece[skip:], self._offset + skip, final=not following)
            self._offset += len(piece)
            yield _SURROGATE.sub("\ufffd", text)
            if not following:
                return
            piece = following

    @property
    def first_bad(self) -> int | None:
        """Offset of the first byte that could not be read so."""
        return self._decoder.first_bad

    def note(self, name: str) -> str | None:
        """Note on bytes that are not of the encoding; None if there are none so far."""
        if self.first_bad is None:
            return None
        return (
            f"{name} is not {self.encoding.name} at byte {self.first_bad}; such bytes are read as "
            f"windows-1252, {setting('encoding')} NAME says otherwise"
        )


def without_entities(pieces: Iterator[str], name: str) -> Iterator[str]:
    """Pieces of XML without its declarations, and with characters in the place of entities.

    A parser then has no entities to expand and nothing to look up elsewhere. An entity that is
    declared nowhere is left as it is written.

    Raises
    ------
    InputError
        If entities are declared by others, or are to be looked up elsewhere.
    """
    beginning = ""
    entities: dict[str, str] = {}
    for piece in pieces:
        beginning += piece
        cut = _root(beginning)
        if cut is not None:
            start, after = cut
            entities = _declared(beginning[start:after], name)
            beginning = beginning[after:]
            break
        if len(beginning) > _LONGEST_BEGINNING:
            raise InputError(f"{name} declares too much before it begins; give another copy of it")

    def put(found: re.Match[str]) -> str:
        name = found[1]
        if name in _PLAIN:
            return found[0]
        value = entities.get(name) or html5.get(f"{name};")
        if value is None:
            return f"&amp;{name};"
        return "".join(f"&#{ord(c)};" for c in value)

    yield _ENTITY.sub(put, beginning[: (at := _unfinished(beginning))])
    held = beginning[at:]
    for piece in pieces:
        text = held + piece
        at = _unfinished(text)
        yield _ENTITY.sub(put, text[:at])
        held = text[at:]
    yield _ENTITY.sub(put, held)


def _root(text: str) -> tuple[int, int] | None:
    """Where the document type begins and ends, after which there is the first element.

    The result is None if that is not known yet; both are the same if there is no type.
    """
    at = 0
    while found := _BEFORE_ROOT.match(text, at):
        at = found.end()
    at += len(text[at:]) - len(text[at:].lstrip("\ufeff \t\r\n"))
    begins = text[at : at + 9]
    if begins.upper() != "<!DOCTYPE":
        unknown = len(begins) < 9 or begins.startswith(("<?", "<!--"))
        return None if unknown else (at, at)
    depth = 0
    for found in _STRING.finditer(text, at):
        if found[0] == "[":
            depth += 1
        elif found[0] == "]":
            depth -= 1
        elif found[0] == ">" and depth <= 0:
            return at, found.end()
    return None


def _declared(doctype: str, name: str) -> dict[str, str]:
    """Characters of the entities that a document type declares."""
    entities: dict[str, str] = {}
    for found in _DECLARATION.finditer(doctype):
        if found["outside"]:
            continue  # it stays as it is written
        value = re.sub(
            r"&#(?:x([0-9a-fA-F]{1,6})|([0-9]{1,7}));",
            lambda number: _character(int(number[1] or number[2], 16 if number[1] else 10)),
            found["value"],
        )
        if re.search(r"[&%]\w+;", value) or len(value) > 256:
            raise InputError(
                f"{name} defines entities by other entities, which could fill the memory; "
                f"give a copy of the book without them"
            )
        entities.setdefault(found["name"], value)
    return entities


def _character(code: int) -> str:
    return chr(code) if code < 0x110000 and not 0xD800 <= code < 0xE000 else "\ufffd"


def _unfinished(text: str) -> int:
    """Where an entity begins that the text may break off in; its length if there is none."""
    at = text.rfind("&", max(len(text) - _LONGEST_NAME, 0))
    return at if at >= 0 and ";" not in text[at:] else len(text)


def _read(stream: Readable, size: int) -> bytes:
    """Read so many bytes, fewer only at the end."""
    parts, left = [], size
    while left and (part := stream.read(left)):
        parts.append(part)
        left -= len(part)
    return b"".join(parts)
