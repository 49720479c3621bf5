"""What is said to whoever feels a picture, and what keys do to it."""

from dataclasses import replace

import numpy as np
import pytest

from tests.reading.felt import DISPLAY, SCENE, Felt
from vbraille.engine.record import tick_dtype
from vbraille.simulation.steering import GlideTo, Steering


@pytest.fixture
def scene(tmp_path):
    """A file of a picture with two elements."""
    path = tmp_path / "house.scene"
    path.write_text(SCENE)
    return path


def test_it_says_what_is_here_and_more_of_it(scene):
    felt = Felt(scene)
    assert felt.be_at(90, 20) == []
    assert felt.press("i") == ["here: Sun", "place: 90 mm from the left, 20 mm from the top"]
    assert felt.press("d") == ["Sun: It shines."]
    felt.be_at(60, 50)
    assert felt.press("d") == ["wall: no description"]
    felt.be_at(110, 80)
    assert felt.press("i")[0] == "here: nothing with a name"
    assert felt.press("d") == ["here: nothing with a name"]
    assert felt.press("t") == [
        "picture: A house",
        "description: A house and the sun.",
        "size: 120 mm × 90 mm",
    ]
    assert felt.press("e") == [
        "element: Sun, at 90 mm right, 20 mm down",
        "element: wall, at 40 mm right, 55 mm down",
    ]
    felt.at = None
    assert felt.press("i") == ["place: not known yet"]


def test_elements_are_said_on_entering_if_that_is_asked_for(scene):
    felt = Felt(scene)
    assert felt.be_at(90, 20) == []
    assert felt.press("s") == ["entering: said"]
    assert felt.be_at(60, 50) == ["entering: wall"]
    assert felt.be_at(60, 52) == []
    assert felt.be_at(110, 80) == []
    assert felt.be_at(90, 20) == ["entering: Sun"]
    assert felt.press("s") == ["entering: not said"]
    assert felt.be_at(60, 50) == []


def test_a_person_is_told_the_way_to_an_element_each_second_until_there(scene):
    felt = Felt(scene)
    felt.be_at(78, 23)
    assert felt.press("g", *"sun", "\n")[-1] == "element: sun"
    assert felt.be_at(78, 23, 10.0) == ["way: 12 mm right, 3 mm up"]
    assert felt.be_at(80, 23, 10.5) == []
    assert felt.be_at(95, 15, 11.0) == ["way: 5 mm left, 5 mm down"]
    assert felt.be_at(91, 21, 11.1) == ["there: Sun"]
    assert felt.be_at(50, 50, 20.0) == []
    felt.press("g", *"wall", "\n")
    assert felt.press("escape") == ["way: no longer said"]
    assert felt.be_at(10, 10, 30.0) == []
    assert felt.press("right") == ["hand: a person moves this device; move it by hand"]


def test_a_simulated_hand_glides_within_the_carriage(scene):
    steering = Steering()
    device = Steering(steering.descriptor)
    felt = Felt(scene, steering=steering)
    felt.be_at(90, 20)
    felt.press("right", "shift-down")
    assert device.take() == GlideTo(91.0, 30.0, 60.0)
    felt.press(*["shift-up"] * 9)
    assert device.take() == GlideTo(91.0, 0.0, 60.0)
    felt.held = True
    felt.feeler.step(np.zeros(1, tick_dtype((8, 8))))
    felt.press("left")
    assert device.take() == GlideTo(89.0, 20.0, 60.0)
    assert felt.press("g", *"wall", "\n")[-1] == "going to: wall"
    assert device.take() == GlideTo(40.0, 55.0, 100.0)


def test_contrast_scales_the_picture_and_fades(scene):
    felt = Felt(scene)
    felt.be_at(90, 10)
    bench = felt.bench
    bench.run(0.2)
    full = bench.device.sent[-1].copy()
    assert full.max() > 0.9
    assert felt.press("c") == ["contrast: 1"]  # there is no more
    assert felt.press("C", "C")[-1] == "contrast: 0.8"
    bench.run(0.2)
    np.testing.assert_allclose(bench.device.sent[-1], 0.8 * full, atol=1e-12)
    steps = np.abs(np.diff(np.array(bench.device.sent), axis=0))
    assert steps.max() <= 1 / 100 + 1e-9


def test_a_changed_file_fades_in_and_a_broken_one_is_said(scene):
    felt = Felt(scene)
    felt.be_at(90, 10)
    felt.bench.run(0.2)
    before = felt.bench.device.sent[-1].copy()
    scene.write_text(SCENE.replace("[90, 20]", "[30, 20]").replace("Sun", "Moon"))
    assert felt.press("r") == ["reloaded: A house"]
    felt.bench.run(0.2)
    assert not felt.bench.device.sent[-1].any()
    assert np.abs(np.diff(np.array(felt.bench.device.sent), axis=0)).max() <= 1 / 100 + 1e-9
    felt.be_at(30, 10)
    assert felt.press("i")[0] == "here: Moon"
    felt.bench.run(0.2)
    np.testing.assert_allclose(felt.bench.device.sent[-1], before, atol=1e-9)
    scene.write_text(SCENE.replace("radius_mm = 10", "radius_mm = -10"))
    said = felt.press("r")
    assert said[0].startswith("not reloaded: ")
    assert "radius" in said[0]
    assert said[1:] == ["picture: as it was"]
    scene.write_text(SCENE.replace("width_mm = 120", "width_mm = 1200"))
    assert "the scene's canvas is 1200 × 90 mm" in felt.press("r")[0]
    scene.unlink()
    assert felt.press("r")[0].startswith("not reloaded: ")
    felt.bench.run(0.2)
    np.testing.assert_allclose(felt.bench.device.sent[-1], before, atol=1e-9)
    assert felt.press("i")[0] == "here: Moon"


def test_a_picture_that_has_grown_too_large_is_said(scene):
    felt = Felt(scene, room=1000)
    scene.write_text(SCENE.replace("Sun", "Moon"))
    assert "has become too large" in felt.press("r")[0]


def test_what_moves_too_fast_for_the_rate_is_said_with_its_line(scene):
    slow = replace(DISPLAY, rate_hz=80.0)
    felt = Felt(scene, rate_hz=80.0, display=slow)
    scene.write_text(SCENE + "vibration = { frequency_hz = 50 }\n")
    said = felt.press("r")[0]
    line = SCENE.splitlines().index('id = "wall"') - 1  # where the element begins
    assert said.startswith(f"not reloaded: {scene} line {line}: ")
    assert said.endswith('element "wall" moves at 50 Hz; it can be at most half of the rate, 40 Hz')
    felt.press("C")  # the whole picture is then a group
    assert felt.press("r")[0] == said


def test_on_one_axis_keys_choose_the_height(scene):
    felt = Felt(scene, display=replace(DISPLAY, height_mm=0.0, turns=False))
    felt.bench.run(0.01)
    assert felt.press("shift-up") == ["height: 35 mm from the top"]
    assert felt.bench.run(0.01)["y_mm"][-1] == 35
    assert felt.press(*["o"] * 5)[-1] == "height: 0 mm from the top"


def test_pause_learning_and_the_end(scene):
    felt = Felt(scene)
    assert felt.press(" ") == ["paused"]
    assert felt.bench.engine.paused
    assert felt.press(" ") == ["feeling"]
    assert felt.press("?", "i", "q")[1:] == [
        "i: say what is under the finger, and where",
        "learn: off",
    ]
    assert len(felt.press("h")) > 15
    assert not felt.feeler.done
    felt.press("q")
    assert felt.feeler.done
