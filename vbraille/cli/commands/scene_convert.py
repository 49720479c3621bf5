"""``vbraille scene convert``: a scene file made of a file of another program."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.files import write_file
from vbraille.scene.converting import convert_scene
from vbraille.wording import printable

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
    if out.exists() and not arguments.force:
        raise InputError(f"{out} is there already; choose another name, or replace it by --force")
    path = Path(arguments.file)
    made = convert_scene(path, out.parent, as_shown=arguments.as_shown)
    write_file(out, made.text.encode(), replace=arguments.force)
    for difference in made.differences:
        print(f"differs: {path} {printable(difference)}")
    print(f"elements: {made.elements}")
    print(f"differences: {len(made.differences)}")
    print(f"written: {out}")
    return 0
