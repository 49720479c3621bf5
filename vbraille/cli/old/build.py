"""Options to objects: the book, as it was left, its page, and how that is shown."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from vbraille.braille.geometry import PRESETS
from vbraille.cli.old.reading.library import book_options, book_to_open, last_book, resume
from vbraille.cli.old.reading.search.questions import BookOpening
from vbraille.cli.old.reading.search.seeker import Seeker
from vbraille.cli.old.terminal import say_line
from vbraille.config.options import BOOK, CHOICE_OF_TABLE, OPTIONS, held_in
from vbraille.config.settings import display_name, kept_values, missing_profile, with_values
from vbraille.errors import InputError
from vbraille.layout import Layout

Unknown = None
Unshown = None
from vbraille.layout import cells_per_line
from vbraille.render import MAPPINGS, Model, Profile, single_row
from vbraille.translate import Book, BrailleTable, choose_table

Document = None
from vbraille.translate import Undefined, has_tables, open_source, six_dot_table
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from vbraille.cli.old.reading.keptplace import KeptPlace
    from vbraille.cli.old.reading.library import BookOptions, KeptBook, KeptPlaces
    from vbraille.cli.old.reading.reader import Reader
    from vbraille.config.settings import Settings
    from vbraille.layout import Line
    from vbraille.render import BrailleStyle, Model
    from vbraille.translate import Source

_ALL_DOTS = 0xFF


@dataclass(frozen=True, slots=True)
class Page:
    """A text laid out for a display and a style.

    Parameters
    ----------
    layout
        Lines of the text.
    model
        Display and style that the lines are laid out for.
    first, last
        Numbers of the first and last line that were asked for.
    unknown
        Counter of characters that the table does not know; None where there is no table.
    unshown
        Counter of what the source holds that cannot be shown.
    """

    layout: Layout
    model: Model
    first: int
    last: int | None
    unknown: Unknown | None
    unshown: Unshown = field(default_factory=Unshown)

    @property
    def source(self) -> Source:
        """Source of the text."""
        return self.layout.book.source

    def lines(self) -> Iterator[Line]:
        """Lines asked for; stderr is told of the text's encoding and script if need be."""
        for line in self.layout.lines(self.first, self.last):
            self.say_note()
            self._count(line)
            yield line

    def see(self, number: int) -> None:
        """Count the characters on a line that the table does not know; it must be laid out."""
        line = self.layout.line(number)
        if line is not None:
            self._count(line)

    def progress(self, line: Line) -> float:
        """Estimated share of the lines asked for that is done with this one, 0 to 1."""
        if self.last is None:
            return self.layout.progress(line)
        return (line.number - self.first + 1) / (self.last - self.first + 1)

    def share_before(self, line: Line) -> float:
        """Estimated share of the lines asked for that stands before one of them, 0 to 1."""
        if self.last is not None:
            return (line.number - self.first) / (self.last - self.first + 1)
        first = self.layout.line(self.first)
        skipped = self.layout.progress(first) if first is not None else 0.0
        return (self.layout.progress(line) - skipped) / (1 - skipped)

    def say_note(self) -> None:
        """Say once if the text is not UTF-8, and of each script that the table does not know."""
        for note in self.layout.book.notes():
            say_line(spelled(note), aside=True)

    def say_unknown(self) -> None:
        """Say at the end what was not shown: unknown characters, and things such as formulas."""
        for counter in (self.unknown, self.unshown):
            sentence = None if counter is None else counter.sentence
            if sentence is not None:
                say_line(spelled(sentence), aside=True)

    def _count(self, line: Line) -> None:
        if self.unknown is not None:
            self.unknown.see(line)
        self.unshown.see(line)


