"""The loop on the manual clock: order, deadlines, and that nothing jumps."""

from dataclasses import replace

import numpy as np
import pytest

from tests.shown import rendered
from vbraille.display import Display, Pose
from vbraille.engine.clock import ManualClock
from vbraille.engine.constants import NS_PER_S
from vbraille.engine.loop import Loop
from vbraille.engine.record import Flag, Ring, RingReader
from vbraille.errors import DeviceError
from vbraille.render import MAPPINGS, STRESS2, Tuning
from vbraille.simulation.hand import Hand
from vbraille.simulation.motion import Motion
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.steering import Steering

MS = 1_000_000
SPAN_MM = 10.8


def info(**changes) -> Display:
    fields = {
        "name": "test",
        "rows": 6,
        "columns": 10,
        "column_pitch_mm": 1.2,
        "row_pitch_mm": 1.8,
        "levels": 1024,
        "rest_side": "right",
        "travel_mm": 300.0,
        "counts_per_mm": 200.0,
        "rate_hz": 1000.0,
    }
    return Display(**fields | changes)


class Recording(SimulatedDevice):
    """A simulated device that keeps what it was sent."""

    def __init__(self, clock: ManualClock, hand: Hand | None = None, **changes) -> None:
        super().__init__(info(**changes), clock.now_ns, hand, Steering())
        self.sent: list[np.ndarray] = []
        self.silent = False
        self.shift_mm = 0.0

    def read(self) -> Pose | None:
        sample = super().read()
        assert sample is not None
        return None if self.silent else Pose(sample.time_ns, sample.x_mm + self.shift_mm)

    def _send(self, frame):
        super()._send(frame)
        self.sent.append(frame.copy())


def picture(masks=(63,) * 20, mapping="alternate", **tuning):
    return rendered(
        np.array(masks, np.uint8),
        array=STRESS2.display,
        profile=STRESS2.style.profile,
        mapping=MAPPINGS[mapping],
        geometry=STRESS2.style.geometry,
        tuning=Tuning(**tuning),
    )


def straight(*knots: tuple[float, float]) -> Motion:
    t_s, x_mm = np.array(knots, float).T
    return Motion(t_s, x_mm)


@pytest.fixture
def clock():
    return ManualClock()


@pytest.fixture
def device(clock):
    return Recording(clock)


def run(loop: Loop, seconds: float) -> None:
    for _ in range(round(seconds * loop.rate_hz)):
        loop.tick()


def biggest_step(frames: list[np.ndarray]) -> float:
    return float(np.abs(np.diff(np.array(frames), axis=0)).max())


def test_ticks_stand_on_absolute_deadlines(clock, device):
    loop = Loop(device, clock)
    run(loop, 0.5)
    assert clock.now_ns() == 499 * MS
    assert (loop.tally.ticks, loop.tally.late) == (500, 0)


def test_a_device_that_wants_it_is_asked_ahead_of_each_tick(clock):
    asked = []

    class Asked(Recording):
        ahead_ns = 300_000

        def ask(self):
            asked.append(clock.now_ns())

    device = Asked(clock)
    loop = Loop(device, clock)
    begun_ns = clock.now_ns()
    for _ in range(5):
        loop.tick()
    assert asked[1:] == [begun_ns + n * MS - 300_000 for n in range(1, 5)]
    assert len(device.sent) == 5
    assert loop.late == 0


def test_a_late_tick_is_counted_and_never_chased(clock, device):
    loop = Loop(device, clock)
    run(loop, 0.01)
    assert clock.now_ns() == 9 * MS
    device.read = lambda: clock.advance_ns(int(3.5 * MS))  # a tick that takes 3.5 periods
    loop.tick()
    del device.read
    assert loop.tally.late == 2  # its own end overran the next two deadlines
    loop.tick()
    assert clock.now_ns() == int(13.5 * MS)  # at once, half a period behind
    loop.tick()
    assert clock.now_ns() == 14 * MS  # and on the grid again
    assert loop.tally.late == 2


class Waiting(ManualClock):
    """A clock by which a thread can wait for a processor, or for a line, without being busy."""

    waited_ns = 0

    def wait_ns(self, step_ns):
        self.waited_ns += step_ns
        self.advance_ns(step_ns)

    def busy_ns(self):
        return self.now_ns() - self.waited_ns


@pytest.mark.parametrize("does", ["works", "waits"])
def test_only_a_tick_that_works_for_too_long_is_an_overrun(does):
    clock = Waiting()
    device = Recording(clock)
    loop = Loop(device, clock)
    run(loop, 0.01)
    send = device._send

    def take_long(frame):
        send(frame)
        (clock.advance_ns if does == "works" else clock.wait_ns)(3 * MS)

    device._send = take_long
    run(loop, 0.005)
    assert loop.overruns == (5 if does == "works" else 0)
    assert loop.late == 5 * 2  # late is late, whatever it did


