"""Pages of cells as BRF and PEF files, each in one strict form; pages as a braille file has them.

A page is its rows from the top, and a row the dot masks of its cells from the left margin.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.braille.spelling import to_braille
from vbraille.layout.lines import wrap
from vbraille.translate.blocks import BlockKind
from vbraille.translate.braillefiles import DUBLIN_CORE, PEF_NAMESPACE

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from vbraille.translate.book import Book

FORM_FEED, _BLANK = b"\f", b"\0"
_NOT_XML = re.compile("[^\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def kept_pages(book: Book, width: int | None = None) -> list[list[bytes]]:
    """Pages of a book that is in braille already, with the lines that its file has.

    Parameters
    ----------
    book
        Book of ready cells.
    width
        Number of cells in a line, beyond which a line runs over, two cells in; None for lines of
        any width.
    """
    pages: list[list[bytes]] = []
    for block in book.source.blocks():
        if block.kind is BlockKind.PAGE or not pages:
            pages.append([])
        cells = book.cells(block)
        if width is not None and len(cells) > width:
            lines = wrap(block, cells, width, (0, min(2, width // 2)))
            pages[-1] += [line.masks.tobytes() for line in lines]
        elif block.kind is not BlockKind.PAGE:
            pages[-1].append(cells.masks.tobytes())
    return pages


def brf(pages: Iterable[Iterable[bytes]], end: bytes = FORM_FEED) -> Iterator[bytes]:
    """Write pages as BRF: each line ends with a line feed, and each page with a form feed.

    Characters are those from 0x20 to 0x5F, capitals among them, and no line ends in a blank.

    Raises
    ------
    ValueError
        If a cell has dot 7 or 8, which BRF cannot write.
    """
    for rows in pages:
        for row in rows:
            yield Cells.bare(np.frombuffer(row.rstrip(_BLANK), np.uint8)).to_brf().encode() + b"\n"
        yield end


def pef(
    pages: Iterable[Iterable[bytes]],
    head: dict[str, str],
    columns: int,
    rows: int,
    *,
    rowgap: int = 0,
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
        f"      <dc:{name}>{escape(_NOT_XML.sub('�', value))}</dc:{name}>\n"
        for name, value in said.items()
        if value
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
