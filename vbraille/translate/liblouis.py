"""Translation by liblouis."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import pairwise, takewhile
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError, VbrailleError
from vbraille.translate.levels import Superscripts
from vbraille.translate.library import LIBRARY, EndlessError, call, limit_s
from vbraille.translate.scripts import all_letters, native_letters
from vbraille.translate.source import NO_BREAK_SPACE, SPACE, MarkKind, Text, to_codes, to_text
from vbraille.translate.substitutes import Substitutes, Undefined
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from vbraille.translate.scripts import Script
    from vbraille.translate.source import Mark

# Names that tables give the classes. Few tables have the last two.
CLASSES = {
    MarkKind.ITALIC: "italic",
    MarkKind.BOLD: "bold",
    MarkKind.UNDERLINE: "underline",
    MarkKind.SUPERSCRIPT: "super",
    MarkKind.SUBSCRIPT: "sub",
}


def typeforms(
    marks: Iterable[Mark], places: NDArray[np.int64], form_of: Callable[[str], int]
) -> NDArray[np.uint16] | None:
    """Emphasis of each character, as liblouis takes it; None if none is emphasised.

    Parameters
    ----------
    marks
        Marks of the text; those that are no emphasis are left out.
    places : int64[n]
        Place of each character in the source, never decreasing.
    form_of
        Function that gives the bit that a table has for a class; 0 if it has no such class.

    Returns
    -------
    uint16[n] or None
        The bits of all classes that each character is in.
    """
    forms = None
    for mark in marks:
        name = CLASSES.get(mark.kind)
        bit = 0 if name is None else form_of(name)
        if not bit:
            continue
        start, stop = np.searchsorted(places, (mark.start, mark.end)).tolist()
        if start < stop:
            if forms is None:
                forms = np.zeros(places.size, np.uint16)
            forms[start:stop] |= bit
    return forms


# In bytes; liblouis puts a name, with a folder before it, into 2 kB without checking that it fits.
_LONGEST_NAME = 1_000

_NO_CONTRACTIONS, _DOTS_IO, _UNICODE_BRAILLE, _NO_UNDEFINED = 1, 4, 64, 128
_MODE = _DOTS_IO | _UNICODE_BRAILLE
_SIX_DOTS = bytes(range(64))
_SMALL = "abcdefghijklmnopqrstuvwxyz"
_DIGITS = "0123456789"
_MOST_ENDLESS = 3  # words of a text that are tried one after the other

_text, _place = ctypes.c_char_p, ctypes.c_void_p
_version = LIBRARY["lou_version"]
_version.restype = _text
_check_table = LIBRARY["lou_checkTable"]
_check_table.argtypes = [_text]
_translate = LIBRARY["lou_translate"]
_translate.argtypes = [_text, *[_place] * 9, ctypes.c_int]
_to_dots = LIBRARY["lou_charToDots"]
_to_dots.argtypes = [_text, _place, _place, ctypes.c_int, ctypes.c_int]
_list_tables = LIBRARY["lou_listTables"]
_list_tables.restype = ctypes.POINTER(_text)
_get_info = LIBRARY["lou_getTableInfo"]
_get_info.argtypes = [_text, _text]
_get_info.restype = _text
_form_of = LIBRARY["lou_getTypeformForEmphClass"]
_form_of.argtypes = [_text, _text]
_form_of.restype = ctypes.c_ushort
# liblouis is built with characters of four bytes or of two, and a character may become so many.
_WIDE = np.uint32 if LIBRARY["lou_charSize"]() == 4 else np.uint16
_MOST_CELLS = 4 + 2 * np.dtype(_WIDE).itemsize


@ctypes.CFUNCTYPE(None, ctypes.c_int, _text)
def _say_nothing(_level: int, _message: bytes) -> None:
    """Keep liblouis off stderr; an exception says what goes wrong."""


LIBRARY["lou_registerLogCallback"](_say_nothing)


@dataclass(frozen=True, slots=True, order=True)
class TableInfo:
    """Metadata of a table.

    Parameters
    ----------
    name
        File name, which is what `BrailleTable` takes.
    title
        Display name.
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
    title: str
    language: str
    grade: str
    dots: int
    kind: str

    def speaks(self, language: str) -> bool:
        """Tell whether the table is for a language, given by a tag in lower case with hyphens."""
        tag = self.language.lower()
        return tag == language or tag.startswith(f"{language}-")


def library_version() -> str:
    """Version of liblouis, such as 3.24.0."""
    return (_version() or b"").decode()


