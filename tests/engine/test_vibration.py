"""Pictures that move by themselves: their time, their rest, and how long they may."""

import numpy as np
import pytest

from tests.engine.planar import MS, PLANE, STYLE, Bench, still
from vbraille.devices.events import Exposed
from vbraille.engine.record import Flag
from vbraille.render.program import vibration

FADE_S = 0.1


def frame_at(program, time_s):
    out = np.zeros(program.shape)
    program.frame(0.0, out, time_s=time_s)
    return out


def has(ticks, flag):
    return (ticks["flags"] & flag) != 0


def test_its_time_begins_with_it_and_goes_with_the_ticks():
    bench = Bench(still())
    bench.run(0.25)
    program = vibration(PLANE, 13.0, 0.7)
    bench.engine.show(program, 4)
    ticks = bench.run(0.5)
    np.testing.assert_allclose(ticks["shown_s"], np.arange(500) / 1000, rtol=0, atol=1e-12)
    for tick, sent in zip(ticks[150:], bench.sent[400:], strict=True):
        np.testing.assert_array_equal(sent, frame_at(program, float(tick["shown_s"])))


@pytest.mark.parametrize("frequency_hz", [50.0, 13.0])
def test_a_loop_that_is_held_up_makes_no_vibration_jump(frequency_hz):
    bench = Bench(still())
    bench.engine.show(vibration(PLANE, frequency_hz), 1)
    for stall_ms in (39, 0, 7, 250, 1, 0, 3):
        bench.run(0.05)
        bench.clock.advance_ns(stall_ms * MS)
    bench.run(0.2)
    # Its own motion, and the fade with which it began.
    own = np.pi * frequency_hz / 1000
    assert np.abs(np.diff(bench.sent, axis=0)).max() <= own + 1 / (FADE_S * 1000) + 1e-9
    assert np.diff(bench.records["shown_s"]).max() <= 1e-3 + 1e-12
    assert bench.records["shown_s"][-1] == pytest.approx(0.549, abs=0.01)


def test_it_does_not_rest_under_a_hand_that_holds_still():
    bench = Bench(still(), rate_hz=200)
    bench.engine.show(vibration(PLANE, 10.0), 1)
    assert not has(bench.run(12.0), Flag.RESTING)[1:].any()
    bench.engine.show(STYLE.render(np.full(5, 63, np.uint8), PLANE), 2)
    assert has(bench.run(0.5), Flag.RESTING).all()  # for a line the hand has been still too long


def test_a_pause_silence_and_a_device_at_rest_stop_it():
    bench = Bench(still())
    bench.engine.show(vibration(PLANE, 10.0), 1)
    bench.run(0.3)
    bench.engine.paused = True
    bench.run(0.05)
    assert not bench.sent[-1].any()
    bench.engine.paused = False
    bench.run(0.2)
    assert bench.sent[-1].any()
    bench.device.taking = False
    assert not bench.run(0.1)["frame"].any()
    bench.device.taking = True
    bench.run(0.2)
    assert bench.sent[-1].any()
    bench.device.place = lambda _s: None
    ticks = bench.run(0.5)
    assert has(ticks, Flag.SILENT)[-1]
    assert not ticks["frame"][-1].any()


def test_after_so_long_it_fades_and_says_so():
    bench = Bench(still(), rate_hz=1000)
    bench.engine.show(vibration(PLANE, 40.0, exposure_s=0.5), 1)
    assert bench.engine.take_events() == []
    ticks = bench.run(1.0)
    assert bench.engine.take_events() == [Exposed(0.5)]
    assert bench.engine.take_events() == []
    exposed = has(ticks, Flag.EXPOSED)
    (first,) = np.flatnonzero(np.diff(exposed)) + 1
    assert first == 500
    assert has(ticks, Flag.RESTING)[first:].all()
    assert ticks["frame"][first + 1].any()  # it fades
    assert not ticks["frame"][first + 101 :].any()
    own = np.pi * 40.0 / 1000
    assert np.abs(np.diff(bench.sent, axis=0)).max() <= own + 1 / (FADE_S * 1000) + 1e-9


@pytest.mark.parametrize("how", ["pause", "the same picture again", "another picture"])
def test_a_pause_or_a_new_picture_begins_anew(how):
    bench = Bench(still())
    program = vibration(PLANE, 40.0, exposure_s=0.3)
    bench.engine.show(program, 1)
    assert has(bench.run(0.5), Flag.EXPOSED)[-1]
    assert len(bench.engine.take_events()) == 1
    if how == "pause":
        bench.engine.paused = True
        bench.run(0.05)
        bench.engine.paused = False
    elif how == "the same picture again":
        bench.engine.show(program, 2)
    else:
        bench.engine.show(vibration(PLANE, 40.0, exposure_s=0.4), 2)
    ticks = bench.run(0.29)
    assert not has(ticks, Flag.EXPOSED | Flag.RESTING).any()
    assert ticks["shown_s"][0] == 0.0
    assert ticks["frame"][-1].any()
    assert has(bench.run(0.3), Flag.EXPOSED)[-1]
    assert len(bench.engine.take_events()) == 1


def test_time_at_rest_is_no_exposure():
    bench = Bench(still())
    bench.engine.show(vibration(PLANE, 40.0, exposure_s=0.5), 1)
    bench.run(0.3)
    bench.device.place = lambda _s: None
    resting = has(bench.run(1.0), Flag.RESTING)
    shown = 0.3 + np.count_nonzero(~resting) / 1000
    bench.device.place = still()
    ticks = bench.run(0.5)
    (first,) = np.flatnonzero(np.diff(has(ticks, Flag.EXPOSED))) + 1
    assert shown + first / 1000 == pytest.approx(0.5, abs=0.003)


def test_what_was_read_before_is_no_exposure():
    bench = Bench(lambda s: (3.0 + 10 * s, 7.0, 0.0))
    bench.engine.show(STYLE.render(np.full(30, 63, np.uint8), PLANE), 1)
    bench.run(0.8)
    bench.engine.show(vibration(PLANE, 40.0, exposure_s=0.5), 2)
    ticks = bench.run(0.49)
    assert not has(ticks, Flag.EXPOSED | Flag.RESTING).any()
    assert has(bench.run(0.1), Flag.EXPOSED)[-1]
