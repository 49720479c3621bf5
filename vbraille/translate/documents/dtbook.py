"""A DTBook of DAISY 3 as a source: HTML by other names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate.documents.html import HtmlBook
from vbraille.translate.documents.markup.dtbooknames import DTBOOK

if TYPE_CHECKING:
    from typing import BinaryIO, Self


class DtbookBook(HtmlBook):
    """A file of DTBook, the markup of DAISY 3, as a `Source`; for the parameters see `HtmlBook`."""

    begins = DTBOOK

    @classmethod
    def open(cls, stream: BinaryIO, name: str, encoding: str | None = None) -> Self:
        """Open a file, whose stream is the book's from then on.

        Raises
        ------
        InputError
            If it cannot be read, holds no text, or the encoding is unknown.
        """
        return cls(stream, name, encoding)