def build_lengths(
    arguments: argparse.Namespace, model: Model, travel_mm: float | None = None
) -> Model:
    """Display and style with the distances of the options.

    Parameters
    ----------
    arguments
        Parsed options of the command.
    model
        Display and style that the options change.
    travel_mm
        Travel of the carriage where the options do not give one.

    Raises
    ------
    InputError
        If a length is out of range.
    """
    geometry = PRESETS[arguments.geometry] if arguments.geometry else model.style.geometry
    names = ("dot_width", "dot_spacing", "cell_gap", "line_pitch", "travel")
    given = _given(arguments, **{f"{name}_mm": name for name in names})
    if travel_mm is not None:
        given.setdefault("travel_mm", travel_mm)
    return replace(model, style=model.style.replace(geometry=geometry, **given))


def _given(arguments: argparse.Namespace, **fields: str) -> dict[str, Any]:
    """Values of the options that are given, by the fields that they are for."""
    values = {field: getattr(arguments, option) for field, option in fields.items()}
    return {field: value for field, value in values.items() if value is not None}


def build_page(arguments: argparse.Namespace, model: Model) -> Model:
    """Display and style with what the options say of a page on a surface of two axes.

    Raises
    ------
    InputError
        If an option is out of range.
    """
    display, style = model.display, model.style
    if arguments.height is not None:
        display = replace(display, height_mm=arguments.height)
    try:
        straying = replace(style.straying, **_given(arguments, manner="straying", band="band"))
    except ValueError as error:
        raise InputError(str(error)) from None
    style = replace(style, straying=straying)
    return replace(model, display=display, style=style)


def chosen_profile(arguments: argparse.Namespace, settings: Settings) -> str:
    """Name of the profile in use; one that an option names and is not there is said on stderr."""
    if arguments.profile is None:
        return settings.profile
    if note := missing_profile(settings, arguments.profile):
        say_line(note, aside=True)
    return arguments.profile


def build_table(arguments: argparse.Namespace, language: str = "") -> BrailleTable:
    """Table for a text; InputError if there is no such table.

    Parameters
    ----------
    arguments
        Parsed options of the command.
    language
        Language of the text as its own source says, whose usual table is taken if no option of
        the command line names a language or a table, and there is one.
    """
    named, grade, table = _translation(arguments, language)
    return choose_table(named, grade, table, arguments.undefined)


def _translation(
    arguments: argparse.Namespace, language: str
) -> tuple[str | None, int | None, str | None]:
    """Language, grade and table that the reader chose for a text whose own language is this."""
    named, grade, table = arguments.language, arguments.grade, arguments.table
    usual = {"language", "table"} - arguments.settled  # what the settings say is for other texts
    asked = any(getattr(arguments, name) is not None for name in usual)
    if not asked and language and has_tables(language):
        named, table = language, None
        grade = None if "table" in arguments.settled else grade
    return named, grade, table


def build_book(arguments: argparse.Namespace, *, six_dots: bool = False) -> Book:
    """Text and table, before anything is laid out; a source that is in braille has no table.

    With `six_dots`, a table of eight dots is refused.

    Raises
    ------
    InputError
        If an option or the text cannot be used.
    """
    if arguments.file == "-" and arguments.form is None:
        build_table(arguments)  # before a user types a text for a table that is not there
    return book_of(_open(arguments), arguments, six_dots=six_dots)


def book_of(source: Source, arguments: argparse.Namespace, *, six_dots: bool = False) -> Book:
    """Put a text that is open and its table together, as `build_book` does.

    Raises
    ------
    InputError
        If an option cannot be used for this text.
    """
    if source.in_cells:
        for option in ("table", "language", "grade"):
            if getattr(arguments, option) is not None and option not in arguments.settled:
                raise InputError(f"{source.name} is in braille already; leave out --{option}")
        return Book(source)
    table = build_table(arguments, source.language)
    if six_dots and table.eight_dots:
        raise InputError(_eight_dots(table))
    chosen, grade, named = _translation(arguments, source.language)
    unnamed = chosen is None and named is None and not source.language
    switch = arguments.foreign == "switch"
    return Book(source, table, language=chosen or "", grade=grade, switch=switch, unnamed=unnamed)


