"""What is said to those who feel a picture, and what keys do to it."""

import re
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.reading.felt import DISPLAY, SCENE, Felt
from vbraille.engine.record import tick_dtype
from vbraille.live.messages import PagePress, Turn
from vbraille.reading.liveview import FeltState, LastSentences
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
    assert felt.press("w") == ["Sun: It shines."]
    felt.be_at(60, 50)
    assert felt.press("u")[0] == "here: edge of wall"
    assert felt.press("w") == ["wall: polygon, 43 mm × 53 mm with linear grating"]
    felt.be_at(110, 80)
    nothing = ["here: nothing with a name", "nearest: wall, 49 mm left"]
    assert felt.press("i") == [*nothing, "place: 110 mm from the left, 80 mm from the top"]
    assert felt.press("w") == nothing
    assert felt.press("V") == [
        "picture: A house",
        "description: A house and the sun.",
        "size: 120 mm × 90 mm",
    ]
    assert felt.press("O") == [
        "element: Sun, 23 mm × 23 mm, middle 90 mm from the left, 20 mm from the top",
        "element: wall, 43 mm × 53 mm, middle 40 mm from the left, 55 mm from the top",
    ]
    felt.at = None
    assert felt.press("i") == felt.press("w") == ["place: not known yet"]


def test_elements_are_said_on_entering_if_that_is_asked_for(scene):
    felt = Felt(scene)
    assert felt.be_at(90, 20) == []
    assert felt.press("v") == ["entering: said"]
    assert felt.be_at(60, 50) == ["leaving: Sun", "entering: wall"]
    assert felt.be_at(60, 52) == []
    assert felt.be_at(50, 52) == ["on: wall"]
    assert felt.be_at(59, 52) == ["edge: wall"]
    assert felt.be_at(110, 80) == ["leaving: wall"]
    assert felt.be_at(90, 20) == ["entering: Sun"]
    assert felt.press("v") == ["entering: not said"]
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
    assert felt.press("right") == felt.press("e") == ["element: no more"]
    assert felt.press("up") == ["element: Sun"]


def test_a_simulated_hand_glides_within_the_carriage(scene):
    steering = Steering()
    device = Steering(steering.descriptor)
    felt = Felt(scene, steering=steering)
    begun = device.take()
    assert begun == GlideTo(60.0, begun.y_mm, 100.0)  # on the edge of the wall, next to the middle
    felt.be_at(90, 20)
    felt.held = True  # by a page of the live view, which lets it go again
    felt.feeler.step(np.zeros(1, tick_dtype((8, 8))))
    felt.held = False
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
    assert felt.press("\x12") == ["reloaded: A house"]
    felt.bench.run(0.2)
    assert not felt.bench.device.sent[-1].any()
    assert np.abs(np.diff(np.array(felt.bench.device.sent), axis=0)).max() <= 1 / 100 + 1e-9
    felt.be_at(30, 10)
    assert felt.press("i")[0] == "here: edge of Moon"
    felt.bench.run(0.2)
    np.testing.assert_allclose(felt.bench.device.sent[-1], before, atol=1e-9)
    scene.write_text(SCENE.replace("radius_mm = 10", "radius_mm = -10"))
    said = felt.press("\x12")
    assert said[0].startswith("not reloaded: ")
    assert "radius" in said[0]
    assert said[1:] == ["picture: as it was"]
    scene.write_text(SCENE.replace("width_mm = 120", "width_mm = 1200"))
    assert "the scene's canvas is 1200 × 90 mm" in felt.press("\x12")[0]
    scene.unlink()
    assert felt.press("\x12")[0].startswith("not reloaded: ")
    felt.bench.run(0.2)
    np.testing.assert_allclose(felt.bench.device.sent[-1], before, atol=1e-9)
    assert felt.press("i")[0] == "here: edge of Moon"


def test_a_picture_that_has_grown_too_large_is_said(scene):
    felt = Felt(scene, room=1000)
    scene.write_text(SCENE.replace("Sun", "Moon"))
    assert "has become too large" in felt.press("\x12")[0]


