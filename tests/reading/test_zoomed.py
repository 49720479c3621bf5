"""Zoom and pan of a picture that is felt: what is said, where keys lead, and what is sent."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.reading.felt import DISPLAY, SCENE, Felt
from tests.tiers import heavy
from vbraille.engine.constants import CATCH_UP
from vbraille.feeling.aperture import ZOOMS, Aperture
from vbraille.scene.scene import Canvas
from vbraille.simulation.steering import GlideTo, Steering

REACH = DISPLAY.travel_mm, DISPLAY.height_mm


@pytest.fixture
def scene(tmp_path):
    path = tmp_path / "house.scene"
    path.write_text(SCENE)
    return path


def zoomed(felt, *keys):
    felt.press(*keys)
    return felt.wait()


def test_zoom_keeps_the_place_under_the_finger(scene):
    felt = Felt(scene)
    felt.be_at(88, 22)
    before = felt.press("i")
    for key in "+++--=-0":
        zoomed(felt, key)
        if key != "0":
            assert felt.press("i") == before
    assert felt.feeler.aperture.is_whole


def test_zoom_and_what_is_within_reach_are_said(scene):
    felt = Felt(scene)
    felt.be_at(60, 45)
    (said,) = zoomed(felt, "+", "+", "+")  # the one before is not made any more, or at once
    width, height = REACH
    left, top = 60 - 60 / 3, 45 - 45 / 3
    assert said == (
        f"zoom: 3, within reach {left:.0f} to {min(left + width / 3, 120):.0f} mm from the left, "
        f"{top:.0f} to {min(top + height / 3, 90):.0f} mm from the top"
    )
    assert felt.press("z") == [said]
    assert felt.press("V")[-1] == said
    (whole,) = felt.press("0")
    assert whole.startswith("zoom: 1, within reach 0 to 120 mm")


def test_zooms_end(scene):
    felt = Felt(scene)
    for _ in ZOOMS:
        zoomed(felt, "+")
    assert felt.press("+") == ["zoom: 16, no nearer"]
    for _ in ZOOMS:
        zoomed(felt, "-")
    assert felt.press("-") == ["zoom: 0.5, no farther"]


def test_what_is_felt_keeps_its_size_and_what_is_said_that_of_the_picture(scene):
    felt = Felt(scene)
    felt.be_at(60, 50)  # on the right edge of the wall, whose stroke is 3 mm wide
    zoomed(felt, "+", "+", "+", "+")
    assert felt.feeler.aperture.zoom == 4
    assert felt.press("i")[0] == "here: edge of wall"
    felt.be_at(61.4, 50)
    assert felt.press("i")[0] == "here: edge of wall"
    felt.be_at(62, 50)  # half a millimetre of the picture away
    assert felt.press("i") == [
        "here: nothing with a name",
        "nearest: wall, 1 mm left",
        "place: 60 mm from the left, 50 mm from the top",
    ]
    sizes = [re.search(r"(\d+) mm × (\d+) mm", one) for one in felt.press("O")]
    assert [one[0] for one in sizes] == ["21 mm × 21 mm", "41 mm × 51 mm"]


def test_pan_goes_as_far_as_there_is_canvas(scene):
    felt = Felt(scene, display=replace(DISPLAY, travel_mm=120.0, height_mm=90.0))
    felt.be_at(60, 45)
    assert felt.press("]")[0].startswith("zoom: 1, within reach 0 to 120 mm")
    zoomed(felt, "+", "+")
    assert felt.feeler.aperture == Aperture((120.0, 90.0), 2.0, 60.0, 45.0)
    place = felt.press("i")[-1]
    assert felt.press("ctrl-right") == [
        "zoom: 2, within reach 60 to 120 mm from the left, 22 to 68 mm from the top"
    ]
    assert felt.press("i")[-1] == place.replace("60 mm", "90 mm")
    assert felt.feeler.aperture.left_mm == 120.0
    felt.press("]", "]", "}", "}", "}")
    assert (felt.feeler.aperture.left_mm, felt.feeler.aperture.top_mm) == (120.0, 90.0)
    felt.press(*"[[[[", *"{{{{")
    assert (felt.feeler.aperture.left_mm, felt.feeler.aperture.top_mm) == (0.0, 0.0)


def test_a_pan_compiles_nothing(scene, monkeypatch):
    felt = Felt(scene)
    zoomed(felt, "+", "+", "+", "+")
    monkeypatch.setattr("vbraille.reading.sceneview.compose", None)
    felt.press("]", "}", "[")
    assert felt.feeler.place is not None
    felt.press("0")  # nor does the way back to the whole


def test_elements_out_of_reach_are_brought_within(scene):
    steering = Steering()
    device = Steering(steering.descriptor)
    felt = Felt(scene, steering=steering, display=replace(DISPLAY, travel_mm=120, height_mm=90))
    felt.at = (60.0, 45.0)
    felt.bench.run(0.001)
    for _ in range(6):
        zoomed(felt, "+")
    device.take()
    said = felt.press("n")
    assert said[0] == "going to: Sun"
    assert said[1].startswith("zoom: 8, within reach")
    glide = device.take()
    assert isinstance(glide, GlideTo)
    felt.at = (glide.x_mm, glide.y_mm)
    assert felt.press("i")[0] == "here: Sun"
    assert 0 <= glide.x_mm <= 120
    assert 0 <= glide.y_mm <= 90


def test_the_way_is_that_of_the_hand(scene):
    felt = Felt(scene)
    felt.be_at(78, 20)
    felt.press("g", *"sun", "\n")
    assert felt.be_at(78, 20, 10.0) == ["way: 12 mm right"]
    zoomed(felt, "+", "+")
    assert felt.be_at(78, 20, 20.0) == ["way: 24 mm right"]


def test_a_picture_of_one_axis_is_zoomed_at_its_height(scene):
    felt = Felt(scene, display=replace(DISPLAY, height_mm=0.0))
    felt.at = (60.0, 0.0)
    said = felt.press("g", *"wall", "\n")
    height = next(one for one in said if one.startswith("height: "))
    felt.at = (60.0, felt.feeler._program.own_y_mm)
    zoomed(felt, "+", "+")
    assert felt.feeler._at_mm == 2 * float(height.split()[1])
    felt.at = (felt.at[0], felt.feeler._at_mm)
    assert felt.press("i")[-1].endswith(height.removeprefix("height: "))
    felt.press("]")
    assert felt.feeler.aperture.top_mm == 0.0


def test_a_picture_that_would_be_too_large_stays_as_it_was(scene):
    felt = Felt(scene, room=10_000)
    assert (
        zoomed(felt, "+", "+", "+", "+", "+", "+")[-1]
        == "zoom: still 1; the picture would be too large there"
    )
    assert felt.feeler.aperture.is_whole


def test_a_file_that_changes_is_read_again_at_the_same_zoom(scene):
    felt = Felt(scene)
    felt.be_at(88, 22)
    zoomed(felt, "+", "+")
    scene.write_text(SCENE.replace('title = "Sun"', 'title = "Moon"'))
    assert felt.press("\x12") == ["reloaded: A house"]
    assert felt.press("i")[0] == "here: Moon"
    assert felt.feeler.aperture.zoom == 2


def test_the_next_element_is_the_next_at_another_zoom_too(scene):
    felt = Felt(scene)
    assert felt.press("n")[0] == "element: Sun"
    zoomed(felt, "+")
    assert felt.press("n")[0] == "element: wall"


def test_what_is_sent_never_jumps(scene):
    felt = Felt(scene)
    felt.at = (60.0, 50.0)
    felt.bench.run(0.3)
    for key in ("+", "]", "}", "-", "0", "+", "+", "[", "c", "0"):
        felt.press(key)
        felt.wait()
        felt.bench.run(0.13)
    steps = np.abs(np.diff(felt.bench.sent, axis=0))
    # A fade takes 0.1 s, so that full swing goes by a hundredth in a tick; still the hand is.
    assert 0.001 < steps.max() <= 0.0101


@pytest.mark.parametrize("reach", [(120.0, 90.0), (120.0, 0.0)])
def test_an_aperture_goes_to_and_fro(reach):
    aperture = Aperture(reach, 3.0, 12.5, 0.0 if not reach[1] else -7.0)
    assert aperture.of_carriage(*aperture.on_canvas(3.0, 4.0)) == (3.0, 4.0)
    there = aperture.zoomed(6.0, (10.0, 20.0))
    back = there.zoomed(3.0, (10.0, 20.0))
    assert (back.left_mm, back.top_mm) == pytest.approx((aperture.left_mm, aperture.top_mm))
    near = np.array(aperture.on_canvas(10.0, 20.0)) / 3.0
    far = np.array(there.on_canvas(10.0, 20.0)) / 6.0
    assert near[0] == pytest.approx(far[0])


def test_a_picture_smaller_than_the_reach_is_moved_within_it():
    aperture = Aperture((100.0, 100.0), 0.5)
    canvas = Canvas(width_mm=50, height_mm=50)
    moved = aperture.panned(0.5, 0.0, canvas)
    assert moved == aperture
    moved = aperture.panned(-0.5, 0.0, canvas)
    assert (moved.left_mm, moved.top_mm) == (-50.0, 0.0)


LAYERS = """
canvas = { width_mm = 120, height_mm = 90 }

