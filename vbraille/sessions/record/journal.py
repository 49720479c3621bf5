"""The journal of a session: one event on each line, with a checksum that covers the one before.

Events of durable kinds are on the disk before anything is said about them. A last line that a
crash cut short is called torn; any other line that does not match its checksum is damage. Neither
is mended here. `vbraille.sessions.record.events` has the kinds of events.
"""

from __future__ import annotations

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
from vbraille.files import sync_names
from vbraille.sessions.record.events import JournalEvent, Lost, Session, read_event, to_json

if TYPE_CHECKING:
    from pathlib import Path


NAME = "journal.jsonl"
TORN = "journal.torn"
LINE = re.compile(rb'(\{.+),"crc":"([0-9a-f]{8})"\}', re.DOTALL)


class Tie(NamedTuple):
    """Name of a line of the journal, which a trace keeps to show that the line was there before.

    Parameters
    ----------
    number
        Number of the line's event, from 1; 0 if no event was sure to be on the disk yet.
    crc
        Checksum of the line.
    """

    number: int
    crc: int


@dataclass(frozen=True, slots=True)
class JournalContents:
    """The events of a journal, and the state that its bytes are in.

    Parameters
    ----------
    events
        Events of the lines up to the first one that is damaged or torn. If the journal was
        salvaged, events of all lines that are whole; see `vbraille.sessions.record.journal`.
    good_bytes
        Length of the lines up to the first one that is damaged or torn.
    crcs
        Checksums of those lines.
    torn
        Last line without a line break, as a crash leaves it.
    damage
        What is wrong with the first damaged line, which does not match its checksum or has an
        event that is not known; None if no line is damaged.
    bad
        Numbers of all damaged lines, if the journal was salvaged.
    """

    events: list[JournalEvent]
    good_bytes: int
    crcs: list[int]
    torn: bytes
    damage: str | None
    bad: tuple[int, ...] = ()

    @property
    def crc(self) -> int:
        """Checksum of the last line before the first damaged or torn one; 0 if there is none."""
        return self.crcs[-1] if self.crcs else 0

    @property
    def session(self) -> Session:
        """First event of the journal, which says what session it is."""
        first = self.events[0]
        assert isinstance(first, Session), "a journal that is no session's is refused"
        return first


def encode(event: JournalEvent, crc: int) -> tuple[bytes, int]:
    """Line for an event, and its checksum, given the checksum of the line before."""
    text = json.dumps(to_json(event), ensure_ascii=False, separators=(",", ":"))[:-1]
    body = text.encode("utf-8", "backslashreplace")  # JSON has the same escape for a lone surrogate
    crc = crc32(body, crc)
    return b'%s,"crc":"%08x"}\n' % (body, crc), crc


def decode(journal: bytes) -> JournalContents:
    """Read the events of a journal, up to the first line that is damaged or torn."""
    events: list[JournalEvent] = []
    crcs: list[int] = []
    good = crc = 0
    while (end := journal.find(b"\n", good)) >= 0:
        found = LINE.fullmatch(journal[good:end])
        if found is None or crc32(found[1], crc) != int(found[2], 16):
            damage = f"line {len(events) + 1} does not match its checksum"
            return JournalContents(events, good, crcs, b"", damage)
        try:
            events.append(read_event(found[1] + b"}"))
        except ValueError as fault:
            damage = f"line {len(events) + 1} {fault}"
            return JournalContents(events, good, crcs, b"", damage)
        crc = int(found[2], 16)
        crcs.append(crc)
        good = end + 1
    tail = journal[good:]
    found = LINE.match(tail)
    if found is not None and found.end() < len(tail) and crc32(found[1], crc) == int(found[2], 16):
        # No crash leaves this: the line is whole, but another byte stands for its line break.
        damage = f"line {len(events) + 1} does not end where it should"
        return JournalContents(events, good, crcs, b"", damage)
    return JournalContents(events, good, crcs, tail, None)


def sum_of(journal: bytes) -> str:
    """Number of events and SHA-256 of a journal, as a text for people to keep."""
    lines = journal.count(b"\n")
    return f"{lines} events, SHA-256 {sha256(journal).hexdigest()}"


def sum_of_torn(torn: bytes) -> dict[str, Any]:
    """Length and checksum of `journal.torn`, in the form that a run's event has."""
    return {"bytes": len(torn), "crc": f"{crc32(torn):08x}"}


