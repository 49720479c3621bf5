"""Ticks by the block are the loop's: whatever is done, at whatever tick, in blocks of any size."""

import time
from dataclasses import replace

import numpy as np
import pytest

from tests.engine.test_loop import straight
from tests.shown import rendered
from vbraille.display import Display
from vbraille.engine.batch import BatchEngine
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.record import Flag, tick_dtype
from vbraille.errors import DeviceError, InputError
from vbraille.render import MAPPINGS, STRESS2, VBD, Tuning
from vbraille.simulation.simulated import SimulatedDevice
from vbraille.simulation.specs import parse_hand
from vbraille.simulation.steering import ReadLine, Steering

# Some of its rows are idle at 1.
SHEARED = replace(STRESS2, style=replace(STRESS2.style, mapping=MAPPINGS["sheared"]))
LINE_MM = 12.0


def device(model, hand, now_ns=time.monotonic_ns):
    array = model.display
    info = Display(
        name="test",
        rows=array.rows,
        columns=array.columns,
        column_pitch_mm=array.column_pitch_mm,
        row_pitch_mm=1.8,
        levels=1024,
        rest_side=model.display.rest_side,
        travel_mm=300.0,
        counts_per_mm=200.0,
        rate_hz=1000.0,
    )
    return SimulatedDevice(info, now_ns, hand if hand is None else parse_hand(hand, 7), Steering())


def picture(model, masks, tuning):
    return rendered(
        np.array(masks, np.uint8),
        array=model.display,
        profile=model.style.profile,
        mapping=model.style.mapping,
        geometry=model.style.geometry,
        tuning=tuning,
    )


def batch(model=STRESS2, hand="sweep:60", **how):
    return BatchEngine(device(model, hand), **how)


def full(model=STRESS2, **tuning):
    return picture(model, [63] * 8, Tuning(**tuning))


def run(engine, script, ticks):
    """Do what a script says before some ticks; the records of so many ticks or a few more."""
    script, blocks, done = list(script), [], 0
    while done < ticks:
        while script and script[0][0] <= done:
            _, act = script.pop(0)
            act(engine)
        blocks.append(engine.poll())
        done += blocks[-1].size
    return np.concatenate(blocks)


def moved_by(engine):
    return engine.device


def show(shown, line, *, anew=True):
    """Show a picture of a line, which the hand begins to read if it was not shown before."""

    def act(engine):
        engine.show(shown, line)
        if anew:
            moved_by(engine).steering.give(ReadLine(LINE_MM))

    return act


def pause(paused):
    def act(engine):
        engine.paused = paused

    return act


def acted_at(engine, script, ticks):
    """The same as `run`, and the script with the ticks at which blocks let it happen."""
    times = []

    def noted(act):
        def note(engine):
            times.append((engine.tally.ticks, act))
            act(engine)

        return note

    return run(engine, [(at, noted(act)) for at, act in script], ticks), times


def assert_equal_records(got, want):
    """Bit for bit, places that are not known yet among them."""
    assert got.dtype == want.dtype
    for field in got.dtype.names:
        np.testing.assert_array_equal(got[field], want[field], field)


def assert_same(model, hand, got, script, rate_hz):
    clock = ManualClock()
    loop = LocalEngine(device(model, hand, clock.now_ns), clock, rate_hz=rate_hz)
    want = run(loop, script, got.size)
    assert got.dtype == tick_dtype(model.display.shape)
    assert_equal_records(got, want)


def anything(model, seed, ticks):
    """Lines, tunings and pauses at any ticks, many of them in the middle of a fade."""
    random = np.random.default_rng(seed)
    line, tuning, masks = 1, Tuning(), [63, 21, 42]
    script = [(int(random.integers(5)), show(picture(model, masks, tuning), line))]
    at = 0
    while at < ticks:
        at += int(random.choice([1, 3, 15, 70, 250]))
        what = random.choice(["line", "tuning", "pause", "go on"], p=[0.2, 0.4, 0.15, 0.25])
        if what in ("pause", "go on"):
            script.append((at, pause(what == "pause")))
            continue
        if what == "line":
            line, masks = line + 1, random.integers(0, 256, 6)
        tuning = Tuning(texture=random.random(), contrast=random.random())
        script.append((at, show(picture(model, masks, tuning), line, anew=what == "line")))
    return script


HANDS = "sweep:90", "device", "fluent"
MODELS = {"vbd": VBD, "stress2": STRESS2, "sheared": SHEARED}
POLLS = (1000.0, 1), (300.0, 17), (200.0, 110)


