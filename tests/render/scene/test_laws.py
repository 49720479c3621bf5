"""What holds for every tactile picture, wherever the array is and whenever.

Each frame is the kernel's, and it is compared with the twin's on the way.
"""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scene import twin as reference
from tests.render.scene.scenes import KINDS, examples, numbers, patterns, scenes, seeds
from tests.render.scene.showing import (
    DISPLAYS,
    STRESS2_8X8_ARRAY,
    At,
    actuators,
    assets_of,
    poses,
    scene_of,
    shown,
)
from vbraille.scene.patterns import (
    Circle,
    Fill,
    Group,
    LinearGrating,
    Uniform,
)
from vbraille.scene.traversal import moved

EXACT = 1e-6  # frames are of float32
displays = st.sampled_from(DISPLAYS)


def some_poses(seed, count=2):
    return poses(np.random.default_rng(seed), count)


def same(one, other, atol=EXACT):
    np.testing.assert_allclose(one, other, rtol=0, atol=atol)


# Kernel equals twin; values are deflections


@examples(150)
@given(scenes(), seeds, displays)
def test_frames_are_deflections_and_equal_their_twin(scene, seed, display):
    for pose in some_poses(seed, 4):
        frame = shown(scene, display, pose)
        assert np.isfinite(frame).all()
        assert frame.min() >= 0
        assert frame.max() <= 1


@pytest.mark.parametrize("kind", KINDS)
def test_each_pattern_equals_its_twin(kind):
    @examples(30)
    @given(KINDS[kind], seeds, displays)
    def each(pattern, seed, display):
        scene = scene_of(pattern)
        for pose in some_poses(seed, 4):
            shown(scene, display, pose)

    each()


# Opacity


@examples(60)
@given(patterns, seeds)
def test_a_pattern_is_nowhere_above_its_opacity_mask(pattern, seed):
    rng = np.random.default_rng(seed)
    assets = assets_of(pattern)
    x, y = rng.uniform(-5, 65, (2, 400))
    time_s = rng.uniform(0, 10)
    parity = rng.integers(0, 2, 400)
    up = reference.deflection(pattern, assets, reference.places(x, y, parity, time_s))
    over = reference.opacity(pattern, assets, x, y, parity, time_s)
    assert (up <= over + 1e-9).all()
    assert (over >= 0).all()
    assert (over <= 1).all()


@examples(60)
@given(patterns, patterns, seeds, displays)
def test_a_texture_on_top_hides_all_below(below, other, seed, display):
    top = LinearGrating(ridge_mm=3, gap_mm=1, wave_angle_deg=20)
    covered, alone = scene_of(below, other, top), scene_of(top)
    for pose in some_poses(seed):
        same(shown(covered, display, pose), shown(alone, display, pose))


@examples(60)
@given(patterns, seeds)
def test_a_filled_shape_hides_what_is_under_its_inside(below, seed):
    disc = Circle(
        center_mm=(30, 30), radius_mm=25, fill=Fill(texture=Uniform(level=0.3), fade_mm=0)
    )
    rng = np.random.default_rng(seed)
    for theta, time_s in rng.uniform(0, 3, (3, 2)):
        frame = shown(scene_of(below, disc), STRESS2_8X8_ARRAY, At(31.3, 29.1, theta, time_s))
        same(frame, 0.3)


# Pruning


@examples(60)
@given(st.lists(patterns, min_size=1, max_size=2), seeds, displays)
def test_shapes_elsewhere_change_nothing(near, seed, display):
    rng = np.random.default_rng(seed)
    far = [
        Circle(
            center_mm=(float(x), float(y)),
            radius_mm=float(r),
            fill=Fill(texture=Uniform(level=0.5)),
        )
        for x, y, r in rng.uniform((100, -50, 1), (300, 200, 9), (40, 3))
    ]
    pose = At(*rng.uniform(0, 60, 2), rng.uniform(0, 3), 0.7)
    alone = shown(scene_of(*near, operation="maximum"), display, pose)
    same(shown(scene_of(*far[:20], *near, *far[20:], operation="maximum"), display, pose), alone)


# Composition


@examples(60)
@given(patterns, patterns, seeds, st.booleans())
def test_a_blend_shows_one_part_at_0_and_the_other_at_1(one, other, seed, second):
    by = Uniform(level=float(second))
    blend = scene_of(Group(operation="blend", parts=(one, other), by=by))
    alone = scene_of(other if second else one)
    for pose in some_poses(seed):
        same(shown(blend, STRESS2_8X8_ARRAY, pose), shown(alone, STRESS2_8X8_ARRAY, pose))


# Time and place


@examples(60)
@given(patterns, st.tuples(numbers(0, 300), numbers(0, 300)), seeds, displays)
def test_moving_the_picture_and_the_array_together_changes_nothing(pattern, move, seed, display):
    # Both are on the canvas with all that the array can touch.
    here = moved(pattern, (30.0, 30.0))
    there = moved(here, move)
    for pose in some_poses(seed):
        first = At(pose.x_mm + 30, pose.y_mm + 30, pose.theta_rad, pose.time_s)
        other = At(first.x_mm + move[0], first.y_mm + move[1], pose.theta_rad, pose.time_s)
        before = shown(scene_of(here, side_mm=500), display, first)
        same(shown(scene_of(there, side_mm=500), display, other), before, 1e-5)


@examples(40)
@given(patterns, seeds)
def test_beside_the_canvas_actuators_are_at_rest(pattern, seed):
    scene = scene_of(pattern)
    for pose in poses(np.random.default_rng(seed), 2):
        x, y, _ = actuators(STRESS2_8X8_ARRAY, pose)
        beside = (x < 0) | (x > 60) | (y < 0) | (y > 60)
        assert not shown(scene, STRESS2_8X8_ARRAY, pose).ravel()[beside].any()
