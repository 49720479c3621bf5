"""Any book in, blocks and cells out; nothing here knows of millimetres."""

from vbraille.braille.cells import Cells
from vbraille.translate.blocks import Block, BlockKind, Mark, MarkKind
from vbraille.translate.book import Book, remarks
from vbraille.translate.formats import open_source, text_source
from vbraille.translate.source import Source
from vbraille.translate.spellings import Undefined
from vbraille.translate.tables import (
    BrailleTable,
    TableInfo,
    choose_table,
    find_table,
    list_tables,
    table_of,
    tables_of,
    translate_text,
)

__all__ = [
    "Block",
    "BlockKind",
    "Book",
    "BrailleTable",
    "Cells",
    "Mark",
    "MarkKind",
    "Source",
    "TableInfo",
    "Undefined",
    "choose_table",
    "find_table",
    "list_tables",
    "open_source",
    "remarks",
    "table_of",
    "tables_of",
    "text_source",
    "translate_text",
]
