"""Tables that people give, column by column as they came, and what one field of them says.

The standard library reads CSV files, as pandas tells neither the line of a row with too few
values nor, after empty lines, that of any row.
"""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import pandas as pd

from vbraille.analysis.statistics.intervals import LARGEST
from vbraille.braille.cells import UNICODE_BLANK
from vbraille.braille.spelling import LETTERS, UNREAD, to_braille
from vbraille.errors import InputError
from vbraille.files import cell_text
from vbraille.translate.encodings import binary_kind, decode
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

_DELIMITERS = ",;\t"  # spreadsheets write semicolons where the comma is the decimal point


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """A table as it was given.

    Parameters
    ----------
    name
        Name of the file or the session, as it stands in messages.
    frame
        Values: text from a file, empty where there is nothing; from a session, as
        `vbraille.sessions.record.export.frame_of` types them. The index is the number of each
        row's line or, from a session, of the row.
    unit
        Word for what the index counts.
    decimal_comma
        Whether numbers in text may have a comma for a point.
    typed
        Whether columns have their types, so that nothing is left to read and check.
    """

    name: str
    frame: pd.DataFrame
    unit: str = "row"
    decimal_comma: bool = False
    typed: bool = False

    def __len__(self) -> int:
        return len(self.frame)

    def place(self, row: object) -> str:
        """Words for where a row is, such as a message needs."""
        return f"{self.name} {self.unit} {row}"

    def need(self, names: Sequence[str]) -> None:
        """Check that columns are there.

        Raises
        ------
        InputError
            If some are missing; the message names the columns that are nearest.
        """
        missing = [name for name in names if name not in self.frame]
        if missing:
            others = [str(name) for name in self.frame if name not in names]
            said = "; ".join(_miss(name, others) for name in missing)
            raise InputError(
                f"{self.name} needs columns {', '.join(names)}: {said}; "
                f"rename or add what is missing"
            )

    def number(self, text: str) -> float:
        """Value of a number's text.

        Raises
        ------
        ValueError
            If the text is no number.
        """
        return float(text.replace(",", ".") if self.decimal_comma else text)

    def value(self, text: str) -> float:
        """Value of a number's text, NaN if it is not known, and infinity if it is none."""
        if text.strip().lower() in UNKNOWN:
            return math.nan
        try:
            return self.number(text)
        except ValueError:
            return math.inf


def read_csv(path: Path) -> Sheet:
    """Read a CSV file whose first row has the names of the columns.

    Parameters
    ----------
    path
        The file.

    Raises
    ------
    InputError
        If the file is not of this kind.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    kind = binary_kind(content[:512])
    if kind is not None:
        raise InputError(f"{path} is {kind}; give a CSV file or the directory of a session")
    text, _, _ = decode(content)
    first = text.lstrip().split("\n", 1)[0]
    delimiter = max(_DELIMITERS, key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    try:
        frame = _frame(reader, path.name)
    except csv.Error as error:
        raise InputError(f"{path.name} line {reader.line_num} is no CSV: {error}") from None
    return Sheet(path.name, frame, "line", decimal_comma=delimiter == ";")


def _miss(name: str, others: Sequence[str]) -> str:
    return f"there is no {name}{nearest(name, others, lead=', ')}"


def _frame(reader: Any, name: str) -> pd.DataFrame:
    rows = (row for row in reader if "".join(row).strip())
    heads = [head.strip() for head in next(rows, [])]
    if not heads:
        raise InputError(f"{name} is empty; its first line must have the names of the columns")
    twice = sorted({head for head in heads if heads.count(head) > 1})
    if twice:
        raise InputError(f"{name} has column {twice[0] or 'without a name'} twice; rename one")
    kept: list[list[str]] = []
    lines: list[int] = []
    known: dict[str, str] = {}  # few different values, which occur many times
    shared = known.setdefault
    for row in rows:
        if len(row) != len(heads):
            raise InputError(
                f"{name} line {reader.line_num} has {len(row)} values, and the first line has "
                f"{len(heads)} columns; mend that line"
            )
        kept.append([shared(value, value) for value in row])
        lines.append(reader.line_num)
    columns = [list(column) for column in zip(*kept, strict=True)] or [[] for _ in heads]
    if spelled := {cell: text for cell in known if (text := cell_text(cell)) != cell}:
        columns = [[spelled.get(cell, cell) for cell in column] for column in columns]
    return pd.DataFrame(dict(zip(heads, columns, strict=True)), lines, dtype=object)


UNKNOWN = frozenset(("", "n/a", "na", "nan"))  # a value that is not known, in any case
_PAIR = re.compile(r"\s*([0-9.,]+)\s+([0-9.,]+)\s*")
_CELLS = {
    UNREAD: UNREAD,
    **{chr(UNICODE_BLANK + mask): chr(UNICODE_BLANK + mask) for mask in range(256)},
    **{letter: to_braille((mask,)) for letter, mask in LETTERS.items()},
    **{letter.upper(): to_braille((mask,)) for letter, mask in LETTERS.items()},
}


def parse_cells(text: str) -> str:
    """Unicode braille of a string as a table has it: Unicode braille, or letters.

    Raises
    ------
    ValueError
        If something is no cell.
    """
    try:
        return "".join([_CELLS[place] for place in text.strip()])
    except KeyError as error:
        raise ValueError(
            f"is {text.strip()!r}, and {error.args[0]!r} is no cell; give letters a to z or "
            f"Unicode braille, with {UNREAD} for a place not read"
        ) from None


def parse_presented(text: str) -> str:
    """Unicode braille of what was shown, in which no place may be marked as unread."""
    cells = parse_cells(text)
    if not cells or UNREAD in cells:
        raise ValueError(f"is {text!r}; give the cells that were shown")
    return cells


def parse_name(text: str) -> str:
    """A name, which must not be empty."""
    if not text.strip():
        raise ValueError("is empty; name it")
    return text.strip()


def parse_whole(text: str) -> int:
    """A whole number; 0 if it is not known."""
    if text.strip().lower() in UNKNOWN:
        return 0
    if not re.fullmatch(r"[0-9]{1,9}(\.0)?", text.strip()):
        raise ValueError(f"is {text!r}; give a whole number from 1")
    return int(float(text))


def parse_seconds(text: str, *, value: Callable[[str], float]) -> float:
    """Seconds; NaN if they are not known.

    Parameters
    ----------
    value
        `Sheet.value` of the table.
    """
    seconds = value(text)
    if not (math.isnan(seconds) or 0 <= seconds <= LARGEST):
        raise ValueError(f"is {text!r}; give seconds, or nothing if they are not known")
    return seconds


def is_pair(presented: str) -> bool:
    """True if two values were presented, and not a string of cells."""
    return _PAIR.fullmatch(presented) is not None


def parse_pair(
    presented: str, answered: str, *, number: Callable[[str], float]
) -> tuple[float, float, int]:
    """First and second of two values, and which was chosen: 0 or 1.

    Parameters
    ----------
    number
        Function that gives the value of a number's text.
    """
    found = _PAIR.fullmatch(presented)
    try:
        first, second = map(number, found.groups() if found else ("", ""))
        chosen = number(answered)
    except ValueError:
        first = second = chosen = math.inf
    if first == second or chosen not in (first, second) or max(first, second) > LARGEST:
        raise ValueError(
            f"presented is {presented!r} and answered {answered!r}; a comparison presents two "
            f"values, such as 1.5 2, and is answered by one of them"
        )
    return first, second, int(chosen == second)
