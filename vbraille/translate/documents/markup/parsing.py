"""Markup given to a parser piece by piece, so that no document need fit into memory."""

from __future__ import annotations

import pickle
from contextlib import closing
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Any, Protocol
from weakref import finalize

from vbraille.errors import InputError
from vbraille.translate.documents.markup.pieces import (
    PART_BYTES,
    Pieces,
    Readable,
    without_entities,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vbraille.translate.documents.markup.reader import MarkupReader
    from vbraille.translate.documents.parted import Passage


def parts_of(size: int) -> int:
    """Number of parts in which a text of so many bytes is read."""
    return max(-(-size // PART_BYTES), 1)


class Parsing:
    """A text of markup, whose passages are read part by part from its start.

    What was read once is kept in a temporary file if the text is long, since its parser cannot go
    back.

    Parameters
    ----------
    opened
        What opens the text's bytes, each time from their start.
    parts
        Number of parts, as `parts_of` gives it.
    name
        Name of the text in messages.
    reader
        What makes the reader of its events.
    xml
        Whether it is to be read as XML, as long as it is well formed.
    encoding
        Name of the encoding, if the user gives one.
    """

    def __init__(
        self,
        opened: Callable[[], Stream],
        parts: int,
        name: str,
        reader: Callable[[], MarkupReader],
        *,
        xml: bool,
        encoding: str | None = None,
    ) -> None:
        self.parts = parts
        self._opened = opened
        self._name = name
        self._make = reader
        self._xml = xml
        self._encoding = encoding
        self._offsets: list[int] = [0]  # of each part in the file, and of the next
        self._kept = TemporaryFile() if parts > 1 else None  # noqa: SIM115
        if self._kept is not None:
            finalize(self, self._kept.close)
        self._coming: Iterator[list[Passage]] | None = None
        self.pieces: Pieces | None = None
        self.reader: MarkupReader | None = None

    def part(self, number: int) -> list[Passage]:
        """Passages of a part.

        Raises
        ------
        InputError
            If the text cannot be read.
        """
        if self._kept is None:
            return [passage for found in self._read() for passage in found]
        while number >= len(self._offsets) - 1:
            if self._coming is None:
                self._coming = self._read()
            passages = next(self._coming, [])
            if len(self._offsets) == self.parts:  # the file may have grown since
                passages += [passage for found in self._coming for passage in found]
            self._kept.seek(self._offsets[-1])
            pickle.dump(passages, self._kept, pickle.HIGHEST_PROTOCOL)
            self._offsets.append(self._kept.tell())
            if number == len(self._offsets) - 2:
                return passages
        self._kept.seek(self._offsets[number])
        return pickle.load(self._kept)

    def close(self) -> None:
        """Forget what was kept."""
        if self._kept is not None:
            self._kept.close()

    def _read(self) -> Iterator[list[Passage]]:
        """Passages of each part, from the first."""
        well_formed = self._xml and self._is_well_formed()
        stream = self._opened()
        try:
            self.pieces = Pieces(stream, self._encoding)
        except InputError:
            stream.close()
            raise
        self.reader = self._make()
        texts = iter(self.pieces)
        if self._xml:
            texts = without_entities(texts, self._name)
        return _passages(stream, texts, self.reader, self._name, xml=well_formed)

    def _is_well_formed(self) -> bool:
        """Whether the text is XML, which a parser finds out that tells nobody anything."""
        from lxml import etree

        parser = _xml_parser(_Nobody())
        with closing(self._opened()) as stream:
            try:
                for text in without_entities(iter(Pieces(stream, self._encoding)), self._name):
                    if text:
                        parser.feed(text.encode())
                parser.close()
            except etree.XMLSyntaxError:
                return False
        return True


def _passages(
    stream: Stream, texts: Iterator[str], reader: MarkupReader, name: str, *, xml: bool
) -> Iterator[list[Passage]]:
    """Passages of each piece of a text, and of its end."""
    from lxml import etree

    # lxml takes any object with these methods, which its types do not say.
    target: Any = reader
    with closing(stream):
        if xml:
            parser = _xml_parser(target)
        else:
            parser = etree.HTMLParser(target=target, huge_tree=True, encoding="utf-8")
        fed = False
        try:
            for text in texts:
                if text:
                    parser.feed(text.encode())
                    fed = True
                    yield reader.take()
            if fed:
                parser.close()
        except etree.LxmlError as error:
            raise InputError(f"{name} cannot be read as markup: {error}") from None
    yield reader.take()


class Stream(Readable, Protocol):
    """Bytes that are read from the first on, and closed."""

    def close(self) -> None:
        """Close them."""
        ...


class _Nobody:
    """A parser's target that only waits for the end."""

    def close(self) -> None:
        """Take the end of the document."""


def _xml_parser(target: Any) -> Any:
    from lxml import etree

    return etree.XMLParser(
        target=target,
        encoding="utf-8",
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        huge_tree=False,
    )