class Journal:
    """A session's journal, open for adding events, and locked meanwhile. It is a context manager.

    Parameters
    ----------
    folder
        The session's directory.

    Attributes
    ----------
    contents : JournalContents
        Content of the journal when it was opened.
    durable : Tie
        Last event of this run that is sure to be on the disk.

    Raises
    ------
    InputError
        If the journal is open elsewhere, or may not be written.
    VbrailleError
        If the journal is damaged.
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
            self.contents = decode(self._path.read_bytes())
            if self.contents.damage is not None:
                raise VbrailleError(
                    f"{self._path} is damaged: {self.contents.damage}; the "
                    f"{len(self.contents.events)} events before it are whole, and nothing was "
                    f"changed"
                )
        except BaseException:
            self.close()
            raise
        self.durable = Tie(0, 0)
        self._count, self._crc = len(self.contents.events), self.contents.crc
        self._length = self.contents.good_bytes + len(self.contents.torn)

    def torn_file(self) -> dict[str, Any]:
        """Length and checksum of `journal.torn`; empty if that file does not exist.

        Raises
        ------
        VbrailleError
            If the file cannot be read.
        """
        path = self._path.parent / TORN
        try:
            return sum_of_torn(path.read_bytes()) if path.exists() else {}
        except OSError as error:
            raise VbrailleError(f"{path} cannot be read: {error.strerror}") from None

    def set_torn_aside(self) -> int:
        """Move a torn last line to `journal.torn`, and return its length.

        Raises
        ------
        VbrailleError
            If the disk does not take the line, which then stays where it was.
        """
        torn = self.contents.torn
        if not torn:
            return 0
        try:
            aside = self._path.parent / TORN
            aside.touch(0o600)
            with aside.open("ab") as file:
                file.write(torn + b"\n")
                file.flush()
                os.fsync(file.fileno())
            sync_names(self._path.parent)
            os.ftruncate(self._file, self.contents.good_bytes)
            self._length = self.contents.good_bytes
            os.fsync(self._file)
        except OSError as error:
            raise VbrailleError(
                f"the torn end of {self._path} cannot be moved: {error.strerror}"
            ) from None
        return len(torn)

    def append(self, event: JournalEvent) -> JournalEvent:
        """Add an event, and return it with its number and its times.

        If its kind is durable, the event is on the disk when this returns.

        Raises
        ------
        VbrailleError
            If the disk does not take the event, which then is not in the journal.
        """
        numbered = _numbered(event, self._count + 1)
        line, crc = encode(numbered, self._crc)
        try:
            written = os.write(self._file, line)
            if written < len(line):
                os.write(self._file, line[written:])  # a second try tells the reason
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
        """Close the journal, so that others can open it; further calls do nothing."""
        if self._file >= 0:
            os.close(self._file)
            self._file = -1

    def _take_back(self) -> None:
        """Remove the part of an event that was written before the disk failed."""
        try:
            os.ftruncate(self._file, self._length)
        except OSError:  # the part is a torn line now, which nothing may follow
            self.close()

    def _lock(self) -> None:
        import fcntl  # which a system may not have that reads sessions and runs none

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


def first_lines(session: Session, *events: JournalEvent) -> bytes:
    """Bytes of a new journal that has these events."""
    lines, crc = [], 0
    for number, event in enumerate((session, *events), 1):
        line, crc = encode(_numbered(event, number), crc)
        lines.append(line)
    return b"".join(lines)


def _numbered(event: JournalEvent, number: int) -> JournalEvent:
    """Event with its number, and the present time by the wall clock and the machine's."""
    wall = datetime.now(UTC).isoformat(timespec="microseconds").replace("+00:00", "Z")
    return msgspec.structs.replace(event, n=number, wall=wall, up_s=up_s())


def up_s() -> float:
    """Seconds since the machine was started, time asleep included."""
    return round(time.clock_gettime(time.CLOCK_BOOTTIME), 6)


def salvage(content: bytes) -> JournalContents:
    """Read all events of a journal that are whole and known, even after a damage.

    Each other event is replaced by a `Lost` that has its number.
    """
    contents = decode(content)
    if contents.damage is None:
        return contents
    *lines, torn = content.split(b"\n")
    whole, found = _read_lines(lines)
    events: list[JournalEvent] = []
    if lines and found[0] is None and (first := _first(lines[0])):
        # No line before it verifies the first event, but the files whose checksums it has do.
        events.append(first)
    for event in found:
        if event is not None:
            events += _lost(events, event.n - 1, event)
            events.append(event)
    after = next((n for n, event in enumerate(reversed(found)) if event is not None), 0)
    if after and events:
        events += _lost(events, events[-1].n + after, events[-1])
    bad = [number for number, good in enumerate(whole, 1) if not good]
    if not bad:  # the last line has lost its end
        bad, torn = [len(lines) + 1], b""
        events += _lost(events, events[-1].n + 1, events[-1]) if events else []
    return JournalContents(
        events, contents.good_bytes, contents.crcs, torn, contents.damage, tuple(bad)
    )


def _read_lines(lines: list[bytes]) -> tuple[list[bool], list[JournalEvent | None]]:
    """True if each line is whole; and its event, kept even if its checksum alone is damaged."""
    whole: list[bool] = []
    events: list[JournalEvent | None] = []
    written, reckoned = {0}, set[int]()  # checksums that the line before may have
    before: JournalEvent | None = None
    for line in lines:
        found = LINE.fullmatch(line)
        if found is None:
            whole.append(False)
            events.append(None)
            written, reckoned, before = set(), set(), None
            continue
        event = _known(found[1] + b"}")
        sums = {crc: crc32(found[1], crc) for crc in written | reckoned}
        stored = int(found[2], 16)
        by = {crc for crc, made in sums.items() if made == stored}
        whole.append(bool(by) and event is not None)
        events.append(event if by else None)
        if by and not by & written:
            events[-2] = before  # only the checksum of the line before is damaged
        written, reckoned, before = {stored}, set(sums.values()) - {stored}, event
    return whole, events


def _known(line: bytes) -> JournalEvent | None:
    """Event of a line; None if the line has no event that is known."""
    try:
        return read_event(line)
    except ValueError:
        return None


def _first(line: bytes) -> Session | None:
    """First event of a journal; None if it cannot be read."""
    try:
        return msgspec.structs.replace(msgspec.convert(json.loads(line), Session), n=1)
    except ValueError:  # msgspec's errors are ValueErrors too
        return None


def _lost(events: list[JournalEvent], last: int, near: JournalEvent) -> list[JournalEvent]:
    """Stand-ins for the lost events that come after the given ones, up to a number."""
    first = events[-1].n + 1 if events else 1
    return [Lost(n=n, t_s=near.t_s, wall=near.wall) for n in range(first, last + 1)]
