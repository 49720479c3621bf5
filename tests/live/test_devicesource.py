"""The device as a source: frames are the ring's bit for bit, and what is hidden is not shown."""

import json
import math
import os

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.live.canned import canned_state
from tests.live.pages import read_frame
from tests.live.rings import EXTENT, PERIOD_NS, TestRing, frame_of
from tests.tiers import examples
from vbraille.engine.mailbox import Extent
from vbraille.engine.record import FLOATS, INTS, tick_dtype
from vbraille.errors import InputError
from vbraille.live.devicesource import _NUMBERS, DeviceSource, TickViews
from vbraille.live.messages import (
    MOST_SAMPLES,
    LetGo,
    Map,
    Next,
    PagePress,
    Point,
    SignalShown,
    Turn,
)
from vbraille.render import STRESS2
from vbraille.render.program import vibration
from vbraille.simulation.steering import BeAt, Pointer


@pytest.fixture
def ring():
    return TestRing()


@pytest.fixture
def source(ring):
    watching = DeviceSource(lambda _request: None)
    watching.watch(ring.views())
    return watching


def frame(viewer, **request):
    given = viewer.frame(Next(**request))
    return None if given is None else read_frame(given)


def test_a_record_begins_with_the_numbers_that_are_taken_at_once():
    dtype = tick_dtype((2, 3))
    assert dtype.fields is not None
    offsets = [dtype.fields[name][1] for name in (*INTS, *FLOATS, "frame")]
    assert offsets == [*range(0, 8 * len(INTS + FLOATS), 8), _NUMBERS.size]


