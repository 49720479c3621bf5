"""Frames made again from a trace."""

import numpy as np

from tests.shown import array_of, full
from vbraille.engine.record import Flag
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.record.traces import TRACE


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
