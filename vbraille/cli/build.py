"""Options to objects: the page, and how it is shown."""

from __future__ import annotations

import sys
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from vbraille.braille.geometry import PRESETS
from vbraille.cli.terminal import say_line
from vbraille.config.settings import missing_profile
from vbraille.errors import InputError
from vbraille.layout.pages import Layout
from vbraille.layout.texts import cells_per_line, choose_table
from vbraille.layout.unshown import Unknown, Unshown
from vbraille.render import MAPPINGS, Model, Profile, single_row
from vbraille.translate import (
    Book,
    BrailleTable,
    Undefined,
    six_dot_table,
)
from vbraille.translate.formats import open_source, open_stream
from vbraille.translate.languages import has_tables
from vbraille.wording import spelled

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from vbraille.config.settings import Settings
    from vbraille.layout.pages import Line
    from vbraille.reading.places import KeptPlace
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
        build_table(arguments)  # nobody types a text for a table that is not there
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
    return open_stream(sys.stdin.buffer, "standard input", **how)


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
