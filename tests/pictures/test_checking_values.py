"""Advice of `vbraille scene check` on the values of a picture, such as vibrations that meet."""

from pathlib import Path

import pytest

from vbraille.pictures.checking import check_scene
from vbraille.pictures.loading import with_assets
from vbraille.render import MODELS
from vbraille.scene.locations import Locations, OpenedScene
from vbraille.scene.patterns import (
    Along,
    Circle,
    Dotting,
    Fill,
    Group,
    LinearGrating,
    Moving,
    MovingCue,
    Polygon,
    Stroke,
    Tile,
    Uniform,
    UniformVibration,
    VertexMarkers,
    Vibration,
)
from vbraille.scene.reading import resolve
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.signals import Inverse, Pulse, Speed, Switch

LATERO = Canvas(width_mm=280, height_mm=217)
MID = Vibration(frequency_hz=25.0)


def report(*elements, canvas=LATERO, operation="overwrite", **textures):
    return checked(Scene(canvas=canvas, operation=operation, elements=elements, textures=textures))


def checked(written):
    opened = OpenedScene(Path("a.scene"), Path(), written, resolve(written), Locations())
    return check_scene(with_assets(opened, MODELS["stress2"].style))


def advice(*elements, **more):
    return report(*elements, **more).advice


def circle(x=50.0, y=50.0, radius=10.0, **more):
    return Circle(center_mm=(x, y), radius_mm=radius, **{"stroke": Stroke(), **more})


def group(operation, *parts, **more):
    return Group(operation=operation, parts=parts, **more)


def hum(frequency_hz=50.0):
    return UniformVibration(frequency_hz=frequency_hz)


FINE = LinearGrating(ridge_mm=4.0)


VIBRATING = {
    "of the pattern": circle(vibration=MID),
    "of the stroke": circle(stroke=Stroke(vibration=MID)),
    "of the dots at corners": Polygon(
        vertices_mm=((0, 0), (50, 0), (50, 50)), dots=Dotting(vertex_vibration=MID)
    ),
    "of markers": Polygon(
        vertices_mm=((0, 0), (50, 0), (50, 50)),
        stroke=Stroke(),
        markers=VertexMarkers(vibration=MID),
    ),
    "of a tile": Tile(width_mm=20, height_mm=20, part=hum(25.0)),
    "of a part": group("overwrite", circle(), hum(25.0)),
}


@pytest.mark.parametrize("name", VIBRATING)
def test_whatever_vibrates_is_found(name):
    (element,) = report(VIBRATING[name]).elements
    assert element.vibration_hz == (25.0,)


MEETING = {
    "masked": (
        group("multiply", hum(50), hum(10)),
        "masks a vibration of 50 Hz with one of 10 Hz, and they beat or make sharp peaks",
    ),
    "added": (group("add", hum(), hum()), "adds a vibration of 50 Hz to one of 50 Hz, and the sum"),
    "the larger": (group("maximum", hum(), hum(20)), "takes the larger of vibrations of 50 Hz and"),
    "blended by": (
        group("blend", FINE, FINE, by=hum(30)),
        "blends by a pattern that vibrates at",
    ),
    "as a whole": (
        group("overwrite", hum(50), vibration=MID),
        "vibrates as a whole at 25 Hz, and what is in it at 50 Hz; leave one",
    ),
    "a stroke near its fill": (
        circle(stroke=Stroke(vibration=MID), fill=Fill(texture=FINE, gap_mm=1.0)),
        "has a fill that begins 1 mm from a stroke that vibrates, which drowns what is near",
    ),
}


@pytest.mark.parametrize("name", MEETING)
def test_vibrations_that_meet_are_told(name):
    element, sentence = MEETING[name]
    said = [one for one in advice(element) if "cannot be told apart" not in one]
    (one,) = said
    assert one.startswith("elements, number 1: element 1, ")
    assert sentence in one


QUIET = {
    "overwriting": group("overwrite", hum(), circle(vibration=MID)),
    "one of them": group("multiply", hum(), FINE),
    "weighted": Group(operation="weighted", parts=(hum(), hum()), weights=(0.5, 0.5)),
    "blended": group("blend", hum(), FINE, by=FINE),
    "apart": group("maximum", circle(vibration=MID), circle(y=150, vibration=MID)),
    "a fill far enough": circle(stroke=Stroke(vibration=MID), fill=Fill(texture=FINE, gap_mm=2.5)),
}


@pytest.mark.parametrize("name", QUIET)
def test_vibrations_that_do_no_harm_are_not_told(name):
    said = advice(QUIET[name])
    assert [one for one in said if "cannot be told apart" not in one] == []


def test_the_elements_of_the_scene_are_put_together_too():
    said = advice(circle(vibration=MID), circle(vibration=MID), operation="add")
    assert said[0].startswith("the scene adds a vibration of 25 Hz to one of 25 Hz")
    assert not advice(circle(vibration=MID), circle(vibration=MID))