def test_frames_follow_the_hand(clock, device):
    line = picture()
    loop = Loop(device, clock)
    loop.show(line)
    device.move(straight((0, -SPAN_MM), (2, 60)))
    run(loop, 1.0)
    want = np.zeros((6, 10))
    line.frame(device.read().x_mm, want)
    assert np.abs(loop.output).max() > 0.5
    np.testing.assert_array_equal(loop.output, want)


def test_position_is_to_the_encoder_s_count(clock, device):
    device.move(straight((0, 0), (1, 10)))
    loop = Loop(device, clock)
    run(loop, 0.3)
    assert loop.x_mm is not None
    counts = (loop.x_mm + SPAN_MM) * 200
    assert abs(counts - round(counts)) < 1e-6


@pytest.mark.parametrize(
    "mapping", sorted(name for name, each in MAPPINGS.items() if each.rows <= 6)
)
@pytest.mark.parametrize("change", ["start", "line", "tuning", "pause", "jump", "leave"])
def test_nothing_jumps(clock, device, mapping, change):
    device.move(straight((0, 3.0), (20, 3.0)))  # the hand holds still, on a dot
    loop = Loop(device, clock)
    run(loop, 0.1)  # so long it takes to get there
    loop.show(picture(mapping=mapping))
    if change != "start":
        run(loop, 0.3)
        device.sent.clear()
    if change == "line":
        loop.show(picture((1, 2, 4), mapping=mapping))
    elif change == "tuning":
        loop.show(picture(mapping=mapping, texture=1.0, contrast=0.4))
    elif change == "pause":
        loop.paused = True
    elif change == "jump":
        device.shift_mm = 37.3  # the carriage is elsewhere from one tick to the next
    if change == "leave":
        loop.fade_to_rest()
        assert loop.resting
    else:
        run(loop, 0.3)
    step = 1 / 20 if change == "pause" else 1 / 100
    assert len(device.sent) > 20
    assert biggest_step([np.zeros((6, 10)), *device.sent] if change == "start" else device.sent) > 0
    assert biggest_step(device.sent) <= step + 1e-9


def test_a_change_in_the_middle_of_a_fade_does_not_jump(clock, device):
    device.move(straight((0, 3.0), (20, 3.0)))
    loop = Loop(device, clock)
    run(loop, 0.1)
    for n in range(20):
        loop.show(picture((n + 1,) * 5, mapping="sheared", contrast=(n % 5) / 4))
        run(loop, 0.03)
    assert biggest_step(device.sent) <= 1 / 100 + 1e-9


@pytest.mark.parametrize("change", ["start", "pause", "leave"])
def test_a_machine_that_stalls_makes_no_fade_faster(clock, device, change):
    device.move(straight((0, 3.0), (20, 3.0)))
    loop = Loop(device, clock)
    run(loop, 0.1)
    loop.show(picture())
    if change != "start":
        run(loop, 0.3)
    device.sent.clear()
    send = device._send

    def stall(frame):
        send(frame)
        clock.advance_ns(39 * MS * (len(device.sent) % 4 == 1))

    device._send = stall
    if change == "leave":
        loop.fade_to_rest()
        assert loop.resting
    else:
        loop.paused = change == "pause"
        run(loop, 0.3)
        assert loop.resting == loop.paused
    step = 1 / 20 if change == "pause" else 1 / 100
    assert 0 < biggest_step(device.sent) <= step + 1e-9


@pytest.mark.parametrize("gap", ["stopped", "mute", "late", "slow"])
def test_a_hand_that_goes_on_in_a_gap_is_caught_up_with(gap):
    """In a driver that is called, and has no controller behind it."""
    clock = ManualClock()
    device = Recording(clock)
    device.move(straight((0, 3.0), (3.0, 3.0 + 3.0 * 60.0)))
    loop = Loop(device, clock)
    loop.show(picture())
    run(loop, 0.3)
    device.sent.clear()
    run(loop, 0.5)
    asked = biggest_step(device.sent)
    device.sent.clear()
    if gap == "slow":  # a place each 5 ms, of then
        read = device.read
        device.read = lambda: read() if len(device.sent) % 5 == 0 else None
    for gap_ms in (11, 23, 37):
        if gap == "stopped":
            clock.advance_ns(gap_ms * MS)
        elif gap == "mute":
            device.silent = True
            run(loop, gap_ms / 1000)
            device.silent = False
        elif gap == "late":  # each tick has a place, but an old one
            read = device.read
            old = read()
            device.read = lambda old=old: old
            run(loop, gap_ms / 1000)
            device.read = read
        run(loop, 0.2)
    assert asked > 0.02
    assert biggest_step(device.sent) <= 3 * asked + 1e-9
    # All was caught up with: what is felt is what lies there.
    still = biggest_step(device.sent[-50:])
    assert gap == "slow" or still <= asked + 1e-9


