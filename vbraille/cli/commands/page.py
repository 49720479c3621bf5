"""``vbraille page``."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from vbraille.cli import embossing
from vbraille.cli.build import build_book, build_lengths, lay_out
from vbraille.cli.settled import TRANSLATION, settle
from vbraille.errors import InputError
from vbraille.render import MODELS
from vbraille.translate.ahead import BookAhead
from vbraille.wording import printable

if TYPE_CHECKING:
    import argparse

    from vbraille.layout.pages import Line
    from vbraille.translate import Book

_USUAL_WORKERS, _MOST_WORKERS = 4, 64  # with more than four, laying out takes the longest


def run(arguments: argparse.Namespace) -> int:
    """Print the lines, or write them to a file."""
    settle(arguments, TRANSLATION)
    embossing.check(arguments)
    workers = _workers(arguments)
    book = build_book(arguments, six_dots=arguments.format == "brf")
    with BookAhead(book, workers) as ahead:
        return _write(arguments, ahead)


def _write(arguments: argparse.Namespace, book: Book) -> int:
    if _keeps_pages(arguments, book) and arguments.format == "brf":
        return embossing.write_kept(arguments, book)
    if arguments.layout or arguments.format == "ebrl" or _keeps_pages(arguments, book):
        return embossing.emboss(arguments, book)
    width = arguments.cells or (embossing.CELLS if arguments.format == "pef" else None)
    model = build_lengths(arguments, MODELS[arguments.model or "stress2"])
    page = lay_out(arguments, book, model, width)
    if arguments.format == "pef":
        embossing.write_pef(arguments, page)
    else:
        with embossing.output(arguments) as write:
            for line in page.lines():
                write(f"{_format(line, arguments.format)}\n".encode("utf-8", "surrogatepass"))
    page.say_note()
    page.say_unknown()
    return 0


def _workers(arguments: argparse.Namespace) -> int:
    """Number of processes that translate a long book.

    Raises
    ------
    InputError
        If the option is out of range.
    """
    asked = arguments.workers
    if asked is not None:
        if not 1 <= asked <= _MOST_WORKERS:
            raise InputError(f"--workers is {asked}; it must be 1 to {_MOST_WORKERS}")
        return asked
    if arguments.layout is None and arguments.lines[1] is not None:
        return 1  # others would translate what nobody wants
    return min(len(os.sched_getaffinity(0)), _USUAL_WORKERS)


def _keeps_pages(arguments: argparse.Namespace, book: Book) -> bool:
    """Whether a book in braille is written with its own lines and pages, on no display's lines."""
    asked = arguments.cells or arguments.out or arguments.format == "pef"
    shown = arguments.model or arguments.geometry or arguments.lines != (1, None)
    in_files = arguments.format in ("brf", "pef") and arguments.layout is None
    return bool(book.source.in_cells and in_files and asked and not shown)


def _format(line: Line, how: str) -> str:
    if how == "text":
        return printable(line.text)
    if how == "dots":
        return line.printed.to_dots()
    if how == "unicode":
        return line.printed.to_unicode()
    try:
        return line.printed.to_brf()
    except ValueError as error:
        raise InputError(f"{error}; give --format unicode, which writes all eight dots") from None
