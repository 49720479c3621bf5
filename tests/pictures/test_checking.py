"""Advice of `vbraille scene check` on what is felt: each mistake is said, and nothing else."""

import pytest
from PIL import Image

from vbraille.pictures.checking import check_scene
from vbraille.pictures.loading import load_scene
from vbraille.render import MODELS

STYLE = MODELS["stress2"].style
STROKE = "stroke = { width_mm = 3 }"
FILL = 'fill = { texture = { kind = "linear-grating", ridge_mm = %g }, gap_mm = %g }'


def circle(x, y, radius, more="", title=""):
    name = f'title = "{title}", ' if title else ""
    inner = f'kind = "circle", {name}center_mm = [{x}, {y}], radius_mm = {radius}, {STROKE}'
    return f"{{ {inner}{', ' if more else ''}{more} }}"


def group(*parts, more=""):
    return f'{{ kind = "group", {more}parts = [{", ".join(parts)}] }}'


def label(text, x, y):
    return f'{{ kind = "label", text = "{text}", place_mm = [{x}, {y}] }}'


def advice(tmp_path, *elements, canvas="{ width_mm = 200, height_mm = 150 }"):
    path = tmp_path / "a.scene"
    path.write_text(f"canvas = {canvas}\nelements = [{', '.join(elements)}]\n")
    return [*check_scene(load_scene(path, STYLE)).advice]


SOLID = 'fill = { texture = { kind = "uniform" } }'
DISC = circle(60, 60, 20, SOLID)
MISTAKES = {
    "a part of a group is too near another": (
        [group(circle(40, 60, 10, title="Eye"), circle(65, 60, 10))],
        "its circle Eye stands less than 2.5 mm from the circle of element 1, with 2.",
    ),
    "a label on the edge of a shape": ([DISC, label("ab", 75, 55)], "label ab lies on element 1"),
    "a label that is written over": ([label("ab", 55, 55), DISC], "label ab lies on element 2"),
    "an element that is wholly hidden": (
        [circle(60, 60, 8, title="Moon"), DISC],
        "circle Moon is wholly hidden by what is written after it",
    ),
    "a fill without room": (
        [circle(60, 60, 8, FILL % (2, 7))],
        "has a gap of 7 mm before its fill",
    ),
    "waves longer than their shape": (
        [circle(60, 60, 5, FILL % (14, 0))],
        "is filled with waves of 14 mm, longer than the 10.0 mm",
    ),
    "what swings too little": (
        [group(circle(60, 60, 20, "amplitude = 0.3"), more="amplitude = 0.5, ")],
        "its circle swings by 0.15 of the full swing",
    ),
    "boxes that are near, where the shapes are not": (
        [circle(40, 40, 20), circle(75, 75, 20)],
        None,
    ),
    "too little blank": (
        [circle(40, 40, 10), circle(65, 40, 10, "vibration = { frequency_hz = 25 }")],
        "with 2.0 mm of blank, which a vibration fills",
    ),
}


@pytest.mark.parametrize("name", MISTAKES)
def test_each_mistake_is_said_and_nothing_else(tmp_path, name):
    elements, told = MISTAKES[name]
    said = advice(tmp_path, *elements)
    assert len(said) == (told is not None), said
    assert all(told in sentence for sentence in said)


@pytest.mark.parametrize(
    ("paper", "more", "said"),
    [
        ((0, 0, 0, 0), "", 'write channel = "alpha"'),
        ((0, 0, 0, 0), 'channel = "alpha"', None),
        ((255, 255, 255, 255), "", "inverted_source = true to feel what is black"),
        ((255, 255, 255, 255), "inverted_source = true", None),
        ((0, 0, 0, 255), "", 'write channel = "alpha", or inverted_source'),
    ],
)
def test_images_whose_paper_is_felt_in_place_of_their_lines_are_said(tmp_path, paper, more, said):
    picture = Image.new("RGBA", (40, 40), paper)
    picture.paste((0, 0, 0, 255), (10, 10, 20, 30))
    picture.save(tmp_path / "a.png")
    image = 'kind = "image", file = "a.png", place_mm = [20, 20], width_mm = 60'
    told = advice(tmp_path, f"{{ {', '.join(filter(None, (image, more)))} }}")
    assert [said in one for one in told if said] == ([True] if said else []), told
    assert said or not told


