"""The book that `vbraille read` is to read, opened as it was left."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.cli.build import book_of, build_book
from vbraille.cli.terminal import say_line
from vbraille.config.knobs import kept_values, with_values
from vbraille.config.options import BOOK, CHOICE_OF_TABLE, OPTIONS, held_in
from vbraille.config.settings import display_name
from vbraille.errors import InputError
from vbraille.reading.places import book_options, book_to_open, last_book, resume
from vbraille.reading.search.queries import BookOpening
from vbraille.reading.search.seeker import Seeker
from vbraille.translate import Document

if TYPE_CHECKING:
    import argparse

    from vbraille.reading.places import BookOptions, KeptBook, KeptPlace, KeptPlaces
    from vbraille.reading.reader import Reader
    from vbraille.render import BrailleStyle, Model
    from vbraille.translate import Book


@dataclass(frozen=True, slots=True)
class BookToRead:
    """A book that is open, with what is kept of it.

    Parameters
    ----------
    book
        The book.
    kept
        What is kept of it; None if nothing is to be kept.
    place
        Place at which reading goes on; None for the beginning.
    """

    book: Book
    kept: KeptBook | None = None
    place: KeptPlace | None = None

    def tuned(self, model: Model) -> Model:
        """Display and style with what the reader turned when the book was read last."""
        values = ((self.kept and self.kept.tuning) or {}).get(display_name(model))
        style = model.style
        if isinstance(values, dict):
            with suppress(InputError):  # values of another version's
                style = with_values(style, model.display, values)
        return replace(model, style=style)

    def seeker(self, arguments: argparse.Namespace) -> Seeker | None:
        """Process that looks through the book; None if it could not open the book again."""
        source, table = self.book.source, self.book.table
        descriptor = None
        if arguments.file == "-":
            if not isinstance(source, Document):
                return None
            descriptor = source.descriptor
        return Seeker(
            BookOpening(
                file=b"" if descriptor is not None else os.fsencode(arguments.file),
                descriptor=descriptor,
                name=source.name,
                encoding=arguments.encoding,
                keep_lines=arguments.keep_lines,
                form=arguments.form,
                brf_table=arguments.brf_table,
                table=None if table is None else table.name,
                language=arguments.language,
                grade=arguments.grade,
                switch=self.book.switch,
                undefined=arguments.undefined,
                index=source.index(),
            )
        )

    def leave(self, reader: Reader, model: Model, before: BrailleStyle) -> None:
        """Keep what another reading goes on with, apart from the place, which the reader keeps.

        Parameters
        ----------
        reader
            Reader of the book.
        model
            Display that the book was read on.
        before
            Style that reading began with; another one was turned to by the reader.
        """
        if self.kept is None:
            return
        if reader.style != before:
            tuning = dict(self.kept.tuning or {})
            tuning[display_name(model)] = kept_values(reader.style)
            self.kept.keep_tuning(tuning)
        self._keep_translation(reader.layout.book)
        self.kept.keep_index(self.book.source.index())
        self.kept.close()

    def _keep_translation(self, book: Book) -> None:
        """Keep the language and grade to which the reader turned, if this is another table."""
        assert self.kept is not None
        if self.book.table is None or book.table is None or book.table.name == self.book.table.name:
            return
        turned = {"language": book.language, "grade": book.grade, "table": None, "turned": True}
        self.kept.keep_options({**self.kept.options, **turned})


def open_to_resume(arguments: argparse.Namespace, places: KeptPlaces) -> BookToRead:
    """Open the book of the options, by its file or number, or the last one if they name none.

    Parameters
    ----------
    arguments
        Parsed options of the command; file and options of the last book are filled in.
    places
        Places that are kept.

    Raises
    ------
    InputError
        If there is no such book, or it cannot be read.
    """
    said = _said(arguments)
    if arguments.file is not None and arguments.book is not None:
        raise InputError("--book names a book by its number; leave out either that or the file")
    if arguments.file is None:
        _take_last(arguments, places, said)
    book = build_book(arguments)
    if arguments.no_places or arguments.file == "-" or arguments.lines != (1, None):
        return BookToRead(book)
    source = book.source
    kept = places.book(str(arguments.file), title=source.title)
    turned = kept.options["turned"] and book.table is not None
    if turned := turned and _take_translation(arguments, kept.options, said):
        with suppress(InputError):  # the language has no table any more
            book = book_of(source, arguments)
    if (note := places.note()) is not None:
        say_line(note, aside=True)
    # What only the settings file says is for every book.
    given = {
        name: value
        for name, value in vars(arguments).items()
        if name not in arguments.settled or OPTIONS[name].default is not None
    }
    options = book_options(given, turned=bool(turned))
    place, note = resume(source, kept, options)
    if note is not None:
        say_line(note, aside=True)
    return BookToRead(book, kept, place)


def _said(arguments: argparse.Namespace) -> frozenset[str]:
    """Which of the options on translation were given, and are not from the settings file."""
    given = {name for name in CHOICE_OF_TABLE if getattr(arguments, name) is not None}
    return frozenset(given - arguments.settled)


def _take_last(arguments: argparse.Namespace, places: KeptPlaces, said: frozenset[str]) -> None:
    """Read the last book, or that of a number, by the options of its last reading.

    Options that are given come before those.
    """
    kept = last_book(places) if arguments.book is None else book_to_open(places, arguments.book)
    arguments.file = str(kept.path)
    options = kept.options
    if any(options[name] is not None for name in CHOICE_OF_TABLE):
        _take_translation(arguments, options, said)
    for option in held_in(BOOK):
        name = option.name
        if name in CHOICE_OF_TABLE or options[name] is None:
            continue
        if getattr(arguments, name) in (None, option.default) or name in arguments.settled:
            setattr(arguments, name, options[name])
            arguments.settled -= {name}


def _take_translation(
    arguments: argparse.Namespace, options: BookOptions, said: frozenset[str]
) -> bool:
    """Translate as a book was translated before, unless options say a language or a table.

    Returns
    -------
    bool
        Whether the book's language or table is taken; a grade that is given holds in any case.
    """
    if said & {"language", "table"} or (said and options["table"] is not None):
        return False
    for name in set(CHOICE_OF_TABLE) - said:
        setattr(arguments, name, options[name])
    arguments.settled -= set(CHOICE_OF_TABLE)
    return True
