"""A braille table: text and its marks to cells."""

from __future__ import annotations

import string
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import Cells
from vbraille.errors import InputError
from vbraille.translate.blocks import MarkKind
from vbraille.translate.languages import TableInfo, find_table, list_tables, preference, tables_of
from vbraille.translate.liblouis import LOUIS, cells_of
from vbraille.translate.spellings import Kind, Undefined
from vbraille.translate.undefined import Written, write
from vbraille.wording import nearest, setting

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vbraille.translate.blocks import Mark

_SIX_DOTS = 0x3F
_LONGEST_NAME = 1_000  # liblouis puts a name into 2 kB without checking that it fits
_CLASSES = {
    MarkKind.ITALIC: "italic",
    MarkKind.BOLD: "bold",
    MarkKind.UNDERLINE: "underline",
    MarkKind.SUPERSCRIPT: "super",
    MarkKind.SUBSCRIPT: "sub",
}
_HYPHEN = b"\x24"  # dots 3 and 6
_UEB_CONTINUATION = b"\x10"  # dot 5, after which a number goes on without its sign
_PARTING = "-‐‑–—/"
_PUNCTUATION = ".,;:!?()[]«»“”‘’\"'…"


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
                f"unknown braille table {name[:_LONGEST_NAME]!r}"
                f"{nearest(name[:_LONGEST_NAME], names, 3)} (vbraille tables lists all)"
            ) from None

    def translate(self, text: str, marks: Sequence[Mark] = (), start: int = 0) -> Cells:
        """Cells of a text, whose first character is at a place of a book.

        Parameters
        ----------
        text, marks
            Text of a paragraph, and the emphasis of its parts.
        start
            Place of its first character.
        """
        return to_cells(self.write(text, marks), len(text), start)

    def write(self, text: str, marks: Sequence[Mark] = ()) -> Written:
        """Dots of a text, with what was written otherwise than it stands."""
        forms = None
        for mark in marks:
            if bit := self._emphasis.get(mark.kind):
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

    def divide(self, text: str, place: int, rest: bytes) -> tuple[bytes, bytes]:
        """Cells that end a line within a word or a number, and those that begin the next line.

        Parameters
        ----------
        text
            Text of the block.
        place
            Index of the character at which the next line begins.
        rest
            Cells of the word from there on.
        """
        before, after = text[place - 1], text[place]
        following = "".join(text[place:].split(None, 1)[:1])
        word = "".join(text[:place].split()[-1:]) + following
        numbers = before.isdecimal() and after.isdecimal()
        ending = self.cells_of("-")[-1:] or _HYPHEN
        if before in _PARTING or after in _PARTING:
            ending = b""  # a line may end at these
        elif self.is_ueb and (numbers or not word.strip(_PUNCTUATION).isalpha()):
            ending = _UEB_CONTINUATION
        sign = whole = b""
        if numbers and ending != _UEB_CONTINUATION:
            whole = self.cells_of(following)
            sign = whole.removesuffix(rest)
        elif before.isupper() and after.isupper():
            whole = self.cells_of(following)
            sign = whole.removesuffix(self.cells_of(following.lower()))
        return ending, sign if len(sign) < len(whole) else b""

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

    @cached_property
    def _emphasis(self) -> dict[MarkKind, int]:
        """Bits of the table's classes of emphasis; 0 for a class that it does not have."""
        bits = LOUIS.ask("emphasis_bits", self.name, list(_CLASSES.values()))
        return dict(zip(_CLASSES, bits, strict=True))


def to_cells(written: Written, length: int, start: int = 0) -> Cells:
    """Cells of what was written for a text of a length that begins at a place of a book."""
    masks = np.frombuffer(written.masks, np.uint8)
    return Cells(masks, np.array(written.places, np.int64) + start, start + length)


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


def six_dot_table(language: str) -> str | None:
    """Name of the most usual six-dot table of a language; None if there is none."""
    try:
        _, tables = tables_of(language)
        names = [find_table(language), *(table.name for table in sorted(tables, key=preference))]
        return next((name for name in names if not BrailleTable(name).eight_dots), None)
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
