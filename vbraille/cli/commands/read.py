"""``vbraille read``: a text on a device, line after line."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from vbraille.cli import options

if TYPE_CHECKING:
    from collections.abc import Callable

    from vbraille.reading.places import KeptBook, Places

_OF_TABLE = ("language", "grade", "table")
_OF_TEXT = (
    *_OF_TABLE, "encoding", "form", "foreign", "undefined", "keep_lines",
)  # fmt: skip


@options.command(
    "read book.epub --speech",
    options.optional_file, options.device, options.hand, options.language, options.grade,
    options.lines, options.echo, options.keys, options.profile,
    *options.TRANSLATION[2:], *options.FEEL, options.model, *options.CARRIAGE, options.cells,
    options.advance, options.no_places, *options.AROUND,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, **_chosen: Any) -> None:
    """Without a file, the book that was read last goes on where it was closed.

    At a terminal, h says the keys.
    """
    read(ctx)


def read(ctx: click.Context, number: int = 1) -> None:
    """Read a book, the one with a number in the list of books if no file is given.

    Raises
    ------
    VbrailleError
        If it cannot be read, or the device is gone.
    """
    from vbraille.cli.build import build_book, build_model, save_style, say_width
    from vbraille.cli.exploring import equipped, say_summary
    from vbraille.cli.printing import say
    from vbraille.reading.places import Places, places_path
    from vbraille.reading.reader import Reader
    from vbraille.render import MODELS

    chosen = ctx.params
    kept_in = None if chosen["no_places"] else places_path()
    places = Places(kept_in, lambda said: say(said, aside=True))
    if chosen["file"] is None:
        chosen["file"] = str(places.numbered(number).path)
    usual = MODELS[chosen["model"] or "stress2"]
    wanted = build_model(ctx, usual, usual.style.geometry.travel_mm)
    display = wanted.on(wanted.style.geometry, chosen["rate"])
    echo = chosen["echo"] or ("none" if sys.stdout.isatty() else "both")
    with equipped(ctx, display, echo) as equipment:
        device = equipment.device
        device.launch()
        kept = _kept(places, chosen["file"])
        _take_options(ctx, kept)
        book = build_book(ctx)
        model = equipment.find(wanted)
        equipment.start(model, language=_spoken(chosen["language"], book), table=book.table)
        reader = Reader(
            book,
            device,
            equipment.outputs,
            kept,
            lines=chosen["lines"],
            cells=chosen["cells"],
            key_set=chosen["keys"],
            attended=equipment.keyboard.attached,
            by_hand=chosen["advance"] == "return",
            echo=echo,
            figures=_figures(ctx, book, model.style),
            save=lambda style: save_style(ctx, model, style),
            changed=_changes(chosen["file"], lambda: build_book(ctx)),
        )
        say_width(reader.layout.width, book)
        reader.begin()
        try:
            equipment.explore(reader, own=True)
        finally:
            reader.keep()
    say_summary(device, f"lines {reader.lines_read}", speed=True)


def _kept(places: Places, file: str) -> KeptBook:
    """Places and choices kept of a book, which is known by its content."""
    path = Path(file)
    if file == "-" or not path.is_file():
        return places.book("", Path(), "")
    try:
        with path.open("rb") as opened:
            digest = hashlib.file_digest(opened, "sha256").hexdigest()
    except OSError:  # which opening the book says in a sentence
        return places.book("", Path(), "")
    return places.book(digest, path.absolute(), path.stem)


def _take_options(ctx: click.Context, kept: KeptBook) -> None:
    """Keep options of the text that were given, and take those that are kept for the others."""
    from vbraille.cli.settings import given

    asked = given(ctx) & set(_OF_TEXT)
    if asked & set(_OF_TABLE):
        asked |= set(_OF_TABLE)
    if asked:
        kept.set_options(**{name: ctx.params[name] for name in asked})
    for name, value in kept.options.items():
        if name not in asked and value is not None:
            ctx.params[name] = value
            ctx.set_parameter_source(name, ParameterSource.COMMANDLINE)


def _changes(file: str, open_book: Callable[[], Any]) -> Callable[[], Any]:
    """Function that gives a book anew once its file has changed, and is whole again."""
    path = Path(file)
    known = seen = _stamp(path)

    def changed() -> Any:
        nonlocal known, seen
        before, seen = seen, _stamp(path)
        if seen in (None, known) or seen != before:
            return None
        known = seen
        return open_book()

    return changed


def _stamp(path: Path) -> tuple[int, int] | None:
    """Mark that tells states of a file apart; None without one, or while it is empty."""
    found = path.stat() if path.is_file() else None
    return None if found is None or not found.st_size else (found.st_mtime_ns, found.st_size)


def _spoken(asked: str | None, book: Any) -> str:
    """Language in which a book is spoken."""
    info = None if book.table is None else book.table.info
    return asked or book.source.language or (info.language if info else "") or "en"


def _figures(ctx: click.Context, book: Any, style: Any) -> Any:
    """Figures of a book: in its container, or in the folder that it stands in."""
    from vbraille.reading.figures import BookFigures

    in_container = book.source.form == "epub"
    folder = None if in_container else Path(ctx.params["file"]).parent
    return BookFigures(book.source, folder, style)
