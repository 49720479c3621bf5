"""A session in the Brain Imaging Data Structure: trials as behaviour, traces as recordings.

Behavioural data of BIDS 1.9, "Behavioral experiments (with no neural
recordings)" and "Physiological recordings".
"""

from __future__ import annotations

import gzip
import io
import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.export import COLUMNS, rows, to_csv, write_new
from vbraille.sessions.progress import Progress
from vbraille.sessions.traces import read_trace

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.sessions.record import Record

_BIDS = "1.9.0"
_UNITS = {name: "s" for name in COLUMNS if name.endswith("_s")}
# Column of a recording: where it comes from, how it is printed, and what it is.
_RECORDED = {
    "x_mm": ("x_mm", "%.6g", "mm", "place of the array's left column"),
    "speed_mm_s": ("speed_mm_s", "%.6g", "mm/s", "of the hand, to the right"),
    "frame": ("tick", "%d", "", "number of the frame, from 0"),
    "line": ("line", "%d", "", "number of what was shown last, as in the journal; 0 before"),
    "flags": ("flags", "%d", "", "bits, as docs/session-format.md has them"),
}


def files(record: Record) -> dict[str, bytes]:
    """Files of a session, by their paths in the dataset."""
    who, task = _label(record.plan.participant), _label(record.plan.protocol)
    stem = f"sub-{who}/beh/sub-{who}_task-{task}"
    made = {
        f"{stem}_beh.tsv": to_csv(rows(record), "\t", "n/a").encode(),
        f"{stem}_beh.json": _json(_beh(record)),
    }
    started = [run for run in Progress(record.plan, record.told.events).runs if "trace" in run]
    for number, run in enumerate(started, 1):
        name = f"{stem}_run-{number:02}_recording-carriage_physio"
        ticks = read_trace(record.folder / run["trace"]).ticks
        made[f"{name}.tsv.gz"] = _recording(ticks)
        made[f"{name}.json"] = _json(
            {
                "SamplingFrequency": record.head["rate_hz"],
                "StartTime": 0.0,
                "Columns": list(_RECORDED),
                **{
                    column: {"Units": unit, "Description": what}
                    for column, (_, _, unit, what) in _RECORDED.items()
                },
                "Trace": run["trace"],
                "Manufacturer": run["device"]["name"],
            }
        )
    return made


def write(record: Record, folder: Path) -> list[Path]:
    """Write a session into a dataset, which is begun if there is none; the files written.

    Raises
    ------
    InputError
        If one of the files is there already, or cannot be made.
    """
    made = {folder / name: content for name, content in files(record).items()}
    for path in made:
        if path.exists():
            raise InputError(f"{path} is there already; give another directory with --out")
    about = folder / "dataset_description.json"
    if not about.exists():
        made[about] = _json(
            {
                "Name": "vbraille legibility sessions",
                "BIDSVersion": _BIDS,
                "DatasetType": "raw",
                "GeneratedBy": [
                    {"Name": "vbraille", "Version": record.head["versions"]["vbraille"]}
                ],
            }
        )
    for path, content in made.items():
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{path.parent} cannot be made: {error.strerror}") from None
        write_new(path, content)
    return list(made)


def _label(name: str) -> str:
    """Name without what BIDS does not take in a label."""
    return re.sub(r"[^A-Za-z0-9]", "", name)


def _json(content: dict[str, Any]) -> bytes:
    return (json.dumps(content, ensure_ascii=False, indent=2) + "\n").encode()


def _beh(record: Record) -> dict[str, Any]:
    described: dict[str, Any] = {
        "TaskName": record.protocol.title,
        "TaskDescription": record.protocol.source,
    }
    for name, what in COLUMNS.items():
        described[name] = {"Description": what}
        if name in _UNITS:
            described[name]["Units"] = _UNITS[name]
    for field in record.protocol.fields:
        described[f"field_{field.name}"] = {"Description": field.ask}
    return described


def _recording(ticks: NDArray[np.void]) -> bytes:
    """Columns of a trace at regular times: a row a deadline, n/a where it was missed."""
    due = ticks["tick"] + ticks["late"]
    due = due - due[0] if due.size else due
    rows_: list[str] = []
    missing = "\t".join(["n/a"] * len(_RECORDED))
    columns = [np.char.mod(form, ticks[field]) for field, form, _, _ in _RECORDED.values()]
    at = 0
    for slot, *values in zip(due.tolist(), *columns, strict=True):
        rows_ += [missing] * (slot - at)
        rows_.append("\t".join(values))
        at = slot + 1
    text = "\n".join([*rows_, ""]).replace("nan", "n/a")
    packed = io.BytesIO()
    with gzip.GzipFile(fileobj=packed, mode="wb", mtime=0, filename="") as file:
        file.write(text.encode())
    return packed.getvalue()
