"""What a scene's picture shows, in words."""

import pytest

from vbraille.pictures.scenes import slowest_s
from vbraille.pictures.scenewords import pattern_words, scene_lines
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Fill,
    Group,
    Image,
    Label,
    Moving,
    Polygon,
    StraightLine,
    Tile,
)
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Direction, Inverse, Product, Pulse, Speed, Switch
from vbraille.scene.strokes import Along, Dotting, MovingCue, Stroke, VertexMarkers, Vibration
from vbraille.scene.textures import (
    AxialGrating,
    LinearGrating,
    RadialGrating,
    SignalLevel,
    Uniform,
    UniformVibration,
)

CANVAS = Canvas(width_mm=100, height_mm=80)


@pytest.mark.parametrize(
    ("pattern", "words"),
    [
        (Uniform(level=0.5, id="a"), "a, uniform deflection 0.5"),
        (UniformVibration(frequency_hz=20), "uniform vibration at 20 Hz"),
        (Uniform(factor="slow"), "uniform deflection 1, times signal slow"),
        (
            Moving(part=SignalLevel(name="slow"), velocity_mm_s=(3, 0), array_at_mm=(0, 0)),
            "signal slow, moving by (3, 0) mm/s, not by the hand",
        ),
        (
            LinearGrating(ridge_mm=2, gap_mm=1, ridge_angle_deg=0, title="waves", id="w"),
            "waves, ridges of 2 mm with gaps of 1 mm, the wave at 90°",
        ),
        (
            LinearGrating(ridge_mm=2, velocity_mm_s=-20, velocity_by="slow"),
            "ridges of 2 mm with gaps of 0 mm, the wave at 0°, moving left at 20 mm/s times signal "
            "slow",
        ),
        (
            LinearGrating(ridge_mm=2, wave_angle_deg=30, velocity_mm_s=9),
            "ridges of 2 mm with gaps of 0 mm, the wave at 30°, moving at 30° (right and down) at "
            "9 mm/s",
        ),
        (
            RadialGrating(center_mm=(1, 2), ridge_mm=2, velocity_mm_s=5),
            "rings: ridges of 2 mm with gaps of 0 mm around (1, 2) mm, moving outward at 5 mm/s",
        ),
        (
            AxialGrating(center_mm=(1, 2), ridge_deg=20, velocity_deg_s=-9),
            "spokes of 20° with gaps of 0° around (1, 2) mm, moving against the clock at 9 °/s",
        ),
        (
            RadialGrating(center_mm=(1, 2), ridge_mm=2, inverted=True),
            "rings: ridges of 2 mm with gaps of 0 mm around (1, 2) mm, inverted",
        ),
        (
            AxialGrating(center_mm=(1, 2), ridge_deg=20, amplitude=0.5),
            "spokes of 20° with gaps of 0° around (1, 2) mm, amplitude 0.5",
        ),
        (
            StraightLine(start_mm=(0, 0), end_mm=(9, 0), stroke=Stroke(width_mm=3, along=Along())),
            "line from (0, 0) mm to (9, 0) mm, stroke of 3 mm cut every 2 mm",
        ),
        (
            StraightLine(
                start_mm=(0, 0),
                end_mm=(9, 0),
                dots=Dotting(velocity_mm_s=-5, velocity_by="on"),
                cue=MovingCue(),
            ),
            "line from (0, 0) mm to (9, 0) mm, of dots of radius 1 mm, moving from its end to its "
            "beginning at 5 mm/s times signal on, under bands every 17 mm, moving along it at 50 "
            "mm/s",
        ),
        (Dots(centers_mm=((1, 1), (2, 2))), "2 dots of radius 1 mm"),
        (Label(text="sun\n", place_mm=(3, 4)), 'braille "sun " at (3, 4) mm'),
        (
            Tile(width_mm=5, height_mm=4, part=Uniform()),
            "tiles of 5 × 4 mm with uniform deflection 1",
        ),
        (
            Group(operation="multiply", parts=(Uniform(), UniformVibration())),
            "2 parts, each masking the others (uniform deflection 1; uniform vibration at 50 Hz)",
        ),
        (Image(file="a\x1b.png"), "image a\\x1b.png at (0, 0) mm"),
    ],
)
def test_each_pattern_has_words(pattern, words):
    assert pattern_words(pattern) == words


def test_a_scene_says_what_vibrates_once_for_each_element():
    triangle = Polygon(
        vertices_mm=((0, 0), (9, 0), (0, 9)),
        id="roof",
        stroke=Stroke(vibration=Vibration(frequency_hz=20)),
        markers=VertexMarkers(),
        fill=Fill(texture=UniformVibration(frequency_hz=20)),
    )
    ring = Circle(center_mm=(5, 5), radius_mm=4, dots=Dotting(vertex_vibration=None))
    scene = Scene(canvas=CANVAS, title="House", elements=(ring, triangle), operation="maximum")
    lines = scene_lines(scene)
    assert lines[0] == "title: House"
    assert lines[1] == "size: 100 × 80 mm"
    assert lines[2] == "elements: 2, the largest of them"
    assert lines[-1] == "vibrates: element roof, 20 Hz, 50 Hz"
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
    assert "blended by signal slow (" in lines[2]
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
