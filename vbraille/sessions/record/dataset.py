"""A dataset in the Brain Imaging Data Structure, to which sessions are added one by one."""

from __future__ import annotations

import csv
import io
import json
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError
from vbraille.files import missing, write_file
from vbraille.sessions.record.anonymous import number_of
from vbraille.sessions.record.bids import SESSION, files
from vbraille.sessions.record.codebook import CodebookEntry
from vbraille.sessions.record.export import encode, to_csv
from vbraille.sessions.record.participants import alike, label_of
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.sessions.record.export import Traces
    from vbraille.sessions.record.folder import Record

_BIDS = "1.9.0"
_ABOUT, _README = "dataset_description.json", "README"
_PEOPLE, _PEOPLE_COLUMNS = "participants.tsv", "participants.json"
_ID, _PSEUDONYM = "participant_id", "pseudonym"
_DESCRIBED = CodebookEntry(
    _PSEUDONYM, "as the laboratory has it; participant_id has letters and digits"
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
        (_ABOUT, _json(_about(record))),
        (_README, _README_TEXT.encode()),
        (_PEOPLE_COLUMNS, _json({_PSEUDONYM: _DESCRIBED.to_bids()})),
    ):
        if not (folder / path).exists():
            new[folder / path] = content
    people.setdefault(label, pseudonym)
    rows = [{_ID: f"sub-{of}", _PSEUDONYM: name} for of, name in people.items()]
    _write(folder, new, _PEOPLE, encode(to_csv(rows, "\t", "n/a")))
    return [*new, folder / _PEOPLE]


def _read_people(folder: Path) -> dict[str, str]:
    """Read the pseudonyms of a dataset's participants, by their labels.

    Raises
    ------
    InputError
        If the table cannot be read, or has columns of others.
    """
    path = folder / _PEOPLE
    try:
        rows = list(csv.reader(io.StringIO(path.read_text("utf-8")), delimiter="\t"))
    except (FileNotFoundError, NotADirectoryError):
        return {}  # a dataset that is no directory is refused when it is written
    except (OSError, ValueError, csv.Error):
        rows = []
    if not rows or rows[0] != [_ID, _PSEUDONYM] or any(len(row) != 2 for row in rows):
        raise InputError(
            f"{path} is no table of {_ID} and {_PSEUDONYM} alone, to which participants could be "
            f"added; give another directory with {setting('out')}, and put the tables together"
        )
    return {label.removeprefix("sub-"): pseudonym for label, pseudonym in rows[1:]}


def _check_pseudonym(folder: Path, people: dict[str, str], pseudonym: str) -> None:
    """Check that nobody else in the dataset could be mistaken for this participant."""
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
            with suppress(OSError):  # a directory that somebody else has used meanwhile stays
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


def _json(content: dict[str, Any]) -> bytes:
    return encode(json.dumps(content, ensure_ascii=False, indent=2) + "\n")
