"""Traces: every tick, to the last whole chunk."""

import gzip

import numpy as np
import pytest

from tests.sessions.sittings import Session, of
from vbraille.engine.record import tick_dtype
from vbraille.errors import VbrailleError
from vbraille.sessions.record.journal import NAME, Tie
from vbraille.sessions.record.traces import (
    CHUNK_TICKS,
    TRACE,
    TraceWriter,
    read_last_tie,
    read_trace,
)

TIE = Tie(7, 8)


def ticks(first, count):
    made = np.zeros(count, tick_dtype((1, 12)))
    made["tick"] = np.arange(first, first + count)
    for n, name in enumerate(("x_mm", "y_mm", "theta_rad", "vx_mm_s", "vy_mm_s", "shown_s"), 1):
        made[name] = np.sin(n * made["tick"])
    made["x_mm"][:3] = np.nan
    made["part"] = made["tick"] % 3
    made["frame"] = 0.5
    return made


def written(path, *counts):
    writer = TraceWriter(path, lambda: TIE)
    first = 0
    for count in counts:
        writer.add(ticks(first, count))
        first += count
    writer.close()
    return path.read_bytes()


def test_every_tick_comes_back_bit_for_bit(tmp_path):
    path = tmp_path / "trace-001.gz"
    written(path, 20, 1500, 0, 3000, 7)
    trace = read_trace(path)
    assert trace.ticks["tick"].tolist() == list(range(4527))
    want = np.concatenate([ticks(0, 20), ticks(20, 1500), ticks(1520, 3000), ticks(4520, 7)])
    for name in TRACE.names:
        assert trace.ticks[name].tobytes() == np.ascontiguousarray(want[name]).tobytes()
    assert (trace.torn_bytes, trace.damage) == (0, None)


def test_gzip_reads_a_trace(tmp_path):
    path = tmp_path / "trace-001.gz"
    written(path, 2500, 10)
    assert len(gzip.decompress(path.read_bytes())) == 2510 * TRACE.itemsize


def test_a_chunk_is_on_the_disk_when_it_is_full(tmp_path):
    path = tmp_path / "trace-001.gz"
    writer = TraceWriter(path, lambda: TIE)
    writer.add(ticks(0, CHUNK_TICKS - 1))
    assert read_trace(path).ticks.size == 0
    writer.add(ticks(CHUNK_TICKS - 1, 1))
    assert read_trace(path).ticks.size == CHUNK_TICKS
    writer.add(ticks(CHUNK_TICKS, 5))
    writer.sync()
    assert read_trace(path).ticks.size == CHUNK_TICKS + 5
    writer.close()


def test_a_trace_that_was_synced_is_whole_on_the_disk_and_so_is_its_name(tmp_path, synced):
    path = tmp_path / "trace-001.gz"
    writer = TraceWriter(path, lambda: TIE)
    assert synced == [("", {path.name: 0})]
    writer.add(ticks(0, 5))
    writer.sync()
    whole = path.stat().st_size
    assert synced[1:] == [(path.name, {path.name: whole})]
    assert read_trace(path).ticks.size == 5
    writer.close()
    assert path.stat().st_size == whole


def test_each_answer_of_a_session_finds_the_trace_of_its_trial_on_the_disk(tmp_path, synced):
    session = Session(tmp_path / "s")
    answers = len(of(session.sit().events, "answer"))
    found, on_disk, begun = 0, 0, 0
    for name, sizes in synced:
        if name == "trace-001.gz":
            on_disk = sizes[name]
        elif name == NAME and on_disk > begun:
            assert sizes["trace-001.gz"] == on_disk
            found, begun = found + 1, on_disk
    assert found == answers > 0


def test_a_trace_cut_short_is_read_to_its_last_whole_chunk(tmp_path, rng):
    path = tmp_path / "trace-001.gz"
    whole = written(path, 1000, 1000, 1000)
    path.write_bytes(whole)
    sizes = [0, *(len(written(tmp_path / f"{n}.gz", *[1000] * n)) for n in (1, 2))]
    for cut in [*rng.integers(1, len(whole), 60).tolist(), *sizes[1:]]:
        path.write_bytes(whole[:cut])
        trace = read_trace(path)
        chunks = sum(size <= cut for size in sizes[1:])
        assert trace.ticks.size == 1000 * chunks
        assert trace.torn_bytes == cut - sizes[chunks]
        assert trace.damage is None


def test_no_bit_flips_unseen(tmp_path, rng):
    path = tmp_path / "trace-001.gz"
    whole = written(path, 1000, 1000)
    first = len(written(tmp_path / "first.gz", 1000))
    bits = [*range(80), *rng.integers(0, 8 * len(whole), 300).tolist()]
    for bit in bits:
        flipped = bytearray(whole)
        flipped[bit // 8] ^= 1 << bit % 8
        path.write_bytes(flipped)
        trace = read_trace(path)
        assert trace.damage or trace.torn_bytes, bit
        assert trace.ticks.size <= (1000 if bit // 8 >= first else 0), bit


def test_a_trace_is_never_written_over(tmp_path):
    path = tmp_path / "trace-001.gz"
    before = written(path, 10)
    with pytest.raises(VbrailleError, match="File exists"):
        TraceWriter(path, lambda: TIE)
    assert path.read_bytes() == before


def test_a_trace_that_is_not_there_is_one_sentence(tmp_path):
    with pytest.raises(VbrailleError, match=r"trace-001\.gz cannot be read: No such file"):
        read_trace(tmp_path / "trace-001.gz")


def test_a_chunk_is_tied_to_the_line_of_the_journal_that_was_on_the_disk(tmp_path):
    path = tmp_path / "trace-001.gz"
    line = [TIE]
    writer = TraceWriter(path, lambda: line[-1])
    writer.add(ticks(0, 1200))
    writer.add(ticks(1200, 1200))
    assert read_last_tie(path) == TIE
    line.append(Tie(9, 10))
    writer.close()
    assert read_trace(path).ties == (TIE, Tie(9, 10))
    assert read_last_tie(path) == Tie(9, 10)
