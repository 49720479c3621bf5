"""Translation by liblouis; the only module that imports its binding.

liblouis is not thread-safe and the binding lets go of the interpreter's lock,
so that two threads at once would crash the process: one lock guards every call.
"""

from __future__ import annotations

import ctypes
import itertools
import threading
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vbraille.braille.cells import UNICODE_BLANK, Cells
from vbraille.errors import InputError, VbrailleError
from vbraille.translate.emphasis import CLASSES, typeforms
from vbraille.translate.levels import Superscripts
from vbraille.translate.scripts import all_letters, native_letters
from vbraille.translate.substitutes import Substitutes
from vbraille.translate.text import SPACE, Text, to_codes, to_text
from vbraille.translate.undefined import Undefined
from vbraille.wording import nearest

try:
    import louis
except ImportError as error:
    raise VbrailleError(
        "liblouis's Python binding is missing; install it (Debian: apt-get install python3-louis) "
        "and run make setup"
    ) from error

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vbraille.translate.scripts import Script
    from vbraille.translate.source import Mark

# In bytes; liblouis puts a name, with a folder before it, into 2 kB without checking that it fits.
_LONGEST_NAME = 1_000

_MODE = louis.dotsIO | louis.ucBrl
_SIX_DOTS = bytes(range(64))
_SMALL = "abcdefghijklmnopqrstuvwxyz"
_DIGITS = "0123456789"

_lock = threading.RLock()
# Our own prototypes: the binding would copy every number of the maps through Python lists.
# Indexing a ctypes library makes a function object that the binding does not share.
_translate = louis.liblouis["lou_translate"]
_translate.argtypes = [ctypes.c_char_p, *[ctypes.c_void_p] * 9, ctypes.c_int]
_list_tables = louis.liblouis["lou_listTables"]
_list_tables.restype = ctypes.POINTER(ctypes.c_char_p)
_get_info = louis.liblouis["lou_getTableInfo"]
_get_info.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
_get_info.restype = ctypes.c_char_p
_form_of = louis.liblouis["lou_getTypeformForEmphClass"]
_form_of.argtypes = [ctypes.c_char_p, ctypes.c_char_p]
_form_of.restype = ctypes.c_ushort


@louis.LogCallback
def _say_nothing(_level: int, _message: bytes) -> None:
    """Keep liblouis off stderr; an exception says what goes wrong."""


louis.liblouis.lou_registerLogCallback(_say_nothing)


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
        """Whether the table is for a language, given by a tag in lower case with hyphens."""
        tag = self.language.lower()
        return tag == language or tag.startswith(f"{language}-")


def library_version() -> str:
    """Version of liblouis, such as 3.24.0."""
    return louis.version()


@cache
def list_tables() -> tuple[TableInfo, ...]:
    """All tables that have metadata, by name."""
    with _lock:  # asked once: liblouis 3.24 has nothing to free the answers with
        return tuple(sorted(_table_info(str(path).encode()) for path in _table_paths()))


