"""A session in the Brain Imaging Data Structure: trials as behaviour, traces as recordings.

Behavioural data of BIDS 1.9, "Behavioral experiments (with no neural
recordings)" and "Physiological recordings".
"""

from __future__ import annotations

import gzip
import io
import json
import re
from contextlib import suppress
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError
from vbraille.sessions.record.export import COLUMNS, Traces, encode, rows, to_csv, write_new
from vbraille.sessions.record.folder import missing
from vbraille.sessions.record.progress import Progress

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from vbraille.sessions.record.folder import Record

_BIDS = "1.9.0"
_ROWS = 1000  # formatted at once
_LEVEL = 3  # of gzip: higher ones take longer than all the rest
_UNITS = {name: "s" for name in COLUMNS if name.endswith("_s")}
# Column of a recording: where it comes from, how it is printed, and what it is.
_RECORDED = {
    "x_mm": ("x_mm", "%.6g", "mm", "place of the array's left column"),
    "speed_mm_s": ("speed_mm_s", "%.6g", "mm/s", "of the hand, to the right"),
    "frame": ("tick", "%d", "", "number of the frame, from 0"),
    "line": ("line", "%d", "", "number of what was shown last, as in the journal; 0 before"),
    "flags": ("flags", "%d", "", "bits, as docs/session-format.md has them"),
}


def files(record: Record, traces: Traces | None = None) -> dict[str, bytes]:
    """Files of a session, by their paths in the dataset.

    Parameters
    ----------
    record
        The session.
    traces
        Its traces, for who wants to know what is wrong with them; what can be read of them
        is written.
    """
    traces = Traces(record) if traces is None else traces
    who, task = _label(record.plan.participant), _label(record.plan.protocol)
    stem = f"sub-{who}/beh/sub-{who}_task-{task}"
    made = {
        f"{stem}_beh.tsv": encode(to_csv(rows(record, traces), "\t", "n/a")),
        f"{stem}_beh.json": _json(_beh(record)),
    }
    started = [run for run in Progress(record.plan, record.told.events).runs if "trace" in run]
    for number, run in enumerate(started, 1):
        name = f"{stem}_run-{number:02}_recording-carriage_physio"
        ticks = traces.read(run["trace"]).ticks
        if not ticks.size:
            continue
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
                "Trace": run["trace"],
                "Manufacturer": run["device"]["name"],
            }
        )
    return made


def write(record: Record, folder: Path, traces: Traces | None = None) -> list[Path]:
    """Write a session into a dataset, which is begun if there is none; the files written.

    Raises
    ------
    InputError
        If one of the files is there already, or cannot be made; nothing is written then.
    VbrailleError
        If the disk does not take them; nothing is left then.
    """
    made = {folder / name: content for name, content in files(record, traces).items()}
    about = folder / "dataset_description.json"
    written: list[Path] = []
    try:
        for path in made:
            if path.exists():
                raise InputError(f"{path} is there already; give another directory with --out")
        if not about.exists():
            made[about] = _json(_about(record))
        parents = {parent for path in made for parent in missing(path.parent)}
        for parent in sorted(parents):  # each after the one that it is in
            parent.mkdir(exist_ok=True)
            written.append(parent)
        for path, content in made.items():
            write_new(path, content)
            written.append(path)
    except BaseException as fault:
        for path in reversed(written):
            with suppress(OSError):  # where somebody else has put something meanwhile
                path.rmdir() if path.is_dir() else path.unlink()
        if isinstance(fault, OSError):
            raise InputError(f"{folder} cannot be written: {fault.strerror}") from None
        raise
    return list(made)


def _about(record: Record) -> dict[str, Any]:
    """What the dataset is."""
    return {
        "Name": "vbraille legibility sessions",
        "BIDSVersion": _BIDS,
        "DatasetType": "raw",
        "GeneratedBy": [{"Name": "vbraille", "Version": record.head["versions"]["vbraille"]}],
    }


def _label(name: str) -> str:
    """Name without what BIDS does not take in a label."""
    return re.sub(r"[^A-Za-z0-9]", "", name)


def _json(content: dict[str, Any]) -> bytes:
    return encode(json.dumps(content, ensure_ascii=False, indent=2) + "\n")


def _beh(record: Record) -> dict[str, Any]:
    described: dict[str, Any] = {
        "TaskName": record.protocol.name,  # of which the task in the files' names is made
        "TaskDescription": f"{record.protocol.title} ({record.protocol.source})",
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
                # Formatted by the thousand, which is several times as fast as one by one.
                file.write((row * some.size % values).replace("nan", "n/a").encode())
    return packed.getvalue()
