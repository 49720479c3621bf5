"""A document in braille, translated only as far as somebody reads."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vbraille.braille.cells import Cells
    from vbraille.translate.documents.document import Document
    from vbraille.translate.documents.paragraphs import Paragraph
    from vbraille.translate.liblouis import BrailleTable


class Book:
    """Paragraphs of a document with their cells.

    Parameters
    ----------
    document
        The text.
    table
        The table to translate it with.
    """

    _REMEMBERED = 16

    def __init__(self, document: Document, table: BrailleTable) -> None:
        self.document = document
        self.table = table
        self._recent: dict[int, tuple[Paragraph, Cells]] = {}

    def paragraph(self, number: int) -> tuple[Paragraph, Cells] | None:
        """Paragraph of a number, from 0, with its cells; None past the end."""
        found = self._recent.get(number)
        if found is None:
            paragraph = self.document.paragraph(number)
            if paragraph is None:
                return None
            found = paragraph, self.table.translate(paragraph)
            if len(self._recent) >= self._REMEMBERED:
                del self._recent[next(iter(self._recent))]
            self._recent[number] = found
        return found
