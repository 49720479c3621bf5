"""``vbraille plot``."""

from __future__ import annotations

import sys
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say

if TYPE_CHECKING:
    from vbraille.pictures.series import FigureTable

_LINES = 6  # lines of a page, unless told otherwise


@options.command(
    "plot page book.txt --lines 1-4 --x 120 --out page.png",
    click.argument("kind", type=click.Choice(["deflection", "mapping", "wave", "strain", "page"])),
    options.optional_file,
    options.out(metavar="F.png|F.svg", help="Picture to write; vbraille-KIND.png if not given."),
    options.force,
    options.csv(help="Print the numbers as CSV instead."),
    options.model(group=options.FIRST, help="Display model."),
    options.lines,
    options.option("--x", type=options.Number(-1e4, 1e4), metavar="MM", default=20.0,
                   help="Of page: place of the array's left column."),
    options.option("--letter", metavar="LETTER", help="Of mapping: letter to show."),
    options.language, options.grade,
    *options.TRANSLATION[2:], *options.FEEL, options.travel,
    options.profile(group="Places and settings"), options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, kind: str, **chosen: Any) -> None:
    """Kinds of drawings:

    \b
    deflection  how far an actuator leans along a dot
    mapping     which row of actuators shows which row of dots
    wave        the actuators as the array passes a dot
    strain      strain of the skin between neighbouring actuators
    page        lines of a text, with the array on one
    """  # noqa: D301, D400 - click's mark for lines that are not wrapped
    from vbraille.errors import InputError
    from vbraille.files import check_unused, write_files
    from vbraille.pictures.series import write_csv

    if (kind == "page") != (chosen["file"] is not None):
        raise InputError(f"plot {kind} takes {'a text' if kind == 'page' else 'no text'}")
    path = Path(chosen["out"] or f"vbraille-{kind}.png")
    suffix = path.suffix.lower()[1:]
    if suffix not in ("png", "svg"):
        raise InputError(f"cannot draw to {path}: end its name in .png or .svg")
    if not chosen["csv"]:
        check_unused(path, replace=chosen["force"])
    table = _table(ctx, kind, chosen)
    if chosen["csv"]:
        write_csv(table, sys.stdout)
        return
    from vbraille.pictures.draw import draw
    from vbraille.pictures.figurefiles import to_bytes

    content = to_bytes(draw(table), suffix, table.title)
    write_files([(path, content)], replace=chosen["force"])
    say(f"drawn: {table.title}, {path}")


def _table(ctx: click.Context, kind: str, chosen: dict[str, Any]) -> FigureTable:
    """Numbers of a drawing."""
    from vbraille.cli.build import Page, build_book, build_model
    from vbraille.errors import InputError
    from vbraille.pictures import series
    from vbraille.render import MODELS

    usual = "vbd" if kind in ("wave", "strain") else "stress2"
    model = build_model(ctx, MODELS[chosen["model"] or usual])
    if kind == "deflection":
        return series.profile(model)
    if kind == "wave":
        return series.wave(model)
    if kind == "strain":
        if model.name != "vbd":
            raise InputError("plot strain is of the VBD; give --model vbd")
        return series.strain(model.style.geometry, model.style.tuning)
    if kind == "mapping":
        if model.style.mapping.rows == 1:
            raise InputError(f"the {model.title} has one row; plot mapping is of several rows")
        return series.mapping(model.style, **_letter(ctx, chosen["letter"]), model=model)
    page = Page(ctx, build_book(ctx), model)
    lines = list(islice(page.lines(), None if page.last else _LINES))
    for sentence in page.remarks():
        say(sentence, aside=True)
    x_mm = chosen["x"] + model.display.span_mm / 2
    return series.page(lines, model, x_mm=x_mm, first=page.first)


def _letter(ctx: click.Context, letter: str | None) -> dict[str, Any]:
    """Cells of a letter; empty if none was given."""
    if letter is None:
        return {}
    from vbraille.cli.build import table_options
    from vbraille.errors import InputError
    from vbraille.translate import translate_text

    language, grade, table = table_options(ctx)
    cells = translate_text(letter, language=language, grade=grade, table=table)
    if not 1 <= len(cells) <= 4:
        raise InputError(f"--letter {letter!r} is {len(cells)} cells; give a letter of 1 to 4")
    return {"masks": cells.masks}
