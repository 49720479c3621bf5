"""A session's directory: what is on the disk before trial 1, and what is added to it.

`docs/session-format.md` describes the files.
"""

from __future__ import annotations

import json
import os
import platform
import shutil
import sys
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

from vbraille import __version__
from vbraille.errors import InputError, VbrailleError
from vbraille.sessions import journal
from vbraille.sessions.plan import Plan
from vbraille.sessions.protocol import Protocol, parse_protocol

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.sessions.journal import Told

FORMAT = 1
HEAD, PLAN, PROTOCOL = "session.json", "plan.json", "protocol.toml"
_TOLD_VERSIONS = ("numpy", "numba", "pyserial", "cobs", "h5py")


@dataclass(frozen=True, slots=True)
class Record:
    """What a session's directory holds.

    Parameters
    ----------
    folder
        The directory.
    head
        Of `HEAD`: who, what, with what.
    protocol, plan
        What is done, and in which order.
    told
        The journal, when it was read.
    """

    folder: Path
    head: dict[str, Any]
    protocol: Protocol
    plan: Plan
    told: Told


def create(folder: Path, protocol: Protocol, plan: Plan, head: dict[str, Any]) -> None:
    """Put a new session on the disk: whole, or not at all.

    Raises
    ------
    InputError
        If there is something already, or nothing can be written there.
    """
    folder = folder.absolute()
    partial = folder.with_name(f".{folder.name}.partial")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} is there already; give a new directory with --out")
    files = {
        PROTOCOL: protocol.text.encode(),
        PLAN: plan.to_json().encode(),
        HEAD: (json.dumps(head, ensure_ascii=False, indent=2) + "\n").encode(),
    }
    sums = {name: sha256(content).hexdigest() for name, content in files.items()}
    # The others' checksums are in the journal, as its first event.
    first = {"event": "session", "format": FORMAT, "sha256": sums, "t_s": 0.0}
    files[journal.NAME] = journal.first_lines([first])
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        shutil.rmtree(partial, ignore_errors=True)  # of a session that was killed being born
        partial.mkdir()
        try:
            for name, content in files.items():
                _write(partial / name, content)
            _sync(partial)
            partial.rename(folder)
            _sync(folder.parent)
        except BaseException:
            shutil.rmtree(partial, ignore_errors=True)
            raise
    except OSError as error:
        raise InputError(f"{folder} cannot be written: {error.strerror}") from None


def load(folder: Path) -> Record:
    """Read a session's directory; of a damaged journal, what comes before the damage.

    Raises
    ------
    InputError
        If it is no session, or one of a newer format.
    VbrailleError
        If a file other than the journal is missing or not what it was.
    """
    path = folder / journal.NAME
    if not folder.is_dir():
        raise InputError(f"there is no directory {folder}; give that of a session")
    if not path.is_file():
        raise InputError(f"{folder} is not the directory of a session: it has no {journal.NAME}")
    told = journal.decode(_read(path))
    if not told.events:
        raise VbrailleError(f"{path} is damaged in its first line; there is nothing to go by")
    first = told.events[0]
    if first.get("event") != "session":
        raise InputError(f"{path} is not the journal of a session")
    if first["format"] > FORMAT:
        raise InputError(
            f"{folder} is a session of format {first['format']}, and this vbraille knows format "
            f"{FORMAT}; use the vbraille that made it, or a newer one"
        )
    contents = {name: _read(folder / name) for name in (HEAD, PLAN, PROTOCOL)}
    for name, content in contents.items():
        if sha256(content).hexdigest() != first["sha256"][name]:
            raise VbrailleError(
                f"{folder / name} is not what it was when the session began; "
                f"put it back as it was, nothing else was changed"
            )
    return Record(
        folder,
        json.loads(contents[HEAD]),
        parse_protocol(contents[PROTOCOL].decode(), str(folder / PROTOCOL)),
        Plan.from_json(contents[PLAN].decode()),
        told,
    )


def versions() -> dict[str, str]:
    """Versions of all that has a part in what the actuators do."""
    return {
        "vbraille": __version__,
        "python": sys.version.split()[0],
        **{name: version(name) for name in _TOLD_VERSIONS},
        "system": platform.platform(),
    }


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None


def _write(path: Path, content: bytes) -> None:
    with path.open("xb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())


def _sync(folder: Path) -> None:
    """Have a directory's names on the disk."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
