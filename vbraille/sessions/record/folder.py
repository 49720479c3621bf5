"""A session's directory: files written before the first trial, those that grow, and whose it is.

`docs/session-format.md` describes the files.
"""

from __future__ import annotations

import gzip
import json
import platform
import re
import sys
import zlib
from dataclasses import dataclass, replace
from hashlib import sha256
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np

from vbraille.errors import InputError, VbrailleError
from vbraille.files import write_folder
from vbraille.sessions.planning.choosing import Procedure, procedure_of
from vbraille.sessions.planning.plan import Plan
from vbraille.sessions.planning.protocolfiles import parse_protocol
from vbraille.sessions.record import journal
from vbraille.sessions.record.events import Closed, Session
from vbraille.sessions.record.journal import JournalContents, Tie, salvage
from vbraille.sessions.record.progress import Progress
from vbraille.sessions.record.traces import TRACE, Trace, read_last_tie, read_trace
from vbraille.version import __version__

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from vbraille.sessions.planning.protocol import Protocol


FORMAT = 6
HEAD, PLAN, PROTOCOL = "session.json", "plan.json", "protocol.toml"
FILES = (HEAD, PLAN, PROTOCOL)
_TOLD_VERSIONS = ("numpy", "numba", "pyserial", "cobs", "h5py")


@dataclass(frozen=True, slots=True)
class Record:
    """What a session's directory holds.

    Parameters
    ----------
    folder
        The directory.
    head
        Content of session.json: who takes part, what is shown, and with which equipment.
    protocol, plan
        What the session shows, and in which order.
    told
        Content of the journal at the time when it was read.
    procedure
        Rule that chooses the next trial.
    """

    folder: Path
    head: dict[str, Any]
    protocol: Protocol
    plan: Plan
    told: JournalContents
    procedure: Procedure

    def progress(self) -> Progress:
        """How far the session had come by then."""
        return Progress(self.plan, self.told.events, self.procedure)


def create(folder: Path, protocol: Protocol, plan: Plan, head: dict[str, Any]) -> None:
    """Put a new session on the disk, either whole or not at all.

    Raises
    ------
    InputError
        If the path exists already, or no directory can be made there.
    VbrailleError
        If the disk does not take the session.
    """
    files = {
        PROTOCOL: protocol.text.encode(),
        PLAN: plan.to_json().encode(),
        # A lone surrogate, which a file's name may have, becomes an escape of JSON.
        **{name: text.encode() for name, text in protocol.files.items()},
        HEAD: (json.dumps(head, ensure_ascii=False, indent=2) + "\n").encode(
            "utf-8", "backslashreplace"
        ),
    }
    sums = {name: sha256(content).hexdigest() for name, content in files.items()}
    # The others' checksums are in the journal, as its first event.
    files[journal.NAME] = journal.first_lines(Session(format=FORMAT, sha256=sums, t_s=0.0))
    write_folder(
        folder, files, durable=True, private=True, clear=lambda partial: _clear(partial, files)
    )


def read_journal(folder: Path, *, salvaged: bool = False) -> JournalContents:
    """Read the journal of a session, up to a damage or a torn end.

    If it is salvaged, the events after a damage are read as well.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If the journal cannot be read, or its first line is damaged.
    """
    path = folder / journal.NAME
    try:
        content = path.read_bytes()
    except OSError as error:
        raise _no_journal(folder, error) from None
    told = salvage(content) if salvaged else journal.decode(content)
    if not told.events:
        raise VbrailleError(f"{path} is damaged in its first line; there is nothing to go by")
    first = told.events[0]
    if 1 in told.bad and not (
        isinstance(first, Session) and first.sha256.keys() >= set(FILES) and first.format == FORMAT
    ):
        raise VbrailleError(f"{path} is damaged in its first line; there is nothing to go by")
    if not isinstance(first, Session):
        raise InputError(f"{path} is not the journal of a session")
    if first.format != FORMAT:
        raise InputError(
            f"{folder} is a session of format {first.format}, and this vbraille knows format "
            f"{FORMAT}; use the vbraille that made it"
        )
    return told


def whole_lines(folder: Path) -> bytes:
    """Bytes of the journal of a session, without a torn end.

    Raises
    ------
    VbrailleError
        If the journal cannot be read.
    """
    try:
        content = (folder / journal.NAME).read_bytes()
    except OSError as error:
        raise _no_journal(folder, error) from None
    return content[: content.rfind(b"\n") + 1]


def read_file(folder: Path, name: str, told: JournalContents) -> bytes:
    """Read one of `FILES`, and check that it is as it was when the session began.

    Raises
    ------
    VbrailleError
        If the file is missing or was changed.
    """
    path = folder / name
    try:
        content = path.read_bytes()
    except OSError as error:
        raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None
    if sha256(content).hexdigest() != told.session.sha256[name]:
        raise VbrailleError(
            f"{path} is not what it was when the session began; "
            f"put it back as it was, nothing else was changed"
        )
    return content


def load(folder: Path, *, salvaged: bool = False) -> Record:
    """Read a session's directory; `read_journal` says what is read of a damaged journal.

    Raises
    ------
    InputError
        If the directory holds no session, or one of another format.
    VbrailleError
        If the journal cannot be used, or another file is missing or was changed.
    """
    told = read_journal(folder, salvaged=salvaged)
    contents = {name: read_file(folder, name, told).decode() for name in FILES}
    plan = Plan.from_json(contents[PLAN])

    def beside(name: str) -> str:
        if name not in told.session.sha256:
            raise VbrailleError(f"{folder} has lost {name} of its protocol; nothing was changed")
        return read_file(folder, name, told).decode()

    where = str(folder / PROTOCOL)
    whole = parse_protocol(contents[PROTOCOL], where, planned=True, beside=beside)
    try:
        protocol = whole.assigned(plan.group)
    except ValueError as error:
        raise VbrailleError(f"{folder / PLAN} is damaged: {error}; put it back") from None
    head = json.loads(contents[HEAD])
    return Record(folder, head, protocol, plan, told, procedure_of(protocol, plan))


