r"""Codebook: the meaning of each column of a table, with its unit and its values.

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
from vbraille.sessions.planning.questions import KINDS
from vbraille.sessions.record.passages import COLUMNS as PASSAGE

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from vbraille.sessions.planning.protocol import Protocol
    from vbraille.sessions.planning.stimuli import Trial


# What each column holds: the table's head, and its description in BIDS.
COLUMNS = {
    "session": "name of the session's directory",
    "participant": "pseudonym",
    "protocol": "name of the protocol",
    "block": "from 1",
    "trial": "from 1, in the order of the plan",
    "condition": "name, as in the protocol",
    "texture": "level of texture, 0 to 1",
    "contrast": "share of the full swing, 0 to 1",
    "texture_cycles": "half-cycles of texture a radius, where the model has that",
    "model": "name of the display",
    "shown_on": "where strings stood: device, conventional for a conventional display, or paper",
    "mapping": "how dot rows are shown by actuator rows, by name",
    "dot_width_mm": "width of a dot along the line; two values where they are compared",
    "dot_spacing_mm": "between the two dot columns of a cell; two values where they are compared",
    "cell_gap_mm": "from a cell's right dot column to the next cell's left one",
    "row_spacing_mm": "between neighbouring dot rows",
    "line_pitch_mm": "between lines",
    "travel_mm": "of the carriage",
    "parameter": "what two stimuli were compared by, in mm if its name says so; empty where "
    "strings are read",
    "presented": "Unicode braille of the cells asked for; two values, the first one first",
    "string_set": "Unicode braille of the protocol's string, if its cells come in another order "
    "at each showing; else empty",
    "answered": "Unicode braille, ? for a place not read; the value chosen; as asked for, yes or "
    "no, same or different, a number, or words; empty if not answered",
    "correct": "1 if all places are right, or the answer is, 0 if not; empty where nothing is "
    "right and without an answer",
    "question": f"what was asked: {', '.join(KINDS)}",
    "outcome": "right or wrong; where something is looked for, hit, miss, false alarm or correct "
    "rejection; empty if nothing is right, and without an answer",
    "confidence": "how sure the answer is, on the scale of the protocol; empty if not asked",
    "first_answer": "what had been answered before an undo; else empty",
    "answers_from": "typed, simulated:NOISE for a simulated reader, program, or a file",
    "moved_by": "what moved the carriage: person, simulated for a simulated hand, or "
    "simulated:pointer if a person at the live view was that hand in a part of the trial, so that "
    "it is no data about people; empty on paper",
    "attempt": "how often the trial was begun",
    "duration_s": "from the array's first touch of the leftmost dot to its last way back over it "
    "(Levesque 2009, 3.4); on paper and on a conventional display, by key",
    "returned": "1 if the hand went back over the leftmost dot; 0 if the duration ends with the "
    "last tick at which an actuator was off its idle end",
    "contact_s": "from the start signal to the first touch",
    "response_s": "from the start signal to the participant's key, or to the answer where there "
    "was none, pauses left out",
    "ended_by": "what ended reading: button:N, key:NAME, exposure, or answer if the answer came "
    "before these; empty if the protocol has no such key, and no limit of the exposure",
    "paused_s": "length of the pauses",
    "early": "1 if it was answered before it was read to its end: its duration does not count",
    "analysed": "1 if the analysis uses the trial; 0 for a catch trial, unless detecting is what "
    "was asked, and for one without an answer",
    "warned": "1 if the warning sounded",
    "faults": "what went wrong with the device in the trial, all attempts",
    "notes": "of the experimenter, typed in the trial",
    "notes_before": "typed between the trial shown before and this one",
    "notes_after": "typed between this trial and the one shown next, or the end",
    "cue_time": "wall clock at the start signal, UTC",
    "answer_time": "wall clock at the answer, UTC",
    "trace": "file of the trace of the last attempt",
}

# Columns that a protocol has only if it asks for what they hold.
FURTHER = {
    "table": "braille table that made the cells of the text",
    "text": "text that the cells asked for stand for; empty for a blank catch trial",
    "scene": "file of the scene that the picture is of",
    "picture": "ids of the elements of the scene that were shown",
    "late": "1 if the answer came after the time that the protocol gives for it, or not at all",
    **PASSAGE,
}


def designed(protocol: Protocol, trial: Trial) -> dict[str, str]:
    """Cells of a trial's row for the design: its group, factors, item and catch.

    A protocol without one of these has no column for it.
    """
    cells: dict[str, str] = {}
    if protocol.groups:
        cells["group"] = protocol.group
    for name, level in protocol.levels(trial.condition).items():
        cells[f"factor_{name}"] = level
    if protocol.item_columns:
        own = protocol.columns_of(trial.item)
        cells |= {f"item_{name}": value for name, value in own.items()}
    if protocol.design.catch is not None:
        cells["catch"] = trial.catch
    if protocol.pictures:
        cells |= {name: getattr(trial.stimuli[0], name) or "" for name in ("scene", "picture")}
    if protocol.written:
        cells |= {name: getattr(trial.stimuli[0], name) or "" for name in ("table", "text")}
    return cells


def describe_design(protocol: Protocol) -> dict[str, str]:
    """Describe the columns of a protocol's factors and items, by their names."""
    told: dict[str, str] = {}
    for factor in protocol.factors:
        whose = "the participant's" if factor.between else "the condition's"
        told[f"factor_{factor.name}"] = f"{whose} level of the factor {factor.name}"
    for name in protocol.item_columns:
        told[f"item_{name}"] = f"column {name} of the protocol's file of items"
    return told


