"""The journal of a session: one event a line, each with a checksum that holds the one before.

What was said to be in is on the disk. A line that a crash cut short is the
journal's torn tail; anything else that does not match is damage. Neither is
mended here. `vbraille.sessions.record.events` has the kinds of events.
"""

from __future__ import annotations

import fcntl
import json
import os
import re
import time
from dataclasses import dataclass
from datetime import UTC, datetime
from hashlib import sha256
from typing import TYPE_CHECKING, Any, NamedTuple, Self
from zlib import crc32

import msgspec

from vbraille.errors import InputError, VbrailleError
from vbraille.sessions.record.events import Session, read, to_json

if TYPE_CHECKING:
    from pathlib import Path

    from vbraille.sessions.record.events import Event

NAME = "journal.jsonl"
TORN = "journal.torn"
LINE = re.compile(rb'(\{.+),"crc":"([0-9a-f]{8})"\}', re.DOTALL)


class Tie(NamedTuple):
    """A line of the journal, as what was written after it names it.

    Parameters
    ----------
    number
        Number of its event, from 1; 0 before there was one that was sure to be on the disk.
    crc
        Its checksum.
    """

    number: int
    crc: int


@dataclass(frozen=True, slots=True)
class JournalContents:
    """What a journal holds.

    Parameters
    ----------
    events
        The events of its lines, up to the first line that is not whole.
    good_bytes
        Length of those lines.
    crcs
        Checksum of each of them.
    torn
        A last line without an end, as a crash leaves it.
    damage
        What is wrong with the first line that has an end and is not whole, or that has an event
        which there is not; None if nothing is.
    bad
        Numbers of all such lines, if it was salvaged; its events are then those of all others,
        `vbraille.sessions.record.salvage`.
    """

    events: list[Event]
    good_bytes: int
    crcs: list[int]
    torn: bytes
    damage: str | None
    bad: tuple[int, ...] = ()

    @property
    def crc(self) -> int:
        """Checksum of the last line that is whole."""
        return self.crcs[-1] if self.crcs else 0

    @property
    def session(self) -> Session:
        """The first event of all, which every journal of a session has."""
        first = self.events[0]
        assert isinstance(first, Session), "a journal that is no session's is refused"
        return first

    @property
    def format(self) -> int:
        """Format that the session began in, which it is gone on with in."""
        return self.session.format


def encode(event: Event, crc: int) -> tuple[bytes, int]:
    """Line of an event after one with that checksum, and its own checksum."""
    text = json.dumps(to_json(event), ensure_ascii=False, separators=(",", ":"))[:-1]
    body = text.encode("utf-8", "backslashreplace")  # as JSON spells a lone surrogate too
    crc = crc32(body, crc)
    return b'%s,"crc":"%08x"}\n' % (body, crc), crc


def decode(journal: bytes) -> JournalContents:
    """Read the events of a journal, as far as it is whole and all of them are known."""
    events: list[Event] = []
    crcs: list[int] = []
    good = crc = 0
    while (end := journal.find(b"\n", good)) >= 0:
        found = LINE.fullmatch(journal[good:end])
        if found is None or crc32(found[1], crc) != int(found[2], 16):
            damage = f"line {len(events) + 1} does not match its checksum"
            return JournalContents(events, good, crcs, b"", damage)
        try:
            events.append(read(found[1] + b"}"))
        except ValueError as fault:
            damage = f"line {len(events) + 1} {fault}"
            return JournalContents(events, good, crcs, b"", damage)
        crc = int(found[2], 16)
        crcs.append(crc)
        good = end + 1
    tail = journal[good:]
    found = LINE.match(tail)
    if found is not None and found.end() < len(tail) and crc32(found[1], crc) == int(found[2], 16):
        # No crash leaves that: the line is whole, and its line break is something else.
        damage = f"line {len(events) + 1} does not end where it should"
        return JournalContents(events, good, crcs, b"", damage)
    return JournalContents(events, good, crcs, tail, None)


def sum_of(journal: bytes) -> str:
    """Say how many lines a journal has, and their SHA-256, for people to keep."""
    lines = journal.count(b"\n")
    return f"{lines} events, SHA-256 {sha256(journal).hexdigest()}"


def sum_of_torn(torn: bytes) -> dict[str, Any]:
    """Length and checksum of what was set aside of a journal, as a run tells of it."""
    return {"bytes": len(torn), "crc": f"{crc32(torn):08x}"}


