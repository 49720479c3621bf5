"""A damaged journal, line by line: each that verifies by its neighbour's checksum is kept.

A line's checksum holds the one before, which that line has at its end. So a damaged line is
known by itself, and so is each one after it: by the checksum that is written in the line before,
or by the one that the line before should have, if only its checksum was hit.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING
from zlib import crc32

import msgspec

from vbraille.sessions.record.events import Lost, Session, read
from vbraille.sessions.record.journal import LINE, JournalContents, decode

if TYPE_CHECKING:
    from vbraille.sessions.record.events import Event


def salvage(content: bytes) -> JournalContents:
    """Read the events of a journal, as far as they are whole and known, damaged or not.

    In the place of each event that is not, there is a `Lost` with its number.
    """
    told = decode(content)
    if told.damage is None:
        return told
    *lines, torn = content.split(b"\n")
    whole, found = _read_lines(lines)
    events: list[Event] = []
    if lines and found[0] is None and (first := _first(lines[0])):
        # It is not sure itself: but who has the files that it has the checksums of, knows.
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
    return JournalContents(events, told.good_bytes, told.crcs, torn, told.damage, tuple(bad))


def _read_lines(lines: list[bytes]) -> tuple[list[bool], list[Event | None]]:
    """Whether each line is whole; and its event, which is kept if only its checksum was hit."""
    whole: list[bool] = []
    events: list[Event | None] = []
    written, reckoned = {0}, set[int]()  # checksums that the line before may have
    before: Event | None = None
    for line in lines:
        found = LINE.fullmatch(line)
        if found is None:
            whole.append(False)
            events.append(None)
            written, reckoned, before = set(), set(), None
            continue
        event = _read(found[1] + b"}")
        sums = {crc: crc32(found[1], crc) for crc in written | reckoned}
        stored = int(found[2], 16)
        by = {crc for crc, made in sums.items() if made == stored}
        whole.append(bool(by) and event is not None)
        events.append(event if by else None)
        if by and not by & written:
            events[-2] = before  # its checksum alone was hit
        written, reckoned, before = {stored}, set(sums.values()) - {stored}, event
    return whole, events


def _read(line: bytes) -> Event | None:
    """Event that a line tells of; None if there is no such event."""
    try:
        return read(line)
    except ValueError:
        return None


def _first(line: bytes) -> Session | None:
    """First event, if it can be read."""
    try:
        return msgspec.structs.replace(msgspec.convert(json.loads(line), Session), n=1)
    except ValueError:  # msgspec's is one too
        return None


def _lost(events: list[Event], last: int, near: Event) -> list[Event]:
    """Events that are lost, from after those that there are to the one with that number."""
    first = events[-1].n + 1 if events else 1
    return [Lost(n=n, t_s=near.t_s, wall=near.wall) for n in range(first, last + 1)]
