"""Signals against the velocity of the hand: values are those of the equations, in words too."""

from pathlib import Path

import numpy as np
import pytest

from tests.render.scene.twinsignals import Signals
from vbraille.errors import InputError
from vbraille.pictures.loading import with_assets
from vbraille.pictures.maps import MapRequest, draw_map
from vbraille.render import STRESS2_8X8
from vbraille.scene.converting import write_scene
from vbraille.scene.reading import open_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch

SIGNALS = {
    "slow": Speed(below_mm_s=10, transition_mm_s=30),
    "along": Direction(angle_deg=30, axis=True, at_rest="low", below_mm_s=5),
    "onward": Direction(angle_deg=-90, at_rest="high"),
    "key": Switch(levels=(1.0, 0.4)),
    "beat": Pulse(),
    "both": Product(of=("slow", "along", "key", "beat")),
    "neither": Inverse(of="both"),
}


@pytest.fixture
def loaded(tmp_path):
    path = tmp_path / "answers.scene"
    path.write_text(write_scene(Scene(canvas=Canvas(width_mm=50, height_mm=40), signals=SIGNALS)))
    return with_assets(open_scene(path), STRESS2_8X8.style)


def drawn(loaded, name, states=None):
    """Velocities and values of a signal, and what is said of it."""
    request = MapRequest("csv", STRESS2_8X8, switches=states or {}, signal=name)
    [(_, content)], (_, *said) = draw_map(loaded, request, Path("a.csv"))
    header, *rows = b"".join(content).decode().splitlines()
    assert header == "x_mm_s,y_mm_s,value"
    return np.array([row.split(",") for row in rows], float), said


@pytest.mark.parametrize("name", ["slow", "along", "onward", "both", "neither"])
def test_the_plot_has_the_signal_of_the_equations_at_each_velocity(loaded, name, rng):
    states = {1: 1}
    values, _ = drawn(loaded, name, states)
    steady = SIGNALS | {"beat": Switch(levels=(1.0, 1.0))}
    for x, y, value in rng.choice(values, 200):
        want = Signals(steady).step(0.0, (x, y), states=states)[name]
        assert value == pytest.approx(want, abs=1e-4), (x, y)


def test_words_say_what_the_plot_shows(loaded):
    _, lines = drawn(loaded, "onward")
    assert lines[2] == (
        "signal onward: 1 under a hand that goes up within 30°, 0 from 50° on, 1 at rest"
    )
    assert lines[3] == "at 0 mm/s: 1.00"
    assert lines[-1].startswith("at 6.25 mm/s: right 0.00, right and down 0.00, down 0.00")
    assert lines[-1].endswith("left and up 0.25, up 1.00, right and up 0.25")
    assert "in all directions" in drawn(loaded, "slow")[1][-1]
    assert "time: pulses are taken as 1" in drawn(loaded, "both")[1]


@pytest.mark.parametrize(
    ("name", "problem"),
    [
        ("other", "has no signal 'other'; its signals are: slow, along"),
        ("key", "does not depend on the velocity"),
        ("beat", "does not depend on the velocity"),
    ],
)
def test_signals_that_no_hand_changes_are_refused(loaded, name, problem):
    with pytest.raises(InputError, match=problem):
        drawn(loaded, name)