@pytest.mark.no_cover
@pytest.mark.parametrize("hand", range(3), ids=HANDS)
@pytest.mark.parametrize("model", range(3), ids=MODELS)
def test_it_gives_the_loop_s_records(hand, model):
    """Each with each, as far as nine cases go."""
    seed = 3 * hand + model
    rate_hz, poll_ticks = POLLS[(hand + model) % 3]
    hand, model = HANDS[hand], list(MODELS.values())[model]
    engine = batch(model, hand, rate_hz=rate_hz, poll_ticks=poll_ticks)
    got, script = acted_at(engine, anything(model, seed, 1200), 1200)
    assert_same(model, hand, got, script, rate_hz)
    flags = np.bitwise_or.reduce(got["flags"])
    assert flags & Flag.PAUSED
    assert flags & Flag.CHANGED
    assert len(np.unique(got["share"])) > 5
    assert got["frame"].min() >= 0
    assert 0.3 < got["frame"].max() <= 1


@pytest.mark.parametrize("rate_hz", [2.0, 40.0])
def test_slow_ticks_are_the_loop_s_too(rate_hz):
    script = [(0, show(full(), 1))]
    got = run(batch(rate_hz=rate_hz, poll_ticks=30), script, 90)
    assert_same(STRESS2, "sweep:60", got, script, rate_hz)


@pytest.mark.no_cover
def test_the_size_of_a_block_does_not_matter():
    # Where actions fall is the same for all: at multiples of all sizes, no hand done before.
    script = [
        (0, show(full(SHEARED), 1)),
        (240, show(full(SHEARED, contrast=0.3), 1, anew=False)),
        (300, pause(True)),
        (360, pause(False)),
        (420, show(full(SHEARED, texture=1.0), 2)),
    ]
    polled = [run(batch(SHEARED, "sweep:5", poll_ticks=n), script, 1200) for n in (1, 12, 60)]
    for ticks in polled[1:]:
        assert_equal_records(ticks, polled[0])


@pytest.mark.no_cover
@pytest.mark.parametrize("poll_ticks", [90, 1500])
def test_it_rests_when_the_hand_stands_still(poll_ticks):
    engine = batch(SHEARED, rate_hz=200, poll_ticks=poll_ticks)
    got, script = acted_at(engine, [(0, show(full(SHEARED), 1)), (1450, show(full(), 2))], 2000)
    assert_same(SHEARED, "sweep:60", got, script, 200)
    resting = got["flags"] & Flag.RESTING != 0
    # The hand is back after 0.4 s or so, goes to rest 5 s later, and then reads line 2.
    assert not resting[:1000].any()
    assert resting[1120:1450].all()
    assert not got["frame"][1120:1450].any()
    assert not resting[script[1][0] + 1 :][:50].any()  # it sets out with the first tick


@pytest.mark.no_cover
def test_unpausing_counts_as_motion():
    script = [(0, show(full(SHEARED), 1)), (900, pause(True)), (990, pause(False))]
    got, script = acted_at(batch(SHEARED, rate_hz=200, poll_ticks=90), script, 2500)
    assert_same(SHEARED, "sweep:60", got, script, 200)
    last_mm = np.flatnonzero(np.diff(got["x_mm"]))[-1]
    resting = np.flatnonzero(got["flags"] & (Flag.RESTING | Flag.PAUSED) == Flag.RESTING)
    unpaused = next(at for at, _ in reversed(script))
    assert unpaused > last_mm + 400
    assert resting[0] == unpaused + 1000  # 5 s after the tick before


class Resting(SimulatedDevice):
    """A device that may go to rest by itself."""

    taking = True


@pytest.mark.no_cover
@pytest.mark.parametrize("poll_ticks", [1, 40])
def test_a_device_that_rests_by_itself_is_the_loop_s(poll_ticks):
    def rest(held):
        def act(engine):
            moved = moved_by(engine)
            moved.rested += held
            moved.taking = not held

        return act

    # At rest in the middle of a line, then in the middle of a fade, then while it is paused.
    script = [(0, show(full(SHEARED), 1)), (40, rest(True)), (80, rest(False))]
    script += [(120, rest(True)), (160, rest(False)), (160, show(full(SHEARED), 2))]
    script += [(200, pause(True)), (240, rest(True)), (280, rest(False)), (320, pause(False))]
    info = device(SHEARED, None).display
    moving = Resting(info, time.monotonic_ns, parse_hand("sweep:5"), Steering())
    got = run(BatchEngine(moving, 200, poll_ticks), script, 600)
    clock = ManualClock()
    looped = Resting(info, clock.now_ns, parse_hand("sweep:5"), Steering())
    want = run(LocalEngine(looped, clock, rate_hz=200), script, got.size)
    assert_equal_records(got, want)
    rested = np.flatnonzero(got["flags"] & Flag.RESTED)
    assert rested.tolist() == [40, 120, 240]
    assert (np.flatnonzero(got["flags"] & Flag.HELD)[[0, -1]] == [40, 279]).all()


