"""A dataset in the Brain Imaging Data Structure, to which sessions are added one by one."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from vbraille.errors import InputError, VbrailleError
from vbraille.files import missing, write_file
from vbraille.sessions.record.anonymous import number_of
from vbraille.sessions.record.bids import SESSION, files
from vbraille.sessions.record.export import encode
from vbraille.sessions.record.participants import alike, label_of
from vbraille.sessions.record.people import PEOPLE, PEOPLE_COLUMNS, described, read_people
from vbraille.wording import setting

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.sessions.record.export import Traces
    from vbraille.sessions.record.folder import Record

_BIDS = "1.9.0"
_ABOUT, _README = "dataset_description.json", "README"
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
    site: str = "",
    session: str | None = None,
) -> list[Path]:
    """Add a session to a dataset, which is begun if there is none, and return the files written.

    Parameters
    ----------
    record, traces, without_times
        These are described at `vbraille.sessions.record.bids.files`.
    folder
        Directory of the dataset.
    site
        Where the participant took part, if the dataset has several sites: P01 of two sites are two
        participants then.
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
    people = read_people(folder)
    pseudonym = record.plan.participant
    name = f"{site}/{pseudonym}" if site else pseudonym
    label = label_of(name)
    _check_pseudonym(folder, people.names(), name)
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
        participant=name,
    )
    if there := next((path for path in made if (folder / path).exists()), None):
        raise InputError(
            f"{folder / there} is there already, of another session; leave out "
            f"{setting('session-by')}, or give another directory with {setting('out')}"
        )
    new = {folder / path: content for path, content in made.items()}
    for path, content in ((_ABOUT, _json(_about(record))), (_README, _README_TEXT.encode())):
        if not (folder / path).exists():
            new[folder / path] = content
    after = people.add(label, pseudonym, site)
    told = {PEOPLE: encode(after.to_tsv())}
    if (columns := described(folder, after)) is not None:
        path = folder / PEOPLE_COLUMNS
        if path.exists():
            told[PEOPLE_COLUMNS] = _json(columns)
        else:
            new[path] = _json(columns)
    _write(folder, new, told)
    return [*new, *(folder / name for name in reversed(told))]


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


def _write(folder: Path, new: dict[Path, bytes], told: dict[str, bytes]) -> None:
    """Write new files, and then those that tell of participants; undo everything if one fails."""
    before = {name: _content(folder / name) for name in told}
    replaced: list[str] = []
    written: list[Path] = []
    try:
        parents = {parent for path in new for parent in missing(path.parent)}
        for parent in sorted(parents):  # a directory comes after the one that contains it
            parent.mkdir(exist_ok=True)
            written.append(parent)
        for path, content in new.items():
            write_file(path, content)
            written.append(path)
        for name, content in reversed(told.items()):
            replaced.append(name)
            write_file(folder / name, content, replace=True, durable=True)
    except BaseException as fault:
        for name in replaced:
            with suppress(OSError, VbrailleError):
                if (content := before[name]) is None:
                    (folder / name).unlink(missing_ok=True)
                else:
                    write_file(folder / name, content, replace=True)
        for path in reversed(written):
            with suppress(OSError):  # a directory that somebody else has used meanwhile stays
                path.rmdir() if path.is_dir() else path.unlink()
        if isinstance(fault, OSError):
            raise InputError(f"{folder} cannot be written: {fault.strerror}") from None
        raise


def _content(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except OSError:
        return None


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
