"""A book for embossers and braille displays: as BRF, PEF or eBraille, on pages or in lines."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.terminal import say_line
from vbraille.errors import InputError, VbrailleError
from vbraille.files import whole_file
from vbraille.layout.embossed import BanaPages, blocks_of, cut_pages, kept_pages, rows_of
from vbraille.layout.unknown import Unknown
from vbraille.layout.unshown import Unshown
from vbraille.translate import Undefined
from vbraille.translate.braillefiles.writing import (
    FORM_FEED,
    Imprint,
    brf_lines,
    brf_pages,
    pef,
    unicode_lines,
)
from vbraille.translate.source import BlockKind
from vbraille.wording import count, spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable, Iterable, Iterator
    from typing import BinaryIO

    from vbraille.cli.build import Page
    from vbraille.layout.embossed import Row
    from vbraille.translate import Block, Book

CELLS, LINES = 40, 25  # of a page of embossed braille, where nothing else is asked for
_MOST_CELLS, _MOST_LINES = 200, 200
_SIX_DOTS_ONLY = "give --format unicode, which writes all eight"


def embosses(arguments: argparse.Namespace) -> bool:
    """Whether the options ask for a book on pages of paper, and not for a display's lines."""
    return arguments.layout is not None or arguments.format in ("pef", "ebrl")


def check(arguments: argparse.Namespace) -> None:
    """Check that the options of pages and of files go together, before anything is read.

    Raises
    ------
    InputError
        If they do not.
    """
    given = arguments.cells
    if given is not None and not 1 <= given <= _MOST_CELLS:
        raise InputError(f"--cells is {given}; it must be 1 to {_MOST_CELLS}")
    if arguments.model is not None and (given is not None or embosses(arguments)):
        raise InputError("a page has as many cells as --cells says; leave out --model")
    if arguments.format == "ebrl":
        if arguments.out is None:
            raise InputError("eBraille is no text to print; name a file with --out BOOK.ebrl")
        if arguments.layout is not None:
            raise InputError("eBraille is laid out by who reads it; leave out --layout")
        if arguments.lines != (1, None):
            raise InputError("eBraille has no lines; leave out --lines")
    if arguments.layout is not None:
        if arguments.format in ("dots", "text"):
            raise InputError("--layout makes pages; give --format brf, pef or unicode")
        lines_per_page(arguments)
    if arguments.out is not None:
        path = Path(arguments.out)
        if path.exists() and not arguments.force:
            raise InputError(_taken(arguments.out))
        if not path.parent.is_dir():
            raise InputError(f"there is no directory {path.parent}; make it, or choose another")


def lines_per_page(arguments: argparse.Namespace) -> int:
    """Number of lines on a page; with --layout it is what --lines says."""
    if arguments.layout is None or arguments.lines == (1, None):
        return LINES
    first, last = arguments.lines
    if first != last or first > _MOST_LINES:
        raise InputError(
            f"with --layout, --lines says how many lines a page has, 1 to {_MOST_LINES}; "
            f"give one number, such as --lines {LINES}"
        )
    return first


@contextmanager
def output(arguments: argparse.Namespace) -> Iterator[Callable[[bytes], object]]:
    """Give a function that writes to the file of --out, whole or not at all, or prints.

    Raises
    ------
    InputError
        If the file cannot be made.
    VbrailleError
        If the disk cannot take it.
    """
    if arguments.out is None:
        yield lambda content: sys.stdout.write(content.decode("utf-8", "surrogatepass"))
        return
    with output_file(arguments.out, replace=arguments.force) as file:
        yield file.write


@contextmanager
def output_file(name: str, *, replace: bool) -> Iterator[BinaryIO]:
    """Open a file to be written whole, or not at all.

    Raises
    ------
    InputError
        If the file cannot be made, or is there already and may not be replaced.
    VbrailleError
        If the disk cannot take it.
    """
    path = Path(name)
    if not path.name or path.is_dir():
        raise InputError(f"{name} is a directory; give the name of a file in it")
    try:
        with whole_file(path, replace=replace) as partial:
            try:
                file = partial.open("wb")
            except OSError as error:
                raise InputError(f"{name} cannot be written: {error.strerror}") from None
            with file:
                yield file
    except FileExistsError:
        raise InputError(_taken(name)) from None
    except OSError as error:
        raise VbrailleError(f"{name} could not be written: {error.strerror}") from None


def _taken(name: str) -> str:
    return f"{name} is there already; choose another name, or replace it by --force"


