"""Scene files that are written: the same scene again, and lines that a finger can read."""

import re
import textwrap

import pytest
from hypothesis import given

from tests.render.scene.scenes import scenes
from tests.tiers import examples
from vbraille.errors import InputError
from vbraille.scene.converting import LONGEST, write_scene
from vbraille.scene.patterns import (
    Circle,
    Group,
    Image,
    LinearGrating,
    PathShape,
    Peak,
    Polygon,
    StraightLine,
    Stroke,
    Uniform,
    Use,
    VertexMarkers,
    Vibration,
)
from vbraille.scene.reading import open_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.toml import TomlFile

CANVAS = Canvas(width_mm=100, height_mm=80)


def again(scene):
    return TomlFile(write_scene(scene), "made.scene").read(Scene)


@given(scenes())
@examples(30)
def test_a_scene_is_read_as_it_was_written(scene):
    assert again(scene) == scene


def test_a_smooth_stroke_and_plain_markers_are_said_in_words():
    corners = ((0, 0), (30, 0), (15, 20))
    smooth = Stroke(width_mm=6, edge_mm="smooth")
    made = Polygon(vertices_mm=corners, stroke=smooth, markers=VertexMarkers(plain=True))
    scene = Scene(canvas=CANVAS, elements=(made,))
    lines = write_scene(scene).splitlines()
    assert 'stroke = { width_mm = 6, edge_mm = "smooth" }' in lines
    assert "markers = { plain = true }" in lines
    assert again(scene) == scene
    assert smooth.edge == 3


@pytest.mark.parametrize(
    ("look", "said"),
    [
        ('stroke = { edge_mm = "smoth" }', "edge_mm: is 'smoth'; did you mean smooth?"),
        (
            "stroke = { edge_mm = true }",
            "edge_mm: must be a number or a text in quotation marks, not true or false",
        ),
        (
            "markers = { plain = true, vibration = { amplitude = 0.5 } }",
            "vibration cannot be given beside plain = true; leave one out",
        ),
    ],
)
def test_what_those_words_cannot_be_is_said(look, said):
    canvas = "canvas = { width_mm = 9, height_mm = 9 }"
    shape = 'kind = "polygon"\nvertices_mm = [[0, 0], [9, 0], [9, 9]]'
    with pytest.raises(InputError, match=re.escape(said)):
        TomlFile(f"{canvas}\n[[elements]]\n{shape}\n{look}\n", "made.scene").read(Scene)


def test_the_text_has_one_thing_on_a_line_and_nothing_that_is_as_usual():
    scene = Scene(
        canvas=CANVAS,
        title='A "house"',
        operation="maximum",
        textures={"fine lines": LinearGrating(ridge_mm=2.4, gap_mm=0.1)},
        elements=(
            Circle(
                id="sun",
                center_mm=(50.5, -4),
                radius_mm=1e-1,
                stroke=Stroke(width_mm=6, vibration=Vibration()),
                amplitude=0.5,
            ),
            Group(
                operation="overwrite",
                parts=(Uniform(), Use(name="fine lines", move_mm=(1 / 3, 0))),
                inverted=True,
            ),
            Image(
                file="a.png",
                width_mm=5,
                texture=LinearGrating(ridge_mm=8, distortion=Peak(factor=4, center_mm=100)),
            ),
        ),
    )
    comments = {(): ("Made by hand.",), ("elements", 1, "parts", 0): ("Line 7.", "")}
    assert write_scene(scene, comments) == textwrap.dedent(
        """\
        # Made by hand.

        title = "A \\"house\\""
        operation = "maximum"

        [canvas]
        width_mm = 100
        height_mm = 80

        [textures."fine lines"]
        kind = "linear-grating"
        ridge_mm = 2.4
        gap_mm = 0.1

        [[elements]]
        kind = "circle"
        id = "sun"
        amplitude = 0.5
        center_mm = [50.5, -4]
        radius_mm = 0.1

        [elements.stroke]
        width_mm = 6
        vibration = {}

        [[elements]]
        kind = "group"
        inverted = true

        # Line 7.
        #
        [[elements.parts]]
        kind = "uniform"

        [[elements.parts]]
        kind = "use"
        name = "fine lines"
        move_mm = [0.3333333333333333, 0]

        [[elements]]
        kind = "image"
        file = "a.png"
        width_mm = 5

        [elements.texture]
        kind = "linear-grating"
        ridge_mm = 8
        distortion = { kind = "peak", factor = 4, center_mm = 100 }
        """
    )
    assert again(scene) == scene


def test_long_lists_have_an_item_on_each_line():
    corners = tuple((float(i), (i % 7) ** 2 / 3) for i in range(40))
    scene = Scene(
        canvas=CANVAS,
        elements=(StraightLine(start_mm=(0, 0), end_mm=(1, 1), stroke=Stroke()),),
        textures={"many": Group(operation="add", parts=(Uniform(), Uniform()))},
    )
    assert all(len(line) <= LONGEST for line in write_scene(scene).splitlines())
    text = write_scene(
        Scene(canvas=CANVAS, elements=(PathShape(contours_mm=(corners,), stroke=Stroke()),))
    )
    assert max(map(len, text.splitlines())) <= LONGEST


def test_a_written_file_is_opened(tmp_path):
    path = tmp_path / "made.scene"
    scene = Scene(canvas=CANVAS, elements=(Uniform(id="ünder", title="\\ \u2028".strip()),))
    path.write_text(write_scene(scene), encoding="utf-8")
    assert open_scene(path).written == scene