def test_what_moves_too_fast_for_the_rate_is_said_with_its_line(scene):
    slow = replace(DISPLAY, rate_hz=80.0)
    felt = Felt(scene, rate_hz=80.0, display=slow)
    scene.write_text(SCENE + "vibration = { frequency_hz = 50 }\n")
    said = felt.press("\x12")[0]
    line = SCENE.splitlines().index('id = "wall"') - 1  # where the element begins
    assert said.startswith(f"not reloaded: {scene} line {line}: ")
    assert said.endswith('element "wall" moves at 50 Hz; it can be at most half of the rate, 40 Hz')
    felt.press("C")  # the whole picture is then a group
    assert felt.press("\x12")[0] == said


def test_on_one_axis_keys_choose_the_height(scene):
    felt = Felt(scene, display=replace(DISPLAY, height_mm=0.0, turns=False))
    felt.bench.run(0.01)
    assert felt.press("shift-up") == ["height: 35 mm from the top"]
    assert felt.bench.run(0.01)["y_mm"][-1] == 35
    assert felt.press(*["shift-up"] * 5)[-1] == "height: 0 mm from the top"
    assert felt.press("g", *"sun", "\n")[-1] == "height: 20 mm from the top"
    assert felt.be_at(80, 20, 1.0) == ["way: 10 mm right"]


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


PLAN = """
canvas = { width_mm = 120, height_mm = 90 }

[[elements]]
kind = "polygon"
title = "Roof"
vertices_mm = [[20, 40], [60, 10], [100, 40]]
stroke = { width_mm = 3 }

[[elements]]
kind = "group"
title = "House"
operation = "overwrite"
parts = [
  { kind = "polygon", vertices_mm = [[20, 40], [100, 40], [100, 85], [20, 85]], stroke = WIDE },
  { kind = "circle", title = "Window", center_mm = [60, 60], radius_mm = 8, stroke = NARROW },
]

[[elements]]
kind = "label"
text = "hut"
place_mm = [5, 5]
""".replace("WIDE", "{ width_mm = 3 }").replace("NARROW", "{ width_mm = 2 }")


@pytest.fixture
def plan(tmp_path):
    """A file of a picture of outlines, with a label."""
    path = tmp_path / "plan.scene"
    path.write_text(PLAN)
    return path


def test_outlines_tell_inside_edge_and_outside(plan):
    felt = Felt(plan, entering=True)
    felt.be_at(110, 5)
    assert felt.press("escape") == ["way: no longer said"]
    assert felt.be_at(60, 10) == ["entering: Roof"]
    assert felt.be_at(60, 25) == ["inside: Roof"]
    assert felt.press("i")[0] == "here: inside Roof"
    assert felt.be_at(60, 45) == ["leaving: Roof", "entering: House"]
    assert felt.be_at(60, 52) == ["entering: Window"]  # the house is around it
    assert felt.be_at(60, 60) == ["inside: Window"]
    assert felt.press("w") == ["Window: circle, 18 mm × 18 mm"]
    assert felt.be_at(60, 75) == ["leaving: Window", "entering: House"]


def test_a_label_says_its_text_and_outlines_are_led_to_where_they_are_felt(plan):
    felt = Felt(plan)
    assert felt.press("O")[-1].startswith("element: hut, ")
    felt.press("g", *"roof", "\n")
    said = felt.be_at(60, 25, 1.0)[0]
    assert said != "there: Roof"  # its middle, where nothing is felt
    felt.press("g", *"hut", "\n")
    felt.be_at(60, 60, 3.0)
    assert felt.press("n") == ["element: no more"]
    assert felt.press("p") == ["element: Window"]
    assert felt.press("p", "p", "p")[-1] == "element: no others before"


