"""What of a scene is at a place, against asking every element."""

import math
import time

import pytest

from tests.render.scene.twin import opacity
from vbraille.pictures.index import SceneIndex
from vbraille.render.compiling import SceneMap
from vbraille.render.labels import Assets
from vbraille.scene.patterns import (
    Along,
    Circle,
    Dots,
    DotStyle,
    Fill,
    Group,
    LinearGrating,
    Polygon,
    StraightLine,
    Stroke,
    Uniform,
)
from vbraille.scene.scene import Canvas, Scene

GRATING = LinearGrating(ridge_mm=2, gap_mm=2)
AROUND = tuple(
    (90 + 60 * math.cos(math.tau * n / 5000), 70 + 60 * math.sin(math.tau * n / 5000))
    for n in range(5000)
)
MANY = {
    "dots": Dots(centers_mm=AROUND, dot=DotStyle(radius_mm=0.5), title="many"),
    "polygon": Polygon(vertices_mm=AROUND, stroke=Stroke(along=Along()), title="many"),
}


def disc(x_mm, y_mm, radius_mm, **named):
    return Circle(
        center_mm=(x_mm, y_mm),
        radius_mm=radius_mm,
        stroke=Stroke(width_mm=2),
        fill=Fill(texture=GRATING),
        **named,
    )


def index_of(*elements, width_mm=100.0, height_mm=80.0):
    canvas = Canvas(width_mm=width_mm, height_mm=height_mm)
    return SceneIndex(Scene(canvas=canvas, elements=elements), Assets())


def name_at(index, x_mm, y_mm):
    found = index.here(x_mm, y_mm)
    return None if found is None else found.name


def test_the_uppermost_element_is_told_and_where_it_hides_nothing_the_one_below():
    index = index_of(
        Uniform(level=0.2, title="paper"),
        disc(50, 40, 20, id="pond"),
        disc(60, 40, 8, title="Island", id="i"),
        StraightLine(
            start_mm=(0, 5), end_mm=(99, 5), stroke=Stroke(width_mm=4)
        ),  # which has no name
    )
    assert name_at(index, 60, 40) == "Island"
    assert name_at(index, 35, 40) == "pond"
    assert name_at(index, 5, 70) == "paper"
    assert name_at(index, 50, 5) == "paper"
    for place in ((-1, 5), (5, 81), (float("nan"), 5), (1e30, 5)):
        assert name_at(index, *place) is None


def test_parts_go_by_the_name_of_their_group_unless_they_have_one():
    house = Group(
        title="House",
        parts=(disc(20, 20, 8), disc(50, 20, 8, title="Window")),
    )
    index = index_of(house)
    assert name_at(index, 20, 20) == "House"
    assert name_at(index, 50, 20) == "Window"
    assert name_at(index, 35, 60) is None
    assert [element.name for element in index.elements] == ["House", "Window"]
    assert index.elements[1].box == pytest.approx((41, 11, 59, 29))


def test_a_group_that_is_felt_as_a_whole_is_asked_as_a_whole():
    mask = Group(
        title="Cut", operation="multiply", parts=(disc(20, 20, 8, title="never"), Uniform(level=0))
    )
    index = index_of(mask)
    assert name_at(index, 20, 20) == "Cut"
    assert [element.name for element in index.elements] == ["Cut"]


def test_elements_are_found_by_title_and_id_and_by_parts_of_them():
    index = index_of(disc(20, 20, 8, id="b1", title="Blue lake"), disc(50, 20, 8, id="lake"))
    for text, name in (("LAKE", "lake"), ("blue", "Blue lake"), ("ue la", "Blue lake")):
        found = index.find(text)
        assert found is not None
        assert found.name == name
    assert index.find("b1").name == "Blue lake"
    assert index.find("  ") is None
    assert index.find("sea") is None


def test_it_finds_what_asking_every_element_finds(rng):
    discs = [
        disc(*rng.uniform((0, 0), (100, 80)), rng.uniform(1, 15), title=str(n)) for n in range(40)
    ]
    index = index_of(*discs)
    for x_mm, y_mm in rng.uniform((0, 0), (100, 80), (60, 2)):
        shares = [float(opacity(each, Assets(), x_mm, y_mm)[0]) for each in discs]
        over = [n for n, share in enumerate(shares) if share >= 0.5]
        if over:
            assert name_at(index, x_mm, y_mm) == str(over[-1])
        elif max(shares) <= 0.02:
            assert name_at(index, x_mm, y_mm) is None


def test_very_many_that_cover_everything_take_little_and_only_the_upper_ones_are_asked(monkeypatch):
    asked = []
    monkeypatch.setattr(
        "vbraille.pictures.index.SceneMap", lambda *of: asked.append(of) or SceneMap(*of)
    )
    layers = [Uniform(level=0.0, title=str(n), inverted=False) for n in range(3000)]
    squares = [
        Polygon(vertices_mm=((0, 0), (290, 0), (290, 290)), stroke=Stroke(width_mm=1), title=str(n))
        for n in range(500)
    ]
    index = index_of(*layers, *squares, width_mm=300, height_mm=300)
    index.here(100, 250)
    assert 0 < len(asked) <= 64


@pytest.mark.parametrize("name", MANY)
def test_it_takes_no_longer_where_a_pattern_has_thousands_of_parts(name):
    few = Circle(center_mm=(90, 70), radius_mm=60, stroke=Stroke(), title="few")

    def least_s(element):
        index = index_of(element, width_mm=200, height_mm=150)
        took_s = []
        for _ in range(9):
            began = time.thread_time()
            assert name_at(index, 149.9, 70.0) == element.title
            took_s.append(time.thread_time() - began)
        return min(took_s)

    assert least_s(MANY[name]) < 10 * least_s(few)
