"""``vbraille tables``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate import list_tables
from vbraille.translate.liblouis import nearest

if TYPE_CHECKING:
    import argparse

    from vbraille.translate import TableInfo


def run(arguments: argparse.Namespace) -> int:
    """Print a line a table."""
    tables = list_tables()
    if arguments.language is not None:
        wanted = arguments.language.lower().replace("_", "-")
        tables = [t for t in tables if t.speaks(wanted)]
        if not tables:
            tags = sorted({t.language for t in list_tables() if t.language})
            raise InputError(
                f"there is no table for language {arguments.language!r}{nearest(wanted, tags)}"
            )
    for table in tables:
        print(_describe(table))
    return 0


def _describe(table: TableInfo) -> str:
    parts = [f"{table.name}: {table.title or 'no title'}", f"language {table.language or 'unsaid'}"]
    parts.append(f"grade {table.grade or 'unsaid'}")
    parts.append(f"{table.dots} dots" if table.dots else "dots unsaid")
    return ", ".join(parts)
