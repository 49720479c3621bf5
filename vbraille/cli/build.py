"""From options to values: a book, its lines, and how a display shows them."""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from vbraille.braille.geometry import PRESETS
from vbraille.cli.printing import say
from vbraille.cli.settings import given, save_profile, settings_of, style_options
from vbraille.errors import InputError
from vbraille.knobs import KNOBS, profile_values
from vbraille.layout import Layout
from vbraille.render import MAPPINGS, single_row
from vbraille.translate import Book, choose_table, open_source, remarks, table_of
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    import click

    from vbraille.layout import Line
    from vbraille.render import Model
    from vbraille.render.braille.style import BrailleStyle
    from vbraille.translate import Block, Source

_OF_TABLE = ("language", "grade", "table")


def build_book(ctx: click.Context) -> Book:
    """Open a text, with the table that translates it.

    The table is that of the options that were given, or else of the text's own language, or else of
    the settings file. A text that is in braille has none.

    Parameters
    ----------
    ctx
        Context of a command with a file and `options.TRANSLATION`.

    Raises
    ------
    InputError
        If the text or the table cannot be used.
    """
    chosen, asked = ctx.params, given(ctx)
    source = open_text(chosen, wishes={"encoding", "keep_lines"} - asked)
    if source.in_cells:
        if wrong := asked & {*_OF_TABLE}:
            raise InputError(f"{source.name} is in braille already; leave out --{min(wrong)}")
        return Book(source)
    language, grade, table = table_options(ctx, source.language)
    made = choose_table(language, grade, table, chosen["undefined"])
    switch = chosen["foreign"] == "switch"
    return Book(source, made, language=language or "", grade=grade, switch=switch)


def open_text(chosen: dict[str, Any], wishes: Collection[str] = ()) -> Source:
    """Open a text by options on it, of which `wishes` are passed over where they do not fit.

    The file "-" is standard input.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    names = ("encoding", "keep_lines", "form")
    how: dict[str, Any] = {"wishes": wishes} | {name: chosen[name] for name in names}
    if chosen["file"] != "-":
        return open_source(chosen["file"], **how)
    if sys.stdin.isatty():
        say("type the text; Ctrl-D on an empty line ends it", aside=True)
    return open_source(sys.stdin.buffer, name="standard input", **how)


def table_options(ctx: click.Context, own: str = "") -> tuple[str | None, int | None, str | None]:
    """Language, grade and table for a text whose own language is this, empty for unknown."""
    chosen, asked = dict(ctx.params), given(ctx)
    if "table" in asked:
        chosen |= {name: None for name in ("language", "grade") if name not in asked}
    elif "language" in asked or "grade" in asked:
        chosen["table"] = None
    if not asked & {"language", "table"} and own and table_of(own):
        chosen |= {"language": own, "table": None}
    return chosen["language"], chosen["grade"], chosen["table"]


def display_name(model: Model) -> str:
    """Name of a display in profiles: its model's, or its own in small letters."""
    return model.name or re.sub(r"[^a-z0-9]+", "-", model.title.lower()).strip("-") or "display"


def build_model(ctx: click.Context, model: Model, travel_mm: float | None = None) -> Model:
    """Display and style, with what the options say of them.

    Parameters
    ----------
    ctx
        Context of a command with `options.settings`.
    model
        Display, and the style that the options change.
    travel_mm
        Travel of the carriage where no option gives one.

    Raises
    ------
    InputError
        If an option is out of range, or not for this display.
    """
    asked, chosen = given(ctx), ctx.params
    values = {name: value for name, (value, _) in style_options(ctx, display_name(model)).items()}
    style, rows = model.style, model.style.mapping.rows
    changes: dict[str, Any] = {}
    if chosen.get("geometry"):
        changes["geometry"] = PRESETS[chosen["geometry"]]
    for name, knob in KNOBS.items():
        if name in values and (knob.fits(style) or name in asked):
            if not knob.fits(style):
                raise InputError(f"the texture of the {model.title} has a fixed wavelength")
            changes[knob.field] = values[name]
    if "mapping" in asked and rows == 1:
        raise InputError(f"the {model.title} has one row of actuators; --dot-row chooses its dots")
    if "dot_row" in asked and rows > 1:
        raise InputError(f"the {model.title} shows all rows of dots; --mapping chooses how")
    if rows == 1 and "dot_row" in values:
        changes["mapping"] = single_row(values["dot_row"])
    elif rows > 1 and "mapping" in values:
        changes["mapping"] = MAPPINGS[values["mapping"]]
    travel = chosen.get("travel")
    if travel or travel_mm:
        changes["travel_mm"] = travel or travel_mm
    display = model.display
    if chosen.get("height") is not None:
        display = replace(display, height_mm=chosen["height"])
    strayed = {"manner": chosen.get("straying"), "band": chosen.get("band")}
    strayed = {name: value for name, value in strayed.items() if value is not None}
    try:
        style = style.replace(**changes, straying=replace(style.straying, **strayed))
        style.rows_on(display)
    except ValueError as error:
        raise InputError(str(error)) from None
    return replace(model, display=display, style=style)


def save_style(ctx: click.Context, model: Model, style: BrailleStyle) -> str:
    """Save a style in the profile, for one display; the sentence that says so.

    Raises
    ------
    VbrailleError
        If it cannot be saved.
    """
    settings = settings_of(ctx)
    name = display_name(model)
    save_profile(settings.path, settings.profile, name, profile_values(style))
    return f"profile {settings.profile}: saved"


def say_width(width: int, book: Book) -> None:
    """Print how many cells are in a line, and how the text is written."""
    written = "braille as it is" if book.table is None else book.table.said
    say(f"line width: {count(width, 'cell')}, {written}", aside=True)


class Page:
    """A book laid out for a display, of which some lines are wanted.

    Parameters
    ----------
    ctx
        Context of a command with `options.lines` and `options.undefined`.
    book, model
        The book; the display, and how it shows braille.
    width
        Cells in a line; None for as many as the hand can cross.

    Raises
    ------
    InputError
        If there is no room for a cell, or no line of those that are wanted.
    """

    def __init__(
        self, ctx: click.Context, book: Book, model: Model, width: int | None = None
    ) -> None:
        width = width or model.style.geometry.cells_per_line(model.display.span_mm)
        self.layout, self.model = Layout(book, width), model
        self.first, self.last = ctx.params["lines"]
        self._seen: list[Block] = []
        self._given = 0  # lines
        if self.layout.line(self.first) is None:
            name, lines = book.source.name, self.layout.count()
            if not lines:
                raise InputError(f"{name} has no text")
            raise InputError(f"{name} has {lines} lines; --lines {self.first} is past the end")
        say_width(width, book)

    def lines(self) -> Iterator[Line]:
        """Lines that are wanted; notes on the text are printed on standard error."""
        for line in self.layout.lines(self.first, self.last):
            self._given += 1
            for note in self.layout.book.source.notes():
                say(note, aside=True)
            if line.block not in self._seen[-1:]:
                self._seen.append(line.block)
            yield line

    def progress(self, line: Line) -> float:
        """Share of the lines that is done with the last of `lines`, 0 to 1."""
        if self.last is None:
            return self.layout.book.source.progress(line.place)
        return self._given / (self.last - self.first + 1)

    def remarks(self) -> Iterator[str]:
        """New notes on the text, and sentences on content of the lines that was not shown."""
        yield from self.layout.book.source.notes()
        yield from remarks(self.layout.book, self._seen)
