"""Frames made again from a trace."""

import numpy as np
import pytest
from vbraille.render.renderer import Renderer

from tests.engine.test_batch import device
from vbraille.engine.clock import ManualClock
from vbraille.engine.local import LocalEngine
from vbraille.engine.ring import Flag
from vbraille.render import STRESS2
from vbraille.sessions.record.replay import Replay
from vbraille.sessions.record.traces import TRACE, TraceWriter, read_trace


class Full:
    """A picture of actuators all the way up."""

    def frame(self, _x_mm, out):
        out.fill(1.0)


def test_what_a_device_that_rested_by_itself_was_sent_did_nothing():
    ticks = np.zeros(6, TRACE)
    ticks["tick"] = np.arange(6)
    ticks["line"], ticks["share"] = 1, 1.0
    ticks["flags"][2:4] = int(Flag.HELD)
    ticks["flags"][4] = int(Flag.CHANGED | Flag.RESTING)
    ticks["share"][4:] = 0.0, 0.5
    ticks["flags"][5] = int(Flag.RESTING)
    frames = Replay(lambda _: Full(), (1, 2)).frames(ticks)
    # The fade to rest at the end goes on from what was written last, as the loop's does.
    assert frames[:, 0, 0].tolist() == [1.0, 1.0, 0.0, 0.0, 1.0, 0.5]


@pytest.mark.parametrize("centred", [True, False])
def test_what_an_engine_did_is_replayed_bit_for_bit_in_every_format(tmp_path, centred):
    half_mm = STRESS2.array.span_mm / 2

    def picture(**anchor):
        return Renderer(
            np.array([63, 21, 42], np.uint8),
            array=STRESS2.array,
            profile=STRESS2.profile,
            mapping=STRESS2.mapping,
            geometry=STRESS2.geometry,
            tuning=STRESS2.tuning,
            **anchor,
        )

    clock = ManualClock()
    engine = LocalEngine(device(STRESS2, "fluent", clock.now_ns), clock, poll_ticks=3000)
    engine.show(picture(), 1, 30.0)
    ticks = engine.poll()
    writer = TraceWriter(tmp_path / "trace", None, None if centred else half_mm)
    writer.add(ticks)
    writer.close()
    again = picture() if centred else picture(anchor_mm=0.0)
    kept = read_trace(tmp_path / "trace").ticks
    frames = Replay(lambda _: again, STRESS2.array.shape).frames(kept)
    assert frames.max() > 0.5
    assert (frames.astype(np.float32) == ticks["frame"]).all()
