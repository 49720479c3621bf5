"""Text in, cells out; nothing here knows of millimetres."""

from vbraille.braille.cells import Cells
from vbraille.translate.book import Book
from vbraille.translate.documents.document import Document
from vbraille.translate.languages import find_table, six_dot_table, tables_of
from vbraille.translate.liblouis import BrailleTable, TableInfo, list_tables
from vbraille.translate.source import Block, BlockKind, Source, Text
from vbraille.translate.substitutes import Undefined

__all__ = [
    "Block",
    "BlockKind",
    "Book",
    "BrailleTable",
    "Cells",
    "Document",
    "Source",
    "TableInfo",
    "Text",
    "Undefined",
    "find_table",
    "list_tables",
    "six_dot_table",
    "tables_of",
]
