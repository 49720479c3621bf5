"""Signals against the velocity of the hand: values are those of the equations, in words too."""

import math

import numpy as np
import pytest

from tests.render.scene.twinsignals import Signals
from vbraille.errors import InputError
from vbraille.pictures.blending import blending, blending_csv, blending_figure, blending_words
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch, packed

SIGNALS = {
    "slow": Speed(below_mm_s=10, transition_mm_s=30),
    "along": Direction(angle_deg=30, axis=True, at_rest="low", below_mm_s=5),
    "onward": Direction(angle_deg=-90, at_rest="high"),
    "key": Switch(levels=(1.0, 0.4)),
    "beat": Pulse(),
    "both": Product(of=("slow", "along", "key", "beat")),
    "neither": Inverse(of="both"),
}
SCENE = Scene(canvas=Canvas(width_mm=50, height_mm=40), signals=SIGNALS)


@pytest.mark.parametrize("name", ["slow", "along", "onward", "both", "neither"])
def test_the_plot_has_the_signal_of_the_equations_at_each_velocity(name, rng):
    states = {1: 1}
    shown = blending(SCENE, name, packed(states, SIGNALS))
    assert shown.values.shape == (shown.speeds_mm_s.size, shown.angles_deg.size)
    steady = SIGNALS | {"beat": Switch(levels=(1.0, 1.0))}
    for _ in range(200):
        row, column = (int(rng.integers(size)) for size in shown.values.shape)
        speed, angle = shown.speeds_mm_s[row], math.radians(shown.angles_deg[column])
        twin = Signals(steady)
        velocity = speed * math.cos(angle), speed * math.sin(angle)
        want = twin.step(0.0, velocity, states=states)[name]
        assert shown.values[row, column] == pytest.approx(want, abs=1e-9), (speed, angle)
    # All that speed changes is in the plot.
    np.testing.assert_allclose(shown.values[-1], shown.values[-5], atol=1e-12)


def test_words_and_csv_say_what_the_plot_shows():
    shown = blending(SCENE, "onward")
    lines = blending_words(shown)
    assert lines[2] == (
        "signal onward: 1 under a hand that goes up within 30°, 0 from 50° on, 1 at rest"
    )
    assert lines[3] == "at 0 mm/s: 1.00"
    assert lines[-1].startswith("at 6.25 mm/s: right 0.00, right and down 0.00, down 0.00")
    assert lines[-1].endswith("left and up 0.25, up 1.00, right and up 0.25")
    assert "in all directions" in blending_words(blending(SCENE, "slow"))[-1]
    assert "time: pulses are taken as 1" in blending_words(blending(SCENE, "both"))
    header, *rows = blending_csv(shown).decode().splitlines()
    assert header == "speed_mm_s,direction_deg,value"
    values = np.array([row.split(",") for row in rows], float)
    assert values[-1].tolist() == [6.25, 357.5, 0]
    np.testing.assert_allclose(values[:, 2], shown.values.ravel(), atol=1e-6)


def test_right_is_at_the_right_and_down_below():
    (axes,) = blending_figure(blending(SCENE, "onward")).axes
    at = axes.transData.transform([(math.radians(angle), 5.0) for angle in (0, 90, 180, 270)])
    right, down, left, up = at.tolist()
    assert right[0] > down[0] > left[0]
    assert up[1] > right[1] > down[1]


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("other", "has no signal 'other'; its signals are: slow, along"),
        ("key", "does not depend on the velocity"),
        ("beat", "does not depend on the velocity"),
    ],
)
def test_signals_that_no_hand_changes_are_refused(name, problem):
    with pytest.raises(InputError, match=problem):
        blending(SCENE, name)
