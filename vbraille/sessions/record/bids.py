"""Sessions in the Brain Imaging Data Structure: trials as behaviour, traces as recordings.

The files follow BIDS 1.9, "Behavioral experiments (with no neural recordings)" and "Physiological
recordings". Sessions are added to a dataset one by one.
"""

from __future__ import annotations

import csv
import gzip
import io
import json
import re
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError
from vbraille.files import missing, write_file
from vbraille.sessions.record.codebook import CodebookEntry, asked_in, describe_design, entry_of
from vbraille.sessions.record.events import AnyTime, End, JournalEvent, Note, Reply, Run
from vbraille.sessions.record.export import (
    PlacedNote,
    Traces,
    anonymous,
    encode,
    number_of,
    read_notes,
    rows,
    to_csv,
    without_paths,
)
from vbraille.sessions.record.folder import Record, alike, label_of
from vbraille.wording import setting

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from numpy.typing import NDArray


EVENT_COLUMNS = {
    "onset": {"Description": "from the first row of the run's recording", "Units": "s"},
    "duration": {"Description": "no event has one that is known", "Units": "s"},
    "trial_type": {"Description": "what happened, by the names of docs/session-format.md"},
    "practice": {"Description": "1 in a trial of practice, else 0"},
    "trial": {"Description": "number of the trial that it happened in"},
    "trial_before": {"Description": "of a note: the trial that was shown last before it"},
    "trial_after": {"Description": "of a note: the trial that was shown next"},
    "value": {
        "Description": "of an answer, what was answered, and its confidence after a "
        "semicolon; of a note, its text; else what"
    },
}


@dataclass(frozen=True, slots=True)
class BidsRun:
    """A run of a session, with its events.

    Parameters
    ----------
    event
        Event that the run began with.
    events
        Events of the run, after that one.
    notes
        All notes of the session, by the numbers of their events.
    """

    event: Run
    events: list[JournalEvent]
    notes: dict[int, PlacedNote]

    def table(self, first_ns: int | None, *, without_times: bool) -> str:
        """Events as a table, with tabs between columns.

        Parameters
        ----------
        first_ns
            Time of the first tick of the run's trace; None if there is none, and times count
            from the event that the run began with.
        without_times
            Whether notes, answers to the questionnaire, reasons, and words that may be paths, are
            left out.
        """
        begun_s = self._begun_s(first_ns)
        rows = [
            self._row(event, begun_s, without_times)
            for event in self.events
            if event.exported and not (without_times and isinstance(event, Note | Reply))
        ]
        # The journal may have an event a little later than one that happened after it.
        rows.sort(key=lambda row: row["onset"])
        if not rows:
            return "\t".join(EVENT_COLUMNS) + "\n"
        return to_csv(rows, "\t", "n/a")

    def _begun_s(self, first_ns: int | None) -> float:
        """Time of the first tick, in seconds that the session had run for."""
        for event in self.events:
            time_ns = getattr(event, "time_ns", None)
            if first_ns is not None and time_ns is not None:
                return event.t_s - (time_ns - first_ns) / 1e9
        return self.event.t_s

    def _row(self, event: JournalEvent, begun_s: float, without_times: bool) -> dict[str, Any]:
        note = self.notes.get(event.n)
        text = event.why if without_times and isinstance(event, End) else event.said
        return {
            "onset": round(event.t_s - begun_s, 6),
            "duration": "",
            "trial_type": event.kind,
            "practice": int(isinstance(event, AnyTime) and event.practice),
            "trial": (isinstance(event, AnyTime) and event.trial) or "",
            "trial_before": note.before or "" if note else "",
            "trial_after": note.after or "" if note else "",
            "value": without_paths(text) if without_times else text,
        }


def runs_of(record: Record) -> list[BidsRun]:
    """Runs of a session, in order."""
    notes = {note.event: note for note in read_notes(record.journal.events)}
    runs: list[BidsRun] = []
    for event in record.journal.events:
        if isinstance(event, Run):
            runs.append(BidsRun(event, [], notes))
        elif runs:
            runs[-1].events.append(event)
    return runs


