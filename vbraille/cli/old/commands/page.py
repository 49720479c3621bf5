"""``vbraille page``."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.old.build import build_book, build_lengths, lay_out
from vbraille.cli.old.terminal import say_line
from vbraille.config.options import CHOICE_OF_TABLE
from vbraille.config.settings import settle
from vbraille.errors import InputError
from vbraille.files import check_unused, write_file
from vbraille.layout.braillepages import (
    FORM_FEED,
    Imprint,
    brf_lines,
    brf_pages,
    cut_pages,
    kept_pages,
    pef,
)
from vbraille.render import MODELS
from vbraille.translate.source import BlockKind
from vbraille.wording import count, printable, spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Iterator

    from vbraille.cli.old.build import Page
    from vbraille.layout.pages import Line
    from vbraille.translate import Book

_CELLS, _LINES = 40, 25  # of a page of paper, where nothing else is asked for


def run(arguments: argparse.Namespace) -> int:
    """Print the lines, or write them to a file."""
    settle(arguments, CHOICE_OF_TABLE)
    _check(arguments)
    book = build_book(arguments, six_dots=arguments.format == "brf")
    if _keeps_pages(arguments, book):
        _write_kept(arguments, book)
    else:
        _write_laid(arguments, book)
    return 0


def _check(arguments: argparse.Namespace) -> None:
    """Check that the options go together, before anything is read.

    Raises
    ------
    InputError
        If they do not.
    """
    cells, out = arguments.cells, arguments.out
    if arguments.model is not None and (cells is not None or arguments.format == "pef"):
        raise InputError("a page has as many cells as --cells says; leave out --model")
    if out is not None:
        check_unused(Path(out), replace=arguments.force)
        if Path(out).is_dir():
            raise InputError(f"{out} is a directory; give the name of a file in it")
        if not Path(out).parent.is_dir():
            raise InputError(f"there is no directory {Path(out).parent}; make it, or use another")


def _keeps_pages(arguments: argparse.Namespace, book: Book) -> bool:
    """Tell if a book in braille is written with its own lines and pages, on no display's lines."""
    asked = arguments.cells or arguments.out or arguments.format == "pef"
    shown = arguments.model or arguments.geometry or arguments.lines != (1, None)
    return bool(book.source.in_cells and arguments.format in ("brf", "pef") and asked and not shown)


def _write_laid(arguments: argparse.Namespace, book: Book) -> None:
    """Write lines as they are laid out for a display or for a number of cells."""
    width = arguments.cells or (_CELLS if arguments.format == "pef" else None)
    model = build_lengths(arguments, MODELS[arguments.model or "stress2"])
    page = lay_out(arguments, book, model, width)
    _write(arguments, _laid(page, arguments.format))
    page.say_note()
    page.say_unknown()


def _laid(page: Page, how: str) -> Iterable[bytes]:
    if how != "pef":
        return (f"{_format(line, how)}\n".encode("utf-8", "surrogatepass") for line in page.lines())
    pages = cut_pages((line.masks for line in page.lines()), _LINES)
    width, book = page.layout.width, page.layout.book
    return pef(pages, _imprint_of(book, width, _LINES), width, _LINES, rowgap=_rowgap(book))


def _write_kept(arguments: argparse.Namespace, book: Book) -> None:
    """Write a book that is in braille already, with the lines and pages of its file."""
    pages = kept_pages(book, arguments.cells)
    said = None
    if arguments.format == "pef":
        found = list(pages)
        if not found:
            raise InputError(f"{book.source.name} has nothing in it to emboss; give another")
        cells = max([1, *(row.size for page in found for row in page)])
        lines = max([1, *(len(page) for page in found)])
        content = pef(found, _imprint_of(book, cells, lines), cells, lines, rowgap=_rowgap(book))
        said = f"pages: {count(len(found), 'page')} of {lines} lines, {cells} cells each"
    elif (first := book.block(0)) is not None and first[0].kind is BlockKind.PAGE:
        content = brf_pages(pages)
    else:
        content = (FORM_FEED * (made > 0) + brf_lines(rows) for made, rows in enumerate(pages))
    _write(arguments, content)
    for note in filter(None, (*book.notes(), said)):
        say_line(spelled(note), aside=True)


def _checked(contents: Iterable[bytes]) -> Iterator[bytes]:
    """Pass on what is written.

    Raises
    ------
    InputError
        If a cell has dots that BRF does not have.
    """
    try:
        yield from contents
    except ValueError as error:
        raise InputError(f"{error}; give --format unicode, which writes all eight") from None


def _write(arguments: argparse.Namespace, contents: Iterable[bytes]) -> None:
    """Write a page to the file of --out, whole or not at all, or print it part by part.

    Raises
    ------
    InputError
        If the page cannot be written in this form, or the file cannot be made.
    VbrailleError
        If the disk cannot take it.
    """
    parts = _checked(contents)
    if arguments.out is not None:
        write_file(Path(arguments.out), b"".join(parts), replace=arguments.force)
        return
    for part in parts:
        sys.stdout.write(part.decode("utf-8", "surrogatepass"))


def _imprint_of(book: Book, cells: int, lines: int) -> Imprint:
    """Say of a file that is written from a book which book it is, and how it was made."""
    source, table = book.source, book.table
    language = source.language
    if not language and table is not None and table.info is not None:
        language = table.info.language
    title = source.title or Path(source.name).stem
    made_with = (None if table is None else table.name, "pef", cells, lines)
    return Imprint.of_file(title, language, source.sha256(), *made_with)


def _rowgap(book: Book) -> int:
    return int(book.table is not None and book.table.eight_dots)


def _format(line: Line, how: str) -> str:
    if how == "text":
        return printable(line.text)
    if how == "dots":
        return line.printed.to_dots()
    if how == "unicode":
        return line.printed.to_unicode()
    return line.printed.to_brf()
