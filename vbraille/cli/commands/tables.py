"""``vbraille tables``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli import options
from vbraille.cli.printing import show

if TYPE_CHECKING:
    from vbraille.translate import TableInfo


@options.command("tables --language fr", options.language, options.json)
def command(language: str | None, json: bool) -> None:
    """With a language, only its tables, and which one is taken."""
    from vbraille.translate import find_table, list_tables, tables_of

    tables = list(list_tables() if language is None else tables_of(language)[1])
    usual = None if language is None else find_table(language)
    lines = [f"usual: {usual}"] if usual else []
    show([*lines, *map(_described, tables)], {"usual": usual, "tables": tables}, as_json=json)


def _described(table: TableInfo) -> str:
    dots = f", {table.dots} dots" if table.dots else ""
    return (
        f"{table.name}: {table.title or 'no title'}, language {table.language or 'unknown'}, "
        f"grade {table.grade or 'unknown'}{dots}"
    )