HEAD = ("file", "column", "meaning", "unit", "values")
FIELD = "field_"  # how columns begin that hold what a protocol asked about the participant
ASKED, CORRECT = "asked_", "_correct"  # of answers to the questionnaire, and of their score
_UNITS = {"_mm_s": "mm/s", "_mm": "mm", "_ms": "ms", "_hz": "Hz", "_s": "s"}
# Values of columns that have a few, and what each means.
_VALUES = {
    "correct": {"1": "all places are right", "0": "a place is wrong"},
    "returned": {"1": "the hand went back", "0": "it did not"},
    "early": {"1": "it does not count", "0": "it counts"},
    "analysed": {"1": "the analysis uses the trial", "0": "it does not"},
    "late": {"1": "it came too late, or not at all", "0": "it came in time"},
    "warned": {"1": "the warning sounded", "0": "it did not"},
    "moved_by": {
        "person": "a person's hand",
        "simulated": "a simulated hand",
        "simulated:pointer": "a person at the live view, in a part of the trial",
    },
}


@dataclass(frozen=True, slots=True)
class CodebookEntry:
    """Description of a column.

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


def asked_in(protocol: Protocol) -> dict[str, str]:
    """Columns with answers of the participant beside the trials, each with its question."""
    asked = {f"{FIELD}{field.name}": field.ask for field in protocol.fields}
    for item in protocol.questionnaire:
        asked[f"{ASKED}{item.name}"] = item.ask
        if item.right:
            asked[f"{ASKED}{item.name}{CORRECT}"] = f"1 if the answer is right to: {item.ask}"
    return asked


def entry_of(name: str, asked: Mapping[str, str] | None = None) -> CodebookEntry:
    """Entry of a column of exported trials.

    Parameters
    ----------
    name
        Name of the column.
    asked
        What the protocol asks beside the trials, by the columns of the answers; see `asked_in`.
    """
    if name.startswith((FIELD, ASKED)):
        meaning = (asked or {}).get(name) or "answer to a question of the protocol"
        return CodebookEntry(name, meaning)
    meaning = COLUMNS.get(name) or FURTHER.get(name) or _designed(name) or "as it was given"
    return CodebookEntry(name, meaning, unit_of(name), _VALUES.get(name, {}))


def _designed(name: str) -> str:
    """Meaning of a column of a lab's own design; empty if it is no such column."""
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