@pytest.mark.parametrize("moving", [False, True])
def test_a_gap_is_caught_up_with_only_if_the_hand_moved_in_it(clock, device, moving):
    device.move(straight((0, 3.0), (20, 3.0 + 600.0 * moving)))
    ring = Ring.alone((6, 10), 2000)
    reader = ring.reader()
    loop = Loop(device, clock, ring=ring)
    loop.show(picture())
    run(loop, 0.3)
    reader.drain()
    clock.advance_ns(30 * MS)
    run(loop, 0.1)
    after = reader.drain()[1:]
    assert (after["share"] < 1).any() == moving
    assert (after["flags"] & Flag.CHANGED).any() == moving


@pytest.mark.parametrize("late_us", [20_950, 30_900, 44_700])
def test_a_frame_that_went_out_late_is_left_no_sooner_than_the_hand_asks_for(clock, late_us):
    """A write that takes long ends just before the next tick: actuators have only just moved."""
    out, slow = [], []

    class Late(Recording):
        def _send(self, frame):
            if len(out) == 300:
                clock.advance_ns(late_us * 1000)
            out.append(clock.now_ns())
            slow.append(frame.copy())

    device, speed_mm_s = Late(clock, counts_per_mm=20_000.0), 15.0
    line = picture(mapping="sheared")
    device.move(straight((0, -5.0), (10, -5.0 + 10 * speed_mm_s)))
    loop = Loop(device, clock)
    loop.show(line)
    run(loop, 0.6)
    x_mm = np.arange(-8.0, 40.0, 0.005)
    steepest = np.abs(np.diff(line.path(x_mm), axis=0)).max() / 0.005
    steps = np.abs(np.diff(slow[150:], axis=0)).max(axis=(1, 2))
    passed_s = np.diff(out[150:]) / NS_PER_S
    asked = steepest * (speed_mm_s * passed_s + 2 / 20_000)  # a count more or less at either end
    assert steps.max() > 0
    assert (steps <= 3 * asked).all()


@pytest.mark.parametrize("late_ms", [11, 39])
def test_a_fade_goes_on_as_it_was_over_a_gap_in_which_the_hand_stands_still(clock, device, late_ms):
    device.move(straight((0, 3.0), (20, 3.0)))
    ring = Ring.alone((6, 10), 2000)
    reader = ring.reader()
    loop = Loop(device, clock, ring=ring)
    run(loop, 0.1)
    loop.show(picture())
    run(loop, 0.05)
    clock.advance_ns(late_ms * MS)
    run(loop, 0.1)
    assert biggest_step(device.sent) <= 1 / 100 + 1e-9
    steps = np.diff(reader.drain()["share"][101:])
    assert steps.min() >= 0
    assert steps.max() <= 1 / 100 + 1e-9


def test_while_frames_are_not_taken_the_array_rests_and_fades_in_then(clock, device):
    device.move(straight((0, 3.0), (20, 3.0)))
    ring = Ring.alone((6, 10), 2000)
    reader = ring.reader()
    loop = Loop(device, clock, ring=ring)
    loop.show(picture())
    run(loop, 0.3)
    device.taking = False
    run(loop, 0.2)
    assert loop.resting
    device.sent.clear()
    device.taking = True
    run(loop, 0.2)
    assert not loop.resting
    assert biggest_step([np.zeros((6, 10)), *device.sent]) <= 1 / 100 + 1e-9
    ticks = reader.drain()
    resting = (ticks["flags"] & Flag.RESTING) > 0
    assert resting[301:499].all()
    assert not ticks["frame"][301:499].any()
    assert not resting[501:].any()


@pytest.mark.no_cover
def test_rest_after_stillness_and_back_with_motion(clock, device):
    device.move(straight((0, 3.0), (6, 3.0), (7, 8.0), (20, 8.0)))
    loop = Loop(device, clock)
    loop.show(picture(mapping="sheared"))
    run(loop, 4.9)
    assert not loop.resting
    run(loop, 0.3)
    assert loop.resting
    run(loop, 1.0)
    assert not loop.resting
    run(loop, 6.0)
    assert loop.resting
    assert biggest_step(device.sent) < 0.2


def test_a_pause_rests_whatever_the_hand_does(clock, device):
    device.move(straight((0, 0.0), (5, 100.0)))
    loop = Loop(device, clock)
    loop.show(picture(mapping="sheared"))
    run(loop, 0.5)
    loop.paused = True
    run(loop, 0.022)
    assert loop.resting
    run(loop, 0.5)
    assert loop.resting
    loop.paused = False
    run(loop, 0.2)
    assert not loop.resting


