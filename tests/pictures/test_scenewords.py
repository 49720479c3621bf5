"""What a scene's picture shows, in words."""

import pytest

from vbraille.pictures.scenes import slowest_s
from vbraille.pictures.scenewords import pattern_words, scene_lines
from vbraille.scene.patterns import (
    Along,
    Circle,
    Dotting,
    Fill,
    Group,
    Image,
    Label,
    LinearGrating,
    Moving,
    Polygon,
    SignalLevel,
    StraightLine,
    Stroke,
    Uniform,
    UniformVibration,
    Vibration,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch

CANVAS = Canvas(width_mm=100, height_mm=80)


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        (Uniform(level=0.5, id="a"), "a, uniform, level 0.5"),
        (UniformVibration(), "vibration, frequency 50 Hz"),
        (
            LinearGrating(ridge_mm=2, velocity_mm_s=-20, velocity_by="slow", inverted=True),
            "linear grating, ridge 2 mm, velocity -20 mm/s, velocity by slow, inverted",
        ),
        (
            StraightLine(start_mm=(0, 0), end_mm=(9, 0), stroke=Stroke(width_mm=3, along=Along())),
            "line, stroke (width 3 mm, along (ridge 2 mm)), start 0, 0 mm, end 9, 0 mm",
        ),
        (Label(text="sun\n", place_mm=(3, 4)), "label, text sun , place 3, 4 mm"),
        (
            Group(operation="multiply", parts=(Uniform(), UniformVibration())),
            "group, operation multiply, 2 parts (uniform, level 1; vibration, frequency 50 Hz)",
        ),
        (Image(file="a\x1b.png"), "image, file a\\x1b.png"),
    ],
)
def test_each_pattern_has_words(pattern, words):
    assert pattern_words(pattern) == words


def test_a_scene_says_what_vibrates_once_for_each_element():
    triangle = Polygon(
        vertices_mm=((0, 0), (9, 0), (0, 9)),
        id="roof",
        stroke=Stroke(vibration=Vibration(frequency_hz=20)),
        fill=Fill(texture=UniformVibration(frequency_hz=20)),
    )
    ring = Circle(center_mm=(5, 5), radius_mm=4, dots=Dotting(vertex_vibration=None))
    scene = Scene(canvas=CANVAS, title="House", elements=(ring, triangle), operation="maximum")
    lines = scene_lines(scene)
    assert lines[0] == "title: House"
    assert lines[1] == "size: 100 × 80 mm"
    assert lines[2] == "elements: 2, the largest of them"
    assert lines[-1] == "vibrates: element roof, 20 Hz"
    assert slowest_s(scene) == pytest.approx(0.05)


def test_a_scene_that_stands_still_says_so():
    scene = Scene(canvas=CANVAS, elements=(LinearGrating(ridge_mm=3),))
    assert scene_lines(scene)[-1] == "vibrates: nothing"
    assert slowest_s(scene) is None
    moving = Scene(canvas=CANVAS, elements=(LinearGrating(ridge_mm=3, velocity_mm_s=-6),))
    assert slowest_s(moving) == pytest.approx(0.5)
    whole = Moving(part=LinearGrating(ridge_mm=2, gap_mm=1), velocity_mm_s=(0, -6))
    assert slowest_s(Scene(canvas=CANVAS, elements=(whole,))) == pytest.approx(0.5)


def test_signals_say_when_they_are_1_and_what_is_blended_by_them():
    blend = Group(
        operation="blend", parts=(Uniform(), Uniform(level=0)), by=SignalLevel(name="slow")
    )
    signals = {
        "slow": Speed(delay_s=0),
        "late": Speed(),
        "axis": Direction(angle_deg=45, axis=True, at_rest="low"),
        "on": Switch(title="Streets", levels=(1, 0), states=("shown", "hidden")),
        "beat": Pulse(shape="ramp", period_s=2),
        "both": Product(of=("slow", "on")),
        "not": Inverse(of="both"),
    }
    lines = scene_lines(Scene(canvas=CANVAS, elements=(blend,), signals=signals))
    assert "by (signal, name slow)" in lines[2]
    assert lines[3:-1] == [
        "signal slow: 1 under a hand slower than 5 mm/s, 0 from 10 mm/s on",
        "signal late: 1 under a hand slower than 5 mm/s, 0 from 10 mm/s on; it waits 0.25 s and "
        "rises as long",
        "signal axis: 1 under a hand that goes right and down or left and up within 30°, 0 from "
        "50° on, 0 at rest",
        "signal on: Streets, key 1: shown 1, hidden 0",
        "signal beat: ramp, again every 2 s",
        "signal both: slow × on",
        "signal not: 1 - both",
    ]
