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
_README_TEXT = """\
Legibility sessions of vbraille, as behavioural data.

Each sub- is a participant, by the pseudonym that participants.tsv has. Each ses- is one session: a
protocol from its first trial to its last, in the order in which they were added. A session that was
broken off and gone on with has several runs.

*_beh.tsv has a row a trial. *_events.tsv has what happened in a run, notes of the experimenter
included, and *_recording-carriage_physio.tsv.gz where the array was at each moment, with its speed.
What each column holds is in the file of the same name that ends in .json.
"""
_PEOPLE_TOLD = {
    "pseudonym": {"Description": "as the laboratory has it; participant_id has letters and digits"}
}


def write(
    record: Record,
    folder: Path,
    traces: Traces | None = None,
    *,
    without_times: bool = False,
) -> list[Path]:
    """Add a session to a dataset, which is begun if there is none, and return the files written.

    Parameters
    ----------
    record, traces, without_times
        These are described at `vbraille.sessions.record.bids.files`.
    folder
        Directory of the dataset.

    Raises
    ------
    InputError
        If the dataset has the session already, another participant's pseudonym is too similar
        to this one's, or a file cannot be made. Nothing is written then.
    VbrailleError
        If the disk does not take the files. The dataset then is as it was before.
    """
    people = _people(folder)
    pseudonym, label = record.plan.participant, label_of(record.plan.participant)
    _check_pseudonym(folder, people, pseudonym)
    _check_absent(folder, record)
    session = _next_session(folder / f"sub-{label}")
    made = files(record, traces, session=session, without_times=without_times)
    new = {folder / name: content for name, content in made.items()}
    for name, content in (
        (_ABOUT, _json(_about(record))),
        (_README, _README_TEXT.encode()),
        (_PEOPLE_COLUMNS, _json(_PEOPLE_TOLD)),
    ):
        if not (folder / name).exists():
            new[folder / name] = content
    rows = [
        {"participant_id": f"sub-{known}", "pseudonym": name}
        for known, name in sorted({**people, label: pseudonym}.items())
    ]
    _write(folder, new, encode(to_csv(rows, "\t", "n/a")))
    return [*new, folder / _PEOPLE]


def _people(folder: Path) -> dict[str, str]:
    """Pseudonyms of the participants of a dataset, by their labels."""
    try:
        told = list(
            csv.DictReader(io.StringIO((folder / _PEOPLE).read_text("utf-8")), delimiter="\t")
        )
        known = {row["participant_id"].removeprefix("sub-"): row["pseudonym"] for row in told}
    except (FileNotFoundError, NotADirectoryError):
        known = {}  # a dataset that is no directory is refused when it is written
    except OSError as error:
        raise InputError(f"{folder} cannot be written: {error.strerror}") from None
    except (ValueError, KeyError, AttributeError):
        raise InputError(
            f"{folder / _PEOPLE} cannot be read as a table of participant_id and pseudonym; "
            f"give another directory with {setting('out')}"
        ) from None
    labels = [path.name.removeprefix("sub-") for path in folder.glob("sub-*")]
    return {label: label for label in labels} | known


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
    if (participant / "beh").exists():
        raise InputError(
            f"{participant} was written by an older vbraille, without sessions; "
            f"give another directory with {setting('out')}"
        )
    names = [path.name for path in participant.glob("ses-*")]
    numbers = [int(name[4:]) for name in names if re.fullmatch("ses-[0-9]{1,9}", name)]
    return f"{max(numbers, default=0) + 1:02}"


def _write(folder: Path, new: dict[Path, bytes], people: bytes) -> None:
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
        write_file(folder / _PEOPLE, people, replace=True, durable=True)
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
