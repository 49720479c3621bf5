"""A session as tables: one row a planned trial, made from the record alone."""

from __future__ import annotations

import csv
import io
import os
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.progress import Progress
from vbraille.sessions.showing import render
from vbraille.sessions.traces import read_trace
from vbraille.sessions.trajectory import duration, first_edge_mm

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.sessions.plan import Trial
    from vbraille.sessions.progress import Told
    from vbraille.sessions.record import Record

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
    "parameter": "what two stimuli were compared by, in mm; empty where strings are read",
    "presented": "Unicode braille of the cells asked for; two values, the first one first",
    "answered": "Unicode braille, ? for a place not read; the value chosen; empty if not answered",
    "correct": "1 if all places are right, 0 if not; empty for comparisons and without an answer",
    "first_answer": "what had been answered before an undo; else empty",
    "attempt": "how often the trial was begun",
    "duration_s": "from the array's first touch of the leftmost dot to its last way back over it "
    "(Levesque 2009, 3.4); on paper, by key",
    "returned": "1 if the hand went back over the leftmost dot; 0 if the duration ends with the "
    "last tick at which an actuator was off its idle end",
    "contact_s": "from the start signal to the first touch",
    "response_s": "from the start signal to the answer, pauses left out",
    "paused_s": "length of the pauses",
    "warned": "1 if the warning sounded",
    "faults": "what went wrong with the device in the trial, all attempts",
    "notes": "of the experimenter",
    "cue_time": "wall clock at the start signal, UTC",
    "answer_time": "wall clock at the answer, UTC",
    "trace": "file of the trace of the last attempt",
}


class Traces:
    """The traces of a session, each read once.

    Parameters
    ----------
    record
        The session.
    """

    def __init__(self, record: Record) -> None:
        self._folder = record.folder
        self._ticks: dict[str, NDArray[np.void]] = {}
        self._starts: dict[str, NDArray[np.int64]] = {}

    def of(self, name: str, lines: list[int]) -> NDArray[np.void]:
        """Ticks of some lines of a trace, in order."""
        if name not in self._ticks:
            ticks = read_trace(self._folder / name).ticks
            self._ticks[name] = ticks
        ticks = self._ticks[name]
        # Line numbers grow along a trace.
        first, stop = np.searchsorted(ticks["line"], (min(lines), max(lines) + 1))
        part = ticks[first:stop]
        return part[np.isin(part["line"], lines)]


def rows(record: Record) -> list[dict[str, Any]]:
    """Rows of a session, by `COLUMNS` and then the protocol's fields.

    Raises
    ------
    VbrailleError
        If a trace cannot be read.
    """
    progress = Progress(record.plan, record.told.events)
    traces = Traces(record)
    fields = {f"field_{name}": value for name, value in record.head["fields"].items()}
    return [
        _row(record, trial, progress.trials[trial.number], traces) | fields
        for trial in record.plan.trials
    ]


def _row(record: Record, trial: Trial, told: Told, traces: Traces) -> dict[str, Any]:
    t_s = told.t_s
    tuning = trial.stimuli[0].tuning
    row: dict[str, Any] = dict.fromkeys(COLUMNS, "")
    row |= {
        "session": record.folder.resolve().name,
        "participant": record.plan.participant,
        "protocol": record.plan.protocol,
        "block": trial.block,
        "trial": trial.number,
        "condition": trial.condition,
        "texture": told.tuning.get("texture", tuning.texture),
        "contrast": told.tuning.get("contrast", tuning.contrast),
        "attempt": told.attempts,
        "paused_s": round(told.paused_s, 6),
        "warned": int("warning" in t_s),
        "faults": "; ".join(told.faults),
        "notes": "; ".join(told.notes),
        "cue_time": told.wall.get("cue", ""),
        "answer_time": told.wall.get("answer", ""),
    }
    if "cue" in t_s and "contact" in t_s and t_s["contact"] >= t_s["cue"]:
        row["contact_s"] = round(t_s["contact"] - t_s["cue"], 6)
    if "cue" in t_s and "answer" in t_s:
        row["response_s"] = round(t_s["answer"] - t_s["cue"] - told.paused_s, 6)
    if len(trial.stimuli) == 2:
        values = [f"{stimulus.value:g}" for stimulus in trial.stimuli]
        row["parameter"] = record.protocol.parameter
        row["presented"] = " ".join(values)
        row["answered"] = _chosen(values, told.answer)
        row["first_answer"] = _chosen(values, told.first_answer)
    else:
        row["presented"] = trial.presented
        row["answered"] = told.answer or ""
        row["first_answer"] = told.first_answer or ""
        if told.answer is not None:
            row["correct"] = int(told.answer == trial.presented)
        if record.protocol.medium == "paper":
            if "read" in t_s and "cue" in t_s:
                row["duration_s"] = round(t_s["read"] - t_s["cue"], 6)
        elif told.answer is not None:
            row |= _trajectory(record, trial, told, traces)
    return row


def _chosen(values: list[str], answer: str | None) -> str:
    return "" if answer is None else values[int(answer) - 1]


def _trajectory(record: Record, trial: Trial, told: Told, traces: Traces) -> dict[str, Any]:
    """What the trace tells of the last attempt."""
    shown = told.last_attempt
    name = shown[-1].trace
    if name is None:
        return {}
    ticks = traces.of(name, [showing.line for showing in shown])
    protocol, stimulus = record.protocol, trial.stimuli[0]
    line = protocol.line(stimulus.masks)
    edge_mm = first_edge_mm(line, protocol.mapping, stimulus.geometry)
    if edge_mm is None:
        return {"trace": name}
    renderer = render(protocol, stimulus, stimulus.tuning)

    def moved() -> NDArray[np.bool_]:
        frames = renderer.path(ticks["x_mm"])
        idle = renderer.path(np.full(1, np.nan))
        return (frames != idle).any(axis=(1, 2))

    found = duration(
        ticks["x_mm"],
        ticks["time_ns"],
        moved,
        edge_mm=edge_mm,
        span_mm=protocol.model.array.span_mm,
    )
    if found is None:
        return {"trace": name}
    return {
        "trace": name, "duration_s": round(found.seconds, 6), "returned": int(found.returned)
    }  # fmt: skip


def to_csv(table: list[dict[str, Any]], delimiter: str = ",", missing: str = "") -> str:
    """Write rows of one kind as text."""
    text = io.StringIO()
    writer = csv.writer(text, delimiter=delimiter, lineterminator="\n")
    writer.writerow(table[0])
    for row in table:
        writer.writerow([missing if value == "" else value for value in row.values()])
    return text.getvalue()


def write_new(path: Path, content: bytes) -> None:
    """Write a file that is not there yet: whole, or not at all.

    Raises
    ------
    InputError
        If it is there, or cannot be made.
    VbrailleError
        If the disk does not take it.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        try:
            file = partial.open("wb")
        except OSError as error:
            raise InputError(f"{path} cannot be written: {error.strerror}") from None
        with file:
            file.write(content)
        os.link(partial, path)
    except FileExistsError:
        raise InputError(f"{path} is there already; give another name with --out") from None
    except OSError as error:
        raise VbrailleError(f"{path} could not be written: {error.strerror}") from None
    finally:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
