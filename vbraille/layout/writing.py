"""Pages of cells as BRF and PEF files, each in one strict form; pages as a braille file has them.

A page is its rows from the top, and a row the dot masks of its cells from the left margin.
"""

from __future__ import annotations

import hashlib
import uuid
from itertools import islice
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.braille.spelling import to_braille
from vbraille.layout.wrapping import wrap
from vbraille.translate.blocks import BlockKind
from vbraille.translate.braillefiles import DUBLIN_CORE, PEF_NAMESPACE
from vbraille.wording import printable

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from vbraille.translate.book import Book

    Rows = Sequence[bytes]

FORM_FEED, _BLANK = b"\f", b"\0"


def cut_pages(rows: Iterable[bytes], lines: int) -> Iterator[list[bytes]]:
    """Cut rows into pages of a number of lines, the last of which may be shorter."""
    rows = iter(rows)
    while page := list(islice(rows, lines)):
        yield page


def kept_pages(book: Book, width: int | None = None) -> Iterator[list[bytes]]:
    """Pages of a book that is in braille already, with the lines that its file has.

    Parameters
    ----------
    book
        Book of ready cells.
    width
        Number of cells in a line, beyond which a line runs over, two cells in; None for lines of
        any width.
    """
    page: list[bytes] | None = None
    for block in book.source.blocks():
        if block.kind is BlockKind.PAGE:
            if page is not None:
                yield page
            page = []
            continue
        page = [] if page is None else page
        masks = book.cells(block).masks.tobytes()
        if width is None or len(masks) <= width:
            page.append(masks)
        else:
            places = range(len(masks))
            for piece in wrap(masks, places, block.text, width, 0, min(2, width // 2)):
                page.append(bytes(piece.indent) + masks[piece.start : piece.stop])
    if page is not None:
        yield page


def brf_pages(pages: Iterable[Rows]) -> Iterator[bytes]:
    """Write pages as BRF: each line ends with a line feed, and each page with a form feed.

    Characters are those from 0x20 to 0x5F, capitals among them, and no line ends in a blank.

    Raises
    ------
    ValueError
        If a cell has dot 7 or 8, which BRF cannot write.
    """
    for rows in pages:
        yield brf_lines(rows) + FORM_FEED


def brf_lines(rows: Iterable[bytes]) -> bytes:
    """Write lines of cells as BRF, without the end of a page.

    Raises
    ------
    ValueError
        If a cell has dot 7 or 8, which BRF cannot write.
    """
    lines = (Cells.bare(np.frombuffer(row.rstrip(_BLANK), np.uint8)).to_brf() for row in rows)
    return "".join(f"{line}\n" for line in lines).encode("ascii")


def identifier(sha256: str, *made_with: object) -> str:
    """Name that a written book has, and no other: of its file, and what decides on its cells."""
    whole = hashlib.sha256(repr((sha256, *made_with)).encode()).digest()
    return f"urn:uuid:{uuid.UUID(bytes=whole[:16], version=4)}"


def pef(
    pages: Iterable[Rows], head: dict[str, str], columns: int, rows: int, *, rowgap: int = 0
) -> Iterator[bytes]:
    """Write pages as PEF 2008-1, in one volume of one section, on one side of the paper.

    Parameters
    ----------
    pages
        Pages, at least one.
    head
        What the file says of itself: its ``identifier``, ``title`` and ``language``.
    columns, rows
        Numbers of cells in a row and of rows on a page that the largest has at most.
    rowgap
        Distance between rows, in distances of dots; eight-dot braille needs 1.
    """
    said = {"format": "application/x-pef+xml", **head}
    meta = "".join(
        f"      <dc:{name}>{escaped(value)}</dc:{name}>\n" for name, value in said.items() if value
    )
    yield (
        f'<?xml version="1.0" encoding="UTF-8"?>\n<pef version="2008-1" xmlns="{PEF_NAMESPACE}">\n'
        f'  <head>\n    <meta xmlns:dc="{DUBLIN_CORE}">\n{meta}    </meta>\n  </head>\n  <body>\n'
        f'    <volume cols="{columns}" rows="{rows}" rowgap="{rowgap}" duplex="false">\n'
        f"      <section>\n"
    ).encode()
    for page in pages:
        inner = "".join(f"          <row>{to_braille(row.rstrip(_BLANK))}</row>\n" for row in page)
        yield f"        <page>\n{inner}        </page>\n".encode()
    yield b"      </section>\n    </volume>\n  </body>\n</pef>\n"


def escaped(text: str) -> str:
    """Text as XML has it, with the control characters named that XML cannot have."""
    plain = printable(" ".join(text.split())).encode("utf-8", "replace").decode()
    return escape(plain.replace("\ufffe", "\ufffd").replace("\uffff", "\ufffd"), {'"': "&quot;"})
