"""The table of participants of a dataset, in which others may have columns and people of theirs."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.sessions.record.codebook import CodebookEntry
from vbraille.sessions.record.export import to_csv
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

PEOPLE, PEOPLE_COLUMNS = "participants.tsv", "participants.json"
ID, PSEUDONYM, SITE = "participant_id", "pseudonym", "site"
UNKNOWN = "n/a"
ENTRIES = {
    PSEUDONYM: CodebookEntry(
        PSEUDONYM, "as the laboratory has it; participant_id has letters and digits"
    ),
    SITE: CodebookEntry(SITE, "where the participant took part"),
}


@dataclass(frozen=True, slots=True)
class PeopleTable:
    """Participants of a dataset.

    Parameters
    ----------
    columns
        Names of the columns, in order.
    rows
        Values of each participant, by the names of the columns.
    """

    columns: tuple[str, ...] = (ID, PSEUDONYM)
    rows: tuple[dict[str, str], ...] = ()

    def names(self) -> dict[str, str]:
        """Name of each participant by the label: the pseudonym, after the site if there is one."""
        told: dict[str, str] = {}
        for row in self.rows:
            label = row[ID].removeprefix("sub-")
            name = row.get(PSEUDONYM, UNKNOWN)
            site = row.get(SITE, UNKNOWN)
            name = label if name == UNKNOWN else name
            told[label] = name if site == UNKNOWN else f"{site}/{name}"
        return told

    def add(self, label: str, pseudonym: str, site: str = "") -> PeopleTable:
        """Table with another participant, at its end; the same one if the label is there."""
        if any(row[ID] == f"sub-{label}" for row in self.rows):
            return self
        wanted = [PSEUDONYM, *([SITE] if site else [])]
        columns = (*self.columns, *(name for name in wanted if name not in self.columns))
        new = {ID: f"sub-{label}", PSEUDONYM: pseudonym, SITE: site or UNKNOWN}
        return PeopleTable(columns, (*self.rows, new))

    def to_tsv(self) -> str:
        """Text of the table, with n/a for what is not known."""
        filled = [{name: row.get(name) or UNKNOWN for name in self.columns} for row in self.rows]
        return to_csv(filled, "\t", UNKNOWN)


def read_people(folder: Path) -> PeopleTable:
    """Read the participants of a dataset; those of directories alone are added to the table's.

    Raises
    ------
    InputError
        If the table cannot be read as one of participants.
    """
    table = PeopleTable()
    try:
        text = (folder / PEOPLE).read_text("utf-8")
        read = csv.DictReader(io.StringIO(text), delimiter="\t")
        rows = tuple(read)
        if any(None in row or None in row.values() for row in rows):
            raise ValueError("a row is too long or too short")
        if rows:
            table = PeopleTable(tuple(rows[0]), rows)
            table.names()
    except (FileNotFoundError, NotADirectoryError):
        pass  # a dataset that is no directory is refused when it is written
    except OSError as error:
        raise InputError(f"{folder} cannot be written: {error.strerror}") from None
    except (ValueError, KeyError, AttributeError, csv.Error):
        raise InputError(
            f"{folder / PEOPLE} cannot be read as a table of {ID} and {PSEUDONYM}; "
            f"give another directory with {setting('out')}"
        ) from None
    for path in sorted(folder.glob("sub-*")):
        label = path.name.removeprefix("sub-")
        table = table.add(label, label)
    return table


def described(folder: Path, table: PeopleTable) -> dict[str, Any] | None:
    """What the table's columns hold, added to what is there; None if nothing is to be added.

    Raises
    ------
    InputError
        If there is a description that cannot be read.
    """
    path = folder / PEOPLE_COLUMNS
    try:
        there = json.loads(path.read_text("utf-8"))
        if not isinstance(there, dict):
            raise ValueError("it is no object")
    except (FileNotFoundError, NotADirectoryError):
        there = {}
    except (OSError, ValueError):
        raise InputError(
            f"{path} cannot be read; mend it, or give another directory with {setting('out')}"
        ) from None
    new = {
        name: entry.to_bids()
        for name, entry in ENTRIES.items()
        if name in table.columns and name not in there
    }
    return there | new if new else None
