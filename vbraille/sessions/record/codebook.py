r"""What each column of a table holds, with its unit and its values: a codebook.

The same entries become the codebook of a CSV file and the JSON beside a table of BIDS.

>>> entry = entry_of("early")
>>> entry.values["1"]
'it does not count'
>>> to_codebook({"trials.csv": [entry_of("paused_s")]})
'file,column,meaning,unit,values\ntrials.csv,paused_s,length of the pauses,s,\n'
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from vbraille.files import no_formula
from vbraille.sessions.record.columns import COLUMNS, WRITTEN

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

HEAD = ("file", "column", "meaning", "unit", "values")
FIELD = "field_"  # how columns begin that hold what a protocol asked about the participant
_UNITS = {"_mm_s": "mm/s", "_mm": "mm", "_ms": "ms", "_hz": "Hz", "_s": "s"}
# Values of columns that have a few, and what each means.
_VALUES = {
    "correct": {"1": "all places are right", "0": "a place is wrong"},
    "returned": {"1": "the hand went back", "0": "it did not"},
    "early": {"1": "it does not count", "0": "it counts"},
    "analysed": {"1": "the analysis uses the trial", "0": "it does not"},
    "warned": {"1": "the warning sounded", "0": "it did not"},
    "moved_by": {
        "person": "a person's hand",
        "simulated": "a simulated hand",
        "simulated:pointer": "somebody at the live view, in a part of the trial",
    },
}


@dataclass(frozen=True, slots=True)
class CodebookEntry:
    """What a column holds.

    Parameters
    ----------
    column
        Name of the column.
    meaning
        What it holds, in words.
    unit
        Unit of its numbers; empty if they have none.
    values
        Meaning of each value, where there are few.
    """

    column: str
    meaning: str
    unit: str = ""
    values: Mapping[str, str] = field(default_factory=dict)

    def to_bids(self) -> dict[str, Any]:
        """Object that the JSON beside a table of BIDS has for the column."""
        told: dict[str, Any] = {"Description": self.meaning}
        if self.unit:
            told["Units"] = self.unit
        if self.values:
            told["Levels"] = dict(self.values)
        return told


def unit_of(name: str) -> str:
    """Unit that a column's name ends with; empty if it names none."""
    return next((unit for end, unit in _UNITS.items() if name.endswith(end)), "")


def entry_of(name: str, asked: Mapping[str, str] | None = None) -> CodebookEntry:
    """Entry of a column of exported trials.

    Parameters
    ----------
    name
        Name of the column.
    asked
        What the protocol asks about the participant, by the names of its fields.
    """
    if name.startswith(FIELD):
        question = (asked or {}).get(name.removeprefix(FIELD))
        meaning = question or "answer to a question of the protocol about the participant"
        return CodebookEntry(name, meaning)
    meaning = COLUMNS.get(name) or WRITTEN.get(name) or _designed(name) or "as it was given"
    return CodebookEntry(name, meaning, unit_of(name), _VALUES.get(name, {}))


def _designed(name: str) -> str:
    """What a column of a lab's own design holds; empty if it is no such column."""
    if name == "group":
        return "name of the participant's group"
    if name == "catch":
        return "blank or repeat for a trial that only keeps watch; else empty"
    for prefix, what in (("factor_", "level of the factor"), ("item_", "column of the items:")):
        if name.startswith(prefix):
            return f"{what} {name.removeprefix(prefix)}"
    return ""


def to_codebook(files: Mapping[str, Iterable[CodebookEntry]]) -> str:
    """Text of a codebook: CSV with a row for each column of each file.

    Parameters
    ----------
    files
        Entries of the columns in their order, by the names of the files.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(HEAD)
    for name, entries in files.items():
        writer.writerows(map(no_formula, (name, *_row(entry))) for entry in entries)
    return text.getvalue()


def _row(entry: CodebookEntry) -> Sequence[str]:
    values = "; ".join(
        f"{value}: {what}" if what else value for value, what in entry.values.items()
    )
    return entry.column, entry.meaning, entry.unit, values
