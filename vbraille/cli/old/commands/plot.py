"""``vbraille plot``."""

from __future__ import annotations

import math
import os
import sys
from itertools import chain, islice
from itertools import count as numbers
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vbraille import pictures
from vbraille.cli.old.build import build_book, build_lengths, build_show, build_table, lay_out
from vbraille.config.options import CHOICE_OF_TABLE
from vbraille.config.settings import settle
from vbraille.errors import InputError
from vbraille.files import check_unused
from vbraille.render import MODELS, VBD
from vbraille.translate import Document

if TYPE_CHECKING:
    import argparse

    from vbraille.pictures import FigureTable

_LINES = 6  # lines of a page, unless told otherwise


def run(arguments: argparse.Namespace) -> int:
    """Draw a picture, or print its numbers."""
    if arguments.out is not None and arguments.csv:
        raise InputError("--csv prints numbers and draws nothing; leave out either --csv or --out")
    if arguments.kind == "page" and arguments.file is None:
        raise InputError("plot page needs a text: vbraille plot page FILE")
    if arguments.kind != "page" and arguments.file is not None:
        raise InputError(f"plot {arguments.kind} takes no text; only plot page does")
    if arguments.out is not None:
        check_unused(Path(arguments.out), replace=arguments.force)
    table = _table(arguments)
    if arguments.csv:
        pictures.write_csv(table, sys.stdout)
        return 0
    from vbraille.pictures import draw

    path = Path(arguments.out) if arguments.out is not None else _new_name(arguments.kind)
    draw.save(draw.draw(table), path)
    print(f"drawn: {table.title}, {path}")
    if arguments.kind == "resolution":
        print("\n".join(pictures.resolution_words()))
    if arguments.kind == "page":
        drawn = np.unique(table["line"]).size
        chosen = "" if arguments.lines[1] else "; --lines chooses others"
        print(f"lines: {drawn} drawn, from line {arguments.lines[0]}{chosen}")
    return 0


def _new_name(kind: str) -> Path:
    """Name for a picture without a name: the first of its kind that does not exist yet."""
    names = (
        f"vbraille-{kind}{number}.png" for number in chain([""], map("-{}".format, numbers(2)))
    )
    return next(path for path in map(Path, names) if not os.path.lexists(path))


def _table(arguments: argparse.Namespace) -> FigureTable:
    if arguments.kind == "resolution":
        if arguments.model is not None:
            raise InputError("the resolution is of the Tactograph's arms; leave --model out")
        return pictures.resolution()
    settle(arguments, CHOICE_OF_TABLE)
    if arguments.model is None:
        arguments.model = "vbd" if arguments.kind in ("wave", "strain") else "stress2"
    model = MODELS[arguments.model]
    shown = build_show(arguments, build_lengths(arguments, model))
    style = shown.style
    match arguments.kind:
        case "deflection":
            return pictures.profile(shown)
        case "wave":
            return pictures.wave(shown)
        case "strain":
            if model is not VBD:
                raise InputError("the strain figure is of the VBD; leave --model out or give vbd")
            return pictures.strain(style.geometry, style.tuning)
        case "mapping":
            if model is VBD:
                raise InputError("the VBD has one row; the mappings are of displays of several")
            return pictures.mapping(style, **_letter(arguments), model=model)
    if not math.isfinite(arguments.x):
        raise InputError(f"--x is {arguments.x}; it must be a number of mm")
    page = lay_out(arguments, build_book(arguments), shown)
    lines = list(islice(page.lines(), None if page.last else _LINES))
    page.say_note()
    page.say_unknown()
    return pictures.page(lines, shown, x_mm=arguments.x + shown.display.span_mm / 2)


def _letter(arguments: argparse.Namespace) -> dict:
    """Cells of the letter that was asked for; empty if none was."""
    if arguments.letter is None:
        return {}
    if not arguments.letter.strip():
        raise InputError("--letter is blank; give a letter")
    block = Document.from_text(arguments.letter).block(0)
    assert block is not None
    cells = build_table(arguments).translate(block.text)
    if not 1 <= len(cells) <= 4:
        raise InputError(f"{arguments.letter!r} is {len(cells)} cells; give a letter of 1 to 4")
    return {"masks": cells.masks}
