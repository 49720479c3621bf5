"""A damaged journal, line by line: each that verifies by its neighbour's checksum is kept.

A line's checksum holds the one before, which that line has at its end. So a damaged line is
known by itself, and so is each one after it: by the checksum that is written in the line before,
or by the one that the line before should have, if only its checksum was hit.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING
from zlib import crc32

from vbraille.sessions.record.journal import LINE, Told, decode

if TYPE_CHECKING:
    from vbraille.sessions.record.journal import Event


def salvage(content: bytes) -> Told:
    """Events of a journal, as far as they are whole, damaged or not.

    In the place of each event that is not, there is one that is called ``lost``, with its number.
    """
    told = decode(content)
    if told.damage is None:
        return told
    *lines, torn = content.split(b"\n")
    sound, whole = _whole(lines)
    events: list[Event] = []
    if lines and not whole[0] and (first := _first(lines[0])):
        # It is not sure itself: but who has the files that it has the checksums of, knows.
        events.append({**first, "n": 1})
    for line, good in zip(lines, whole, strict=True):
        if good:
            event = _parse(line)
            events += _lost(events, event["n"] - 1, event)
            events.append(event)
    after = whole[::-1].index(True) if True in whole else 0
    if after and events:
        events += _lost(events, events[-1]["n"] + after, events[-1])
    bad = [number for number, good in enumerate(sound, 1) if not good]
    if not bad:  # the last line has lost its end
        bad, torn = [len(lines) + 1], b""
        events += _lost(events, events[-1]["n"] + 1, events[-1]) if events else []
    return Told(events, told.good_bytes, told.crcs, torn, told.damage, tuple(bad))


def _whole(lines: list[bytes]) -> tuple[list[bool], list[bool]]:
    """Whether each line verifies, and whether its event does, if only its checksum was hit."""
    sound: list[bool] = []
    whole: list[bool] = []
    written, reckoned = {0}, set[int]()  # checksums that the line before may have
    for line in lines:
        found = LINE.fullmatch(line)
        if found is None:
            sound.append(False)
            whole.append(False)
            written, reckoned = set(), set()
            continue
        sums = {before: crc32(found[1], before) for before in written | reckoned}
        stored = int(found[2], 16)
        by = [before for before, crc in sums.items() if crc == stored]
        sound.append(bool(by))
        whole.append(bool(by))
        if by and not set(by) & written:
            whole[-2] = True  # its checksum alone was hit
        written, reckoned = {stored}, set(sums.values()) - {stored}
    return sound, whole


def _parse(line: bytes) -> Event:
    found = LINE.fullmatch(line)
    assert found is not None, "a line that verifies is one"
    return json.loads(found[1] + b"}")


def _first(line: bytes) -> Event | None:
    """First event, if it can be read."""
    try:
        event = json.loads(line)
    except ValueError:
        return None
    good = isinstance(event, dict) and event.get("event") == "session"
    return event if good and {"n", "format", "sha256", "t_s", "wall"} <= event.keys() else None


def _lost(events: list[Event], last: int, near: Event) -> list[Event]:
    """Events that are lost, from after those that there are to the one with that number."""
    first = events[-1]["n"] + 1 if events else 1
    when = {"t_s": near["t_s"], "wall": near["wall"]}
    return [{"n": n, "event": "lost", **when} for n in range(first, last + 1)]
