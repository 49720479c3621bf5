"""Text in, cells out; nothing here knows of millimetres."""

from vbraille.braille.cells import Cells
from vbraille.translate.book import Book
from vbraille.translate.documents.document import Document
from vbraille.translate.documents.paragraphs import Paragraph
from vbraille.translate.languages import find_table, six_dot_table, tables_of
from vbraille.translate.liblouis import BrailleTable, TableInfo, list_tables
from vbraille.translate.undefined import Undefined

__all__ = [
    "Book",
    "BrailleTable",
    "Cells",
    "Document",
    "Paragraph",
    "TableInfo",
    "Undefined",
    "find_table",
    "list_tables",
    "six_dot_table",
    "tables_of",
]