def emboss(arguments: argparse.Namespace, book: Book) -> int:
    """Write a book on pages, or as eBraille; stderr is told what was made."""
    unshown = Unshown()
    table = book.table
    unknown = None if table is None else Unknown(table, Undefined(arguments.undefined))

    def see(block: Block) -> None:
        unshown.see_block(block)
        if unknown is not None:
            unknown.see_text(str(block.text))

    if arguments.format == "ebrl":
        said = _write_ebraille(arguments, book, see)
    else:
        said = _write_pages(arguments, book, see)
    _say_notes(book)
    for counter in (unknown, unshown):
        if counter is not None and counter.sentence is not None:
            say_line(spelled(counter.sentence), aside=True)
    say_line(said, aside=True)
    return 0


def _say_notes(book: Book) -> None:
    for note in book.notes():
        say_line(spelled(note), aside=True)


def _write_pages(arguments: argparse.Namespace, book: Book, see: Callable[[Block], None]) -> str:
    cells, lines = arguments.cells or CELLS, lines_per_page(arguments)
    pages: Iterable[list[Row]]
    if arguments.layout is None:  # PEF of a book that has its pages
        found = list(kept_pages(book, arguments.cells))
        pages = found
        cells = max([1, *(row.size for page in found for row in page)])
        lines = max([1, *(len(page) for page in found)])
    else:
        try:
            pages = BanaPages(book, cells, lines, see)
        except ValueError as error:
            raise InputError(str(error)) from None
    made = 0

    def counted() -> Iterator[list[Row]]:
        nonlocal made
        for page in pages:
            made += 1
            yield page

    with output(arguments) as write:
        for content in _pages_as(arguments.format, counted(), book, cells, lines):
            write(content)
        if not made:
            raise InputError(f"{book.source.name} has nothing in it to emboss; give another")
    return f"pages: {count(made, 'page')} of {lines} lines, {cells} cells each"


def _pages_as(
    how: str, pages: Iterable[list[Row]], book: Book, cells: int, lines: int
) -> Iterator[bytes]:
    if how == "pef":
        eight = book.table is not None and book.table.eight_dots
        yield from pef(pages, imprint_of(book, how, cells, lines), cells, lines, rowgap=int(eight))
    elif how == "brf":
        yield from six_dots(brf_pages(pages))
    else:
        yield from (unicode_lines(rows) + FORM_FEED for rows in pages)


def write_pef(arguments: argparse.Namespace, page: Page) -> None:
    """Write the lines of a display or of a width as PEF, so many on a page as it usually has."""
    width = page.layout.width
    pages = cut_pages(rows_of(page.lines()), LINES)
    with output(arguments) as write:
        for content in _pages_as("pef", pages, page.layout.book, width, LINES):
            write(content)


def write_kept(arguments: argparse.Namespace, book: Book) -> int:
    """Write a book that is in braille already as BRF, with the lines and pages of its file."""
    first = book.block(0)
    pages = kept_pages(book, arguments.cells)
    with output(arguments) as write:
        if first is not None and first[0].kind is BlockKind.PAGE:
            for content in six_dots(brf_pages(pages)):
                write(content)
        else:
            for made, content in enumerate(six_dots(brf_lines(rows) for rows in pages)):
                write(FORM_FEED + content if made else content)
    _say_notes(book)
    return 0


def six_dots(written: Iterable[bytes]) -> Iterator[bytes]:
    """Pass on what is written in BRF.

    Raises
    ------
    InputError
        If a cell has dots that it does not have.
    """
    try:
        yield from written
    except ValueError as error:
        raise InputError(f"{error}; {_SIX_DOTS_ONLY}") from None


def _write_ebraille(arguments: argparse.Namespace, book: Book, see: Callable[[Block], None]) -> str:
    from datetime import UTC, datetime

    from vbraille.translate.braillefiles.ebraille import Edition, write_ebraille

    def blocks() -> Iterator:
        for block, cells in blocks_of(book):
            see(block)
            yield block, cells

    now = datetime.now(UTC)
    with output_file(arguments.out, replace=arguments.force) as file:
        write_ebraille(file, blocks(), imprint_of(book, "ebrl"), Edition(book.table, now))
    return f'eBraille: creator "unknown", copyright date {now.year}; the book does not say them'


def imprint_of(book: Book, *made_with: object) -> Imprint:
    """What a file that is written from a book says of itself."""
    source, table = book.source, book.table
    name = None if table is None else table.name
    title = source.title or Path(source.name).stem
    language = source.language
    if not language and table is not None and table.info is not None:
        language = table.info.language
    return Imprint.of_file(title, language, source.sha256(), name, *made_with)
