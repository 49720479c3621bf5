"""``vbraille page``."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from vbraille.cli.build import build_page
from vbraille.cli.settled import TRANSLATION, settle
from vbraille.errors import InputError
from vbraille.wording import printable

if TYPE_CHECKING:
    import argparse

    from vbraille.layout.pages import Line


def run(arguments: argparse.Namespace) -> int:
    """Print the lines."""
    settle(arguments, TRANSLATION)
    page = build_page(arguments, six_dots=arguments.format == "brf")
    write = sys.stdout.write
    for line in page.lines():
        write(f"{_format(line, arguments.format)}\n")
    page.say_note()
    page.say_unknown()
    return 0


def _format(line: Line, how: str) -> str:
    if how == "text":
        return printable(line.text)
    if how == "dots":
        return line.printed.to_dots()
    if how == "unicode":
        return line.printed.to_unicode()
    try:
        return line.printed.to_brf()
    except ValueError as error:
        raise InputError(f"{error}; give --format unicode, which writes all eight dots") from None
