"""A session in the Brain Imaging Data Structure: trials as behaviour, traces as recordings.

The files follow BIDS 1.9, "Behavioral experiments (with no neural recordings)" and "Physiological
recordings".
"""

from __future__ import annotations

import gzip
import io
import json
from dataclasses import replace
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.sessions.record.anonymous import anonymous, number_of
from vbraille.sessions.record.bidsevents import EVENT_COLUMNS, runs_of
from vbraille.sessions.record.codebook import entry_of
from vbraille.sessions.record.columns import describe_design
from vbraille.sessions.record.export import Traces, encode, rows, to_csv
from vbraille.sessions.record.participants import label_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from vbraille.sessions.record.folder import Record

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
    asked = {field.name: field.ask for field in record.protocol.fields}
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