def test_silence_of_the_device_rests_the_array(clock, device):
    device.move(straight((0, 3.0), (20, 3.0)))
    loop = Loop(device, clock)
    loop.show(picture())
    run(loop, 0.5)
    assert not loop.resting
    device.silent = True
    run(loop, 0.25)
    assert loop.resting
    device.silent = False
    run(loop, 0.25)
    assert not loop.resting


def test_speed_and_scanning_speed(clock, device):
    device.move(straight((0, -10.0), (2, 90.0), (3, 90.0), (4, -10.0)))
    loop = Loop(device, clock)
    run(loop, 1.0)
    assert loop.state.now["vx_mm_s"] == pytest.approx(50, rel=0.01)
    run(loop, 2.5)
    assert loop.state.now["vx_mm_s"] == pytest.approx(-100, rel=0.01)
    assert loop.tally.scanning_mm_s == pytest.approx(50, rel=0.02)


def test_a_machine_that_stalls_makes_no_hand_faster(clock, device):
    device.move(straight((0, -SPAN_MM), (4, 200 - SPAN_MM)))
    loop = Loop(device, clock)
    fastest = 0.0
    for tick in range(1500):
        if tick % 100 == 50:
            clock.advance_ns(60 * MS)
        loop.tick()
        fastest = max(fastest, loop.state.now["vx_mm_s"])
    assert fastest == pytest.approx(50, rel=0.02)
    assert loop.tally.late > 500


@pytest.mark.parametrize("field", ["x_mm", "y_mm", "theta_rad"])
@pytest.mark.parametrize("value", [float("nan"), float("inf"), float("-inf")])
@pytest.mark.parametrize("free", [{}, {"height_mm": 200.0, "turns": True}])
def test_a_pose_that_is_no_number_is_a_fault(clock, field, value, free):
    device = Recording(clock, **free)
    device.read = lambda: Pose(0, 1.0)._replace(**{field: value})
    with pytest.raises(DeviceError, match=f"{value}.* cannot be"):
        Loop(device, clock).tick()


def test_a_pose_of_two_axes_is_motion_and_is_recorded(clock):
    device = Recording(clock, height_mm=200.0, turns=True)
    memory = memoryview(bytearray(Ring.bytes_needed((6, 10), 9000)))
    ring, reader = Ring(memory, (6, 10), 9000), RingReader(memory, (6, 10), 9000)
    loop = Loop(device, clock, ring=ring)
    loop.show(picture(mapping="sheared"))
    device.read = lambda: None
    run(loop, 0.05)
    # Along y alone, to the reader, at 20 mm/s.
    device.read = lambda: Pose(clock.now_ns(), 3.0, clock.now_ns() / NS_PER_S * 20, 0.3)
    run(loop, 8.0)
    assert not loop.resting  # a hand that stands still rests after 5 s
    ring.publish()
    ticks = reader.drain()
    for name in ("x_mm", "y_mm", "theta_rad"):
        assert np.isnan(ticks[name][:50]).all()
    ticks = ticks[50:]
    np.testing.assert_array_equal(ticks["y_mm"], ticks["device_ns"] / NS_PER_S * 20)
    assert set(zip(ticks["x_mm"].tolist(), ticks["theta_rad"].tolist(), strict=True)) == {(3, 0.3)}
    assert not ticks["vx_mm_s"].any()
    assert ticks["vy_mm_s"][100:] == pytest.approx(20)
    assert not ticks["forward_mm"].any()  # way to the right


@pytest.mark.parametrize("rate", [0, -1, 20_000, float("nan")])
def test_rate_has_bounds(clock, device, rate):
    with pytest.raises(ValueError, match="1 to 10000"):
        Loop(device, clock, rate_hz=rate)


@pytest.mark.parametrize(
    ("x_mm", "to_do"),
    [
        (-64654392.32, "switch it off .* look at its encoder"),
        (float("nan"), "its driver must give numbers"),
        (float("inf"), "its driver must give numbers"),
    ],
)
def test_a_carriage_that_cannot_be_there_is_told_with_what_to_do(clock, device, x_mm, to_do):
    device.shift_mm = x_mm
    with pytest.raises(DeviceError, match=f"where it cannot be; {to_do}") as told:
        run(Loop(device, clock), 0.01)
    assert "INFO" not in str(told.value)  # which few devices have


class Turned(SimulatedDevice):
    def read(self):
        return super().read()._replace(theta_rad=0.3)


def test_an_angle_ends_the_reading_where_the_display_says_that_none_is_measured(clock):
    turns = replace(info(), turns=True)
    run(Loop(Turned(turns, clock.now_ns), clock), 0.01)
    with pytest.raises(DeviceError, match=r"turned by 0.3 rad, .* must give Display turns=True"):
        run(Loop(Turned(info(), clock.now_ns), clock), 0.01)
