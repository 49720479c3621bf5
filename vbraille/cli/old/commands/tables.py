"""``vbraille tables``."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

from vbraille.cli.old.terminal import print_json
from vbraille.translate import find_table, list_tables, tables_of

if TYPE_CHECKING:
    import argparse

    from vbraille.translate import TableInfo


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each table; for a language also the table that is taken by default."""
    language = arguments.language
    tables = list_tables() if language is None else tables_of(language)[1]
    usual = None if language is None else find_table(language)
    if arguments.json:
        print_json({"usual": usual, "tables": [asdict(table) for table in tables]})
        return 0
    if usual is not None:
        print(f"usual: {usual}")
    for table in tables:
        print(_describe(table))
    return 0


def _describe(table: TableInfo) -> str:
    parts = [f"{table.name}: {table.title or 'no title'}", f"language {table.language or 'unsaid'}"]
    parts.append(f"grade {table.grade or 'unsaid'}")
    parts.append(f"{table.dots} dots" if table.dots else "dots unsaid")
    return ", ".join(parts)
