"""``vbraille tables``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.translate import find_table, list_tables, tables_of

if TYPE_CHECKING:
    import argparse

    from vbraille.translate import TableInfo


def run(arguments: argparse.Namespace) -> int:
    """Print a line for each table; for a language also the table that is taken by default."""
    if arguments.language is None:
        for table in list_tables():
            print(_describe(table))
        return 0
    _, tables = tables_of(arguments.language)
    print(f"usual: {find_table(arguments.language)}")
    for table in tables:
        print(_describe(table))
    return 0


def _describe(table: TableInfo) -> str:
    parts = [f"{table.name}: {table.title or 'no title'}", f"language {table.language or 'unsaid'}"]
    parts.append(f"grade {table.grade or 'unsaid'}")
    parts.append(f"{table.dots} dots" if table.dots else "dots unsaid")
    return ", ".join(parts)
