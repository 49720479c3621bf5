"""How to open the same book once more, in another process."""

from __future__ import annotations

import msgspec

from vbraille.layout.texts import choose_table
from vbraille.translate import Book, Undefined
from vbraille.translate.opening import open_source
from vbraille.translate.source import Index


class BookOpening(msgspec.Struct, frozen=True):
    """How a book is opened, as plain values that go through a pipe.

    Parameters
    ----------
    file
        Path of the file.
    descriptor
        Number of an open file that has the text, such as what standard input gave, in place of
        a path; None for a path.
    name
        Name of the book in messages; empty for the path.
    encoding, keep_lines, form, brf_table
        As the reader opened the book.
    table, language, grade
        Braille table; or None, and the language and grade by which it is chosen. With a table,
        these are what the reader chose, by which passages in other languages are translated.
    switch
        Whether passages in other languages are translated by the tables of those languages.
    undefined
        What is written for characters that the table does not know.
    index
        Index of the source, as far as it is known.
    """

    file: str = ""
    descriptor: int | None = None
    name: str = ""
    encoding: str | None = None
    keep_lines: bool = False
    form: str | None = None
    brf_table: str | None = None
    table: str | None = None
    language: str | None = None
    grade: int | None = None
    switch: bool = True
    undefined: str = "mark"
    index: Index | None = None


def open_again(opening: BookOpening) -> Book:
    """Open a book as the reader has it open.

    Raises
    ------
    InputError
        If the book or its table cannot be opened.
    """
    # A path of its own gives the process a place of its own in the file.
    path = opening.file if opening.descriptor is None else f"/proc/self/fd/{opening.descriptor}"
    source = open_source(
        path,
        name=opening.name or opening.file,
        encoding=opening.encoding,
        keep_lines=opening.keep_lines,
        brf_table=opening.brf_table,
        form=opening.form,
        wishes=("encoding", "keep_lines"),  # the reader has the book open with them
    )
    if opening.index is not None:
        source.adopt(opening.index)
    if source.in_cells:
        return Book(source)
    undefined = Undefined(opening.undefined)
    named = None if opening.table else opening.language
    table = choose_table(named, None if opening.table else opening.grade, opening.table, undefined)
    return Book(
        source,
        table,
        language=opening.language or "",
        grade=opening.grade,
        switch=opening.switch,
    )