class Journal:
    """A session's journal, open to be added to, by nobody else meanwhile. A context manager.

    Parameters
    ----------
    folder
        The session's directory.

    Attributes
    ----------
    told : JournalContents
        What was in it when it was opened.
    durable : Tie
        The last event of this run that is sure to be on the disk.

    Raises
    ------
    InputError
        If it is open elsewhere, or may not be written.
    VbrailleError
        If it is damaged.
    """

    def __init__(self, folder: Path) -> None:
        self._path = folder / NAME
        try:
            self._file = os.open(self._path, os.O_RDWR | os.O_APPEND | os.O_CLOEXEC)
        except OSError as error:
            raise InputError(
                f"{self._path} cannot be opened for writing: {error.strerror}"
            ) from None
        try:
            self._lock()
            self.told = decode(self._path.read_bytes())
            if self.told.damage is not None:
                raise VbrailleError(
                    f"{self._path} is damaged: {self.told.damage}; the {len(self.told.events)} "
                    f"events before it are whole, and nothing was changed"
                )
        except BaseException:
            self.close()
            raise
        self.durable = Tie(0, 0)
        self._count, self._crc = len(self.told.events), self.told.crc
        self._length = self.told.good_bytes + len(self.told.torn)

    def torn_file(self) -> dict[str, Any]:
        """Length and checksum of all that was ever set aside; empty if nothing was.

        Raises
        ------
        VbrailleError
            If it cannot be read.
        """
        path = self._path.parent / TORN
        try:
            return sum_of_torn(path.read_bytes()) if path.exists() else {}
        except OSError as error:
            raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None

    def set_torn_aside(self) -> int:
        """Move a torn tail to a file of its own; its length.

        Raises
        ------
        VbrailleError
            If the disk does not take it: the tail is then where it was.
        """
        torn = self.told.torn
        if not torn:
            return 0
        try:
            with (self._path.parent / TORN).open("ab") as file:
                file.write(torn + b"\n")
                file.flush()
                os.fsync(file.fileno())
            os.ftruncate(self._file, self.told.good_bytes)
            self._length = self.told.good_bytes
            os.fsync(self._file)
        except OSError as error:
            raise VbrailleError(
                f"the torn end of {self._path} cannot be moved: {error.strerror}"
            ) from None
        return len(torn)

    def append(self, event: Event) -> Event:
        """Add an event, and return it with its number and its times.

        It is on the disk when this returns, if its kind is durable.

        Raises
        ------
        VbrailleError
            If the disk does not take it: it is then not in.
        """
        numbered = _numbered(event, self._count + 1, self.told.format)
        line, crc = encode(numbered, self._crc)
        try:
            written = os.write(self._file, line)
            if written < len(line):
                os.write(self._file, line[written:])  # says why not
            if event.durable:
                os.fsync(self._file)
        except OSError as error:
            self._take_back()
            raise VbrailleError(
                f"{self._path} cannot be written: {error.strerror}; the {event.kind} is not "
                f"in, all before it is: make room, then session resume goes on"
            ) from None
        self._count += 1
        self._crc = crc
        self._length += len(line)
        if event.durable:
            self.durable = Tie(self._count, crc)
        return numbered

    def close(self) -> None:
        """Let others open it; further calls do nothing."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _take_back(self) -> None:
        """Leave nothing of an event that is not in."""
        try:
            os.ftruncate(self._file, self._length)
        except OSError:  # it is a torn end now, and nothing may come after it
            self.close()

    def _lock(self) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise InputError(
                f"{self._path.parent} is open in another console; end that one first"
            ) from None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def first_lines(session: Session, *events: Event) -> bytes:
    """Write a journal that begins with these events."""
    lines, crc = [], 0
    for number, event in enumerate((session, *events), 1):
        line, crc = encode(_numbered(event, number, session.format), crc)
        lines.append(line)
    return b"".join(lines)


def _numbered(event: Event, number: int, form: int) -> Event:
    """Event with its number, and the time by the clocks that a format has."""
    machine_s = up_s() if form > 1 else None
    return msgspec.structs.replace(event, n=number, wall=_now(), up_s=machine_s)


def up_s() -> float:
    """Seconds since the machine was started, asleep or not: a clock that nobody sets."""
    return round(time.clock_gettime(time.CLOCK_BOOTTIME), 6)


def _now() -> str:
    """Wall-clock time, UTC."""
    return datetime.now(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")
