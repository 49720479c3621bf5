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
from vbraille.translate import liblouis
from vbraille.wording import nearest, setting

_DATA = tomllib.loads(Path(__file__).with_name("languages.toml").read_text("utf-8"))
_USUAL, _SAME = _DATA["usual"], _DATA["same"]
# Languages whose books of general interest are contracted.
_CONTRACTED = frozenset(("da", "de", "en", "ko"))
# Tables of a standard that is no longer in force, or with signs that books leave out.
_DATED = re.compile(r"_\d{4}\b|-\d{4}[-.]|-detailed\b")
_SIX_DOTS = ("dra.tbl", "mn-MN-g1.utb", "mn-MN-g2.ctb")  # whatever their metadata say


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

    def speaks(self, language: str) -> bool:
        """Tell whether the table is for a language, given by a tag in lower case with hyphens."""
        tag = self.language.lower()
        return tag == language or tag.startswith(f"{language}-")


@cache
def list_tables() -> tuple[TableInfo, ...]:
    """All tables that have metadata, by name."""
    found = []
    for said in liblouis.list_tables():
        dots = 6 if said["name"] in _SIX_DOTS else int(said["dots"] or 0)
        title = said["display-name"] or said["index-name"]
        found.append(
            TableInfo(said["name"], title, said["language"], said["grade"], dots, said["type"])
        )
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
    wanted = language.strip().lower().replace("_", "-")
    if not wanted:
        raise InputError(
            f"the language is empty; give a tag such as fr, or leave {setting('language')} out"
        )
    tag = wanted
    while tag:
        tag = _SAME.get(tag, tag)
        found = tuple(table for table in list_tables() if table.speaks(tag))
        if found or tag in _USUAL:
            return tag, found
        tag = tag.rpartition("-")[0]
    tags = sorted({table.language for table in list_tables() if table.language})
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
    uncontracted, contracted = _USUAL.get(tag, ("", ""))
    if grade is None:
        usual = contracted if tag in _CONTRACTED else uncontracted
        return usual or min(tables, key=preference).name
    if (grade, bool(uncontracted)) == (1, True) or (grade, bool(contracted)) == (2, True):
        return (uncontracted, contracted)[grade - 1]
    plain = [table for table in tables if not _is_contracted(table)]
    fitting = [t for t in tables if t.grade == str(grade) and t.kind != "computer"]
    if not fitting and grade < 2:
        if uncontracted:
            return uncontracted
        fitting = plain
    if not fitting:
        there = {table.grade for table in tables if table.grade.isdecimal()}
        there |= {"1"} if plain or uncontracted else set()
        there |= {"2"} if contracted else set()
        raise InputError(
            f"there is no grade {grade} for language {language!r}; there is "
            f"{', '.join(sorted(there))} (vbraille tables {setting('language')} {language})"
        )
    return min(fitting, key=preference).name


def _is_contracted(table: TableInfo) -> bool:
    return table.grade not in ("", "0", "1")


def preference(table: TableInfo) -> tuple[bool, bool, bool, bool, int, str]:
    """Key by which the most usual of a language's tables sorts first."""
    dated = _DATED.search(table.name) is not None
    computer, contracted = table.kind == "computer", _is_contracted(table)
    return computer, table.dots == 8, dated, contracted, len(table.language), table.name