def test_frequencies_that_cannot_be_told_apart_are_told():
    assert advice(group("overwrite", hum(50), hum(35))) == (
        "vibrations of 35 and 50 Hz cannot be told apart; set them 20 Hz apart or more",
    )
    assert not advice(group("overwrite", hum(50), hum(30)))


ADVICE = {
    "outside": (circle(x=-30), "is wholly outside the canvas, and cannot be felt; move it"),
    "partly outside": (circle(x=5), "reaches 7.0 mm beyond the canvas"),
    "nowhere": (
        group("multiply", circle(), circle(y=150)),
        "can nowhere be felt; its parts have no place in common",
    ),
    "a thin stroke": (circle(stroke=Stroke(width_mm=1.0)), "has a stroke of 1 mm; from 2 to 10 mm"),
    "a fine grating": (
        circle(fill=Fill(texture=LinearGrating(ridge_mm=1.5))),
        "has a grating of 1.5 mm, which is felt as noise; 2 to 15 mm are felt best",
    ),
    "a coarse grating": (
        LinearGrating(ridge_mm=10, gap_mm=6),
        "has a grating of 16 mm, which is felt weakly; 2 to 15 mm are felt best",
    ),
    "a quick flow": (
        circle(fill=Fill(texture=LinearGrating(ridge_mm=3, gap_mm=2, velocity_mm_s=-40))),
        "has a grating that moves by 8 waves a second; 1 to 5 are felt best",
    ),
    "what moves quickly as a whole": (
        Moving(part=LinearGrating(ridge_mm=5, wave_angle_deg=90), velocity_mm_s=(90, -30)),
        "has a grating that moves by 6 waves a second",
    ),
    "dots that move quickly": (
        circle(stroke=None, dots=Dotting(velocity_mm_s=-18)),
        "has a row of dots that moves by 6 waves a second",
    ),
    "a cue that moves quickly": (
        circle(stroke=Stroke(), cue=MovingCue(velocity_mm_s=102)),
        "has a cue that moves by 6 waves a second",
    ),
    "a quick flow along a stroke": (
        circle(stroke=Stroke(along=Along(ridge_mm=2, velocity_mm_s=12))),
        "has a grating along a stroke that moves by 6 waves a second",
    ),
}


@pytest.mark.parametrize("name", ADVICE)
def test_what_is_hard_to_feel_is_told(name):
    element, sentence = ADVICE[name]
    (said,) = advice(element)
    assert said.startswith("elements, number 1: element 1, ")
    assert sentence in said


def test_what_holds_for_many_elements_is_said_once():
    thin = [circle(x=40.0 * n + 20, stroke=Stroke(width_mm=1.0)) for n in range(6)]
    (said,) = advice(*thin)
    assert "element 1, circle (and 5 others) has a stroke of 1 mm" in said


def test_a_texture_on_top_hides_all_below_it():
    (said,) = advice(circle(), FINE)
    assert "element 2, linear-grating is everywhere, and hides all elements before it" in said
    assert not advice(FINE, circle())
    assert not advice(circle(), FINE, operation="maximum")


def test_a_canvas_that_no_carriage_reaches_is_told():
    (said,) = advice(circle(), canvas=Canvas(width_mm=291, height_mm=200))
    assert said.startswith("canvas is larger than any known carriage reaches; the largest, the Lat")
    assert not advice(circle(), canvas=Canvas(width_mm=280, height_mm=217))


def test_more_than_five_textures_are_told_and_places_make_no_difference():
    def filled(number, ridge_mm, start_mm=(0.0, 0.0)):
        texture = LinearGrating(ridge_mm=ridge_mm, start_mm=start_mm)
        return circle(x=40.0 * number + 20, fill=Fill(texture=texture))

    six = [filled(n, 3.0 + n) for n in range(6)]
    assert advice(*six) == ("there are 6 different textures; more than 5 are hard to tell apart",)
    assert not advice(*six[:5], filled(5, 3.0, (7.0, 7.0)))
    assert report(circle(fill=Fill(texture=Uniform()))).textures == 0


def test_an_empty_scene_says_that_nothing_can_be_felt():
    assert advice() == (
        "the scene has no elements, so nothing can be felt; write some under [[elements]]",
    )


def test_a_signal_that_nothing_uses_is_remarked_on():
    signals = {"slow": Speed(), "not": Inverse(of="slow"), "view": Switch(), "beat": Pulse()}
    along = Along(ridge_mm=3.0, velocity_mm_s=10.0, velocity_by="view")
    written = Scene(
        canvas=LATERO,
        signals=signals,
        elements=(circle(factor="beat", stroke=Stroke(along=along)),),
    )
    assert checked(written).advice == (
        "signals not: signal not is used by nothing; use it, or leave it out",
    )
