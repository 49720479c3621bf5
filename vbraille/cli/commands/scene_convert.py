"""``vbraille scene convert``: a scene file made of a file of another program."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.cli.terminal import say_line
from vbraille.files import check_unused, write_file
from vbraille.scene.converting import convert_scene

if TYPE_CHECKING:
    import argparse


def convert(arguments: argparse.Namespace) -> int:
    """Write the new file, and say what differs.

    Raises
    ------
    InputError
        If the file cannot be converted, or the new one cannot be written.
    """
    out = Path(arguments.out)
    check_unused(out, replace=arguments.force)
    path = Path(arguments.file)
    made = convert_scene(path, out.parent, as_shown=arguments.as_shown)
    write_file(out, made.text.encode(), replace=arguments.force)
    for difference in made.differences:
        say_line(f"differs: {path} {difference}")
    say_line(f"elements: {made.elements}")
    say_line(f"differences: {len(made.differences)}")
    say_line(f"written: {out}")
    return 0
