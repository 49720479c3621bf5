"""``vbraille page``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say
from vbraille.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vbraille.cli.build import Page
    from vbraille.translate import Book

_CELLS, _LINES = 40, 25  # of a page of paper, where nothing else is asked for
_SHOWN = ("model", "travel", "geometry")  # what lays a book in braille out anew


@options.command(
    "page book.txt --format brf --out book.brf",
    options.file,
    options.option("--format", type=click.Choice(["unicode", "brf", "pef", "dots", "text"]),
                   default="unicode", show_default=True, help="Form of the lines."),
    options.out, options.force,
    options.cells(group=options.FIRST),
    options.lines, options.language, options.grade,
    *options.TRANSLATION[2:], options.model, options.travel, *options.DISTANCES, options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **chosen: Any) -> None:
    """A book in braille keeps its own lines and pages in BRF and PEF."""
    from vbraille.cli.build import Page, build_book, build_model
    from vbraille.files import check_unused, write_file
    from vbraille.render import MODELS

    form = chosen["format"]
    if chosen["model"] is not None and (chosen["cells"] is not None or form == "pef"):
        raise InputError("a page has as many cells as --cells says; leave out --model")
    if chosen["out"] is not None:
        check_unused(Path(chosen["out"]), replace=chosen["force"])
    book = build_book(ctx)
    if form == "brf" and book.table is not None and book.table.eight_dots:
        raise InputError(_eight_dots(book))
    asked = chosen["cells"] or chosen["out"] or form == "pef"
    shown = chosen["lines"] != (1, None) or any(chosen[name] for name in _SHOWN)
    if book.source.in_cells and form in ("brf", "pef") and asked and not shown:
        content, said = _kept(book, form, chosen["cells"])
    else:
        width = chosen["cells"] or (_CELLS if form == "pef" else None)
        page = Page(ctx, book, build_model(ctx, MODELS[chosen["model"] or "stress2"]), width)
        content, said = _laid(page, form), page.remarks()
    try:
        if chosen["out"] is None:
            for part in content:
                sys.stdout.write(part.decode("utf-8", "replace"))
        else:
            write_file(Path(chosen["out"]), b"".join(content), replace=chosen["force"])
    except ValueError as error:  # a cell has dots that BRF does not have
        raise InputError(f"{error}; give --format unicode, which writes all eight") from None
    for note in said:
        say(note, aside=True)


def _laid(page: Page, form: str) -> Iterable[bytes]:
    """Write lines as they are laid out for a display or for a number of cells."""
    from vbraille.braille.cells import Cells
    from vbraille.layout.writing import pef
    from vbraille.wording import printable

    if form == "pef":
        rows = [line.masks.tobytes() for line in page.lines()]
        pages = [rows[at : at + _LINES] for at in range(0, len(rows), _LINES)]
        width, book = page.layout.width, page.layout.book
        yield from pef(pages, _head(book, width, _LINES), width, _LINES, rowgap=_rowgap(book))
        return
    for line in page.lines():
        cells = Cells.bare(line.masks)
        if form == "text":
            text = printable(line.text)
        elif form == "brf":
            text = cells.to_brf()
        else:
            text = cells.to_dots() if form == "dots" else cells.to_unicode()
        yield f"{text}\n".encode()


def _kept(book: Book, form: str, width: int | None) -> tuple[Iterable[bytes], list[str]]:
    """Write a book that is in braille with the lines and pages of its file; notes on it."""
    from vbraille.layout.writing import FORM_FEED, brf, kept_pages, pef
    from vbraille.translate import BlockKind
    from vbraille.wording import count

    pages = kept_pages(book, width)
    notes = [*book.source.notes()]
    if form == "brf":
        first = book.source.block(0)
        return brf(pages, FORM_FEED if first and first.kind is BlockKind.PAGE else b""), notes
    cells = max([1, *(len(row) for page in pages for row in page)])
    lines = max([1, *map(len, pages)])
    notes.append(f"pages: {count(len(pages), 'page')} of {lines} lines, {cells} cells each")
    return pef(pages, _head(book, cells, lines), cells, lines, rowgap=_rowgap(book)), notes


def _head(book: Book, cells: int, lines: int) -> dict[str, str]:
    """Facts that a file says of itself which is written from a book."""
    source, table = book.source, book.table
    info = None if table is None else table.info
    made_by = "braille" if table is None else table.name
    return {
        "identifier": f"{source.sha256()} {made_by} {cells}x{lines}",  # no other book's
        "title": source.title or Path(source.name).stem,
        "language": source.language or (info.language if info else ""),
    }


def _rowgap(book: Book) -> int:
    return int(book.table is not None and book.table.eight_dots)


def _eight_dots(book: Book) -> str:
    """Sentence on a table of eight dots where only six can be written."""
    from vbraille.translate import table_of

    table = book.table
    assert table is not None
    other = table_of(table.info.language)
    instead = "give"
    if other is not None and not other.eight_dots:
        instead = f"give --table {other.name}, which has six, or"
    return (
        f"the table {table.name} has eight dots and BRF has six; "
        f"{instead} --format unicode, which writes all eight"
    )
