"""Braille tables: those that there are, the one of a language, and text to cells by one.

liblouis finds the literary, uncontracted table of a language; what its readers have otherwise is
listed in `languages.toml`. `docs/languages.md` has the outcome for every language.
"""

from __future__ import annotations

import re
import string
import tomllib
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.translate.blocks import MarkKind
from vbraille.translate.liblouis import LOUIS, cells_of
from vbraille.translate.spellings import Kind, Undefined
from vbraille.translate.undefined import Written, write
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.braille.cells import Cells
    from vbraille.translate.blocks import Mark

_DATA = tomllib.loads(Path(__file__).with_name("languages.toml").read_text("utf-8"))
# Tables of a standard that is no longer in force, or with signs that books leave out.
_DATED = re.compile(r"_\d{4}\b|-\d{4}[-.]|-detailed\b")


_UNCONTRACTED = ("", "0", "1")  # grades
_SIX_DOTS = 0x3F
_LONGEST_NAME = 1_000  # liblouis puts a name into 2 kB without checking that it fits
# Bits that liblouis has for the emphasis of a character.
_EMPHASIS = {MarkKind.ITALIC: 1, MarkKind.UNDERLINE: 2, MarkKind.BOLD: 4}
_HYPHEN = b"\x24"  # dots 3 and 6
_UEB_CONTINUATION = b"\x10"  # dot 5, after which a number goes on without its sign
_PARTING = "-‐‑–—/"
_PUNCTUATION = ".,;:!?()[]«»“”‘’\"'…"


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


def find_table(language: str, grade: int | None = None) -> str:
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
    named, wanted, fitting = _DATA["usual"].get(tag, {}), "usual", list(tables)
    if grade is not None:
        wanted = str(grade)
        fitting = [table for table in tables if table.grade == wanted and table.kind != "computer"]
        if not fitting and grade < 2:
            wanted, fitting = "1", [table for table in tables if table.grade in _UNCONTRACTED]
    if wanted in named:
        return named[wanted]
    if fitting:
        return min(fitting, key=_preference).name
    there = {*named, *(table.grade or "1" for table in tables)}
    raise InputError(
        f"there is no grade {grade} for language {language!r}; there is "
        f"{', '.join(sorted(filter(str.isdecimal, there)))} "
        f"(vbraille tables {setting('language')} {language})"
    )


def _preference(table: TableInfo) -> tuple[bool, bool, bool, bool, int, str]:
    """Key by which the most usual of a language's tables sorts first."""
    dated = _DATED.search(table.name) is not None
    computer, contracted = table.kind == "computer", table.grade not in _UNCONTRACTED
    return computer, table.dots == 8, dated, contracted, len(table.language), table.name


