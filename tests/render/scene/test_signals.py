"""Signals against their twin, and what moves by them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.render.scene import twin
from tests.render.scene.scenes import examples, numbers
from tests.render.scene.showing import STRESS2_8X8_ARRAY, actuators, assets_of
from tests.render.scene.showing import At as Pose
from tests.render.scene.twinsignals import Signals
from vbraille.render import work
from vbraille.render.compiling import SceneMap, compile_scene
from vbraille.render.signalkernels import begin, compute
from vbraille.scene.patterns import (
    Along,
    AxialGrating,
    Circle,
    Fill,
    Group,
    LinearGrating,
    Moving,
    SignalLevel,
    StraightLine,
    Stroke,
    Uniform,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import (
    Direction,
    Inverse,
    Product,
    Pulse,
    Speed,
    Switch,
    ordered,
    packed,
)

CANVAS = Canvas(width_mm=60, height_mm=60)
speeds = {"below_mm_s": numbers(0, 20), "transition_mm_s": numbers(0.1, 20)}
ones = st.one_of(
    st.builds(Speed, **speeds, delay_s=st.just(0.0) | numbers(0.01, 0.3)),
    st.builds(
        Direction,
        angle_deg=numbers(-360, 360),
        axis=st.booleans(),
        tolerance_deg=numbers(0, 120),
        transition_deg=numbers(0.1, 60),
        at_rest=st.sampled_from(["high", "low", "keep"]),
        below_mm_s=numbers(0, 10),
        slow_transition_mm_s=numbers(0.1, 10),
    ),
    st.builds(
        Switch,
        key=st.integers(1, 3),
        levels=st.lists(numbers(0, 1), min_size=3, max_size=3).map(tuple),
        fade_s=st.just(0.0) | numbers(0.01, 0.5),
    ),
    st.builds(Pulse, shape=st.sampled_from(["sine", "square", "ramp"]), period_s=numbers(0.02, 2)),
)
named = st.lists(ones, min_size=3, max_size=3).map(
    lambda found: {
        "not": Inverse(of="both"),
        "both": Product(of=("first", "third")),
        **dict(zip(("first", "second", "third"), found, strict=True)),
    }
)


@given(signals=named, seed=st.integers(0, 2**32 - 1))
@examples(100)
def test_signals_are_those_of_the_equations_at_each_tick(signals, seed):
    scene = Scene(
        canvas=CANVAS,
        signals=signals,
        elements=(LinearGrating(ridge_mm=2, velocity_mm_s=5, velocity_by="first"),),
    )
    numbers, at = compile_scene(scene, STRESS2_8X8_ARRAY).numbers, np.zeros(work.AT)
    begin(numbers, at)
    reference = Signals(signals, ["first"])
    names = [one.name if one.signal else f"∫{one.name}" for one in ordered(signals, ["first"])]
    rng = np.random.default_rng(seed)
    velocity, states, time_s, passed_s = np.zeros(2), {}, 0.0, 0.0
    for tick in range(150):
        if tick % 25 == 0:
            velocity = rng.choice([0, 1, 1, 3]) * rng.uniform(-12, 12, 2)
            states = {key: int(rng.integers(3)) for key in (1, 2, 3)}
        at[work.VX : work.VY + 1], at[work.TIME] = velocity, time_s
        at[work.SWITCHES] = packed(states, signals)
        compute(numbers, at, passed_s)
        values = reference.step(passed_s, velocity, time_s, states)
        want = [values[name] for name in names]
        np.testing.assert_allclose(at[work.SIGNAL :][: len(want)], want, rtol=0, atol=1e-9)
        passed_s = float(rng.choice([0.001, 0.01]))
        time_s += passed_s


def along(velocity_by):
    return Stroke(width_mm=6, along=Along(ridge_mm=3, velocity_mm_s=30, velocity_by=velocity_by))


MOVING = {
    "grating": LinearGrating(ridge_mm=4, gap_mm=2, velocity_mm_s=-25, velocity_by="fast"),
    "spokes": AxialGrating(center_mm=(30, 30), ridge_deg=20, velocity_deg_s=90, velocity_by="fast"),
    "stroke": Circle(center_mm=(30, 30), radius_mm=12, stroke=along("fast")),
    "line in a fill": Circle(
        center_mm=(30, 30),
        radius_mm=12,
        fill=Fill(texture=StraightLine(start_mm=(20, 20), end_mm=(40, 40), stroke=along("fast"))),
    ),
    "texture": Moving(
        part=LinearGrating(ridge_mm=4, wave_angle_deg=30),
        velocity_mm_s=(10, -20),
        velocity_by="fast",
    ),
}


@pytest.mark.parametrize("name", MOVING)
def test_what_moves_by_a_signal_goes_by_its_integral(name):
    signals = {"slow": Speed(delay_s=0), "fast": Inverse(of="slow")}
    scene = Scene(canvas=CANVAS, elements=(MOVING[name],), signals=signals)
    program = compile_scene(scene, STRESS2_8X8_ARRAY)
    rng = np.random.default_rng(1)
    time_s = np.cumsum(rng.uniform(0, 0.01, 80))
    x, y = rng.uniform(15, 45, (2, 80))
    velocity = np.repeat(rng.uniform(0, 15, (8, 2)), 10, axis=0)
    made = [
        program.poses(x[part], y[part], 0.0, time_s[part], velocity[part], going_on=part.start > 0)[
            1
        ]
        for part in (slice(0, 33), slice(33, 80))
    ]
    reference = Signals(signals, ["fast"])
    for n, frame in enumerate(np.concatenate(made)):
        values = reference.step(time_s[n] - time_s[n - 1] if n else 0.0, velocity[n], time_s[n])
        places = actuators(STRESS2_8X8_ARRAY, Pose(x[n], y[n], 0.0, 0.0))
        want = twin.deflections(scene, assets_of(), *places, time_s[n], values)
        np.testing.assert_allclose(frame.ravel(), want, rtol=0, atol=1e-6)


def test_what_flows_under_the_finger_does_not_go_by_the_hand():
    flow = Moving(part=LinearGrating(ridge_mm=3), velocity_mm_s=(12, 0), array_at_mm=(30, 30))
    program = compile_scene(Scene(canvas=CANVAS, elements=(flow,)), STRESS2_8X8_ARRAY)
    frame, other = np.zeros((2, 8, 8))
    for time_s in (0.0, 0.1):
        program.frame(30, frame, y_mm=30, time_s=time_s)
        program.frame(21.3, other, y_mm=40.7, time_s=time_s)
        np.testing.assert_allclose(frame, other, atol=1e-9)


def test_the_map_for_a_velocity_is_that_of_signals_without_memory():
    """Lévesque 2009, 9.6."""
    by = SignalLevel(name="slow")
    blend = Group(operation="blend", parts=(Uniform(level=0.2), Uniform(level=0.9)), by=by)
    scene = Scene(canvas=CANVAS, elements=(blend,), signals={"slow": Speed()})
    drawn, at = SceneMap(scene), np.array([30.0])
    for speed, want in ((0, 0.9), (7.5, 0.55), (20, 0.2)):
        velocity = (speed * math.cos(2), speed * math.sin(2))
        shown = drawn.deflections(at, at, velocity_mm_s=velocity)
        np.testing.assert_allclose(shown, want, atol=1e-6)
