"""``vbraille structure``."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from vbraille.cli.old.build import build_book
from vbraille.cli.old.terminal import print_json, say_line
from vbraille.translate.outline import outline

if TYPE_CHECKING:
    import argparse

    from vbraille.translate.outline import OutlineHeading


def run(arguments: argparse.Namespace) -> int:
    """Print the outline, one line for each heading, then what else there is."""
    source = build_book(arguments).source
    found = outline(source)
    if arguments.json:
        print_json(asdict(found))
        return 0
    for what, value in (("title", found.title), ("language", found.language)):
        if value:
            say_line(f"{what}: {value}")
    for heading in found.headings:
        say_line(_said(heading))
    say_line(f"headings: {len(found.headings)}")
    for what, number in found.counts.items():
        if number:
            say_line(f"{what}: {number}")
    if found.languages:
        named = ", ".join(f"{tag} {number}" for tag, number in found.languages.items())
        say_line(f"languages: {named}")
    if found.unshown:
        named = ", ".join(f"{what} {number}" for what, number in found.unshown.items())
        say_line(f"not shown: {named}")
    return 0


def _said(heading: OutlineHeading) -> str:
    page = f"page {heading.page}, " if heading.page else ""
    return f"level {heading.level}: {heading.title}, {page}{heading.percent:.0f} percent"
