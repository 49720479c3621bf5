"""Withdrawal of a participant: all that holds data of one person is found, and removed.

Sessions, tables, datasets and reports below some directories are looked through. A report, which
can be made again, is removed, since its numbers are made of all.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterable
from pathlib import Path

from vbraille.csvfiles import read_csv
from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_file
from vbraille.sessions.record.bids import PEOPLE, PSEUDONYM, label_of
from vbraille.sessions.record.record import Record, participant_of
from vbraille.sessions.record.trials import to_csv

TABLES = {".csv": ",", ".tsv": "\t"}
TEXTS = (*TABLES, ".json", ".txt", ".md", ".html", ".svg", ".toml", ".brf")
PERSON = ("participant", PSEUDONYM)  # columns that tell whose a row is
REPORT = "report.html"
MOST_BYTES = 200_000_000  # of a file that is looked through


class Withdrawal:
    """Data of a person below some directories.

    Parameters
    ----------
    folders, participant
        The directories, and the pseudonym of the person.

    Attributes
    ----------
    whole : dict
        Directories and files that are removed, each with words for what it is.
    rows : dict
        Tables that lose rows, and how many.
    left : list
        Files that name the person and stay.

    Raises
    ------
    InputError
        If a directory is missing.
    """

    def __init__(self, folders: Iterable[Path], participant: str) -> None:
        self.participant = participant
        self.whole: dict[Path, str] = {}
        self.rows: dict[Path, int] = {}
        self.left: list[Path] = []
        word = re.compile(rf"(?<![A-Za-z0-9_-]){re.escape(participant)}(?![A-Za-z0-9_])")
        for folder in folders:
            if not folder.is_dir():
                raise InputError(f"there is no directory {folder}; give one that sessions are in")
            for path in sorted(folder.rglob("*")):
                if path.is_file() and not any(parent in self.whole for parent in path.parents):
                    self._look_at(path, word)

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
                mode, (_, others) = path.stat().st_mode, _without(path, self.participant)
                write_file(path, others, replace=True, durable=True)
                path.chmod(mode)
        except OSError as error:
            said = f"{error.filename} could not be removed: {error.strerror}"
            raise VbrailleError(f"{said}; mend that, and withdraw again") from None

    def _look_at(self, path: Path, word: re.Pattern[str]) -> None:
        """Note what a file has of the person."""
        if path.suffix == ".session" and participant_of(path) == self.participant:
            self.whole[path] = "a session"
        if path.suffix not in TEXTS or path.stat().st_size > MOST_BYTES:
            return
        if not word.search(path.read_text("utf-8", "replace")):
            return
        report = next((folder for folder in path.parents if (folder / REPORT).exists()), None)
        if report is not None:
            self.whole[report] = "a report, which can be made again without the person"
        elif path.suffix in TABLES and (count := _without(path, self.participant)[0]):
            self.rows[path] = count
            if path.name == PEOPLE:
                home = path.parent / f"sub-{label_of(self.participant)}"
                self.whole[home] = "a person of a dataset"
        else:
            self.left.append(path)


def _without(path: Path, participant: str) -> tuple[int, bytes]:
    """Return how many rows of a table are a person's, and the table without them."""
    try:
        sheet = read_csv(path)
    except InputError:
        return 0, b""
    others = [row for row in sheet.records() if participant not in map(row.get, PERSON)]
    text = to_csv(others, TABLES[path.suffix], columns=sheet.columns)
    return len(sheet.rows) - len(others), text.encode()
