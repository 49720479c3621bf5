"""Sessions in the Brain Imaging Data Structure: trials as behaviour, ticks as recordings.

The files follow BIDS 1.9, "Behavioral experiments (with no neural recordings)" and "Physiological
recordings". Sessions are added to a dataset one by one.
"""

from __future__ import annotations

import gzip
import io
import json
import re
from collections.abc import Iterable, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vbraille.csvfiles import read_csv
from vbraille.errors import InputError
from vbraille.files import write_file, write_files
from vbraille.names import likeness
from vbraille.sessions.record.record import Content, Event, read, reading
from vbraille.sessions.record.ticks import read_all
from vbraille.sessions.record.trials import COLUMNS_OF, Column, codebook, protocol_of, rows, to_csv

DATASET, README = "dataset_description.json", "README"
PEOPLE, PSEUDONYM = "participants.tsv", "pseudonym"
SUM = "SessionSum"  # key that tells which session a file of a dataset is of
README_TEXT = """\
Sessions of vbraille, as behavioural data.

Each sub- is a participant, by the pseudonym that participants.tsv has. Each ses- is one session. A
session that was stopped and gone on with has several runs. *_beh.tsv has a row a trial,
*_events.tsv what happened in a run, and *_recording-carriage_physio.tsv.gz where the array was at
each moment. The file of the same name that ends in .json says what each column holds.
"""
ABOUT = {"Name": "vbraille sessions", "BIDSVersion": "1.9.0", "DatasetType": "raw"}
# Fields of the ticks that a recording's columns are, and their formats.
FIELDS = {"x_mm": "%.6g", "y_mm": "%.6g", "vx_mm_s": "%.6g", "tick": "%.12g", "line": "%.12g",
          "flags": "%.12g"}  # fmt: skip
SAID = ("answer", "confidence", "reply", "text", "what", "why", "by")
WORDS = ("reply", "text", "why", "what")  # what anonymous datasets leave out


def export_bids(paths: Iterable[Path], folder: Path, *, anonymous: bool = False) -> list[Path]:
    """Add sessions to a dataset, which is begun if there is none, and return the files written.

    Parameters
    ----------
    anonymous
        Whether times of day, notes, words and names of files are left out.

    Raises
    ------
    InputError
        If the dataset has a session already, two participants could not be told apart, or a file
        cannot be written. The sessions before it are whole in the dataset.
    """
    written: list[Path] = []
    for content in [read(path) for path in paths]:
        written += _add(content, folder, anonymous)
    return written


def label_of(name: str) -> str:
    """Return the label that BIDS takes for a name: its letters and digits alone."""
    return re.sub(r"[^A-Za-z0-9]", "", name)


def _add(content: Content, folder: Path, anonymous: bool) -> list[Path]:
    """Add a session to a dataset."""
    people, who = _read_people(folder), content.plan.participant
    label, alike = label_of(who), likeness(who, person=True)
    for other in people.values():
        if other != who and likeness(other, person=True) == alike:
            raise InputError(f"{folder} has {other}, who is hard to tell from {who}")
    for told in folder.glob("sub-*/ses-*/beh/*_beh.json"):
        if json.loads(told.read_text("utf-8")).get(SUM) == content.events[0].data["plan"]:
            raise InputError(f"{content.path} is there already, as {told.with_suffix('.tsv')}")
    known = [int(path.name[4:]) for path in folder.glob(f"sub-{label}/ses-[0-9][0-9]")]
    visit = f"ses-{max(known, default=0) + 1:02}"
    home = folder / f"sub-{label}" / visit / "beh"
    stem = f"sub-{label}_{visit}_task-{label_of(content.head['protocol'])}"
    made = {home / name: data for name, data in _files(content, stem, anonymous).items()}
    maker = {"Name": "vbraille", "Version": version("vbraille")}
    whole = {
        DATASET: _json(ABOUT | {"GeneratedBy": [maker]}),
        README: README_TEXT.encode(),
        "participants.json": _json({PSEUDONYM: {"Description": "as the laboratory has it"}}),
    }
    made |= {folder / name: data for name, data in whole.items() if not (folder / name).exists()}
    people[label] = who
    table = [{"participant_id": f"sub-{of}", PSEUDONYM: name} for of, name in people.items()]
    try:
        home.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"{home} cannot be made: {error.strerror}") from None
    write_files(made.items())
    write_file(folder / PEOPLE, _tsv(table), replace=True)
    return [*made, folder / PEOPLE]