WAY = re.compile(r"(\d+) mm (left|right|up|down)")
NAME = re.compile(r"element: (.*), \d+ mm × ")
SCENES = sorted(Path("texts/scenes").rglob("*.scene"))


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_who_only_hears_finds_each_element_of_the_gallery(path):
    """Following the sentences that say the way leads to a place where the element is felt."""
    felt = Felt(path)
    x_mm, y_mm = 1.0, 1.0
    felt.be_at(x_mm, y_mm)
    now_s = 0.0
    for name in [found[1] for said in felt.press("O") if (found := NAME.match(said))]:
        felt.press("g", *name, "\n")
        for _ in range(10):
            now_s += 1.0
            said = felt.be_at(x_mm, y_mm, now_s)
            if said and said[-1].startswith("there: "):
                break
            ways = {way: int(mm) for mm, way in WAY.findall(said[-1])}
            x_mm += ways.get("right", 0) - ways.get("left", 0)
            y_mm += ways.get("down", 0) - ways.get("up", 0)
        assert said[-1].casefold() == f"there: {name}".casefold()
        index = felt.feeler._index
        element = index.find(name)
        x, y = index.point_on(element)
        assert index.where(x, y) is not None, name


def test_a_person_is_led_into_a_picture_whose_middle_is_empty(scene):
    felt = Felt(scene)
    said = felt.be_at(110, 80, 1.0)
    assert WAY.search(said[0])
    assert felt.be_at(60, 45, 2.0) == ["there: picture"]


def test_a_person_whose_finger_is_on_the_picture_is_not_led(scene):
    assert Felt(scene).be_at(90, 20, 1.0) == []


def test_one_axis_begins_at_a_height_where_something_is_felt(scene):
    scene.write_text(
        SCENE.replace("[[20, 30], [60, 30], [60, 80], [20, 80]]", "[[9, 2], [9, 9], [2, 9]]")
    )
    felt = Felt(scene, display=replace(DISPLAY, height_mm=0.0))
    assert 9 <= felt.feeler._at_mm <= 31  # of the sun, and not the empty middle


ANSWERS = """
title = "Streets"
canvas = { width_mm = 120, height_mm = 90 }
[signals.streets]
kind = "switch"
title = "Streets"
levels = [1, 0]
states = ["shown", "hidden"]
[signals.slow]
kind = "speed"
[[elements]]
kind = "line"
title = "Mill Street"
start_mm = [10, 20]
end_mm = [110, 20]
stroke = { width_mm = 4 }
factor = "streets"
[[elements]]
kind = "circle"
title = "Pond"
center_mm = [60, 60]
radius_mm = 10
stroke = { width_mm = 3 }
factor = "slow"
"""


def test_pages_see_signals_and_layers_and_call_the_commands_of_keys(tmp_path):
    path = tmp_path / "streets.scene"
    path.write_text(ANSWERS)
    felt = Felt(path)
    told = FeltState(felt, felt.feeler, LastSentences())
    state = told.changed()
    assert state.scene.image.startswith("data:image/png")
    assert (state.scene.off, state.scene.off_image) == ([], "")
    assert [(signal.name, signal.words) for signal in state.signals] == [
        ("streets", "Streets, key 1: shown 1, hidden 0"),
        (
            "slow",
            "1 under a hand slower than 5 mm/s, 0 from 10 mm/s on; it waits 0.25 s and rises as "
            "long",
        ),
    ]
    names = [command.name for command in state.commands]
    assert names[0] == "PAUSE"
    assert {"ZOOM_IN", "PAN_LEFT", "WHOLE"} <= set(names)
    assert names[-1] == "SWITCH_1"
    assert told.changed() is None

    told.obey(PagePress("SWITCH_1"))
    assert felt.press() == ["Streets: hidden"]
    before, end_s = state, time.monotonic() + 60
    while state is None or not state.scene.off:  # it is drawn meanwhile
        assert time.monotonic() < end_s
        state = told.changed() or state
    assert state.scene.off == ["Mill Street (signal streets)"]
    assert state.scene.off_image.startswith("data:image/png")
    assert state.scene.image != before.scene.image

    told.obey(PagePress("ZOOM_IN"))
    assert any(said.startswith("zoom: ") for said in felt.wait())
    assert told.changed().scene.width_mm > 120
    told.obey(PagePress("PAN_RIGHT"))
    assert felt.press()[-1].startswith("zoom: ")
    told.obey(PagePress("GOTO"))  # which is typed where the reader is
    assert felt.press() == ["live view: GOTO is no command that a page may call"]
    told.obey(Turn("texture", 0.5))
    assert felt.press() == ["live view: knobs turn while a text is under the hand"]
