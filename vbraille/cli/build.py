"""Options to objects: the page, and how it is shown."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from vbraille.cli.printable import printable
from vbraille.cli.unknown import Unknown
from vbraille.errors import InputError
from vbraille.geometry import PRESETS, Geometry
from vbraille.page import Layout
from vbraille.render import MAPPINGS, MODELS, Mapping, Model, Tuning, single_row
from vbraille.translate import Book, Document, Table, Undefined, find_table, six_dot_table

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterator

    from vbraille.page import Line


@dataclass(frozen=True, slots=True)
class Page:
    """A text laid out for a model.

    Parameters
    ----------
    layout
        Its lines.
    model, geometry
        What they are laid out for.
    first, last
        Lines asked for.
    unknown
        Counts what the table does not know.
    """

    layout: Layout
    model: Model
    geometry: Geometry
    first: int
    last: int | None
    unknown: Unknown

    @property
    def document(self) -> Document:
        """The text."""
        return self.layout.book.document

    def lines(self) -> Iterator[Line]:
        """Lines asked for; says on stderr what the text's encoding and script need saying."""
        for line in self.layout.lines(self.first, self.last):
            self.say_note()
            self.unknown.see(line)
            yield line

    def see(self, number: int) -> None:
        """Count what the table does not know on a line that was laid out."""
        line = self.layout.line(number)
        if line is not None:
            self.unknown.see(line)

    def progress(self, line: Line) -> float:
        """How much of the lines asked for is done with this one, about, 0 to 1."""
        if self.last is None:
            return self.layout.progress(line)
        return (line.number - self.first + 1) / (self.last - self.first + 1)

    def say_note(self) -> None:
        """Say once if the text is not UTF-8, and of each script that the table does not know."""
        for note in (self.document.note(), self.layout.book.table.note()):
            if note is not None:
                print(printable(note), file=sys.stderr, flush=True)

    def say_unknown(self) -> None:
        """Say at the end how many characters the table does not know, if there were any."""
        sentence = self.unknown.sentence
        if sentence is not None:
            print(printable(sentence), file=sys.stderr, flush=True)


def build_geometry(arguments: argparse.Namespace) -> tuple[Model, Geometry]:
    """Model and distances.

    Raises
    ------
    InputError
        If a length is out of range.
    """
    model = MODELS[arguments.model]
    geometry = PRESETS[arguments.geometry] if arguments.geometry else model.geometry
    given = {
        f"{name}_mm": getattr(arguments, name)
        for name in ("dot_width", "dot_spacing", "cell_gap", "line_pitch", "travel")
        if getattr(arguments, name) is not None
    }
    try:
        return model, replace(geometry, **given)
    except ValueError as error:
        raise InputError(str(error)) from None


def build_table(arguments: argparse.Namespace) -> Table:
    """Table of the text.

    Raises
    ------
    InputError
        If there is none such.
    """
    undefined = Undefined(arguments.undefined)
    if arguments.table is None:
        return Table(find_table(arguments.language or "en", arguments.grade), undefined)
    if arguments.language is not None or arguments.grade is not None:
        raise InputError("a table has its language and grade; give either --table or those")
    return Table(arguments.table, undefined)


def build_page(arguments: argparse.Namespace, *, six_dots: bool = False) -> Page:
    """Page of the text, and say on stderr how wide it is.

    With `six_dots`, a table of eight dots is refused.

    Raises
    ------
    InputError
        If an option or the text cannot be used.
    """
    model, geometry = build_geometry(arguments)
    try:
        width = geometry.cells_per_line(model.array.span_mm)
    except ValueError as error:
        raise InputError(str(error)) from None
    table = build_table(arguments)
    if six_dots and table.eight_dots:
        raise InputError(_eight_dots(table))
    document = Document.open(arguments.file, arguments.encoding, keep_lines=arguments.keep_lines)
    first, last = arguments.lines
    layout = Layout(Book(document, table), width)
    if layout.line(first) is None:
        lines = layout.count()
        if not lines:
            raise InputError(f"{arguments.file} has no text in it; give a text file")
        raise InputError(f"{arguments.file} ends at line {lines}; --lines {first} is past that")
    print(f"line width: {width} cells", file=sys.stderr, flush=True)
    unknown = Unknown(table, Undefined(arguments.undefined))
    return Page(layout, model, geometry, first, last, unknown)


def _eight_dots(table: Table) -> str:
    """What to say of a table of eight dots where only six can be written."""
    info = table.info
    other = None if info is None else six_dot_table(info.language)
    instead = f"give --table {other}, which has six, or" if other else "give"
    return (
        f"the table {table.name} has eight dots and BRF has six; "
        f"{instead} --format unicode, which writes all eight"
    )


def build_show(arguments: argparse.Namespace, model: Model) -> tuple[Mapping, Tuning]:
    """How the lines are shown.

    Raises
    ------
    InputError
        If an option is out of range or not the model's.
    """
    if model.array.rows == 1:
        if arguments.mapping is not None:
            raise InputError(f"the {model.title} has one row of actuators; --dot-row chooses dots")
        if arguments.texture_cycles is not None:
            raise InputError(f"the texture of the {model.title} has a fixed wavelength")
    elif arguments.dot_row is not None:
        raise InputError(f"the {model.title} shows all dot rows; --mapping chooses how")
    given = {
        name: value
        for name, value in (
            ("texture", arguments.texture),
            ("contrast", arguments.contrast),
            ("cycles", arguments.texture_cycles),
        )
        if value is not None
    }
    try:
        mapping = model.mapping
        if arguments.dot_row is not None:
            mapping = single_row(arguments.dot_row)
        elif arguments.mapping is not None:
            mapping = MAPPINGS[arguments.mapping]
        return mapping, replace(model.tuning, **given)
    except ValueError as error:
        raise InputError(str(error)) from None


def note_unseen_dots(page: Page, mapping: Mapping) -> None:
    """Say on stderr if the table writes dots that the display does not show."""
    info = page.layout.book.table.info
    if info is not None and info.dots == 8 and mapping.rows > 1:
        print(
            f"table {info.name} has eight dots; the {page.model.title} shows six, "
            f"so that dots 7 and 8 are not felt",
            file=sys.stderr,
            flush=True,
        )