[signals.land]
kind = "switch"
levels = [1, 0.3, 0]

[signals.sea]
kind = "inverse"
of = "land"

[[elements]]
kind = "linear-grating"
ridge_mm = 4
factor = "sea"

[[elements]]
kind = "circle"
title = "Island"
center_mm = [60, 50]
radius_mm = 20
stroke = { width_mm = 4 }
fill = { texture = { kind = "use", name = "stock:dots" } }
factor = "land"

[[elements]]
kind = "use"
name = "stock:linear-45"
zoom_from = 3
"""


# Everything that moves by itself, so slowly that what its period asks for is known.
MOVING_MM_S = 5.0
MOVING = f"""
canvas = {{ width_mm = 120, height_mm = 90 }}

[signals.on]
kind = "switch"
levels = [1, 0]

[[elements]]
kind = "moving"
velocity_mm_s = [3, 4]
array_at_mm = [0, 0]
part = {{ kind = "linear-grating", ridge_mm = 5, wave_angle_deg = 53 }}
factor = "on"

[[elements]]
kind = "radial-grating"
center_mm = [20, 20]
ridge_mm = 4
velocity_mm_s = {MOVING_MM_S}
factor = "on"
zoom_from = 3

[[elements]]
kind = "circle"
title = "Ring of dots"
center_mm = [60, 50]
radius_mm = 12
dots = {{ dot = {{ radius_mm = 2 }}, velocity_mm_s = {MOVING_MM_S}, velocity_by = "on" }}

