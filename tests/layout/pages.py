"""Texts laid out in lines, for tests of lines and of places in them."""

from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document


def lay_out(text: str, table: BrailleTable, width: int = 26, *, keep_lines: bool = False) -> Layout:
    return Layout(Book(Document.from_text(text, keep_lines=keep_lines), table), width)


def brf(layout: Layout) -> list[str]:
    return [line.printed.to_brf() for line in layout.lines()]
