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
    from collections.abc import Iterable, Iterator

    from vbraille.cli.build import Page
    from vbraille.layout import Line
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
    from vbraille.cli.build import build_book

    form = chosen["format"]
    if chosen["model"] is not None and (chosen["cells"] is not None or form == "pef"):
        raise InputError("a page has as many cells as --cells says; leave out --model")
    _check_out(chosen)
    book = build_book(ctx)
    if form == "brf" and book.table is not None and book.table.eight_dots:
        raise InputError(_eight_dots(book))
    asked = chosen["cells"] or chosen["out"] or form == "pef"
    shown = chosen["lines"] != (1, None) or any(chosen[name] for name in _SHOWN)
    if book.source.in_cells and form in ("brf", "pef") and asked and not shown:
        _write_kept(chosen, book)
    else:
        _write_laid(ctx, chosen, book)


def _check_out(chosen: dict[str, Any]) -> None:
    """Check that the file can be made, before anything is read.

    Raises
    ------
    InputError
        If it cannot.
    """
    from vbraille.files import check_unused

    if chosen["out"] is None:
        return
    out = Path(chosen["out"])
    if out.is_dir():
        raise InputError(f"{out} is a directory; give the name of a file in it")
    if not out.parent.is_dir():
        raise InputError(f"there is no directory {out.parent}; make it, or use another")
    check_unused(out, replace=chosen["force"])


def _write_laid(ctx: click.Context, chosen: dict[str, Any], book: Book) -> None:
    """Write lines as they are laid out for a display or for a number of cells."""
    from vbraille.cli.build import Page, build_model
    from vbraille.render import MODELS

    form = chosen["format"]
    width = chosen["cells"] or (_CELLS if form == "pef" else None)
    page = Page(ctx, book, build_model(ctx, MODELS[chosen["model"] or "stress2"]), width)
    _write(chosen, _laid(page, form))
    page.say_end()


def _laid(page: Page, form: str) -> Iterable[bytes]:
    from vbraille.layout.writing import pef

    if form != "pef":
        return (f"{_printed(line, form)}\n".encode() for line in page.lines())
    rows = [line.masks.tobytes() for line in page.lines()]
    pages = [rows[at : at + _LINES] for at in range(0, len(rows), _LINES)]
    width, book = page.layout.width, page.layout.book
    return pef(pages, _head(book, width, _LINES), width, _LINES, rowgap=_rowgap(book))


def _printed(line: Line, form: str) -> str:
    if form == "text":
        from vbraille.wording import printable

        return printable(line.text)
    cells = line.printed
    return {"unicode": cells.to_unicode, "brf": cells.to_brf, "dots": cells.to_dots}[form]()


def _write_kept(chosen: dict[str, Any], book: Book) -> None:
    """Write a book that is in braille already, with the lines and pages of its file."""
    from vbraille.layout.writing import FORM_FEED, brf, kept_pages, pef
    from vbraille.translate import BlockKind
    from vbraille.wording import count

    pages, said = kept_pages(book, chosen["cells"]), ""
    if chosen["format"] == "pef":
        cells = max([1, *(len(row) for page in pages for row in page)])
        lines = max([1, *(len(page) for page in pages)])
        content = pef(pages, _head(book, cells, lines), cells, lines, rowgap=_rowgap(book))
        said = f"pages: {count(len(pages), 'page')} of {lines} lines, {cells} cells each"
    else:
        first = book.source.block(0)
        content = brf(pages, FORM_FEED if first and first.kind is BlockKind.PAGE else b"")
    _write(chosen, content)
    for note in (*book.source.notes(), *filter(None, [said])):
        say(note, aside=True)


def _write(chosen: dict[str, Any], contents: Iterable[bytes]) -> None:
    """Write a page to the file of --out, whole or not at all, or print it part by part.

    Raises
    ------
    InputError
        If the page cannot be written in this form, or the file cannot be made.
    VbrailleError
        If the disk cannot take it.
    """
    from vbraille.files import write_file

    parts = _checked(contents)
    if chosen["out"] is not None:
        write_file(Path(chosen["out"]), b"".join(parts), replace=chosen["force"])
        return
    for part in parts:
        sys.stdout.write(part.decode("utf-8", "replace"))


def _checked(contents: Iterable[bytes]) -> Iterator[bytes]:
    """Pass on what is written; InputError if a cell has dots that BRF does not have."""
    try:
        yield from contents
    except ValueError as error:
        raise InputError(f"{error}; give --format unicode, which writes all eight") from None


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
    from vbraille.translate import six_dot_table

    table = book.table
    assert table is not None
    other = None if table.info is None else six_dot_table(table.info.language)
    instead = f"give --table {other}, which has six, or" if other else "give"
    return (
        f"the table {table.name} has eight dots and BRF has six; "
        f"{instead} --format unicode, which writes all eight"
    )
