"""The ring: every record once and whole to each reader, or counted as lost."""

import json
import os
import subprocess
import sys
import threading

import numpy as np
import pytest

from vbraille.engine.mailbox import Extent, attach, divide, watch
from vbraille.engine.record import FLOATS, INTS, Flag, Ring, RingReader

SHAPE = (2, 3)
# A reader in another process: it drains as soon as so many ticks are new, up to the last tick.
APART = """
import json, sys
from vbraille.engine.mailbox import Extent, attach, divide, watch
descriptor, last, slow = map(int, sys.argv[1:])
extent = Extent(2, 3, 1, 64)
_, reader = watch(attach(descriptor, extent).toreadonly(), extent)
print("joined", flush=True)
told = {"ticks": 0, "wrong": 0, "before": -1}
while told["before"] < last:
    for _ in range(slow):
        pass
    for tick in reader.drain():
        told["ticks"] += 1
        told["wrong"] += tick["time_ns"] != 10 * tick["tick"] or tick["tick"] <= told["before"]
        told["wrong"] += (tick["frame"] != tick["tick"] / 1024).any()
        told["before"] = int(tick["tick"])
print(json.dumps({**told, "wrong": int(told["wrong"]), "lost": reader.lost}), flush=True)
"""


def pair(size):
    """Both ends over the same memory."""
    memory = memoryview(bytearray(Ring.bytes_needed(SHAPE, size)))
    return Ring(memory, SHAPE, size), RingReader(memory, SHAPE, size)


def append(ring, n):
    ints, floats, frames = ring.columns
    slot = ring.begin()
    ints[slot] = n, 10 * n, 20 * n, 3, 4, 5, 6, 7, 8, int(Flag.PAUSED)
    floats[slot] = n / 2, n / 8, 0.25, -n / 4, 0.75, 8.0, 9.0, 10.0, 0.5, *np.arange(8.0)
    frames[slot] = n / 1024
    ring.end()


def test_a_record_has_every_field_in_its_place():
    writer, reader = pair(8)
    append(writer, 0)
    append(writer, 1)
    writer.publish()
    tick = reader.drain()[1]
    want = {
        "tick": 1, "time_ns": 10, "device_ns": 20, "lateness_ns": 3, "work_ns": 4, "late": 5,
        "overruns": 6, "line": 7, "part": 8, "flags": 1, "x_mm": 0.5, "y_mm": 0.125,
        "theta_rad": 0.25, "vx_mm_s": -0.25, "vy_mm_s": 0.75, "forward_mm": 8.0,
        "forward_s": 9.0, "shown_s": 10.0, "share": 0.5,
        **{f"signal_{n + 1}": n for n in range(8)},
    }  # fmt: skip
    assert tuple(want) == (*INTS, *FLOATS)
    assert {name: tick[name] for name in tick.dtype.names if name != "frame"} == want
    np.testing.assert_array_equal(tick["frame"], np.full(SHAPE, 1 / 1024, np.float32))


def test_a_record_is_seen_a_tick_later_or_when_published():
    writer, reader = pair(8)
    append(writer, 0)
    assert reader.drain().size == 0
    append(writer, 1)
    assert reader.drain()["tick"].tolist() == [0]
    writer.publish()
    assert reader.drain()["tick"].tolist() == [1]
    assert reader.drain().size == 0


@pytest.mark.parametrize("parts", [(3, 5, 1, 7, 8), (8,) * 9, (1,) * 40])
def test_drained_in_time_no_tick_is_lost(parts):
    writer, reader = pair(9)
    seen, n = [], 0
    for part in parts:
        for _ in range(part):
            append(writer, n)
            n += 1
        writer.publish()
        seen += reader.drain()["tick"].tolist()
    assert seen == list(range(n))
    assert reader.lost == 0


def test_what_was_overwritten_is_counted():
    writer, reader = pair(8)
    for n in range(20):
        append(writer, n)
    writer.publish()
    ticks = reader.drain()["tick"].tolist()
    # The oldest place may be in the writing.
    assert ticks == list(range(13, 20))
    assert reader.lost == 13
    append(writer, 20)
    writer.publish()
    assert reader.drain()["tick"].tolist() == [20]
    assert reader.lost == 13


def test_readers_follow_each_at_its_own_pace_and_hold_up_nobody():
    ring = Ring.alone(SHAPE, 8)
    often, seldom = ring.reader(), ring.reader()
    seen = []
    for n in range(20):
        append(ring, n)
        if n == 4:
            late = ring.reader()  # begins with record 3, the newest that is published
        seen += often.drain()["tick"].tolist()
    ring.publish()
    assert seen + often.drain()["tick"].tolist() == list(range(20))
    assert seldom.drain()["tick"].tolist() == list(range(13, 20))
    assert late.drain()["tick"].tolist() == list(range(13, 20))
    assert (often.lost, seldom.lost, late.lost) == (0, 13, 13 - 3)


