"""A file of HTML as a source, parsed only as far as somebody reads."""

from __future__ import annotations

import hashlib
import io
from functools import partial
from typing import TYPE_CHECKING, BinaryIO
from urllib.parse import unquote
from weakref import finalize

from vbraille.errors import InputError
from vbraille.translate.documents.markup.elements import BEGINS
from vbraille.translate.documents.markup.parsing import Parsing, parts_of
from vbraille.translate.documents.markup.pieces import PART_BYTES
from vbraille.translate.documents.markup.reader import MarkupReader
from vbraille.translate.documents.parted import PartedSource

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Self

    from vbraille.translate.documents.markup.elements import Begin
    from vbraille.translate.documents.parted import Passage


class HtmlBook(PartedSource):
    """A file of HTML or XHTML as a `Source`.

    A long file is parsed in parts, each after the one before it.

    Parameters
    ----------
    stream
        Bytes of the file; the stream must be able to seek.
    name
        Name of the source in messages.
    encoding
        Encoding that overrides what the bytes say: its name.
    digest
        SHA-256 of the file that the markup was made from, in hexadecimal; that of the bytes if
        they are the file.
    title, language
        Title and language that are given beside the markup, and go before what it says.

    Raises
    ------
    InputError
        If it cannot be read, holds no text, or the encoding is unknown.
    """

    begins: Mapping[str, Begin] = BEGINS

    def __init__(
        self,
        stream: BinaryIO,
        name: str,
        encoding: str | None = None,
        *,
        digest: str | None = None,
        title: str = "",
        language: str = "",
    ) -> None:
        self._stream = stream
        finalize(self, stream.close)  # before the collector looks at the stream, and complains
        size, found = digest_of(stream, name)
        parts = parts_of(size)
        super().__init__(name, [1] * parts, digest or found, title=title, language=language)
        self._noted = False
        self._any = False
        # Nothing here refers to the book, so that the file is closed once the book is forgotten.
        self._parsing = Parsing(
            partial(Rewound, stream),
            parts,
            name,
            partial(MarkupReader, local_target, language=language, begins=self.begins),
            xml=is_xml(stream),
            encoding=encoding,
        )
        self._first: list[Passage] | None = list(self.passages(0))
        reader = self._parsing.reader
        if reader is not None:
            self.title = self.title or reader.title
            self.language = self.language or reader.root_language

    @classmethod
    def open(cls, stream: BinaryIO, name: str, encoding: str | None = None) -> Self:
        """Open a file, whose stream is the book's from then on.

        Raises
        ------
        InputError
            If it cannot be read, holds no text, or the encoding is unknown.
        """
        return cls(stream, name, encoding)

    def passages(self, part: int) -> list[Passage]:
        """Read a part.

        Raises
        ------
        InputError
            If it cannot be read, or the whole file holds no text.
        """
        first = getattr(self, "_first", None)
        if part == 0 and first is not None:
            self._first = None  # it was parsed for the title already
            return first
        found = self._parsing.part(part)
        self._any = self._any or any(passage.text for passage in found)
        if part == self.parts - 1 and not self._any and not self._before(part):
            raise InputError(
                f"{self.name} holds no text that can be read: all of it is hidden, or made by "
                f"scripts; give a file that has its text in it"
            )
        return found

    def note(self) -> str | None:
        """Note on bytes that are not of the encoding, given once after one is found."""
        pieces = self._parsing.pieces
        if self._noted or pieces is None:
            return None
        note = pieces.note(self.name)
        self._noted = note is not None
        return note

    def close(self) -> None:
        """Close the file; it is closed in any case when the book is forgotten."""
        self._stream.close()

    def _before(self, part: int) -> bool:
        """Whether there is text in the parts before one."""
        return any(passage.text for before in range(part) for passage in self._parsing.part(before))


class Rewound(io.RawIOBase):
    """A stream read from its start, which stays open when this is closed.

    Parameters
    ----------
    stream
        The stream, which others may read in the meantime.
    """

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._offset = 0

    def readable(self) -> bool:
        """Tell that it can be read."""
        return True

    def read(self, size: int = -1) -> bytes:
        """Read so many bytes, or fewer."""
        self._stream.seek(self._offset)
        found = self._stream.read(size)
        self._offset += len(found)
        return found


def local_target(address: str) -> str:
    """Target of a link: an anchor's name is written as itself, another address as it is."""
    return f"#{unquote(address[1:])}" if address.startswith("#") else address


def is_xml(stream: BinaryIO) -> bool:
    """Whether a file says in its first bytes that it is XML."""
    stream.seek(0)
    return stream.read(64).removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<?xml")


def digest_of(stream: BinaryIO, name: str) -> tuple[int, str]:
    """Size of a file in bytes, and its SHA-256 in hexadecimal.

    Raises
    ------
    InputError
        If it is empty or cannot be read.
    """
    digest, size = hashlib.sha256(), 0
    try:
        stream.seek(0)
        while piece := stream.read(PART_BYTES):
            digest.update(piece)
            size += len(piece)
    except OSError as error:
        raise InputError(f"{name} cannot be read: {error.strerror or error}") from None
    if not size:
        raise InputError(f"{name} is empty; give a file with text in it")
    return size, digest.hexdigest()