def _read_people(folder: Path) -> dict[str, str]:
    """Return the pseudonyms of a dataset's participants, by their labels."""
    path = folder / PEOPLE
    if not path.exists():
        return {}
    sheet = read_csv(path)
    if sheet.columns != ("participant_id", PSEUDONYM):
        raise InputError(f"{path} has other columns; give another directory, and join the tables")
    return {label.removeprefix("sub-"): who for label, who in sheet.rows}


def _files(content: Content, stem: str, anonymous: bool) -> dict[str, bytes]:
    """Return the files of a session by their names."""
    protocol, table = protocol_of(content), rows(content.path, anonymous=anonymous)
    described = {
        SUM: content.events[0].data["plan"],
        "TaskName": protocol.name,
        "TaskDescription": f"{protocol.title} ({protocol.source})",
    }
    made = {
        f"{stem}_beh.tsv": _tsv(table),
        f"{stem}_beh.json": _json(described | _told(codebook(table[0], protocol))),
    }
    runs = [event for event in content.events if event.kind == "run"]
    ends = [*(run.n for run in runs[1:]), content.events[-1].n + 1]
    with reading(content.path) as db:
        for number, (run, end) in enumerate(zip(runs, ends, strict=True), 1):
            name = f"{stem}_run-{number:02}"
            made[f"{name}_events.tsv"] = _events(content.events[run.n - 1 : end - 1], anonymous)
            made[f"{name}_events.json"] = _json(_told(COLUMNS_OF["events"]))
            ticks = read_all(db, run.n - 1, end)
            if ticks.size:
                columns = COLUMNS_OF["recording"]
                name += "_recording-carriage_physio"
                made[f"{name}.tsv.gz"] = _recording(ticks)
                sampled = {
                    "SamplingFrequency": run.data["conditions"]["rate_hz"],
                    "StartTime": float(ticks["time_ns"][0]) / 1e9 - run.data["clock_s"],
                    "Columns": list(columns),
                }
                made[f"{name}.json"] = _json(sampled | _told(columns))
    return made


def _json(content: dict[str, Any]) -> bytes:
    return (json.dumps(content, ensure_ascii=False, indent=2) + "\n").encode()


def _tsv(table: list[dict[str, Any]]) -> bytes:
    return to_csv(table, "\t", "n/a").encode()


def _told(columns: dict[str, Column]) -> dict[str, dict[str, Any]]:
    """Return what columns hold, as the JSON beside a table has it."""
    found = {}
    for name, (meaning, unit, values) in columns.items():
        found[name] = {"Description": meaning} | ({"Units": unit} if unit else {})
        if values:
            found[name]["Levels"] = {value: value for value in values.split(", ")}
    return found


def _events(events: Sequence[Event], anonymous: bool) -> bytes:
    """Return the events of a run, by their times from its beginning."""
    table = []
    for event in sorted(events, key=lambda event: event.t_s):
        said = [str(event.data[name]) for name in SAID if event.data.get(name) not in (None, "")]
        hidden = anonymous and any(name in event.data for name in WORDS)
        table.append(
            {
                "onset": round(event.t_s - events[0].t_s, 6),
                "duration": "",
                "trial_type": event.kind,
                "practice": int(bool(event.practice)),
                "trial": event.trial or "",
                "value": "" if hidden else "; ".join(said),
            }
        )
    return _tsv(table)


def _recording(ticks: NDArray[np.void]) -> bytes:
    """Return ticks as a table with a row for each deadline; n/a where one was missed."""
    due = ticks["tick"] + ticks["late"] - ticks["tick"][0] - ticks["late"][0]
    table = np.full((due[-1] + 1, len(FIELDS)), np.nan)
    table[due] = np.column_stack([ticks[field] for field in FIELDS])
    text = io.BytesIO()
    np.savetxt(text, table, [*FIELDS.values()], "\t")
    return gzip.compress(text.getvalue().replace(b"nan", b"n/a"), 3, mtime=0)
