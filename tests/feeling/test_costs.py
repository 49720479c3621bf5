"""What frames cost: that places and numbers belong together; times themselves are no tests."""

import numpy as np
import pytest

from tests.reading.felt import DISPLAY, SCENE
from vbraille.feeling import costs as timing
from vbraille.feeling.composing import compose
from vbraille.feeling.costs import (
    ACTUATOR_BUDGET_US,
    BATCH_FRAMES,
    Costs,
    cost_map,
    costs_by_velocity,
    costs_of_elements,
    histogram,
    measure,
    to_csv,
    velocity_map,
)
from vbraille.feeling.loading import load_scene
from vbraille.feeling.paths import PathOptions, path_of
from vbraille.render import MODELS, work
from vbraille.render.scene.compiling import compile_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Speed
from vbraille.scene.textures import Uniform

SPOT = PathOptions("spot:60,50", seconds=0.2)


@pytest.fixture
def loaded(tmp_path):
    path = tmp_path / "house.scene"
    path.write_text(SCENE)
    return load_scene(path, MODELS["stress2-8x8"].style)


def test_each_batch_is_timed_where_its_frames_are(loaded):
    path = path_of(SPOT, loaded.scene.canvas, DISPLAY.span_mm, 1000.0)
    costs = measure(compose(loaded, DISPLAY), path, repeats=3)
    assert costs.frame_us.shape == (path.t_s.size // BATCH_FRAMES,)
    assert costs.x_mm[2] == pytest.approx(path.x_mm[32:48].mean())
    assert (costs.frame_us >= 0).all()
    assert costs.frame_us.max() > 0
    assert 0 < costs.resolution_us < 1
    assert costs.actuator_us == pytest.approx(costs.frame_us.mean() / 64)
    assert ACTUATOR_BUDGET_US == 15.625
    with pytest.raises(ValueError, match="too short to be timed"):
        measure(compose(loaded, DISPLAY), path.only(path.t_s < 0.01))


def test_the_map_has_the_mean_of_each_square_and_the_histogram_all_frames():
    costs = Costs(
        np.array([1.0, 1.5, 9.0, 11.0]),
        np.array([1.0, 1.9, 3.9, 2.0]),
        np.array([0.0, 40.0, -40.0, 0.0]),
        np.array([0.0, 1.0, 1.0, 40.0]),
        np.array([2.0, 4.0, 7.0, 99.0]),
        64,
        0.01,
    )
    drawn = cost_map(costs, Canvas(width_mm=10, height_mm=4), 2.0)
    assert drawn.mean_us.shape == (2, 5)
    assert drawn.mean_us[0, 0] == 3
    assert drawn.mean_us[1, 4] == 7  # and nothing of what is beyond the canvas
    assert np.isnan(drawn.mean_us).sum() == 8
    bars = histogram(costs)
    assert sum(share for *_, share in bars) == pytest.approx(1)
    assert (bars[0][0], bars[-1][1]) == (2, 99)
    assert to_csv(costs).splitlines()[:2] == [
        "x_mm,y_mm,vx_mm_s,vy_mm_s,frame_us",
        "1.0000,1.0000,0.0000,0.0000,2.0000",
    ]
    plane = velocity_map(costs)  # from 45 mm/s to the left and up on
    assert (plane.mean_us.shape, plane.step) == ((9, 9), 10)
    assert (plane.mean_us[4, 4], plane.mean_us[4, 8], plane.mean_us[4, 0]) == (2, 4, 7)
    assert plane.mean_us[8, 4] == 99
    found = [
        (cost.direction, cost.mean_us, cost.from_mm_s > 0) for cost in costs_by_velocity(costs)
    ]
    assert found == [("right", 2, False), ("right", 4, True), ("down", 99, True), ("left", 7, True)]


def test_signals_are_those_of_the_whole_path_in_each_batch():
    """What a frame costs under a hand that stopped shows what signals remember of the hand."""
    scene = Scene(
        canvas=Canvas(width_mm=100, height_mm=60),
        elements=(Uniform(factor="slow"),),
        signals={"slow": Speed(below_mm_s=5, transition_mm_s=5, delay_s=0.1)},
    )
    program = compile_scene(scene, DISPLAY)
    path = path_of(PathOptions("spot:50,30", seconds=0.5), scene.canvas, DISPLAY.span_mm, 1000.0)
    at = timing._batches_of(path)
    timing._remember(program, at)
    _, frames = program.poses(path.x_mm, path.y_mm, path.theta_rad, path.t_s, path.velocity_mm_s)
    felt = frames.max(axis=(1, 2))[: at[..., 0].size]
    assert 0 < (felt > 0).mean() < 1
    np.testing.assert_allclose(at[..., work.SIGNAL].ravel(), felt, atol=1e-6)


def test_an_element_that_the_array_never_comes_near_costs_nothing(loaded):
    path = path_of(SPOT, loaded.scene.canvas, DISPLAY.span_mm, 1000.0)
    found = {
        each.name: each for each in costs_of_elements(loaded, DISPLAY, path, 1000.0, repeats=3)
    }
    assert list(found) == ["Sun", "wall"]
    assert (found["Sun"].mean_us, found["Sun"].most_us) == (0, 0)
    assert found["wall"].most_us > 0
