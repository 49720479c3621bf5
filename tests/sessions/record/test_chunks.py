"""Traces chunk by chunk: what is read is what reading all at once gives."""

import numpy as np
import pytest

from tests.sessions.written import ON_DEVICE, written
from vbraille.errors import VbrailleError
from vbraille.sessions.record.traces import TRACE, ChunkedTrace, read_trace


def all_ticks(trace):
    found = [trace.ticks(n) for n in reversed(range(len(trace)))][::-1]
    return np.concatenate([np.zeros(0, TRACE), *found])


@pytest.mark.parametrize("name", ON_DEVICE)
def test_chunks_have_the_ticks_of_the_trace(name):
    for path in written(name).glob("trace-*.gz"):
        trace = ChunkedTrace(path)
        assert all_ticks(trace).tobytes() == read_trace(path).ticks.tobytes()
        assert trace.damage == []
        assert trace.torn_bytes == 0
        trace.close()


@pytest.mark.parametrize("at", [0.0, 0.3, 0.6, 0.999])
@pytest.mark.parametrize("cut", [True, False])
def test_what_is_whole_is_read_as_salvage_reads_it(tmp_path, at, cut):
    (source,) = written("ended").glob("trace-*.gz")
    content = bytearray(source.read_bytes())
    place = int(at * len(content))
    if cut:
        del content[place:]
    else:
        content[place] ^= 0x10
    path = tmp_path / "trace-001.gz"
    path.write_bytes(content)
    trace, told = ChunkedTrace(path), read_trace(path)
    whole = np.concatenate([told.ticks, *told.later])
    assert all_ticks(trace).tobytes() == whole.tobytes()
    assert trace.torn_bytes == told.torn_bytes
    assert bool(trace.damage) == (told.damage is not None)
    trace.close()


def test_a_trace_that_is_not_there_is_said(tmp_path):
    with pytest.raises(VbrailleError, match="cannot be read: No such file"):
        ChunkedTrace(tmp_path / "trace-001.gz")