def test_a_block_of_records_is_appended_at_once():
    writer, reader = pair(8)
    for first, count in ((0, 3), (3, 5), (8, 2)):
        slot = writer.begin()
        writer.columns[0][(slot + np.arange(count)) % 8, 0] = np.arange(first, first + count)
        writer.end(count)
        writer.publish()
        assert reader.drain()["tick"].tolist() == list(range(first, first + count))
    assert reader.lost == 0


@pytest.mark.no_cover
def test_beside_a_writer_that_does_not_wait_records_are_whole_and_counted():
    writer, reader = pair(64)
    count = 30_000

    def write():
        for n in range(count):
            append(writer, n)
        writer.publish()

    thread = threading.Thread(target=write)
    thread.start()
    seen = []
    while thread.is_alive():
        seen.append(reader.drain())
    thread.join()
    seen.append(reader.drain())
    ticks = np.concatenate(seen)
    assert ticks.size + reader.lost == count
    assert (np.diff(ticks["tick"]) > 0).all()
    np.testing.assert_array_equal(ticks["time_ns"], 10 * ticks["tick"])
    frames = ticks["frame"].reshape(-1, 6)
    np.testing.assert_array_equal(frames, np.repeat(ticks["tick"][:, None] / 1024, 6, axis=1))


def test_each_reader_has_a_pace_of_its_own_and_holds_up_nobody():
    size, count = 9, 100
    memory = memoryview(bytearray(Ring.bytes_needed(SHAPE, size)))
    writer = Ring(memory, SHAPE, size)
    # Memory that cannot be written: whatever a reader does, the writer and others do not see it.
    every, fast, slow = (RingReader(memory.toreadonly(), SHAPE, size) for _ in range(3))
    seen = {every: [], fast: [], slow: []}
    for n in range(count):
        append(writer, n)
        writer.publish()
        for reader, pace in ((every, 1), (fast, 8), (slow, 50)):
            if (n + 1) % pace == 0:
                seen[reader] += reader.drain()["tick"].tolist()
    assert seen[every] == list(range(count))
    assert seen[fast] == list(range(96))
    assert fast.drain()["tick"].tolist() == [96, 97, 98, 99]
    assert seen[slow] == [*range(42, 50), *range(92, 100)]
    assert (every.lost, fast.lost, slow.lost) == (0, 0, 84)


def test_a_reader_that_joins_late_begins_with_the_newest_record():
    memory = memoryview(bytearray(Ring.bytes_needed(SHAPE, 8)))
    writer, reader = Ring(memory, SHAPE, 8), RingReader(memory, SHAPE, 8)
    for n in range(30):
        append(writer, n)
    writer.publish()
    late = RingReader(memory, SHAPE, 8)
    assert late.drain()["tick"].tolist() == [29]
    append(writer, 30)
    writer.publish()
    assert late.drain()["tick"].tolist() == [30]
    assert (late.lost, late.cursor) == (0, 31)
    assert reader.drain()["tick"].tolist() == list(range(24, 31))


@pytest.mark.no_cover
def test_readers_in_other_processes_see_whole_records_or_count_them():
    count = 30_000
    extent = Extent(*SHAPE, 1, 64)
    descriptor = os.memfd_create("vbraille")
    memory = attach(descriptor, extent)
    (_, writer), (_, here) = divide(memory, extent), watch(memory, extent)
    command = [sys.executable, "-c", APART, str(descriptor), str(count - 1)]
    pipe = {"stdout": subprocess.PIPE, "text": True, "pass_fds": (descriptor,)}
    with (
        subprocess.Popen([*command, "0"], **pipe) as fast,
        subprocess.Popen([*command, "100000"], **pipe) as slow,
    ):
        assert [process.stdout.readline() for process in (fast, slow)] == ["joined\n"] * 2
        ticks = 0
        for n in range(count):
            append(writer, n)
            if n % 32 == 0:
                ticks += here.drain().size
        writer.publish()
        ticks += here.drain().size
        assert (ticks, here.lost) == (count, 0)
        for process in (fast, slow):
            told = json.loads(process.stdout.read())
            assert told["ticks"] + told["lost"] == count
            assert (told["wrong"], told["before"]) == (0, count - 1)
            assert told["ticks"] > 0
        assert told["lost"] > 0  # the slow one
