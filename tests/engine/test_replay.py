"""What was written, made again from records; and blocks of ticks with pictures of every kind."""

from functools import cache

import numpy as np
import pytest

from tests.engine.planar import PLANE, STYLE, Bench
from tests.engine.test_batch import HANDS, assert_equal_records, batch, device, run
from tests.engine.test_planar import wandering
from vbraille.engine.clock import ManualClock
from vbraille.engine.loop import LocalEngine
from vbraille.engine.record import Flag
from vbraille.render import STRESS2
from vbraille.render.program import vibration
from vbraille.sessions.record.replay import Replay
from vbraille.simulation.steering import ReadLine

SEEDS = range(8)


def any_picture(random, display):
    """A line, a page or a vibration."""
    kind = random.integers(3)
    if kind == 0:
        return STYLE.render(random.integers(0, 64, 12).astype(np.uint8), display)
    if kind == 1:
        return STYLE.render_page(list(random.integers(0, 64, (25, 12)).astype(np.uint8)), display)
    return vibration(display, random.uniform(1, 50), random.uniform(0.1, 1), 0.2)


def act(random, bench, pictures):
    """Something that a reader or a device does, or an end of it."""
    device, engine = bench.device, bench.engine
    send = type(device)._send

    def stop_taking(frame):
        send(device, frame)
        device.taking = False
        del device._send

    chances = {
        "show": 0.3, "pause": 0.05, "rests": 0.05, "takes nothing": 0.05, "stops taking": 0.05,
        "is lost": 0.05, "goes on": 0.45,
    }  # fmt: skip
    what = random.choice(list(chances), p=list(chances.values()))
    if what == "show":
        pictures.append(any_picture(random, device.display))
        engine.show(pictures[-1], len(pictures) - 1)
    elif what == "pause":
        engine.paused = True
    elif what == "rests":
        device.rested += 1
    elif what == "takes nothing":
        device.taking = False
        device.rested += 1
    elif what == "stops taking":  # in the middle of a tick
        device._send = stop_taking
    elif what == "is lost":
        device.place = lambda _s: None
    else:
        engine.paused, device.taking, device.place = False, True, wandering


@cache
def life(seed):
    """Records of two seconds in which all kinds of things happen, what was sent, and pictures."""
    random = np.random.default_rng(seed)
    bench = Bench(wandering)
    pictures = [None]  # of line 0, before the first
    while len(bench.device.sent) < 2000:
        act(random, bench, pictures)
        bench.clock.advance_ns(int(random.choice([0, 0, 7_300_000])))
        bench.run(random.choice([0.001, 0.02, 0.12, 0.3]))
    return bench.records, bench.sent, pictures


@pytest.mark.no_cover
@pytest.mark.parametrize("seed", SEEDS)
def test_records_say_what_was_written_bit_for_bit(seed):
    records, written, pictures = life(seed)
    held = (records["flags"] & Flag.HELD) != 0
    replay = Replay(pictures.__getitem__, PLANE)
    parts = np.array_split(records, 1 + seed % 4)
    again = np.concatenate([replay.frames(part) for part in parts])
    np.testing.assert_array_equal(again[~held], written[~held])
    np.testing.assert_array_equal(again[held], 0.0)
    np.testing.assert_array_equal(records["frame"], written.astype(np.float32))
    assert written.min() >= 0
    assert written.max() <= 1


@pytest.mark.no_cover
def test_all_that_is_to_be_replayed_happens():
    lives = [life(seed) for seed in SEEDS]
    records = np.concatenate([records for records, _, _ in lives])
    assert len({picture.kind for _, _, pictures in lives for picture in pictures[1:]}) == 3
    flags = np.bitwise_or.reduce(records["flags"])
    for flag in (Flag.PAUSED, Flag.RESTING, Flag.CHANGED, Flag.RESTED, Flag.HELD, Flag.EXPOSED):
        assert flags & flag
    assert flags & Flag.SILENT
    assert np.unique(records["part"]).size > 3
    assert np.count_nonzero(records["frame"].any(axis=(1, 2))) > records.size / 3


def test_frames_after_a_gap_are_not_known_until_a_fade_is_over():
    bench = Bench(wandering)
    bench.engine.show(STYLE.render(np.full(12, 63, np.uint8), PLANE), 1)
    line = STYLE.render(np.full(12, 63, np.uint8), PLANE)
    records = bench.run(0.3)
    again = Replay(lambda _: line, PLANE).frames(records[50:])
    assert np.isnan(again[:50]).any(axis=(1, 2)).all()
    np.testing.assert_array_equal(again[51:], bench.sent[101:])


@pytest.mark.no_cover
@pytest.mark.parametrize(("hand", "poll_ticks"), [*zip(HANDS, (1, 33, 200), strict=True)])
def test_blocks_are_the_loop_s_with_pages_and_vibrations(hand, poll_ticks):
    def show(engine, picture, line):
        engine.show(picture, line)
        moved = engine.device
        moved.steering.give(ReadLine(12.0))

    def pause(engine, paused):
        engine.paused = paused

    random = np.random.default_rng(poll_ticks)
    script, at = [], 0
    engine = batch(hand=hand, poll_ticks=poll_ticks)
    for line in range(1, 9):
        picture = any_picture(random, STRESS2.display)
        script.append((at, lambda engine, p=picture, n=line: show(engine, p, n)))
        at += int(random.choice([200, 400, 800]))
        if line % 3 == 0:
            script.append((at, lambda engine: pause(engine, True)))
            at += 200
            script.append((at, lambda engine: pause(engine, False)))
    times = []

    def noted(act):
        def note(engine):
            times.append((engine.tally.ticks, act))
            act(engine)

        return note

    got = run(engine, [(when, noted(what)) for when, what in script], at + 300)
    clock = ManualClock()
    local = LocalEngine(device(STRESS2, hand, clock.now_ns), clock)
    assert_equal_records(got, run(local, times, got.size))
