"""Text in, cells out; nothing here knows of millimetres."""

from vbraille.translate.book import Book
from vbraille.translate.cells import Cells
from vbraille.translate.documents import Document
from vbraille.translate.liblouis import Table, TableInfo, find_table, list_tables
from vbraille.translate.paragraphs import Paragraph

__all__ = [
    "Book",
    "Cells",
    "Document",
    "Paragraph",
    "Table",
    "TableInfo",
    "find_table",
    "list_tables",
]
