"""A page under a hand that goes anywhere: which line is shown, and that nothing jumps."""

import math

import numpy as np
import pytest

from tests.engine.planar import LINE_MM, PLANE, STYLE, Bench
from tests.shown import array_of
from vbraille.engine.record import Flag
from vbraille.errors import DeviceError
from vbraille.render.work import NO_PART

FADE_S = 0.1
LINES, CELLS = 25, 12


def page_of(rng):
    return STYLE.render_page(list(rng.integers(1, 64, (LINES, CELLS)).astype(np.uint8)), PLANE)


def at(program, tick):
    out = np.zeros(program.shape)
    program.frame(
        float(tick["x_mm"]), out, theta_rad=float(tick["theta_rad"]), part=int(tick["part"])
    )
    return out


def wandering(seconds):
    """A way over all of a page and beyond its edges, turning."""
    return (
        40 + 35 * math.sin(1.3 * seconds),
        LINES * LINE_MM * (0.5 - 0.52 * math.cos(0.4 * seconds)),
        0.3 * math.sin(0.9 * seconds),  # never farther than braille is shown
    )


def test_a_page_is_read_without_a_next_line(rng):
    page = page_of(rng)
    bench = Bench(wandering)
    bench.engine.show(page, 3)
    bench.run(9.0)
    records = bench.records
    part = NO_PART
    exact = 0
    for tick, sent in zip(records[1:], bench.sent[1:], strict=True):
        part = page.part_of(float(tick["y_mm"]), part)
        assert tick["part"] == part
        if tick["share"] == 1 and not tick["flags"] & Flag.RESTING:
            exact += 1
            np.testing.assert_array_equal(sent, at(page, tick))
    assert exact > 1000
    assert set(range(-1, LINES + 1)) == set(records["part"].tolist())
    assert set(records["line"].tolist()) == {3}


@pytest.mark.parametrize("speed_mm_s", [5.0, 60.0, 400.0, 3000.0, 20_000.0])
def test_no_actuator_jumps_where_lines_meet(rng, speed_mm_s):
    # The hand goes straight down, there and back: whatever moves is a crossing's fade.
    height_mm = LINES * LINE_MM

    def place(seconds):
        return 30.0, height_mm / 2 + abs((speed_mm_s * seconds) % (4 * LINE_MM) - 2 * LINE_MM), 0.0

    bench = Bench(place)
    bench.engine.show(page_of(rng), 1)
    bench.run(3.0)
    assert np.abs(np.diff(bench.sent, axis=0)).max() <= 1 / (FADE_S * 1000) + 1e-9
    assert bench.sent.max() > 0.3
    if speed_mm_s > 10:
        assert np.unique(bench.records["part"]).size > 2


@pytest.mark.parametrize("hysteresis", [0.0, 0.25])
def test_a_hand_that_trembles_where_lines_meet_fades_once_or_all_the_time(rng, hysteresis):
    masks = list(rng.integers(1, 64, (LINES, CELLS)).astype(np.uint8))
    page = STYLE.render_page(masks, PLANE, hysteresis=hysteresis)
    bench = Bench(lambda s: (30.0, 5 * LINE_MM + math.sin(40 * s), 0.0))
    bench.engine.show(page, 1)
    ticks = bench.run(2.0)
    crossings = np.count_nonzero(np.diff(ticks["part"]))
    assert (crossings == 0) == (hysteresis > 0)
    assert np.abs(np.diff(bench.sent, axis=0)).max() <= 1 / (FADE_S * 1000) + 1e-9


def test_a_slider_shows_the_first_line_of_a_page_wherever_it_says_that_it_is(rng):
    slider = array_of(8, 8, 1.2, 1.6125)
    masks = list(rng.integers(1, 64, (3, CELLS)).astype(np.uint8))
    page = STYLE.render_page(masks, slider)
    bench = Bench(lambda s: (20 * s, 33.0, 0.0), slider)
    bench.engine.show(page, 1)
    ticks = bench.run(0.5)
    assert set(ticks["part"].tolist()) == {0}
    assert set(ticks["y_mm"].tolist()) == {LINE_MM / 2}
    line = STYLE.render(masks[0], slider)
    np.testing.assert_array_equal(bench.sent[-1], at(line, ticks[-1]))


@pytest.mark.parametrize("way", ["x", "y", "θ"])
def test_any_motion_keeps_the_array_awake(rng, way):
    def place(seconds):
        # So slow that nothing but the rule on stillness sees it.
        slow = 0.02 * seconds
        return 30.0 + slow * (way == "x"), 7.0 + slow * (way == "y"), slow / 20 * (way == "θ")

    bench = Bench(place, rate_hz=50)
    bench.engine.show(page_of(rng), 1)
    assert not (bench.run(12.0)["flags"][1:] & Flag.RESTING).any()
    bench.device.place = lambda _s: place(12.0)
    assert bench.run(6.0)["flags"][-1] & Flag.RESTING


@pytest.mark.parametrize("jump", [(60.0, 0.0, 0.0), (0.0, 90.0, 0.0), (0.0, 0.0, 2.0)])
def test_a_carriage_that_is_elsewhere_all_at_once_fades_in_there(rng, jump):
    there = tuple(np.add((30.0, 7.0, 0.0), jump).tolist())
    bench = Bench(lambda s: there if s > 0.5 else (30.0, 7.0, 0.0))
    bench.engine.show(page_of(rng), 1)
    bench.run(1.0)
    assert np.abs(np.diff(bench.sent, axis=0)).max() <= 1 / (FADE_S * 1000) + 1e-9
    assert np.count_nonzero(bench.records["flags"] & Flag.CHANGED) == 2
    assert not np.array_equal(bench.sent[450], bench.sent[-1])


@pytest.mark.parametrize("place", [(1.0, math.nan, 0.0), (1.0, 2.0, math.inf), (1.0, -1e7, 0.0)])
def test_a_place_that_cannot_be_is_a_fault(place):
    bench = Bench(lambda _s: place)
    with pytest.raises(DeviceError, match="where it cannot be"):
        bench.run(0.01)