def test_a_frame_is_the_newest_record_bit_for_bit(ring, source):
    viewer = source.viewer()
    ring.append(41)
    read = frame(viewer)
    n = 40
    np.testing.assert_array_equal(read.deflections, frame_of(n, (2, 3)))
    header = read.header
    assert (header["tick"], header["line"], header["part"]) == (n, n // 5, n // 9)
    assert (header["flags"], header["late"]) == (n % 99, n // 7)
    assert header["time_s"] == n * PERIOD_NS / 1e9
    assert [header[name] for name in ("x_mm", "y_mm", "theta_rad")] == [n / 8, n / 16, n / 32]
    assert (header["vx_mm_s"], header["share"]) == (-n / 4, 0.5)
    assert header["lateness_us"] == np.float32((2000 + n) / 1e3)
    assert header["work_us"] == np.float32((3000 + n) / 1e3)
    assert header["age_ms"] > 0


def test_a_frame_has_the_values_of_the_signals_that_its_state_names(ring, source):
    viewer = source.viewer()
    ring.append(41)
    assert frame(viewer).signals.size == 0
    signals = [SignalShown("slow", ""), SignalShown("view", "")]
    source.show(canned_state(2, signals=signals))
    ring.append(1)
    np.testing.assert_array_equal(frame(viewer).signals, np.float32([41 / 128, 41 / 256]))
    source.show(canned_state(3, signals=signals, blind=True))
    ring.append(1)
    assert frame(viewer).signals.size == 0  # which would tell what is felt


def test_the_samples_are_the_ticks_since_the_frame_before(ring, source):
    viewer = source.viewer()
    ring.append(20)
    frame(viewer)
    ring.append(16)
    read = frame(viewer, row=1, column=2)
    ticks = np.arange(20, 36)
    np.testing.assert_array_equal(read.samples[:, 0], np.float32((35 - ticks) * 1e-3))
    np.testing.assert_array_equal(read.samples[:, 1], np.float32(ticks / 8))
    np.testing.assert_array_equal(read.samples[:, 2], [frame_of(n, (2, 3))[1, 2] for n in ticks])


@pytest.mark.parametrize("place", [(2, 0), (0, 3), (-1, 0), (0, -1), (1 << 40, 0)])
def test_an_actuator_that_there_is_not_has_no_deflection(ring, source, place):
    ring.append(3)
    read = frame(source.viewer(), row=place[0], column=place[1])
    assert np.isnan(read.samples[:, 2]).all()
    assert not np.isnan(read.samples[:, :2]).any()


@examples(60)
@given(st.lists(st.integers(0, 1200), max_size=6), st.integers(0, 1))
def test_pages_see_every_tick_once_thinned_out_over_any_pauses(pauses, row):
    ring = TestRing()
    source = DeviceSource(lambda _request: None)
    source.watch(ring.views())
    viewer, seen = source.viewer(), 1
    ring.append()
    frame(viewer)
    for pause in pauses:
        ring.append(pause)
        read = frame(viewer, row=row)
        if not pause:
            assert read is None
            continue
        last = seen + pause - 1
        # What was overwritten meanwhile is gone, and the oldest may be in the writing.
        whole = min(pause, EXTENT.ticks)
        assert read.header["tick"] == last
        places = np.rint(read.samples[:, 1] * 8).astype(int)
        assert places[-1] == last
        assert (np.diff(places) >= 1).all()
        assert seen <= places[0]
        assert min(whole, MOST_SAMPLES) - 1 <= len(places) <= MOST_SAMPLES
        assert places[0] <= last - whole + 1 + whole // MOST_SAMPLES + 1
        want = [frame_of(n, (2, 3))[row, 0] for n in places]
        np.testing.assert_array_equal(read.samples[:, 2], want)
        seen += pause


def test_pages_have_cursors_of_their_own(ring, source):
    one, other = source.viewer(), source.viewer()
    ring.append(10)
    assert len(frame(one).samples) == len(frame(other).samples) == 1  # from the newest on
    ring.append(5)
    assert len(frame(one).samples) == 5
    ring.append(5)
    assert len(frame(one).samples) == 5
    assert len(frame(other).samples) == 10


def test_nothing_new_is_no_frame_and_the_old_one_if_there_must_be_one(ring, source):
    viewer = source.viewer()
    ring.append(3)
    frame(viewer)
    assert frame(viewer) is None
    again = read_frame(viewer.frame(Next(), again=True))
    assert again.header["tick"] == 2
    assert len(again.samples) == 0
    np.testing.assert_array_equal(again.deflections, frame_of(2, (2, 3)))


@pytest.mark.parametrize("shares", [False, True], ids=["no host", "no tick"])
def test_before_the_first_tick_there_is_a_frame_of_nothing(ring, shares):
    source = DeviceSource(lambda _request: None)
    if shares:
        source.watch(ring.views())
    viewer = source.viewer()
    assert frame(viewer) is None
    nothing = read_frame(viewer.frame(Next(), again=True))
    assert (nothing.header["rows"], nothing.header["columns"]) == (0, 0)
    assert math.isnan(nothing.header["x_mm"])


def test_a_host_that_was_started_again_is_watched_in_its_new_memory(ring, source):
    viewer = source.viewer()
    ring.append(400)
    frame(viewer)
    after = TestRing(Extent(1, 4, 100, 300))
    source.watch(after.views())
    assert frame(viewer) is None
    after.append(2)
    read = frame(viewer)
    assert (read.header["tick"], read.deflections.shape) == (1, (1, 4))
    ring.append(5)  # no page looks there any more
    assert frame(viewer) is None
    after.append(3)
    assert len(frame(viewer).samples) == 3


def test_the_memory_cannot_be_written(ring):
    views = ring.views()
    with pytest.raises((ValueError, TypeError), match="read-only"):
        views.mailbox.stop()
    with pytest.raises(ValueError, match="read-only"):
        views._x_mm[0] = 1.0


def test_memory_that_is_too_small_is_not_looked_at():
    descriptor = os.memfd_create("small")
    try:
        with pytest.raises(ValueError, match=f"0 of {EXTENT.total_bytes} bytes"):
            TickViews(descriptor, EXTENT)
    finally:
        os.close(descriptor)


def test_frames_belong_to_the_newest_state(ring, source):
    viewer = source.viewer()
    source.show(canned_state(7))
    ring.append(1)
    assert frame(viewer).header["state"] == 7
    number, state = viewer.state(Next())
    assert (number, json.loads(state)["title"]) == (7, "a canned text")


@pytest.mark.parametrize(
    ("blind", "states"), [(True, (False,)), (False, (True, False))], ids=["monitor", "state"]
)
def test_blind_hides_whatever_an_answer_could_be_read_from_for_good(blind, states):
    source = DeviceSource(lambda _request: None, blind=blind)
    ring = TestRing()
    source.watch(ring.views())
    viewer = source.viewer()
    ring.append(1)
    for number, says_blind in enumerate(states, 1):
        source.show(canned_state(number, blind=says_blind))
        ring.append(10)
        read = frame(viewer, row=1, column=1)
        assert read.deflections.size == 0
        assert (read.header["rows"], read.header["columns"]) == (0, 0)
        assert np.isnan(read.samples[:, 2]).all()
        assert len(read.samples) == (10 if number > 1 else 1)
        told = msgspec.json.decode(source.told[1])
        assert (told["lines"], told["rows_shown"], told["blind"]) == ([], [], True)
        assert told["title"] == "a canned text"
        with pytest.raises(InputError, match="stimuli are hidden"):
            source.map(Map())
        assert read_frame(viewer.frame(Next(), again=True)).deflections.size == 0


def test_there_is_no_map_of_nothing(source):
    with pytest.raises(InputError, match="nothing is under the hand yet"):
        source.map(Map())
    with pytest.raises(InputError, match="nothing is under the hand yet"):
        DeviceSource(lambda _request: None).map(Map())


def test_the_hand_is_held_and_let_go():
    pointer = Pointer()
    source = DeviceSource(lambda _request: None, pointer)
    source.ask(Point(3.0, 1.0, 0.5))
    assert Pointer(pointer.descriptor).at() == BeAt(3.0, 1.0, 0.5)
    source.ask(LetGo())
    assert Pointer(pointer.descriptor).at() is None
    with pytest.raises(InputError, match="must be numbers"):
        source.ask(Point(math.inf))


def test_a_device_with_a_real_hand_cannot_be_pointed(source):
    for request in (Point(1.0), LetGo()):
        with pytest.raises(InputError, match="a real hand moves this device"):
            source.ask(request)


def test_commands_and_knobs_go_to_whoever_reads():
    heard = []
    source = DeviceSource(heard.append)
    asked = [PagePress("next line"), Turn("contrast", 0.5)]
    for request in asked:
        source.ask(request)
    assert heard == asked


def test_the_map_is_of_what_is_under_the_hand(ring, source):
    pytest.importorskip("vbraille.live.maps")
    model = STRESS2.on(STRESS2.style.geometry)
    ring.mailbox.post(STRESS2.style.render(np.arange(20, dtype=np.uint8) + 30, model), 1)
    assert source.map(Map("png")).startswith(b"\x89PNG")
    assert b"<svg" in source.map(Map("svg"))
    ring.mailbox.post(vibration(model), 2)
    with pytest.raises(InputError, match="there is no map"):
        source.map(Map())
