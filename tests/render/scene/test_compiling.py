"""Scenes compiled: closed forms, changes, and what is refused."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
import pytest

from vbraille.display import Display
from vbraille.render import kernels, work
from vbraille.render.compiling import compile_scene
from vbraille.scene.patterns import (
    Group,
    LinearGrating,
    StraightLine,
    Stroke,
    Uniform,
    UniformVibration,
    Vibration,
)
from vbraille.scene.scene import Canvas, Scene

if TYPE_CHECKING:
    from vbraille.render.program import Program

DISPLAY = Display("latero", 8, 8, 1.2, 1.4, height_mm=80.0, turns=True)
CANVAS = Canvas(width_mm=100.0, height_mm=80.0)


def compiled(*elements, operation="overwrite", assets=None, display=DISPLAY) -> Program:
    return compile_scene(
        Scene(canvas=CANVAS, elements=elements, operation=operation), display, assets
    )


def frame(program: Program, x=50.0, y=40.0, *, theta=0.0, time_s=0.0) -> np.ndarray:
    out = np.full(program.shape, np.nan)
    program.frame(x, out, y_mm=y, theta_rad=theta, time_s=time_s)
    return out


def actuators(x=50.0, y=40.0, theta=0.0) -> tuple[np.ndarray, np.ndarray]:
    """Places of the actuators: `vbraille.display`."""
    row, column = np.mgrid[:8, :8]
    right, down = (column - 3.5) * 1.2, (row - 3.5) * 1.4
    cosine, sine = math.cos(theta), math.sin(theta)
    return x + right * cosine + down * sine, y + down * cosine - right * sine


def test_the_array_is_turned_as_poses_say():
    grating = LinearGrating(ridge_mm=9.0, wave_angle_deg=90.0)
    shown = frame(compiled(grating), 40.0, 30.0, theta=1.1)
    _, y = actuators(40.0, 30.0, 1.1)
    assert np.allclose(shown, 0.5 - 0.5 * np.cos(2 * np.pi * y / 9), atol=1e-9)


def test_neighbours_vibrate_against_each_other():
    shown = frame(compiled(UniformVibration(frequency_hz=20.0)), time_s=0.0125)
    row, column = np.mgrid[:8, :8]
    assert np.allclose(shown, (row + column + 1) % 2)


def test_beyond_the_canvas_there_is_nothing():
    shown = frame(compiled(Uniform()), 0.0, 40.0)
    x, _ = actuators(0.0)
    assert np.array_equal(shown, np.where(x >= 0, 1.0, 0.0))
    for x, y in ((-20.0, 40.0), (50.0, 95.0), (math.nan, 40.0), (50.0, math.nan), (math.inf, 0.0)):
        assert not frame(compiled(Uniform()), x, y).any()


def test_nothing_on_the_canvas_is_rest():
    assert not frame(compiled()).any()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_poses_are_frames(dtype):
    program = compiled(UniformVibration(), LinearGrating(ridge_mm=3.0, velocity_mm_s=20.0))
    x, times = np.linspace(0, 100, 50), np.linspace(0, 2, 50)
    _, frames = program.poses(x, np.full(50, 30.0), 0.2, times)
    for k in range(50):
        out = np.empty((8, 8), dtype)
        program.frame(x[k], out, y_mm=30.0, theta_rad=0.2, time_s=times[k])
        assert np.array_equal(frames[k], out.astype(np.float32))


def test_the_head_tells_what_moves():
    still, moving = (
        compiled(LinearGrating(ridge_mm=2.0)),
        compiled(
            StraightLine(
                start_mm=(0, 0), end_mm=(9, 9), stroke=Stroke(vibration=Vibration(frequency_hz=30))
            )
        ),
    )
    assert still.numbers[work.FREQUENCY] == 0.0
    assert moving.numbers[work.FREQUENCY] == 30.0
    assert kernels.patience(moving.numbers) == work.PATIENCE_S
    assert math.isinf(kernels.patience(still.numbers))
    assert compiled(LinearGrating(ridge_mm=2.0, gap_mm=3.0, velocity_mm_s=-20.0)).numbers[
        work.FREQUENCY
    ] == pytest.approx(4.0)


def test_a_frequency_above_half_of_the_rate_is_refused():
    scene = Scene(canvas=CANVAS, elements=(Uniform(), UniformVibration(frequency_hz=50, id="sea")))
    with pytest.raises(ValueError, match=r'element "sea" moves at 50 Hz; .* 40 Hz'):
        compile_scene(scene, DISPLAY, rate_hz=80.0)


def test_patterns_may_not_stand_too_deep_in_each_other():
    nested: Group | Uniform = Uniform(level=0.5)
    for depth in range(40):
        nested = Group(operation="maximum", parts=(Uniform(level=0.1), nested))
        if depth == 20:
            assert frame(compiled(nested)).min() == 0.5
    with pytest.raises(ValueError, match="too deep"):
        compiled(nested)
