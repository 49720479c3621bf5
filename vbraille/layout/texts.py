"""A text of a program's own as lines of a page."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.layout.lines import Layout
from vbraille.layout.wrapping import wrap
from vbraille.translate import Book, text_source

if TYPE_CHECKING:
    from vbraille.braille.geometry import Geometry
    from vbraille.display import Display
    from vbraille.translate import BrailleTable


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
    if not text.strip():
        raise InputError("the text has nothing to read in it; give some")
    return Layout(Book(text_source(text, keep_lines=keep_lines), table), width)


def wrap_text(text: str, table: BrailleTable, width: int | None = None) -> list[bytes]:
    """Dot masks of the lines of a paragraph, which is one line without a width.

    Parameters
    ----------
    text
        Text of the paragraph.
    table
        Table by which it is translated.
    width
        Number of cells in a line.
    """
    words = " ".join(text.split())
    cells = table.translate(words)
    masks = cells.masks.tobytes()
    if width is None:
        return [masks]
    return [
        masks[piece.start : piece.stop]
        for piece in wrap(masks, cells.starts.tolist(), words, width)
    ]