def _open(arguments: argparse.Namespace) -> Source:
    """Book of the options, from a file or from standard input."""
    how = {
        "encoding": arguments.encoding,
        "keep_lines": arguments.keep_lines,
        "brf_table": arguments.brf_table,
        "form": arguments.form,
        "wishes": arguments.settled,
    }
    if arguments.file != "-":
        return open_source(arguments.file, **how)
    if sys.stdin.isatty():
        say_line("type the text; Ctrl-D on an empty line ends it", aside=True)
    return open_source(sys.stdin.buffer, name="standard input", **how)


def lay_out(
    arguments: argparse.Namespace,
    book: Book,
    model: Model,
    width: int | None = None,
    place: KeptPlace | None = None,
) -> Page:
    """Page of a text for a display and a style, whose width is said on stderr.

    With a `width`, in cells, lines are so long whatever the display. With a `place` they are laid
    out from there.

    Raises
    ------
    InputError
        If there is no room for a cell, or the text ends before the lines asked for.
    """
    width = width or cells_per_line(model.style.geometry, model.display)
    first, last = arguments.lines
    layout = Layout(book, width) if place is None else _layout_at(book, width, place)
    if place is None and layout.line(first) is None:
        lines = layout.count()
        name = book.source.name
        if not lines:
            raise InputError(f"{name} has no text in it; give a text file")
        raise InputError(f"{name} ends at line {lines}; --lines {first} is past that")
    cells = "1 cell" if width == 1 else f"{width} cells"
    table = book.table
    written = "braille as it is" if table is None else table.said
    say_line(f"line width: {cells}, {written}", aside=True)
    unknown = None if table is None else Unknown(table, Undefined(arguments.undefined))
    return Page(layout, model, first, last, unknown)


def _layout_at(book: Book, width: int, place: KeptPlace) -> Layout:
    """Lines of a book from a place on, or from the beginning if there is no such place any more."""
    table = "" if book.table is None else book.table.name
    before = place.lines_before_for(width, table)
    try:
        return Layout(book, width, start=place.block, lines_before=before)
    except ValueError:
        return Layout(book, width)


def _eight_dots(table: BrailleTable) -> str:
    """Sentence on a table of eight dots where only six can be written."""
    info = table.info
    other = None if info is None else six_dot_table(info.language)
    instead = f"give --table {other}, which has six, or" if other else "give"
    return (
        f"the table {table.name} has eight dots and BRF has six; "
        f"{instead} --format unicode, which writes all eight"
    )


def build_show(arguments: argparse.Namespace, model: Model) -> Model:
    """Display and style with the mapping and the tuning of the options.

    Raises
    ------
    InputError
        If an option is out of range or not for this display.
    """
    style = model.style
    if style.mapping.rows == 1:
        if arguments.mapping is not None:
            rows = "one row" if model.display.rows == 1 else f"{model.display.rows} rows"
            raise InputError(f"the {model.title} has {rows} of actuators; --dot-row chooses dots")
    elif arguments.dot_row is not None:
        raise InputError(f"the {model.title} shows all dot rows; --mapping chooses how")
    if style.profile is Profile.HALF_SINE and arguments.texture_cycles is not None:
        raise InputError(f"the texture of the {model.title} has a fixed wavelength")
    given = _given(arguments, texture="texture", contrast="contrast", cycles="texture_cycles")
    try:
        if arguments.dot_row is not None:
            given["mapping"] = single_row(arguments.dot_row)
        elif arguments.mapping is not None:
            given["mapping"] = MAPPINGS[arguments.mapping]
        style = style.replace(**given)
        style.rows_on(model.display)
    except ValueError as error:
        raise InputError(str(error)) from None
    return replace(model, style=style)


def note_unseen_dots(page: Page) -> None:
    """Say on stderr if the table writes dots that the display does not show."""
    table = page.layout.book.table
    info = None if table is None else table.info
    style = page.model.style
    eight = style.straying.manner == "free" or style.mapping.shown_dots() == _ALL_DOTS
    if info is not None and info.dots == 8 and style.mapping.rows > 1 and not eight:
        say_line(
            f"table {info.name} has eight dots; the {page.model.title} shows six, "
            f"so that dots 7 and 8 are not felt",
            aside=True,
        )


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
    """Give the options on translation that were given, and are not from the settings file."""
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
