"""Text in, cells out; nothing here knows of millimetres."""

from vbraille.translate.book import Book
from vbraille.translate.cells import Cells
from vbraille.translate.documents import Document
from vbraille.translate.languages import find_table, six_dot_table, tables_of
from vbraille.translate.liblouis import Table, TableInfo, list_tables
from vbraille.translate.paragraphs import Paragraph
from vbraille.translate.undefined import Undefined

__all__ = [
    "Book",
    "Cells",
    "Document",
    "Paragraph",
    "Table",
    "TableInfo",
    "Undefined",
    "find_table",
    "list_tables",
    "six_dot_table",
    "tables_of",
]
