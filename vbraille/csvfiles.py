"""Tables in CSV, however a program wrote them: all cells as text."""

from __future__ import annotations

import codecs
import csv
import io
import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError
from vbraille.files import cell_text

if TYPE_CHECKING:
    from collections.abc import Sequence

SEPARATORS = ",;\t"
_UTF16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


@dataclass(frozen=True)
class Sheet:
    """A table of text.

    Parameters
    ----------
    name
        Name of the file, for messages.
    columns
        Names of the columns, each once.
    rows
        Cells of each row, as many as there are columns; an empty cell is an empty string.
    lines
        Line of the file on which each row begins, from 1.
    """

    name: str
    columns: tuple[str, ...]
    rows: list[list[str]]
    lines: list[int]

    def records(self) -> list[dict[str, str]]:
        """Return each row as a dict by the names of the columns."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]


def read_csv(path: str | Path) -> Sheet:
    """Read a file; `parse_csv` describes what it may be.

    Raises
    ------
    InputError
        If it cannot be read, or is no table.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from None
    return parse_csv(data, str(path))


def parse_csv(data: bytes, name: str, columns: Sequence[str] = ()) -> Sheet:
    """Read a table with a first row of names, unless they are given.

    Text is UTF-8, UTF-16 with its mark, or else Windows-1252. Cells are separated by commas,
    semicolons or tabs; a first line such as ``sep=;`` says by which. Blanks around a cell go, and a
    line break inside one becomes a blank. An apostrophe goes that keeps a spreadsheet from taking a
    cell for a formula. Columns without a name and rows without a cell are left
    out.

    Raises
    ------
    InputError
        If it is no table; the message names the line.
    """
    text = _decode(data)
    skipped = 0
    first, _, rest = text.partition("\n")
    told = re.fullmatch(r'"?sep=(.)"?', first.strip("\r "))
    if told:
        text = rest
        skipped = 1
        first = rest.partition("\n")[0]
    separator = told[1] if told else max(SEPARATORS, key=first.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    found: list[tuple[int, list[str]]] = []
    line = skipped + 1
    try:
        for row in reader:
            cells = [_tidy(cell) for cell in row]
            if any(cells):
                found.append((line, cells))
            line = skipped + reader.line_num + 1
    except csv.Error as error:
        raise InputError(f"{name}: line {line} has a cell that does not end: {error}") from None
    if columns:
        found.insert(0, (0, [*columns]))
    if not found:
        raise InputError(f"{name} is empty; give a table whose first row names its columns")
    _, header = found[0]
    header = [unicodedata.normalize("NFC", column) for column in header]
    kept = [n for n, column in enumerate(header) if column]
    for n in kept:
        if header.index(header[n]) < n:
            raise InputError(f"{name} has two columns {header[n]!r}; rename one")
    rows = []
    for line, cells in found[1:]:
        if any(cells[len(header) :]):
            raise InputError(
                f"{name}: line {line} has {len(cells)} cells, and there are {len(header)} columns"
            )
        cells += [""] * (len(header) - len(cells))
        rows.append([cells[n] for n in kept])
    return Sheet(name, tuple(header[n] for n in kept), rows, [line for line, _ in found[1:]])


def _decode(data: bytes) -> str:
    if data.startswith(_UTF16):
        return data.decode("utf-16", errors="replace")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("cp1252", errors="replace")


def _tidy(cell: str) -> str:
    cell = cell.strip()
    if "\n" in cell or "\r" in cell:
        cell = " ".join(line.strip() for line in cell.splitlines())
    return cell_text(cell) if cell.startswith("'") else cell
