"""Tables that people give: CSV files and sessions as columns of text."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.translate.documents.encodings import binary_kind, find_encoding
from vbraille.wording import nearest

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

_DELIMITERS = ",;\t"  # spreadsheets write semicolons where the comma is the decimal point


@dataclass(frozen=True, slots=True)
class Sheet:
    """Columns of text, all of one length.

    Parameters
    ----------
    name
        Of the file or the session, as an error has it.
    columns
        Values by the columns' names.
    lines
        Where each row stands in the file; empty if it comes from no file.
    decimal_comma
        Whether numbers may have a comma for a point.
    """

    name: str
    columns: dict[str, list[str]]
    lines: Sequence[int] = ()
    decimal_comma: bool = False

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()), ()))

    def place(self, row: int) -> str:
        """Where a row is, for a sentence."""
        return f"{self.name} line {self.lines[row]}" if self.lines else f"{self.name} row {row + 1}"

    def need(self, names: Sequence[str]) -> None:
        """See that columns are there.

        Raises
        ------
        InputError
            If some are not: naming those that are nearest.
        """
        missing = [name for name in names if name not in self.columns]
        if missing:
            others = [name for name in self.columns if name not in names]
            said = "; ".join(_miss(name, others) for name in missing)
            raise InputError(
                f"{self.name} needs columns {', '.join(names)}: {said}; "
                f"rename or add what is missing"
            )

    def number(self, text: str) -> float:
        """Value of a number.

        Raises
        ------
        ValueError
            If it is none.
        """
        return float(text.replace(",", ".") if self.decimal_comma else text)


def read_csv(path: Path) -> Sheet:
    """Read a CSV file, its column names first.

    Raises
    ------
    InputError
        If it is no such file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    kind = binary_kind(content[:512])
    if kind is not None:
        raise InputError(f"{path} is {kind}; give a CSV file or the directory of a session")
    encoding = find_encoding(content[:65_536])
    text = content[encoding.skip :].decode(encoding.name, "replace")
    first = text.lstrip().split("\n", 1)[0]
    delimiter = max(_DELIMITERS, key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter)
    try:
        return _columns(reader, path.name, decimal_comma=delimiter == ";")
    except csv.Error as error:
        raise InputError(f"{path.name} line {reader.line_num} is no CSV: {error}") from None


def from_rows(name: str, rows: Sequence[Mapping[str, Any]]) -> Sheet:
    """Sheet of a session's rows, as its export has them."""
    names = list(rows[0]) if rows else []
    return Sheet(name, {column: [str(row[column]) for row in rows] for column in names})


def _miss(name: str, others: Sequence[str]) -> str:
    return f"there is no {name}" + (f", {nearest(name, others)}" if others else "")


def _columns(reader: Any, name: str, *, decimal_comma: bool) -> Sheet:
    rows = (row for row in reader if "".join(row).strip())
    heads = [head.strip() for head in next(rows, [])]
    if not heads:
        raise InputError(f"{name} is empty; its first line must have the names of the columns")
    twice = sorted({head for head in heads if heads.count(head) > 1})
    if twice:
        raise InputError(f"{name} has column {twice[0] or 'without a name'} twice; rename one")
    columns: list[list[str]] = [[] for _ in heads]
    lines: list[int] = []
    known: dict[str, str] = {}  # few values, many times
    for row in rows:
        if len(row) != len(heads):
            raise InputError(
                f"{name} line {reader.line_num} has {len(row)} values, and the first line has "
                f"{len(heads)} columns; mend that line"
            )
        for column, value in zip(columns, row, strict=True):
            column.append(known.setdefault(value, value))
        lines.append(reader.line_num)
    return Sheet(name, dict(zip(heads, columns, strict=True)), lines, decimal_comma)
