"""Rasters of scenes agree with frames, and with the equations."""

from __future__ import annotations

import numpy as np

from vbraille.render.compiling import SceneMap
from vbraille.scene.patterns import (
    Circle,
    LinearGrating,
    StraightLine,
    Stroke,
    Vibration,
)
from vbraille.scene.scene import Canvas, Scene

CANVAS = Canvas(width_mm=60.0, height_mm=40.0)
SCENE = Scene(
    canvas=CANVAS,
    elements=(
        LinearGrating(ridge_mm=7.0, gap_mm=1.0, wave_angle_deg=20.0),
        Circle(center_mm=(30.0, 20.0), radius_mm=10.0, stroke=Stroke(vibration=Vibration())),
        StraightLine(start_mm=(0.0, 0.0), end_mm=(60.0, 40.0), stroke=Stroke(width_mm=2.0)),
    ),
)


def test_noise_has_the_range_of_the_vibration():
    swing = Vibration(amplitude=0.3)
    part = LinearGrating(ridge_mm=8.0, amplitude=0.0, inverted=True, vibration=swing)
    whole = SceneMap(Scene(canvas=CANVAS, elements=(part,)))
    x, y = np.linspace(0, 60, 200), np.linspace(0, 40, 200)
    noise = whole.deflections(x, y, noise_seed=5)
    assert 0.7 <= noise.min() < 0.701
    assert 0.999 < noise.max() <= 1.0
    assert abs(np.corrcoef(noise[:, :-1].ravel(), noise[:, 1:].ravel())[0, 1]) < 0.02
    assert np.array_equal(noise, whole.deflections(x, y, noise_seed=5))


def test_opacity_is_what_hides():
    x, y = np.linspace(0, 60, 61), np.linspace(0, 40, 41)
    assert np.array_equal(SceneMap(SCENE).deflections(x, y, is_mask=True), np.ones((41, 61)))
    weak = Circle(center_mm=(30.0, 20.0), radius_mm=10.0, stroke=Stroke(amplitude=0.2))
    full = Circle(center_mm=(30.0, 20.0), radius_mm=10.0, stroke=Stroke())
    of_weak = SceneMap(Scene(canvas=CANVAS, elements=(weak,))).deflections(x, y, is_mask=True)
    of_full = SceneMap(Scene(canvas=CANVAS, elements=(full,))).deflections(x, y)
    assert np.array_equal(of_weak, of_full)
    both = SceneMap(Scene(canvas=CANVAS, operation="add", elements=(weak, weak))).deflections(
        x, y, is_mask=True
    )
    assert np.allclose(both, np.minimum(2 * of_weak, 1))
