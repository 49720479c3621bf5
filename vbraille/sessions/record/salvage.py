"""Salvage of a damaged journal: every line that can be verified is kept.

A line's checksum is begun with the checksum of the line before. So each line can be verified
with the line before it alone: by the checksum that is written there; or, if that checksum was
damaged, by the one that should be there.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING
from zlib import crc32

import msgspec

from vbraille.sessions.record.eventlines import read
from vbraille.sessions.record.events import Lost, Session
from vbraille.sessions.record.journal import LINE, JournalContents, decode

if TYPE_CHECKING:
    from vbraille.sessions.record.eventbase import JournalEvent


def salvage(content: bytes) -> JournalContents:
    """Read all events of a journal that are whole and known, even after a damage.

    Each other event is replaced by a `Lost` that has its number.
    """
    told = decode(content)
    if told.damage is None:
        return told
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
    return JournalContents(events, told.good_bytes, told.crcs, torn, told.damage, tuple(bad))


def _read_lines(lines: list[bytes]) -> tuple[list[bool], list[JournalEvent | None]]:
    """Whether each line is whole; and its event, kept even if its checksum alone is damaged."""
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
        event = _read(found[1] + b"}")
        sums = {crc: crc32(found[1], crc) for crc in written | reckoned}
        stored = int(found[2], 16)
        by = {crc for crc, made in sums.items() if made == stored}
        whole.append(bool(by) and event is not None)
        events.append(event if by else None)
        if by and not by & written:
            events[-2] = before  # only the checksum of the line before is damaged
        written, reckoned, before = {stored}, set(sums.values()) - {stored}, event
    return whole, events


def _read(line: bytes) -> JournalEvent | None:
    """Event of a line; None if the line has no event that is known."""
    try:
        return read(line)
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
