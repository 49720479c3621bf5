"""Withdrawal of a participant: all that holds data of one person is found, and removed.

Sessions, tables, datasets and reports below some directories are looked through. A report, which
can be made again, is removed, since its numbers are made of all.
"""

from __future__ import annotations

import csv
import io
import re
import shutil
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from vbraille.csvfiles import parse_csv
from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.sessions.record.bids import DATASET, PEOPLE, PSEUDONYM
from vbraille.sessions.record.record import Record, RecordError, connect, told

TABLES = {".csv": ",", ".tsv": "\t"}
TEXTS = (*TABLES, ".json", ".txt", ".md", ".html", ".svg", ".toml", ".brf")
PERSON = ("participant", PSEUDONYM)  # columns that tell whose a row is
REPORT = "report.html"
MOST_BYTES = 200_000_000  # of a file that is looked through


@dataclass
class Withdrawal:
    """Data of a person.

    Parameters
    ----------
    participant
        Pseudonym of the person.
    whole
        Directories and files that are removed, each with words for what it is.
    rows
        Tables that lose rows, and how many.
    left
        Files that name the person and stay.
    """

    participant: str
    whole: dict[Path, str] = field(default_factory=dict)
    rows: dict[Path, int] = field(default_factory=dict)
    left: list[Path] = field(default_factory=list)

    @property
    def lines(self) -> list[str]:
        """Lines on what is removed, a path in each."""
        tables = [f"{path}: {count} rows of the table" for path, count in self.rows.items()]
        return [f"{path}: {what}" for path, what in self.whole.items()] + tables

    def remove(self) -> None:
        """Remove all of it.

        Raises
        ------
        RecordError
            If a session is being run; nothing is removed then.
        VbrailleError
            If the disk fails. The same call goes on where it was.
        """
        for path in self.whole:
            if path.suffix == ".session":
                Record(path).close()
        try:
            # The table of people comes last: until then a dataset tells whose it is.
            for path in self.whole:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
            for path in sorted(self.rows, key=lambda path: path.name == PEOPLE):
                mode = path.stat().st_mode
                write_file(path, _without(path, self.participant), replace=True, durable=True)
                path.chmod(mode)
        except OSError as error:
            said = f"{error.filename} could not be removed: {error.strerror}"
            raise VbrailleError(f"{said}; mend that, and withdraw again") from None


def withdrawal(folders: Iterable[Path], participant: str) -> Withdrawal:
    """Find what there is of a person below some directories.

    Raises
    ------
    InputError
        If a directory is missing.
    """
    found = Withdrawal(participant)
    word = re.compile(rf"(?<![A-Za-z0-9_-]){re.escape(participant)}(?![A-Za-z0-9_])")
    for folder in folders:
        if not folder.is_dir():
            raise InputError(f"there is no directory {folder}; give one that sessions are in")
        for path in sorted(folder.rglob("*")):
            if path.is_file() and not any(parent in found.whole for parent in path.parents):
                _look_at(path, found, word)
    return found


def _look_at(path: Path, found: Withdrawal, word: re.Pattern[str]) -> None:
    """Note what a file has of the person."""
    if path.suffix == ".session":
        if _whose(path) == found.participant:
            found.whole[path] = "a session"
    elif path.suffix not in TEXTS or path.stat().st_size > MOST_BYTES:
        return
    elif path.name == PEOPLE and (path.parent / DATASET).exists():
        for label in _labels(path, found.participant):
            found.whole[path.parent / label] = "a person of a dataset"
            found.rows[path] = 1
    elif not word.search(path.read_text("utf-8", "replace")):
        return
    elif (report := _report_of(path)) is not None:
        found.whole[report] = "a report, which can be made again without the person"
    elif path.suffix in TABLES and (count := len(_rows_of(path, found.participant))):
        found.rows[path] = count
    elif path.suffix == ".txt" and f"participant {found.participant}, seed" in path.read_text():
        found.whole[path] = "a plan"
    else:
        found.left.append(path)


def _report_of(path: Path) -> Path | None:
    return next((folder for folder in path.parents if (folder / REPORT).exists()), None)


def _whose(path: Path) -> str:
    """Return whose session a file is; empty if it cannot be read."""
    try:
        with told(path):
            db = connect(path, "ro")
            try:
                return str(db.execute("SELECT participant FROM session").fetchone()[0])
            finally:
                db.close()
    except (RecordError, TypeError):
        return ""


def _table(path: Path) -> tuple[list[list[str]], int]:
    """Return the rows of a table, and the number of the column that tells whose a row is."""
    try:
        sheet = parse_csv(path.read_bytes(), str(path))
    except InputError:
        return [], -1
    own = next((name for name in PERSON if name in sheet.columns), None)
    return [list(sheet.columns), *sheet.rows], -1 if own is None else sheet.columns.index(own)


def _rows_of(path: Path, participant: str) -> list[list[str]]:
    rows, column = _table(path)
    return [row for row in rows[1:] if column >= 0 and row[column] == participant]


def _labels(path: Path, participant: str) -> list[str]:
    """Return the names that a dataset has for a person's directory."""
    return [row[0] for row in _rows_of(path, participant)]


def _without(path: Path, participant: str) -> bytes:
    """Return a table without a person's rows."""
    rows, column = _table(path)
    text = io.StringIO()
    writer = csv.writer(text, delimiter=TABLES[path.suffix], lineterminator="\n")
    writer.writerows(row for row in rows if row[column] != participant)
    return text.getvalue().encode()