[[elements]]
kind = "line"
title = "Row of dots"
start_mm = [55, 45]
end_mm = [75, 58]
dots = {{ dot = {{ radius_mm = 1.5 }}, velocity_mm_s = {MOVING_MM_S} }}

[[elements]]
kind = "polygon"
title = "Texture"
vertices_mm = [[40, 30], [80, 35], [70, 75]]
stroke = {{ width_mm = 4, along = {{ ridge_mm = 3, velocity_mm_s = {MOVING_MM_S} }} }}
cue = {{ way = "mask", ridge_mm = 3, width_mm = 2, velocity_mm_s = {MOVING_MM_S} }}

[[elements]]
kind = "line"
title = "Cue"
start_mm = [30, 52]
end_mm = [90, 48]
stroke = {{ width_mm = 3 }}
cue = {{ way = "blend", ridge_mm = 3, velocity_mm_s = {MOVING_MM_S}, velocity_by = "on" }}
"""


def felt_at_random(path, frames, seed):
    """Keys, poses that do not come and carriages that are lost, at random; largest steps."""
    rng = np.random.default_rng(seed)
    felt = Felt(path)
    felt.at = (60.0, 50.0)
    felt.bench.run(0.3)
    largest = [0.0]
    while frames > 0:
        key = rng.choice([*"++--]}[{0", "1", "1", "c", "C", "silent", "elsewhere"])
        if key == "silent":
            felt.bench.device.place = lambda _: None
        elif key == "elsewhere":
            felt.at = tuple(rng.uniform((0.0, 0.0), (120.0, 90.0)).tolist())
        else:
            felt.press(key)
            felt.wait()
        begin = len(felt.bench.device.sent) - 1
        count = int(rng.integers(1, 150))
        felt.bench.run(count / 1000)
        felt.bench.device.place = lambda _: (*felt.at, 0.0)
        frames -= count
        largest.append(np.abs(np.diff(felt.bench.device.sent[begin:], axis=0)).max())
    return np.array(largest)


@pytest.mark.parametrize("frames", [2_000, pytest.param(100_000, marks=heavy)])
def test_nothing_jumps_by_switches_pans_and_troubles(tmp_path, frames):
    path = tmp_path / "a.scene"
    path.write_text(LAYERS)
    largest = felt_at_random(path, frames, seed=32)
    # A fade of 0.1 s, which goes quicker where poses were late, and in it another by a switch.
    assert 0.005 < largest.max() <= 0.01 * (CATCH_UP + 1.0) + 1e-6


@pytest.mark.parametrize("frames", [2_000, pytest.param(100_000, marks=heavy)])
def test_what_moves_by_itself_jumps_no_more_than_its_period_asks_for(tmp_path, frames):
    path = tmp_path / "a.scene"
    path.write_text(MOVING)
    largest = felt_at_random(path, frames, seed=33)
    # The steepest of them, a ridge of 3 mm cut by bands of 3 mm, in a millisecond.
    period = MOVING_MM_S / 1000 * 2 * np.pi / 3
    assert 0.005 < largest.max() <= 0.01 * (CATCH_UP + 1.0) + period + 1e-6