def creep(mm_s):
    return straight((0, 0), (20, 20 * mm_s))


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("motion", "rests"),
    [
        # 0.05 mm in 5 s is motion, less is none, though every count of the encoder is seen.
        (creep(0.004), True),
        (creep(0.012), False),
        # Going to rest and waking again in the middle of a block, from frames of that block.
        (straight((0, 0), (1, 6.3), (8, 6.3), (9, 12), (20, 12)), True),
        (straight((0, 0), (1, 6.3), (6.06, 6.3), (6.1, 10), (20, 12)), True),
    ],
    ids=["creeping", "moving", "stopping", "fading"],
)
@pytest.mark.parametrize("poll_ticks", [37, 1500])
def test_stillness_is_the_loop_s(motion, rests, poll_ticks):
    engine = batch(SHEARED, rate_hz=100, poll_ticks=poll_ticks)
    clock = ManualClock()
    loop_device = device(SHEARED, "sweep:60", clock.now_ns)
    loop = LocalEngine(loop_device, clock, rate_hz=100)
    records = []
    for each, moved in ((engine, engine.device), (loop, loop_device)):
        each.show(full(SHEARED), 1)
        moved.move(motion)
        records.append(run(each, [], 1500)[:1500])
    got, want = records
    assert_equal_records(got, want)
    assert (got["flags"][:1200] & Flag.RESTING).any() == rests


def test_a_poll_is_over_when_the_hand_is_done():
    engine = batch(poll_ticks=700)
    assert engine.poll().size == 700  # nothing under way
    for line in (1, 2):
        show(full(), line)(engine)
        blocks = [engine.poll()]
        while not engine.device.steering.done_at(blocks[-1]["device_ns"][-1]):
            blocks.append(engine.poll())
        assert not engine.device.steering.done_at(blocks[-1]["device_ns"][-2])
        assert [block.size for block in blocks[:-1]] == [700] * (len(blocks) - 1)
        assert blocks[-1].size < 700
        assert blocks[-1]["tick"][-1] == engine.tally.ticks - 1
        assert engine.x_mm == pytest.approx(-5.4, abs=1 / 200)
    assert engine.poll().size == 700  # done since long


def test_it_says_what_a_host_says():
    engine = batch(poll_ticks=1500)
    assert engine.x_mm is None
    engine.start()
    assert not engine.paused
    show(full(), 1)(engine)
    ticks = engine.poll()
    engine.set_zero()
    assert engine.display.columns == 10
    assert (engine.lost, engine.counts, list(engine.take_events())) == (0, {}, [])
    assert engine.calibration is None
    assert engine.tally.ticks == ticks.size
    assert engine.tally.forward_mm == pytest.approx(LINE_MM + 10.8, abs=0.1)
    assert engine.tally.scanning_mm_s == pytest.approx(60, rel=0.02)
    assert engine.device.frames == 1
    want = np.rint(ticks["frame"][-1].astype(float) * 1023)
    np.testing.assert_array_equal(engine.device.levels, want)
    engine.close()
    assert not engine.device.levels.any()


def test_a_device_that_is_closed_takes_no_frames():
    engine = batch()
    engine.device.close()
    with pytest.raises(DeviceError, match="closed"):
        engine.poll()


@pytest.mark.parametrize("hand", [None, "recorded"])
def test_it_needs_a_hand_that_reads_lines(hand, tmp_path):
    if hand is not None:
        path = tmp_path / "hand.csv"
        path.write_text("0,0\n0.1,1\n")
        hand = f"recorded:{path}"
    with pytest.raises(InputError, match="‹fast› needs a hand that reads lines"):
        batch(hand=hand)


def test_bounds():
    for rate_hz in (0, 20_000, float("nan")):
        with pytest.raises(ValueError, match="1 to 10000"):
            batch(rate_hz=rate_hz)
    with pytest.raises(ValueError, match="1 or more"):
        batch(poll_ticks=0)
    unsteered = SimulatedDevice(device(VBD, None).display, hand=parse_hand("sweep:60"))
    with pytest.raises(ValueError, match="nothing steers the hand"):
        BatchEngine(unsteered)
