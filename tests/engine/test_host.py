"""The host process: a device of C read through it, its end, and what goes wrong."""

import os
import signal
import time
from collections.abc import Callable

import numpy as np
import pytest

from tests.engine.pretend import pretend, traced
from vbraille.devices.events import AtStart, HandDone, LineRead
from vbraille.engine.host import Host, HostDiedError
from vbraille.engine.record import Flag
from vbraille.errors import InputError
from vbraille.render import MODELS
from vbraille.simulation.steering import GlideTo, Hold, LetGo, ReadLine

MODEL = MODELS["stress2"]
MASKS = np.array([1, 3, 9, 25, 17, 11, 27, 19, 10, 26], np.uint8)


def line_for(display, masks=MASKS):
    return MODEL.style.render(masks, display), MODEL.style.geometry.extent_mm(len(masks))


def polled(host, seconds, until: Callable[[list], bool] = lambda _: False):
    """Ticks and events of some time."""
    ticks, events = [host.poll()], []
    end_s = time.monotonic() + seconds
    while time.monotonic() < end_s and not until(events):
        time.sleep(0.01)
        ticks.append(host.poll())
        events += host.take_events()
    return np.concatenate(ticks), events


def has(kind):
    return lambda events: any(isinstance(event, kind) for event in events)


@pytest.fixture(scope="module")
def host():
    with Host("sim", MODEL.display, hand="sweep:200") as host:
        yield host


def test_a_line_is_read_to_its_end(host):
    picture, end_mm = line_for(host.display)
    host.show(picture, 1, end_mm)
    host.give(ReadLine(end_mm))
    ticks, events = polled(host, 8, lambda events: has(LineRead)(events) and has(HandDone)(events))
    assert has(LineRead)(events)
    assert has(HandDone)(events)
    assert has(AtStart)(events)
    assert host.ready
    shown = ticks[(ticks["line"] == 1) & (ticks["share"] == 1) & (ticks["flags"] == 0)]
    wanted = picture.path(shown["x_mm"])
    assert np.abs(shown["frame"] - wanted).max() < 1e-6
    assert wanted.max() > 0.9


def test_pausing_rests_and_a_second_reader_sees_the_same(host):
    picture, _ = line_for(host.display)
    reader = host.reader()
    host.show(picture, 2)
    host.give(GlideTo(30.0, 0.0, 1000.0))
    polled(host, 0.6)
    host.paused = True
    ticks, _ = polled(host, 0.3)
    assert ticks[-1]["flags"] & int(Flag.PAUSED)
    assert not ticks[-1]["frame"].any()
    host.paused = False
    polled(host, 0.2)
    assert reader.drain()["tick"][-1] >= ticks["tick"][-1]


def test_a_person_may_hold_the_hand(host):
    host.give(Hold(50.0))
    polled(host, 0.3)
    assert host.x_mm == pytest.approx(50.0, abs=0.01)
    host.give(LetGo())
    polled(host, 0.05)


def test_a_large_picture_needs_no_room_of_its_own(host):
    picture, _ = line_for(host.display, np.full(1000, 63, np.uint8))
    host.show(picture, 3)
    ticks, _ = polled(host, 0.3)
    assert ticks["line"][-1] == 3


def test_a_host_that_was_killed_is_told_and_begins_again():
    with Host("sim", MODEL.display, hand="still") as host:
        picture, _ = line_for(host.display)
        host.show(picture, 7)
        host.give(GlideTo(20.0, 0.0, 1000.0))
        polled(host, 0.3)
        os.kill(host._process.pid, signal.SIGKILL)
        with pytest.raises(HostDiedError):
            polled(host, 3)
        host.start()
        ticks, _ = polled(host, 0.5)
        assert ticks["line"][-1] == 7
        assert host.x_mm == pytest.approx(20.0, abs=0.01)


@pytest.mark.parametrize("spec", ["nothing:x", "serial:/dev/no-such-port", "sim:?hand=flying"])
def test_what_is_not_there_is_one_sentence(spec):
    with pytest.raises(InputError) as caught, Host(spec, MODEL.display):
        pass
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM])
def test_a_device_of_c_is_read_and_rests_within_71_ms_of_any_end(tmp_path, how):
    with (
        pretend(tmp_path, "-DVB_TOP=1023", "-DVB_FAST=700") as (spec, trace),
        Host(spec, MODEL.display, fits=False) as host,
    ):
        display = host.display
        assert (display.levels, display.shape) == (1024, (6, 10))
        masks = np.full(40, 63, np.uint8)
        picture, _ = line_for(display, masks)
        host.show(picture, 1)
        ticks, _ = polled(host, 1.5)
        assert np.nanmax(ticks["x_mm"]) - np.nanmin(ticks["x_mm"]) > 10
        at = len(traced(trace))
        os.kill(host._process.pid, how)
        with pytest.raises(HostDiedError):
            polled(host, 8)
        time.sleep(0.2)
        rows = traced(trace)
    assert max(row[1] for row in rows[:at]) > 900
    last = max(n for n, row in enumerate(rows) if n == 0 or row[2] != rows[n - 1][2])
    resting = next(n for n in range(last, len(rows)) if rows[n][1] == 0)
    assert (rows[resting][0] - rows[last][0]) / 1000 <= 71
    assert not any(row[1] for row in rows[resting:])


def test_a_host_that_is_stopped_jumps_nowhere(tmp_path):
    with pretend(tmp_path) as (spec, _), Host(spec, MODEL.display, fits=False) as host:
        picture, _ = line_for(host.display, np.full(40, 63, np.uint8))
        host.show(picture, 1)
        polled(host, 1)
        for gap_s in (0.02, 0.2):
            os.kill(host._process.pid, signal.SIGSTOP)
            time.sleep(gap_s)
            os.kill(host._process.pid, signal.SIGCONT)
            polled(host, 0.5)
        ticks, _ = polled(host, 0.3)
        assert ticks["frame"].any()
        assert ticks["flags"][-1] & int(Flag.HELD) == 0