_ROWS = 1000  # number of rows that are formatted at once
_LEVEL = 3  # level of gzip; higher ones take longer than all the rest
SESSION = "SessionNumber"  # key that tells which session a file in a dataset is of
_CHANGED = "What was exported before 22 November 2026 has the place of the left column"
# Columns of a recording: field of the trace, format, unit and description.
_RECORDED = {
    "x_mm": ("x_mm", "%.6g", "mm", f"place of the array's centre along the line. {_CHANGED}"),
    "y_mm": ("y_mm", "%.6g", "mm", "place across the lines, to the reader; 0 if not measured"),
    "speed_mm_s": ("vx_mm_s", "%.6g", "mm/s", "of the hand, to the right"),
    "frame": ("tick", "%d", "", "number of the frame, from 0"),
    "line": ("line", "%d", "", "number of what was shown last, as in the journal; 0 before"),
    "flags": ("flags", "%d", "", "bits, as docs/session-format.md has them"),
}


def stem_of(record: Record, session: str, participant: str = "") -> str:
    """Path that all files of a session in a dataset begin with.

    Parameters
    ----------
    record
        The session.
    session
        Label of the session among those of the participant, such as "01".
    participant
        Name of the participant in the dataset; empty for the pseudonym.
    """
    who, task = label_of(participant or record.plan.participant), label_of(record.plan.protocol)
    return f"sub-{who}/ses-{session}/beh/sub-{who}_ses-{session}_task-{task}"


def files(
    record: Record,
    traces: Traces | None = None,
    *,
    session: str = "01",
    without_times: bool = False,
    participant: str = "",
) -> dict[str, bytes]:
    """Contents of the files of a session, by their paths in the dataset.

    Parameters
    ----------
    record
        The session.
    traces
        Traces of the session, if the caller wants to know what is wrong with them. The readable
        parts of the traces are written in any case.
    session
        Label of the session among those of the participant.
    without_times
        Whether times of day, paths and notes are left out.
    participant
        Name of the participant in the dataset; empty for the pseudonym.
    """
    traces = Traces(record) if traces is None else traces
    stem = stem_of(record, session, participant)
    who = {"participant": participant or record.plan.participant}
    table = [row | who for row in rows(record, traces)]
    if without_times:
        table = anonymous(record, table)
    made = {
        f"{stem}_beh.tsv": encode(to_csv(table, "\t", "n/a")),
        f"{stem}_beh.json": _json(_beh(record, table)),
    }
    for number, run in enumerate(runs_of(record), 1):
        ticks = traces.read(run.event.trace).ticks if run.event.trace else None
        first_ns = None if ticks is None or not ticks.size else int(ticks["time_ns"][0])
        name = f"{stem}_run-{number:02}"
        made[f"{name}_events.tsv"] = encode(run.table(first_ns, without_times=without_times))
        made[f"{name}_events.json"] = _json(EVENT_COLUMNS)
        if ticks is None or not ticks.size:
            continue
        name += "_recording-carriage_physio"
        made[f"{name}.tsv.gz"] = _recording(ticks)
        made[f"{name}.json"] = _json(
            {
                "SamplingFrequency": record.head["rate_hz"],
                "StartTime": 0.0,
                "Columns": list(_RECORDED),
                **{
                    column: {"Units": unit, "Description": what} if unit else {"Description": what}
                    for column, (_, _, unit, what) in _RECORDED.items()
                },
                **({} if without_times else {"Trace": run.event.trace}),
                "Manufacturer": run.event.device["name"],
            }
        )
    return made


def _json(content: dict[str, Any]) -> bytes:
    return encode(json.dumps(content, ensure_ascii=False, indent=2) + "\n")