@cache
def list_tables() -> tuple[TableInfo, ...]:
    """All tables that have metadata, by name."""
    paths = [str(path).encode() for path in _table_paths()]
    # Asked once: liblouis 3.24 has nothing to free the answers with.
    return tuple(sorted(call(lambda: [_table_info(path) for path in paths])))


@cache
def _table_paths() -> tuple[Path, ...]:
    """Paths of the tables that have metadata."""
    paths: list[bytes] = call(lambda: list(takewhile(bool, _list_tables())))
    return tuple(Path(path.decode()) for path in paths)


def _table_info(path: bytes) -> TableInfo:
    def value(key: str) -> str:
        return (_get_info(path, key.encode()) or b"").decode("utf-8", "replace")

    return TableInfo(
        name=Path(path.decode()).name,
        title=value("display-name") or value("index-name"),
        language=value("language"),
        grade=value("grade"),
        dots=int(value("dots") or 0),
        kind=value("type"),
    )


def display_dots(table: str, characters: str) -> list[int]:
    """Dot masks that a display table has for characters; 0 for what it does not know, and blanks.

    Parameters
    ----------
    table
        File name of a display table that liblouis has (``de-eurobrl6.dis``), or a path.
    characters
        Characters to look up, each in the Basic Multilingual Plane.

    Raises
    ------
    InputError
        If there is no such table; the message names the nearest.
    """
    known = bool(table.strip()) and not {"\0", ","} & set(table)
    name = table.encode("utf-8", "surrogateescape")
    units = np.array([ord(character) for character in characters], _WIDE)
    dots = np.empty_like(units)
    given = name, units.ctypes.data, dots.ctypes.data, units.size, 0
    if not known or len(name) > _LONGEST_NAME or not call(lambda: _to_dots(*given)):
        folders = {path.parent for path in _table_paths()}
        names = sorted(path.name for folder in folders for path in folder.glob("*.dis"))
        raise InputError(f"there is no display table {table!r}{nearest(table, names, 3)}")
    return (dots & 0xFF).tolist()