@cache
def _table_paths() -> tuple[Path, ...]:
    """Paths of the tables that have metadata."""
    with _lock:
        paths: list[bytes] = list(itertools.takewhile(bool, _list_tables()))
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
    try:
        if not known or len(table.encode("utf-8", "surrogateescape")) > _LONGEST_NAME:
            raise RuntimeError
        with _lock:
            found = louis.charToDots([table], characters)
    except RuntimeError:
        folders = {path.parent for path in _table_paths()}
        names = sorted(path.name for folder in folders for path in folder.glob("*.dis"))
        raise InputError(f"there is no display table {table!r}{nearest(table, names, 3)}") from None
    return [ord(dots) & 0xFF for dots in found]


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

    Raises
    ------
    InputError
        If there is no such table, or liblouis cannot compile it; the message names the nearest.
    """

    def __init__(self, name: str, undefined: Undefined = Undefined.MARK) -> None:
        self.name = name
        self.how = undefined
        self._list = name.encode("utf-8", "surrogateescape")
        with _lock:
            known = bool(name.strip()) and "\0" not in name and len(self._list) <= _LONGEST_NAME
            if not known or not louis.liblouis.lou_checkTable(self._list):
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
        if not any(self._writes_some(letters()) for letters in (lambda: _SMALL, all_letters)):
            raise InputError(
                f"{name} has no braille in it, as tables for hyphenation have not; give a braille "
                f"table (vbraille tables lists all)"
            )

    def _writes_some(self, text: str) -> bool:
        """Whether the table has dots of its own for any character of a text."""
        return bool(self._call(to_codes(text), _MODE | louis.noUndefined)[0].any())

    @property
    def info(self) -> TableInfo | None:
        """Metadata of the table; None if it has none."""
        return next((t for t in list_tables() if t.name == Path(self.name).name), None)

    @cached_property
    def said(self) -> str:
        """Language and grade in words, such as "German contracted braille, grade 2".

        A table that does not say what it is has its name.
        """
        with _lock:
            title, index, grade = (
                (_get_info(self._list, key) or b"").decode("utf-8", "replace")
                for key in (b"display-name", b"index-name", b"grade")
            )
        words = title or index
        if not words:
            return self.name
        return f"{words}, grade {grade}" if grade else words

    @cached_property
    def eight_dots(self) -> bool:
        """Whether this is a table of eight-dot braille; a six-dot table writes no dot 7 or 8.

        Metadata may leave it unsaid, or say it of a table that never raises dots 7 and 8.
        Six-dot tables may have eight-dot cells for capitals or letters of another script.
        """
        with _lock:
            said = _get_info(self._list, b"dots")
            literary = _get_info(self._list, b"type") != b"computer"
            described = bool(_get_info(self._list, b"language")) and literary
        if said == b"6":
            return False
        if said == b"8" or not described:
            return self._high(_SMALL + _SMALL.upper() + _DIGITS) or self._high(native_letters())
        has_digits = self._call(to_codes(_DIGITS), _MODE | louis.noUndefined)[0].any()
        return self._high(_DIGITS if has_digits else _SMALL)

    @cached_property
    def is_ueb(self) -> bool:
        """Whether this is a table of Unified English Braille."""
        with _lock:
            return _get_info(self._list, b"system") == b"ueb"

    def spelled(self, text: str) -> NDArray[np.uint8]:
        """Dot masks of a short text of ASCII, without contractions where the table can do so."""
        codes = self._substitutes.put_into(Text.of(text))[0]
        masks, _ = self._call(codes, _MODE | louis.noContractions)
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

    def translate(self, text: Text, marks: tuple[Mark, ...] = ()) -> Cells:
        """Cells of a paragraph's text; no character is left out unless that was asked for.

        The replacement of a character that the table does not know is written by the rules of the
        table, so that it reads back like any other text. Emphasis among the marks is written as
        the table does it; the cells that say so stand for the character next to them. Superscripts
        and subscripts are set apart, those among the characters of Unicode, too.
        """
        text, marks = self._superscripts.put_into(text, marks)
        codes, places = self._substitutes.put_into(text)
        forms = typeforms(marks, places, self._form) if marks else None
        masks, inputs = self._call(codes, _MODE, forms)
        if not masks.size:
            return Cells(masks, np.empty(0, np.int64), text.end)
        if masks.tobytes().translate(None, _SIX_DOTS) and not self.eight_dots:
            masks &= 0x3F  # a rule for neighbours that raises what neither raises alone
        return Cells(masks, places[inputs], text.end)

    def _form(self, name: str) -> int:
        """Bit of a class of emphasis; 0 if the table has no such class."""
        if name not in self._forms:
            with _lock:
                self._forms[name] = _form_of(self._list, name.encode())
        return self._forms[name]

    def _grow(self, characters: int) -> None:
        cells = characters * louis.outlenMultiplier
        self._room = characters
        self._out = np.empty(cells, np.uint32 if louis.wideCharBytes == 4 else np.uint16)
        self._inputs = np.empty(cells, np.int32)
        self._outputs = np.empty(cells, np.int32)

    def _call(
        self, codes: NDArray[np.uint32], mode: int, forms: NDArray[np.uint16] | None = None
    ) -> tuple[NDArray[np.uint8], NDArray[np.int32]]:
        """Translate code points; give dot masks, and for each the index of its character."""
        if louis.wideCharBytes == 2:  # liblouis built with UTF-16: places count its units
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
        with _lock:
            if units.size > self._room:
                self._grow(2 * units.size)
            self._in_length.value = units.size
            # Larger arrays would cost time: liblouis clears and copies all that it is offered.
            self._out_length.value = units.size * louis.outlenMultiplier
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
        """Whether the table has dots of its own for a character, and only dots that it may use."""
        if code in (0, SPACE):
            return code == SPACE
        masks, _ = self._call(np.array([code], np.uint32), _MODE | louis.noUndefined)
        if not masks.any():
            return masks.size > 0 and code == UNICODE_BLANK
        return masks.max() <= 0x3F or self.eight_dots

    def _high(self, letters: str) -> bool:
        """Whether any of these letters that the table knows is written with dot 7 or 8."""
        masks, _ = self._call(to_codes(letters), _MODE | louis.noUndefined)
        return bool(masks.size) and bool(masks.max() > 0x3F)


def _is_file(name: str) -> bool:
    try:
        return Path(name).is_file()
    except OSError:  # the name is longer than names can be
        return False


def _table_files() -> list[str]:
    return [table.name for table in list_tables()]