def _beh(record: Record, table: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    described: dict[str, Any] = {
        SESSION: number_of(record),
        "TaskName": record.protocol.name,  # which the task in the files' names is made from
        "TaskDescription": f"{record.protocol.title} ({record.protocol.source})",
    }
    asked = asked_in(record.protocol)
    for name in table[0]:
        entry = entry_of(name, asked)
        if entry.unit and any(" " in str(row[name]) for row in table):
            # For BIDS a column with units has numbers, and not two in a cell.
            entry = replace(entry, meaning=f"{entry.meaning}, in {entry.unit}", unit="")
        described[name] = entry.to_bids()
    for name, what in describe_design(record.protocol).items():
        described[name] = {"Description": what}
    return described


def _recording(ticks: NDArray[np.void]) -> bytes:
    """Ticks of `TRACE`[n] as a table with a row for each deadline; n/a where one was missed."""
    due = ticks["tick"] + ticks["late"]
    row = "\t".join(form for _, form, _, _ in _RECORDED.values()) + "\n"
    missing = "\t".join(["n/a"] * len(_RECORDED)) + "\n"
    packed = io.BytesIO()
    with gzip.GzipFile(fileobj=packed, mode="wb", compresslevel=_LEVEL, mtime=0) as file:
        after = int(due[0])
        for part in np.split(ticks, np.flatnonzero(np.diff(due) != 1) + 1):
            first = int(part["tick"][0] + part["late"][0])
            file.write((missing * (first - after)).encode())
            after = first + part.size
            for at in range(0, part.size, _ROWS):
                some = part[at : at + _ROWS]
                columns = (some[field].tolist() for field, _, _, _ in _RECORDED.values())
                values = tuple(chain.from_iterable(zip(*columns, strict=True)))
                # Rows are formatted many at a time, which is several times as fast as one by one.
                file.write((row * some.size % values).replace("nan", "n/a").encode())
    return packed.getvalue()


_BIDS = "1.9.0"
DATASET, _README = "dataset_description.json", "README"
PEOPLE, PEOPLE_COLUMNS = "participants.tsv", "participants.json"
_ID, PSEUDONYM = "participant_id", "pseudonym"
_DESCRIBED = CodebookEntry(
    PSEUDONYM, "as the laboratory has it; participant_id has letters and digits"
)
_README_TEXT = """\
Legibility sessions of vbraille, as behavioural data.

Each sub- is a participant, by the pseudonym that participants.tsv has. Each ses- is one session: a
protocol from its first trial to its last, in the order in which they were added. A session that was
broken off and gone on with has several runs.

*_beh.tsv has a row a trial. *_events.tsv has what happened in a run, notes of the experimenter
included, and *_recording-carriage_physio.tsv.gz where the array was at each moment, with its speed.
What each column holds is in the file of the same name that ends in .json.
"""


def write(
    record: Record,
    folder: Path,
    traces: Traces | None = None,
    *,
    without_times: bool = False,
    session: str | None = None,
) -> list[Path]:
    """Add a session to a dataset, which is begun if there is none, and return the files written.

    Parameters
    ----------
    record, traces, without_times
        These are described at `vbraille.sessions.record.bids.files`.
    folder
        Directory of the dataset.
    session
        Label of the session among those of the participant; None for the next number.

    Raises
    ------
    InputError
        If the dataset has the session already, another participant's pseudonym is too similar
        to this one's, or a file cannot be made. Nothing is written then.
    VbrailleError
        If the disk does not take the files. The dataset then is as it was before.
    """
    people = _read_people(folder)
    pseudonym = record.plan.participant
    label = label_of(pseudonym)
    _check_pseudonym(folder, people, pseudonym)
    _check_absent(folder, record)
    if session is None:
        session = _next_session(folder / f"sub-{label}")
    elif not label_of(session):
        raise InputError(
            f"{record.folder} has no answer that could name its session; leave out "
            f"{setting('session-by')}"
        )
    made = files(
        record,
        traces,
        session=label_of(session),
        without_times=without_times,
        participant=pseudonym,
    )
    if there := next((path for path in made if (folder / path).exists()), None):
        raise InputError(
            f"{folder / there} is there already, of another session; leave out "
            f"{setting('session-by')}, or give another directory with {setting('out')}"
        )
    new = {folder / path: content for path, content in made.items()}
    for path, content in (
        (DATASET, _json(_about(record))),
        (_README, _README_TEXT.encode()),
        (PEOPLE_COLUMNS, _json({PSEUDONYM: _DESCRIBED.to_bids()})),
    ):
        if not (folder / path).exists():
            new[folder / path] = content
    people.setdefault(label, pseudonym)
    rows = [{_ID: f"sub-{of}", PSEUDONYM: name} for of, name in people.items()]
    _write(folder, new, PEOPLE, encode(to_csv(rows, "\t", "n/a")))
    return [*new, folder / PEOPLE]


def _read_people(folder: Path) -> dict[str, str]:
    """Read the pseudonyms of a dataset's participants, by their labels.

    Raises
    ------
    InputError
        If the table cannot be read, or has columns of others.
    """
    path = folder / PEOPLE
    try:
        rows = list(csv.reader(io.StringIO(path.read_text("utf-8")), delimiter="\t"))
    except (FileNotFoundError, NotADirectoryError):
        return {}  # a dataset that is no directory is refused when it is written
    except (OSError, ValueError, csv.Error):
        rows = []
    if not rows or rows[0] != [_ID, PSEUDONYM] or any(len(row) != 2 for row in rows):
        raise InputError(
            f"{path} is no table of {_ID} and {PSEUDONYM} alone, to which participants could be "
            f"added; give another directory with {setting('out')}, and put the tables together"
        )
    return {label.removeprefix("sub-"): pseudonym for label, pseudonym in rows[1:]}


def _check_pseudonym(folder: Path, people: dict[str, str], pseudonym: str) -> None:
    """Check that no other participant of the dataset could be mistaken for this one."""
    for other in people.values():
        if other != pseudonym and alike(other, pseudonym):
            raise InputError(
                f"{folder} has a participant {other}, who could not be told from {pseudonym}; "
                f"give another directory with {setting('out')}"
            )


def _check_absent(folder: Path, record: Record) -> None:
    """Check that the dataset does not have the session under any label."""
    number = number_of(record)
    for path in folder.glob("sub-*/ses-*/beh/*_beh.json"):
        try:
            told = json.loads(path.read_text("utf-8")).get(SESSION)
        except (OSError, ValueError, AttributeError):
            continue
        if told == number:
            there = path.with_suffix(".tsv")
            raise InputError(
                f"{record.folder} is there already, as {there}; give another directory with "
                f"{setting('out')}"
            )


def _next_session(participant: Path) -> str:
    """Label for the next session of a participant."""
    names = [path.name for path in participant.glob("ses-*")]
    numbers = [int(name[4:]) for name in names if re.fullmatch("ses-[0-9]{1,9}", name)]
    return f"{max(numbers, default=0) + 1:02}"


def _write(folder: Path, new: dict[Path, bytes], people: str, table: bytes) -> None:
    """Write new files, and then the table of participants; undo everything if one fails."""
    written: list[Path] = []
    try:
        parents = {parent for path in new for parent in missing(path.parent)}
        for parent in sorted(parents):  # a directory comes after the one that contains it
            parent.mkdir(exist_ok=True)
            written.append(parent)
        for path, content in new.items():
            write_file(path, content)
            written.append(path)
        write_file(folder / people, table, replace=True, durable=True)
    except BaseException as fault:
        for path in reversed(written):
            with suppress(OSError):  # a directory that was used meanwhile stays
                path.rmdir() if path.is_dir() else path.unlink()
        if isinstance(fault, OSError):
            raise InputError(f"{folder} cannot be written: {fault.strerror}") from None
        raise


def _about(record: Record) -> dict[str, Any]:
    """Content of the file that describes the dataset."""
    return {
        "Name": "vbraille legibility sessions",
        "BIDSVersion": _BIDS,
        "DatasetType": "raw",
        "GeneratedBy": [{"Name": "vbraille", "Version": record.head["versions"]["vbraille"]}],
    }