def read_told_trace(folder: Path, name: str, told: JournalContents) -> Trace:
    """Read a trace of a session, up to its last whole chunk.

    A trace also counts as damaged if it is missing, or does not have the length that the journal
    tells.
    """
    path = folder / name
    try:
        trace = read_trace(path)
        size = path.stat().st_size
    except (VbrailleError, OSError):
        return Trace(np.zeros(0, TRACE), 0, "it cannot be read" if path.exists() else "it is gone")
    closed = {event.trace: event.trace_bytes for event in told.events if isinstance(event, Closed)}
    damage = trace.damage
    if damage is None and name in closed and size != closed[name]:
        damage = f"it has {size} bytes, and had {closed[name]} when it was closed"
    elif damage is None and trace.torn_bytes and (name in closed or _is_member(path, trace)):
        damage = "its last chunk has a wrong length"
    return replace(trace, damage=damage)


def missed_tie(ties: Iterable[Tie], told: JournalContents) -> str | None:
    """Say which events the journal has lost since a trace was written; None if it has all."""
    for number, crc in ties:
        if number > len(told.events):
            return (
                f"it was written when {journal.NAME} had {number} events, and it has "
                f"{len(told.events)}: events were lost or taken off its end"
            )
        if number and told.crcs[number - 1] != crc:
            return (
                f"it was written when event {number} of {journal.NAME} was another: events were "
                f"taken off its end and replaced"
            )
    return None


def check_end(folder: Path, told: JournalContents) -> None:
    """Check that a journal has all events that it had when its traces were written.

    Raises
    ------
    VbrailleError
        If some are missing: nothing may be added to the journal then.
    """
    for path in sorted(folder.glob("trace-*.gz")):
        tie = read_last_tie(path)
        fault = None if tie is None else missed_tie([tie], told)
        if fault is not None:
            raise VbrailleError(
                f"{folder} is not whole: of {path.name}, {fault}; nothing was changed"
            )


def versions() -> dict[str, str]:
    """Versions of all programs that affect what the actuators do."""
    return {
        "vbraille": __version__,
        "python": sys.version.split()[0],
        **{name: version(name) for name in _TOLD_VERSIONS},
        "system": platform.platform(),
    }


def _no_journal(folder: Path, error: OSError) -> VbrailleError:
    """Make the error that says why there is no journal to be read."""
    try:
        names = {path.name for path in folder.iterdir()}
    except FileNotFoundError:
        return InputError(f"there is no directory {folder}; give that of a session")
    except OSError as fault:
        return InputError(f"{folder} cannot be read: {fault.strerror}; give a session's directory")
    if journal.NAME in names:
        return VbrailleError(f"{folder / journal.NAME} cannot be read: {error.strerror}")
    if names.issuperset(FILES):
        return VbrailleError(f"{folder} has lost its {journal.NAME}; there is nothing to go by")
    return InputError(f"{folder} is not the directory of a session: it has no {journal.NAME}")


def _is_member(path: Path, trace: Trace) -> bool:
    """Whether the torn end of a trace is a whole chunk, which only states a wrong length."""
    try:
        gzip.decompress(path.read_bytes()[-trace.torn_bytes :])
    except (OSError, EOFError, zlib.error):
        return False
    return True


def _clear(partial: Path, names: Iterable[str]) -> None:
    """Remove the files of a session whose creation was interrupted, and nothing else."""
    for name in names:
        (partial / name).unlink(missing_ok=True)
    partial.rmdir()


def label_of(pseudonym: str) -> str:
    """Label that BIDS takes for a pseudonym or other name: its letters and digits alone."""
    return re.sub(r"[^A-Za-z0-9]", "", pseudonym)


def alike(one: str, other: str) -> bool:
    """Whether two pseudonyms differ only in case, leading zeros, or signs that labels lack."""
    return _plain(one) == _plain(other) or label_of(one).lower() == label_of(other).lower()


def participants_in(room: Path) -> dict[str, str]:
    """Participants whose sessions are in a directory, each with the name of one session."""
    found: dict[str, str] = {}
    try:
        heads = sorted(room.glob(f"*/{HEAD}"))
    except OSError:
        return {}
    for head in heads:
        try:
            told = json.loads(head.read_text("utf-8"))
            found.setdefault(str(told["participant"]), head.parent.name)
        except (OSError, ValueError, KeyError, TypeError):
            continue  # this is no readable session; whoever uses it will be told
    return found


def nearly_same(room: Path, participant: str) -> tuple[str, str] | None:
    """Another participant in a directory whose pseudonym is similar to a new one.

    Returns
    -------
    tuple[str, str] or None
        Pseudonym of the other participant, and the name of one of their sessions. None if there
        is no such participant, or the new pseudonym is already in the directory itself.
    """
    known = participants_in(room)
    if participant in known:
        return None
    return next(((other, known[other]) for other in known if alike(other, participant)), None)


def _plain(pseudonym: str) -> str:
    return label_of(re.sub(r"(?<![0-9])0+(?=[0-9])", "", pseudonym)).lower()