def test_what_is_right_is_not_remarked_on(tmp_path):
    elements = (
        circle(40, 60, 20, SOLID),
        circle(40, 60, 6, SOLID),  # on it
        circle(40, 120, 15, FILL % (4, 3)),
        circle(90, 60, 10),
        circle(116.5, 60, 10),
        label("ab", 150, 100),
    )
    assert not advice(tmp_path, *elements)


def test_a_part_of_very_many_is_said(tmp_path):
    many = [circle(3 + 9 * (n % 20), 3 + 7 * (n // 20), 1.5) for n in range(301)]
    said = advice(tmp_path, *many)
    assert any(sentence.startswith("only the first 300 parts") for sentence in said)
    assert sum("of blank" in sentence for sentence in said) <= 20


def test_a_canvas_of_ten_metres_is_looked_at(tmp_path):
    big = "{ width_mm = 10000, height_mm = 10000 }"
    assert any("hidden" in one for one in advice(tmp_path, circle(60, 60, 10), DISC, canvas=big))


def test_a_wave_is_as_wide_as_its_shape_whichever_direction_is_named(tmp_path):
    texture = 'fill = { texture = { kind = "linear-grating", ridge_mm = 14, %s } }'
    corners = "[[20, 20], [80, 20], [80, 30], [20, 30]]"
    flat = f'{{ kind = "polygon", vertices_mm = {corners}, %s }}'
    said = {
        angle: any("filled with waves" in one for one in advice(tmp_path, flat % (texture % angle)))
        for angle in ("wave_angle_deg = 90", "ridge_angle_deg = 0", "ridge_angle_deg = 90")
    }
    assert list(said.values()) == [True, True, False]


FLAT = "{ kind = 'uniform' }"
NESTED = FLAT
for _ in range(20):
    NESTED = f"{{ kind = 'group', operation = 'blend', parts = [{FLAT}, {FLAT}], by = {NESTED} }}"
FAST = "{ kind = 'linear-grating', ridge_mm = 1, velocity_mm_s = 900 }"


@pytest.mark.parametrize(
    ("element", "says"),
    [(NESTED, "patterns stand too deep in each other"), (FAST, "moves at 900 Hz")],
)
def test_what_feel_would_refuse_is_said(tmp_path, element, says):
    (remark,) = [one for one in advice(tmp_path, element) if "cannot be felt" in one]
    assert says in remark


def test_each_zoom_from_which_something_is_there_is_looked_at(tmp_path):
    far = circle(60, 60, 20, "zoom_to = 2")
    near = circle(60, 60, 5, f"zoom_from = 2, {FILL % (24, 0)}")
    *_, said = advice(tmp_path, far, near)
    assert "at a zoom of 2, " in said
    assert (
        "line 2: element 2, circle is filled with waves of 24 mm, longer than the 20.0 mm" in said
    )


SWINGS = "stroke = { width_mm = 3, vibration = { frequency_hz = 50 } }"


@pytest.mark.parametrize(("apart_mm", "is_said"), [(3, True), (8, True), (9.5, False)])
def test_two_vibrations_under_one_finger_are_said(tmp_path, apart_mm, is_said):
    elements = [circle(60 + x, 60, 10).replace(STROKE, SWINGS) for x in (0, 23 + apart_mm)]
    said = advice(tmp_path, *elements)
    assert bool(said) == is_said
    assert all("vibrates" in one and "element 2" in one for one in said)
    assert advice(tmp_path, elements[0], circle(83 + apart_mm, 60, 10)) == []
