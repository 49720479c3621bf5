"""Tactile pictures in the engine: their rest, their changes, and programs of some MB."""

import numpy as np
import pytest

from tests.engine.planar import PLANE, STYLE, Bench, still
from vbraille.engine.record import Flag
from vbraille.render.compiling import compile_scene
from vbraille.render.program import vibration
from vbraille.scene.patterns import Circle
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.strokes import Stroke
from vbraille.scene.textures import LinearGrating, UniformVibration


def scene_of(*elements):
    scene = Scene(canvas=Canvas(width_mm=200, height_mm=200), elements=elements)
    return compile_scene(scene, PLANE)


STILL = scene_of(LinearGrating(ridge_mm=3, gap_mm=3))
VIBRATING = scene_of(UniformVibration(frequency_hz=10.0))


def rests(ticks):
    return (ticks["flags"] & Flag.RESTING) != 0


def last(where):
    """Seconds from the start until something was so for the last time, at 200 Hz."""
    return (np.flatnonzero(where)[-1] + 1) / 200


@pytest.mark.parametrize(("program", "patience_s"), [(STILL, 5.0), (VIBRATING, 60.0)])
def test_a_scene_rests_under_a_hand_that_is_still_and_comes_back_with_it(program, patience_s):
    hand = {"x": 50.0}
    bench = Bench(lambda _: (hand["x"], 50.0, 0.0), rate_hz=200)
    bench.engine.show(program, 1)
    ticks = bench.run(patience_s + 2.0)
    assert not rests(ticks)[2 : round(200 * patience_s) - 5].any()
    assert last(~rests(ticks)) == pytest.approx(patience_s, abs=0.02)
    assert not ticks["frame"][-1].any()
    steps = np.abs(np.diff(ticks["frame"][round(200 * patience_s) - 2 :], axis=0))
    assert steps.max() <= 10 * np.pi / 200 + 1 / 20 + 1e-6  # it fades
    hand["x"] += 1.0
    assert not rests(bench.run(0.3))[2:].any()


def test_a_vibration_alone_is_felt_without_the_hand_as_before():
    bench = Bench(still(), rate_hz=100)
    bench.engine.show(vibration(PLANE, 10.0, exposure_s=100.0), 1)
    assert not rests(bench.run(70.0))[1:].any()


def test_a_vibrating_scene_that_was_exposed_for_a_minute_under_a_moving_hand_goes_on():
    bench = Bench(lambda t_s: (50.0 + t_s, 50.0, 0.0), rate_hz=100)
    bench.engine.show(VIBRATING, 1)
    assert not rests(bench.run(70.0))[2:].any()
    assert bench.engine.take_events() == []


def test_scenes_and_lines_follow_each_other_in_fades():
    bench = Bench(still(), rate_hz=1000)
    ring = Circle(center_mm=(10, 10), radius_mm=6, stroke=Stroke(width_mm=3))
    for program in (STILL, scene_of(ring), STYLE.render(np.full(5, 63, np.uint8), PLANE), STILL):
        bench.engine.show(program, 1)
        bench.run(0.25)
    assert np.abs(np.diff(np.array(bench.sent), axis=0)).max() <= 1 / 100 + 1e-9
