"""Braille tables of languages: those that their readers use today.

liblouis finds the literary, uncontracted table of a language; what its readers have otherwise is
listed in `languages.toml`. `docs/languages.md` has the outcome for every language.
"""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from vbraille.errors import InputError
from vbraille.translate.liblouis import LOUIS
from vbraille.wording import nearest, setting

_DATA = tomllib.loads(Path(__file__).with_name("languages.toml").read_text("utf-8"))
# Tables of a standard that is no longer in force, or with signs that books leave out.
_DATED = re.compile(r"_\d{4}\b|-\d{4}[-.]|-detailed\b")


@dataclass(frozen=True, slots=True, order=True)
class TableInfo:
    """Metadata of a table.

    Parameters
    ----------
    name
        File name, which is what `BrailleTable` takes.
    title
        Display name; empty if unsaid.
    language
        BCP 47 tag, such as ``fr`` or ``en-GB``; empty if unsaid.
    grade
        "0", "1", "2" …; empty if unsaid.
    dots
        6 or 8; 0 if unsaid.
    kind
        "literary" or "computer"; empty if unsaid.
    """

    name: str
    title: str = ""
    language: str = ""
    grade: str = ""
    dots: int = 0
    kind: str = ""


@cache
def list_tables() -> tuple[TableInfo, ...]:
    """All tables that have metadata, by name."""
    found = []
    for name, title, index, language, grade, dots, kind in LOUIS.ask("list_tables"):
        number = 6 if name in _DATA["six_dots"] else int(dots or 0)
        found.append(TableInfo(name, title or index, language, grade, number, kind))
    return tuple(sorted(found))


def tables_of(language: str) -> tuple[str, tuple[TableInfo, ...]]:
    """Tag that liblouis has for a language, in lower case, and the tables that it lists for it.

    Parameters
    ----------
    language
        BCP 47 tag, with hyphens or underscores; for "fr-CA" the tables for French are taken,
        unless there are some for Canada.

    Raises
    ------
    InputError
        If there are no tables; the message names the nearest languages.
    """
    tag = wanted = language.strip().lower().replace("_", "-")
    if not wanted:
        raise InputError(
            f"the language is empty; give a tag such as fr, or leave {setting('language')} out"
        )
    while tag:
        tag = _DATA["same"].get(tag, tag)
        found = tuple(
            table for table in list_tables() if f"{table.language}-".lower().startswith(f"{tag}-")
        )
        if found or tag in _DATA["usual"]:
            return tag, found
        tag = tag.rpartition("-")[0]
    tags = sorted({table.language for table in list_tables()} - {""})
    raise InputError(
        f"no braille table for language {language!r}{nearest(wanted, tags, 3)} "
        f"(vbraille tables lists all)"
    )


def has_tables(language: str) -> bool:
    """Tell whether there is a table for a language, whatever its grade."""
    try:
        tables_of(language)
    except InputError:
        return False
    return True


def find_table(language: str = "en", grade: int | None = None) -> str:
    """Name of the table for a language and grade.

    Parameters
    ----------
    language
        BCP 47 tag; a region may follow ("en-GB").
    grade
        0 or 1 for uncontracted, 2 and up for contracted braille; None for what is usual in the
        language. Where a language numbers its grades otherwise, as German does, its numbers count.

    Raises
    ------
    InputError
        If there is no such table; the message says which grades there are.
    """
    tag, tables = tables_of(language)
    named = _DATA["usual"].get(tag, {})
    wanted = "usual" if grade is None else str(grade)
    plain = [table for table in tables if not _is_contracted(table)]
    fitting = [table for table in tables if table.grade == wanted and table.kind != "computer"]
    if grade is None:
        fitting = list(tables)
    elif not fitting and grade < 2:
        wanted, fitting = "1", plain
    if wanted in named:
        return named[wanted]
    if fitting:
        return min(fitting, key=preference).name
    there = {*named, *(table.grade for table in tables), *["1"][: len(plain)]}
    raise InputError(
        f"there is no grade {grade} for language {language!r}; there is "
        f"{', '.join(sorted(filter(str.isdecimal, there)))} "
        f"(vbraille tables {setting('language')} {language})"
    )


def _is_contracted(table: TableInfo) -> bool:
    return table.grade not in ("", "0", "1")


def preference(table: TableInfo) -> tuple[bool, bool, bool, bool, int, str]:
    """Key by which the most usual of a language's tables sorts first."""
    dated = _DATED.search(table.name) is not None
    computer, contracted = table.kind == "computer", _is_contracted(table)
    return computer, table.dots == 8, dated, contracted, len(table.language), table.name
