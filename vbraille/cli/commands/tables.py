"""``vbraille tables``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from vbraille.cli import options
from vbraille.cli.printing import print_json, say

if TYPE_CHECKING:
    from vbraille.translate import TableInfo


@click.command(cls=options.Command, epilog="Example: vbraille tables --language fr")
@options.takes(options.language, options.json)
def command(language: str | None, json: bool) -> None:
    """With a language, only its tables, and which one is taken."""
    from vbraille.translate import find_table, list_tables, tables_of

    tables = list_tables() if language is None else tables_of(language)[1]
    usual = None if language is None else find_table(language)
    if json:
        print_json({"usual": usual, "tables": list(tables)})
        return
    if usual is not None:
        say(f"usual: {usual}")
    for table in tables:
        say(_described(table))


def _described(table: TableInfo) -> str:
    parts = [f"{table.name}: {table.title or 'no title'}"]
    parts.append(f"language {table.language or 'unknown'}")
    parts.append(f"grade {table.grade or 'unknown'}")
    if table.dots:
        parts.append(f"{table.dots} dots")
    return ", ".join(parts)
