"""Frames made again from a trace."""

import numpy as np

from tests.engine.test_batch import device
from tests.shown import array_of, full
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.record import Flag
from vbraille.render import STRESS2
from vbraille.sessions.record.journal import Tie
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.record.traces import TRACE, TraceWriter, read_trace
from vbraille.simulation.steering import ReadLine


def test_what_a_device_that_rested_by_itself_was_sent_did_nothing():
    display = array_of(1, 2, 1.0, 1.0)
    ticks = np.zeros(6, TRACE)
    ticks["tick"] = np.arange(6)
    ticks["line"], ticks["share"] = 1, 1.0
    ticks["flags"][2:4] = int(Flag.HELD)
    ticks["flags"][4] = int(Flag.CHANGED | Flag.RESTING)
    ticks["share"][4:] = 0.0, 0.5
    ticks["flags"][5] = int(Flag.RESTING)
    frames = Replay(lambda _: full(display), display).frames(ticks)
    # The fade to rest at the end goes on from what was written last, as the loop's does.
    assert frames[:, 0, 0].tolist() == [1.0, 1.0, 0.0, 0.0, 1.0, 0.5]


def test_what_an_engine_did_is_replayed_bit_for_bit(tmp_path):
    display = STRESS2.display
    picture = STRESS2.style.render(np.array([63, 21, 42], np.uint8), display)
    clock = ManualClock()
    engine = LocalEngine(device(STRESS2, "fluent", clock.now_ns), clock, poll_ticks=3000)
    engine.show(picture, 1)
    engine.device.steering.give(ReadLine(30.0))
    ticks = engine.poll()
    writer = TraceWriter(tmp_path / "trace", lambda: Tie(0, 0))
    writer.add(ticks)
    writer.close()
    kept = read_trace(tmp_path / "trace").ticks
    frames = Replay(lambda _: picture, display).frames(kept)
    assert frames.max() > 0.5
    assert (frames.astype(np.float32) == ticks["frame"]).all()