class BrailleTable:
    """A compiled braille table.

    Parameters
    ----------
    name
        File name of a table that liblouis has (``en-ueb-g2.ctb``), a path, or several of these
        with commas in between, as liblouis reads them.
    undefined
        What is written for a character that the table does not know.

    Attributes
    ----------
    undefined : set of int
        Code points that occurred and that the table does not know.
    how : Undefined
        What is written for them.
    endless : set of str
        Words that occurred and are marked, since liblouis does not come to an end with them.

    Raises
    ------
    InputError
        If there is no such table, or liblouis cannot compile it; the message names the nearest.
    """

    def __init__(self, name: str, undefined: Undefined = Undefined.MARK) -> None:
        self.name = name
        self.how = undefined
        self._list = name.encode("utf-8", "surrogateescape")
        known = bool(name.strip()) and "\0" not in name and len(self._list) <= _LONGEST_NAME
        if not known or not call(lambda: _check_table(self._list)):
            names = _table_files()
            if name in names or _is_file(name):
                raise InputError(f"liblouis cannot use {name} as a braille table")
            raise InputError(
                f"there is no braille table {name!r}{nearest(name, names, 3)} "
                f"(vbraille tables lists all)"
            )
        self._substitutes = Substitutes(self._writes, undefined)
        self.undefined = self._substitutes.undefined
        self._forms: dict[str, int] = {}  # bits of classes of emphasis, 0 for those it has not
        self._superscripts = Superscripts(
            lambda text: self._call(to_codes(text), _MODE)[0].tobytes(),
            self._writes,
            lambda kind: bool(self._form(CLASSES[kind])),
        )
        self._in_length, self._out_length = ctypes.c_int(), ctypes.c_int()
        self._grow(1024)
        self.endless: set[str] = set()
        self._endless_due = self._endless_taken = False
        if not any(self._writes_some(letters()) for letters in (lambda: _SMALL, all_letters)):
            raise InputError(
                f"{name} has no braille in it, as tables for hyphenation have not; give a braille "
                f"table (vbraille tables lists all)"
            )

    def _writes_some(self, text: str) -> bool:
        """Tell whether the table has dots of its own for any character of a text."""
        return bool(self._call(to_codes(text), _MODE | _NO_UNDEFINED)[0].any())

    @property
    def info(self) -> TableInfo | None:
        """Metadata of the table; None if it has none."""
        return next((t for t in list_tables() if t.name == Path(self.name).name), None)

    @cached_property
    def said(self) -> str:
        """Language and grade in words, such as "German contracted braille, grade 2".

        A table that does not say what it is has its name.
        """
        keys = b"display-name", b"index-name", b"grade"
        title, index, grade = (
            (value or b"").decode("utf-8", "replace")
            for value in call(lambda: [_get_info(self._list, key) for key in keys])
        )
        words = title or index
        if not words:
            return self.name
        return f"{words}, grade {grade}" if grade else words

    @cached_property
    def eight_dots(self) -> bool:
        """Tell whether this is a table of eight-dot braille; a six-dot table writes no dot 7 or 8.

        Metadata may leave it unsaid, or say it of a table that never raises dots 7 and 8.
        Six-dot tables may have eight-dot cells for capitals or letters of another script.
        """
        keys = b"dots", b"type", b"language"
        said, kind, language = call(lambda: [_get_info(self._list, key) for key in keys])
        described = bool(language) and kind != b"computer"
        if said == b"6":
            return False
        if said == b"8" or not described:
            return self._high(_SMALL + _SMALL.upper() + _DIGITS) or self._high(native_letters())
        has_digits = self._call(to_codes(_DIGITS), _MODE | _NO_UNDEFINED)[0].any()
        return self._high(_DIGITS if has_digits else _SMALL)

    @cached_property
    def is_ueb(self) -> bool:
        """Tell if this is a table of Unified English Braille."""
        return call(lambda: _get_info(self._list, b"system")) == b"ueb"

    def spelled(self, text: str) -> NDArray[np.uint8]:
        """Dot masks of a short text of ASCII, without contractions where the table can do so."""
        codes = self._substitutes.put_into(Text.of(text))[0]
        masks, _ = self._call(codes, _MODE | _NO_CONTRACTIONS)
        return masks if self.eight_dots else masks & np.uint8(0x3F)

    @cached_property
    def brackets(self) -> str:
        """Opening and closing bracket that the table can write; full cells if it has none."""
        return next(pair for pair in ("[]", "()", "⠿⠿") if all(map(self._writes, map(ord, pair))))

    @property
    def marker(self) -> str:
        """Text that marks characters that the table does not know."""
        return self._substitutes.marker

    def take_foreign(self) -> Script | None:
        """Next script that a passage was in and the table does not know, each once; then None."""
        return self._substitutes.take_foreign()

    def take_endless(self) -> bool:
        """Tell if liblouis did not come to an end with a text; True once at most."""
        due = self._endless_due and not self._endless_taken
        self._endless_taken |= due
        return due

    def translate(self, text: Text, marks: tuple[Mark, ...] = ()) -> Cells:
        """Cells of a paragraph's text; no character is left out unless that was asked for.

        The replacement of a character that the table does not know is written by the rules of the
        table, so that it reads back like any other text. Emphasis among the marks is written as
        the table does it; the cells that say so stand for the character next to them. Superscripts
        and subscripts are set apart, those among the characters of Unicode, too. A text that
        liblouis does not come to an end with is translated word by word, and the words that it
        does not come to an end with are marked.
        """
        text, marks = self._superscripts.put_into(text, marks)
        codes, places = self._substitutes.put_into(text)
        forms = typeforms(marks, places, self._form) if marks else None
        try:
            masks, inputs = self._call(codes, _MODE, forms)
        except EndlessError:
            self._endless_due = True
            masks, inputs = self._call_by_words(codes, forms)
        if not masks.size:
            return Cells(masks, np.empty(0, np.int64), text.end)
        if masks.tobytes().translate(None, _SIX_DOTS) and not self.eight_dots:
            masks &= 0x3F  # a rule for neighbours that raises what neither raises alone
        return Cells(masks, places[inputs], text.end)

    def _call_by_words(
        self, codes: NDArray[np.uint32], forms: NDArray[np.uint16] | None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int64]]:
        """Translate each word alone, with the blank after it."""
        ends = np.flatnonzero((codes == SPACE) | (codes == NO_BREAK_SPACE)) + 1
        edges = [0, *ends[ends < codes.size].tolist(), codes.size]
        parts: list[tuple[NDArray[np.uint8], NDArray[np.int64]]] = []
        tries = _MOST_ENDLESS
        for start, stop in pairwise(edges):
            word = to_text(codes[start:stop]).strip()
            if tries and word not in self.endless:
                try:
                    form = None if forms is None else forms[start:stop]
                    masks, inputs = self._call(codes[start:stop], _MODE, form)
                    parts.append((masks, inputs + start))
                    continue
                except EndlessError:
                    tries -= 1
            self.endless.add(word)
            masks, _ = self._call(to_codes(self.marker + " "), _MODE)
            inputs = np.full(masks.size, start)
            inputs[-1] = stop - 1  # the blank
            blank = codes[stop - 1] in (SPACE, NO_BREAK_SPACE)
            parts.append((masks, inputs) if blank else (masks[:-1], inputs[:-1]))
        return np.concatenate([part[0] for part in parts]), np.concatenate([p[1] for p in parts])

    def _form(self, name: str) -> int:
        """Bit of a class of emphasis; 0 if the table has no such class."""
        if name not in self._forms:
            self._forms[name] = call(lambda: _form_of(self._list, name.encode()))
        return self._forms[name]

    def _grow(self, characters: int) -> None:
        cells = characters * _MOST_CELLS
        self._room = characters
        self._out = np.empty(cells, _WIDE)
        self._inputs = np.empty(cells, np.int32)
        self._outputs = np.empty(cells, np.int32)

    def _call(
        self, codes: NDArray[np.uint32], mode: int, forms: NDArray[np.uint16] | None = None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
        """Translate code points; give dot masks, and for each the index of its character."""
        if _WIDE is np.uint16:  # liblouis built with UTF-16: places count its units
            return self._call_utf16(codes, mode, forms)
        return self._call_units(np.ascontiguousarray(codes), mode, forms)

    def _call_utf16(
        self, codes: NDArray[np.uint32], mode: int, forms: NDArray[np.uint16] | None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
        units = np.frombuffer(to_text(codes).encode("utf-16-le", "surrogatepass"), np.uint16)
        character = np.repeat(np.arange(codes.size, dtype=np.int32), 1 + (codes > 0xFFFF))
        masks, inputs = self._call_units(units, mode, None if forms is None else forms[character])
        return masks, character[inputs]

    def _call_units(
        self, units: NDArray[np.unsignedinteger], mode: int, forms: NDArray[np.uint16] | None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
        if units.size == 0:
            return np.empty(0, np.uint8), np.empty(0, np.int32)
        return call(partial(self._call_now, units, mode, forms), limit_s(units.size))

    def _call_now(
        self, units: NDArray[np.unsignedinteger], mode: int, forms: NDArray[np.uint16] | None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
        if units.size > self._room:
            self._grow(2 * units.size)
        self._in_length.value = units.size
        # Larger arrays would cost time: liblouis clears and copies all that it is offered.
        self._out_length.value = units.size * _MOST_CELLS
        if forms is not None:  # liblouis writes into it, for each cell
            forms = np.pad(forms, (0, self._out_length.value - forms.size))
        done = _translate(
            self._list,
            units.ctypes.data,
            ctypes.addressof(self._in_length),
            self._out.ctypes.data,
            ctypes.addressof(self._out_length),
            None if forms is None else forms.ctypes.data,
            None,
            self._outputs.ctypes.data,
            self._inputs.ctypes.data,
            None,
            mode,
        )
        if not done or self._in_length.value != units.size:
            raise VbrailleError(f"liblouis could not translate a text with {self.name}")
        cells = self._out_length.value
        masks = self._out[:cells].astype(np.uint8)  # the low byte of U+2800-28FF
        # Places never decrease or fall below 0, whatever liblouis says of dropped characters.
        inputs = np.maximum(np.maximum.accumulate(self._inputs[:cells]), 0)
        return masks, inputs

    def _writes(self, code: int) -> bool:
        """Tell whether the table has dots of its own for a character, and only ones it may use."""
        if code in (0, SPACE):
            return code == SPACE
        try:
            masks, _ = self._call(np.array([code], np.uint32), _MODE | _NO_UNDEFINED)
        except EndlessError:
            return False
        if not masks.any():
            return masks.size > 0 and code == UNICODE_BLANK
        return masks.max() <= 0x3F or self.eight_dots

    def _high(self, letters: str) -> bool:
        """Tell whether any of these letters that the table knows is written with dot 7 or 8."""
        masks, _ = self._call(to_codes(letters), _MODE | _NO_UNDEFINED)
        return bool(masks.size) and bool(masks.max() > 0x3F)


def _is_file(name: str) -> bool:
    try:
        return Path(name).is_file()
    except OSError:  # the name is longer than names can be
        return False


def _table_files() -> list[str]:
    return [table.name for table in list_tables()]