class BrailleTable:
    """A table of liblouis.

    Parameters
    ----------
    name
        File name of a table that liblouis has, or a path.
    undefined
        What is written for a character that neither the table nor a plain spelling can write.

    Raises
    ------
    InputError
        If there is no such table; the message names the nearest.
    """

    def __init__(self, name: str, undefined: Undefined = Undefined.MARK) -> None:
        self.name = name
        self.undefined = undefined
        try:
            if not 0 < len(name) <= _LONGEST_NAME or "\0" in name:
                raise RuntimeError
            LOUIS.translate(name, "a")
        except RuntimeError:
            names = [table.name for table in list_tables()]
            raise InputError(
                f"unknown braille table {name!r}{nearest(name, names, 3)} "
                f"(vbraille tables lists all)"
            ) from None

    def translate(self, text: str) -> Cells:
        """Cells of a paragraph; the first stands for place 0."""
        return self.write(text).cells(len(text))

    def write(self, text: str, marks: Sequence[Mark] = ()) -> Written:
        """Dots of a text, with what was written otherwise than it stands."""
        forms = None
        for mark in marks:
            if bit := _EMPHASIS.get(mark.kind):
                forms = forms or [0] * len(text)
                for place in range(mark.start, min(mark.end, len(text))):
                    forms[place] |= bit
        written = write(self.name, text, forms, self.undefined)
        if not self.eight_dots:
            written.masks = bytes(mask & _SIX_DOTS for mask in written.masks)
        return written

    def unknown(self, text: str) -> str:
        """Characters of a text that only a marker can stand for, each once."""
        found = self.write(text).otherwise
        return "".join(part for kind, part in found if kind in (Kind.MARKED, Kind.UNENDING))

    def cells_of(self, text: str) -> bytes:
        """Dot masks of a short text; none if the table leaves some of it undefined."""
        return cells_of(self.name, text)

    def divide(self, text: str, place: int) -> tuple[bytes, bytes]:
        """Cells that end a line within a word or a number, and those that begin the next line.

        Parameters
        ----------
        text
            Text of the block.
        place
            Index of the character at which the next line begins.
        """
        before, after = text[place - 1], text[place]
        numbers = before.isdecimal() and after.isdecimal()
        if numbers and self.is_ueb:
            return _UEB_CONTINUATION, b""
        following = "".join(text[place:].split(None, 1)[:1])
        word = "".join(text[:place].split()[-1:]) + following
        ending, sign = self.cells_of("-")[-1:] or _HYPHEN, b""
        if before in _PARTING or after in _PARTING:
            ending = b""  # a line may end at these
        elif self.is_ueb and not word.strip(_PUNCTUATION).isalpha():
            ending = _UEB_CONTINUATION
        if numbers:
            sign = self.cells_of(after)[:-1]
        elif before.isupper() and after.isupper():
            whole, small = map(self.cells_of, (following, following.lower()))
            sign = whole.removesuffix(small) if small and whole.endswith(small) else b""
        return ending, sign

    @cached_property
    def info(self) -> TableInfo:
        """Metadata of the table; all of it is empty for one that has none."""
        found = (table for table in list_tables() if table.name == self.name)
        return next(found, TableInfo(self.name))

    @cached_property
    def eight_dots(self) -> bool:
        """Tell if the table writes with dots 7 and 8, but for letters of other scripts."""
        if self.info.dots or self.info.kind == "literary":
            return self.info.dots == 8
        masks = LOUIS.translate(self.name, string.ascii_letters + string.digits).masks
        return max(masks, default=0) > _SIX_DOTS

    @cached_property
    def is_ueb(self) -> bool:
        """Tell if this is a table of Unified English Braille."""
        return self.name.startswith("en-ueb")

    @property
    def said(self) -> str:
        """Language and grade in words, such as "German contracted braille, grade 2"."""
        grade = f", grade {self.info.grade}" if self.info.grade else ""
        return f"{self.info.title}{grade}" if self.info.title else self.name


def choose_table(
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> BrailleTable:
    """Table by its name, or by a language and a grade.

    Parameters
    ----------
    language
        Language, such as "fr" or "pt-BR"; English if nothing is given.
    grade
        0 or 1 for uncontracted braille, 2 and up for contracted; None for what is usual.
    table
        Name of a liblouis table, in place of a language and grade.
    undefined
        What is written for a character that the table cannot write.

    Raises
    ------
    InputError
        If there is no such table, or both a table and a language are given.
    """
    if undefined not in list(Undefined):
        raise InputError(f"undefined is {undefined!r:.40}; it must be {' or '.join(Undefined)}")
    if table is None:
        table = find_table("en" if language is None else language, grade)
    elif language is not None or grade is not None:
        raise InputError(
            f"a table has its language and grade; give either {setting('table')} or those"
        )
    return BrailleTable(table, Undefined(undefined))


def table_of(language: str, grade: int | None = None) -> BrailleTable | None:
    """Table of a language and a grade; None if there is none."""
    try:
        return BrailleTable(find_table(language, grade))
    except InputError:
        return None


def translate_text(
    text: str,
    language: str | None = None,
    grade: int | None = None,
    table: str | None = None,
    undefined: Undefined | str = Undefined.MARK,
) -> Cells:
    """Translate a text to cells, each of which knows the characters that it stands for.

    Parameters
    ----------
    text
        Text of one paragraph.
    language, grade, table, undefined
        As of `choose_table`.

    Raises
    ------
    InputError
        If something cannot be used.

    Examples
    --------
    >>> import vbraille
    >>> cells = vbraille.translate_text("the world", language="en", grade=2)
    >>> cells.to_unicode(), cells.source(0), cells.of_source(4)
    ('⠮⠀⠸⠺', (0, 3), (2, 4))
    """
    return choose_table(language, grade, table, undefined).translate(text)
