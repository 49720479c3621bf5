"""Withdrawal of a participant: all that holds data of one person is found, and removed.

Sessions, tables of trials, datasets, plans and reports below some directories are looked through.
What holds the data of one person alone is removed as a whole; a table loses the person's rows; a
report, which can be made again, is removed, since its numbers are made of all. Nothing within the
session of another person is changed, as its sums would no longer hold.
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
import shutil
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.sessions.record.bids import DATASET, PEOPLE, PSEUDONYM
from vbraille.sessions.record.folder import HEAD, PLAN
from vbraille.sessions.record.journal import NAME, Journal
from vbraille.wording import count

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_TABLES = {".csv": ",", ".tsv": "\t"}
_TEXTS = (".csv", ".tsv", ".json", ".jsonl", ".txt", ".md", ".html", ".svg", ".toml", ".brf")
_MOST_BYTES = 200_000_000  # of a file that is looked through
_PERSON = ("participant", PSEUDONYM)  # columns that tell whose a row is
REPORT = "report.html"
_PLAN_LINE = "protocol: "


@dataclass(slots=True)
class Withdrawal:
    """Data of a person.

    Parameters
    ----------
    participant
        Pseudonym of the person.
    whole
        Directories and files that are removed, each with words for what it is.
    rows
        Tables that lose rows: number of these rows, by path.
    left
        Files that name the person and stay, since they belong to another record or to nothing that
        the program makes.
    """

    participant: str
    whole: dict[Path, str] = field(default_factory=dict)
    rows: dict[Path, int] = field(default_factory=dict)
    left: list[Path] = field(default_factory=list)

    @property
    def found(self) -> bool:
        """True if there is anything to remove."""
        return bool(self.whole or self.rows)

    def sentences(self) -> Iterator[str]:
        """Say what is removed, a path in each sentence."""
        for path, what in self.whole.items():
            yield f"{path}: {what}"
        for path, number in self.rows.items():
            yield f"{path}: {count(number, 'row')} of the table"

    def remove(self) -> None:
        """Remove all of it.

        Raises
        ------
        InputError
            If a session is being run; nothing is removed then.
        VbrailleError
            If the disk fails. The same call goes on where it was.
        """
        for path in self.whole:
            if (path / NAME).exists():
                try:
                    Journal(path).close()
                except InputError:
                    raise
                except VbrailleError:  # a damaged journal may go as well
                    continue
        try:
            # Tables of people come last, so that a dataset can be told whose it is until then.
            for path in self.whole:
                shutil.rmtree(path) if path.is_dir() else path.unlink()
            for path in sorted(self.rows, key=lambda path: path.name == PEOPLE):
                mode = path.stat().st_mode
                write_file(path, _without(path, self.participant), replace=True, durable=True)
                path.chmod(mode)
        except OSError as error:
            raise VbrailleError(
                f"{error.filename} could not be removed: {error.strerror}; mend that, and withdraw "
                f"again"
            ) from None


def withdrawal(rooms: Iterable[Path], participant: str) -> Withdrawal:
    """Find what there is of a person below some directories.

    Raises
    ------
    InputError
        If a directory is missing.
    """
    told = Withdrawal(participant)
    for room in rooms:
        if not room.is_dir():
            raise InputError(f"there is no directory {room}; give one that sessions are in")
        for top, folders, names in os.walk(room):
            folders.sort()
            folder = Path(top)
            if _look_at(folder, sorted(names), told):
                folders.clear()
            else:
                folders[:] = [name for name in folders if folder / name not in told.whole]
    return told


def _look_at(folder: Path, names: list[str], told: Withdrawal) -> bool:
    """Note what a directory has of the person; True if nothing below it is looked at."""
    word = re.compile(rf"(?<![A-Za-z0-9_-]){re.escape(told.participant)}(?![A-Za-z0-9_])")
    if HEAD in names or NAME in names:
        if _whose(folder / HEAD, folder / PLAN) == told.participant:
            told.whole[folder] = f"a session, {count(len(names), 'file')}"
        else:
            told.left += [folder / name for name in names if _names(folder / name, word)]
        return True
    if REPORT in names and _any_names(folder, word):
        told.whole[folder] = "a report, which can be made again without the person"
        return True
    if PEOPLE in names and DATASET in names:
        for label in _labels(folder / PEOPLE, told.participant):
            if (folder / label).is_dir():
                number = sum(path.is_file() for path in (folder / label).rglob("*"))
                told.whole[folder / label] = f"a person of a dataset, {count(number, 'file')}"
    for name in names:
        _look_at_file(folder / name, told, word)
    return False


def _look_at_file(path: Path, told: Withdrawal, word: re.Pattern[str]) -> None:
    """Note what a file outside of sessions has of the person."""
    if path in told.whole or not _names(path, word):
        return
    if path.suffix == ".json":
        plan = _whose(path) == told.participant
    else:
        plan = path.suffix == ".txt" and _is_plan(path, told.participant)
    if plan:
        told.whole[path] = "a plan"
    elif path.suffix in _TABLES and (number := _rows_of(path, told.participant)):
        told.rows[path] = number
    else:
        told.left.append(path)


def _text(path: Path) -> str:
    """Text of a file; empty if it has none that can be read."""
    try:
        return path.read_text("utf-8") if path.stat().st_size <= _MOST_BYTES else ""
    except (OSError, UnicodeDecodeError):
        return ""


def _names(path: Path, word: re.Pattern[str]) -> bool:
    """True if a file of text names the person."""
    return path.suffix in _TEXTS and path.is_file() and word.search(_text(path)) is not None


def _any_names(folder: Path, word: re.Pattern[str]) -> bool:
    return any(_names(path, word) for path in sorted(folder.rglob("*")))


def _whose(*paths: Path) -> str:
    """Participant whose session or plan these files tell of; empty if none does."""
    for path in paths:
        with suppress(ValueError, KeyError, TypeError):
            return str(json.loads(_text(path))["participant"])
    return ""


def _is_plan(path: Path, participant: str) -> bool:
    """True if a text is what ``vbraille session plan`` printed for the person."""
    first = _text(path).partition("\n")[0]
    return first.startswith(_PLAN_LINE) and f"participant {participant}," in first


def _table(path: Path) -> tuple[list[list[str]], int]:
    """Rows of a table with its head, and the number of the column that tells whose a row is."""
    with suppress(csv.Error):
        rows = list(csv.reader(io.StringIO(_text(path)), delimiter=_TABLES[path.suffix]))
        for name in _PERSON if rows else ():
            if name in rows[0]:
                return rows, rows[0].index(name)
    return [], -1


def _is_of(row: list[str], column: int, participant: str) -> bool:
    return len(row) > column and row[column] == participant


def _rows_of(path: Path, participant: str) -> int:
    """Number of a person's rows in a table."""
    rows, column = _table(path)
    return sum(_is_of(row, column, participant) for row in rows[1:])


def _labels(path: Path, participant: str) -> list[str]:
    """Names that a dataset has for a person's directory."""
    rows, column = _table(path)
    return [row[0] for row in rows[1:] if _is_of(row, column, participant)]


def _without(path: Path, participant: str) -> bytes:
    """Table without a person's rows."""
    rows, column = _table(path)
    text = io.StringIO()
    writer = csv.writer(text, delimiter=_TABLES[path.suffix], lineterminator="\n")
    writer.writerows(row for row in rows if not _is_of(row, column, participant))
    return text.getvalue().encode()
