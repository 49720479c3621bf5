"""One picture in several ways: pruned or not, compiled anew or after another, and as a map."""

import numpy as np
from hypothesis import given

from tests.render.scene import twin as reference
from tests.render.scene.scenes import examples, patterns, scenes, seeds
from tests.render.scene.showing import assets_of, scene_of
from vbraille.render.compiling import SceneMap


@examples(60)
@given(scenes(), seeds)
def test_a_map_is_what_the_twin_shows(scene, seed):
    rng = np.random.default_rng(seed)
    assets = assets_of(*scene.elements)
    x, y = np.sort(rng.uniform(-5, 65, 13)), rng.uniform(-5, 65, 7)
    time_s, parity = float(rng.uniform(0, 10)), int(rng.integers(2))
    got = SceneMap(scene, assets).deflections(x, y, time_s=time_s, parity=parity)
    assert got.shape == (7, 13)
    right, down = (grid.ravel() for grid in np.meshgrid(x, y))
    want = reference.deflections(scene, assets, right, down, parity, time_s)
    np.testing.assert_allclose(got.ravel(), want, rtol=0, atol=1e-6)


@examples(60)
@given(patterns, seeds)
def test_a_map_of_opacity_is_what_the_twin_says(pattern, seed):
    rng = np.random.default_rng(seed)
    assets = assets_of(pattern)
    x, y = np.sort(rng.uniform(0, 60, 13)), rng.uniform(0, 60, 7)
    time_s, parity = float(rng.uniform(0, 10)), int(rng.integers(2))
    got = SceneMap(scene_of(pattern), assets).deflections(
        x, y, is_mask=True, time_s=time_s, parity=parity
    )
    right, down = (grid.ravel() for grid in np.meshgrid(x, y))
    want = reference.opacity(pattern, assets, right, down, parity, time_s)
    np.testing.assert_allclose(got.ravel(), want, rtol=0, atol=1e-6)
