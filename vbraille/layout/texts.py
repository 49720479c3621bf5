"""A text of a program's own as lines of a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.translate import Book, BrailleTable, Document, Undefined, find_table
from vbraille.translate.text import Text
from vbraille.wording import setting

if TYPE_CHECKING:
    from vbraille.braille.cells import Cells
    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display


def cells_per_line(geometry: Geometry, display: Display) -> int:
    """Number of cells that a line has on a display.

    Raises
    ------
    InputError
        If there is no room for a single cell.
    """
    try:
        return geometry.cells_per_line(display.span_mm)
    except ValueError as error:
        raise InputError(str(error)) from None


def choose_table(
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> BrailleTable:
    """Table by its name, or by a language and a grade.

    Parameters
    ----------
    language
        Language, such as "fr" or "pt-BR"; English if nothing is given.
    grade
        0 or 1 for uncontracted braille, 2 and up for contracted; None for what is usual.
    table
        Name of a liblouis table, in place of a language and grade.
    undefined
        What is written for a character that the table does not know.

    Raises
    ------
    InputError
        If there is no such table, or both a table and a language are given.
    """
    how = Undefined(undefined)
    if table is None:
        return BrailleTable(find_table("en" if language is None else language, grade), how)
    if language is not None or grade is not None:
        raise InputError(
            f"a table has its language and grade; give either {setting('table')} or those"
        )
    return BrailleTable(table, how)


def check_text(text: object) -> None:
    """Raise InputError if what is given for a text is no string."""
    if not isinstance(text, str):
        raise InputError(f"the text is {text!r:.40}; give a string")


def translate_text(
    text: str,
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> Cells:
    """Translate a text to cells, each of which knows the characters that it stands for.

    Parameters
    ----------
    text
        Text of one paragraph.
    language, grade, table, undefined
        As of `choose_table`.

    Raises
    ------
    InputError
        If something cannot be used.

    Examples
    --------
    >>> import vbraille
    >>> cells = vbraille.translate_text("the world", language="en", grade=2)
    >>> cells.to_unicode(), cells.source(0), cells.of_source(4)
    ('⠮⠀⠸⠺', (0, 3), (2, 4))
    """
    check_text(text)
    return choose_table(language, grade, table, undefined).translate(Text.of(text))


def lay_out_text(text: str, width: int, table: BrailleTable, *, keep_lines: bool = False) -> Layout:
    """Lay out a string.

    Parameters
    ----------
    text
        Text to lay out; blank lines separate its paragraphs.
    width
        Number of cells in a line.
    table
        Table by which the text is translated.
    keep_lines
        Whether each line of the text stays a line, at the margin; otherwise paragraphs are filled,
        each with an indent.

    Raises
    ------
    InputError
        If the text has nothing to show.
    """
    layout = None
    if text:
        document = Document.from_text(text, keep_lines=keep_lines)
        layout = Layout(Book(document, table), width)
    if layout is None or layout.line(1) is None:
        raise InputError("the text has nothing to read in it; give some")
    return layout
