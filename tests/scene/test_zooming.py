"""Scenes at a zoom: places are farther apart, what is felt keeps its size, and levels of detail."""

import msgspec
import pytest

from vbraille.errors import InputError
from vbraille.pictures.loading import load_scene
from vbraille.render.braille.models import STRESS2
from vbraille.scene.patterns import (
    Circle,
    Dots,
    Dotting,
    Fill,
    Gradual,
    Group,
    Label,
    LinearGrating,
    Moving,
    Peak,
    RadialGrating,
    StraightLine,
    Stroke,
    Tile,
    Uniform,
    UniformVibration,
)
from vbraille.scene.reading import open_scene
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.zooming import zoomed

CANVAS = Canvas(width_mm=100, height_mm=60)
LINE = StraightLine(start_mm=(10, 10), end_mm=(30, 20), stroke=Stroke(width_mm=3))


def at(zoom, *elements, **of_scene):
    return zoomed(Scene(canvas=CANVAS, elements=elements, **of_scene), zoom).scene


def only(zoom, element):
    (found,) = at(zoom, element).elements
    return found


def test_the_canvas_is_larger():
    assert at(4.0, LINE).canvas == Canvas(width_mm=400, height_mm=240)


def test_places_are_multiplied_and_strokes_are_not():
    assert only(2.0, LINE) == msgspec.structs.replace(LINE, start_mm=(20, 20), end_mm=(60, 40))


@pytest.mark.parametrize(
    ("pattern", "changes"),
    [
        (
            Circle(center_mm=(10, 20), radius_mm=5, dots=Dotting(separation_mm=2)),
            {"center_mm": (30, 60), "radius_mm": 15},
        ),
        (LinearGrating(ridge_mm=3, start_mm=(1, 2), velocity_mm_s=9), {"start_mm": (3, 6)}),
        (
            LinearGrating(ridge_mm=3, distortion=Gradual(start_mm=2, length_mm=4)),
            {"distortion": Gradual(start_mm=6, length_mm=12)},
        ),
        (
            RadialGrating(center_mm=(1, 1), ridge_mm=3, distortion=Peak(center_mm=2, length_mm=4)),
            {"center_mm": (3, 3), "distortion": Peak(center_mm=6, length_mm=12)},
        ),
        (
            Tile(width_mm=5, height_mm=5, origin_mm=(1, 1), part=Dots(centers_mm=((2, 2),))),
            {"origin_mm": (3, 3)},
        ),
        (Label(text="a", place_mm=(5, 5), width_mm=30), {"place_mm": (15, 15)}),
    ],
    ids=lambda value: type(value).__name__,
)
def test_what_is_felt_keeps_its_size(pattern, changes):
    assert only(3.0, pattern) == msgspec.structs.replace(pattern, **changes)


def test_zooming_by_steps_is_zooming_at_once():
    elements = (LINE, Circle(center_mm=(10, 20), radius_mm=5, stroke=Stroke()))
    assert at(8.0, *elements) == zoomed(at(4.0, *elements), 2.0).scene


def test_a_scene_without_levels_is_itself_as_it_is_written():
    scene = Scene(canvas=CANVAS, elements=(LINE, Group(parts=(LINE,))))
    assert zoomed(scene).scene is scene


@pytest.mark.parametrize(
    ("zoom", "there"), [(1.0, [0, 1]), (1.99, [0, 1]), (2.0, [0, 2]), (8, [0])]
)
def test_levels_of_detail_hand_over_at_their_zooms(zoom, there):
    coarse = msgspec.structs.replace(LINE, zoom_to=2)
    fine = msgspec.structs.replace(LINE, zoom_from=2, zoom_to=8)
    found = zoomed(Scene(canvas=CANVAS, elements=(LINE, coarse, fine)), zoom)
    assert list(found.numbers) == there
    assert len(found.scene.elements) == len(there)
    assert all(one.zoom_from is one.zoom_to is None for one in found.scene.elements)


def test_a_part_that_is_not_there_is_left_out_of_its_group():
    group = Group(operation="add", parts=(LINE, UniformVibration(zoom_from=2)))
    assert only(1.0, group) == Group(operation="add", parts=(LINE,))


def test_in_a_blend_and_a_weighted_sum_it_is_at_rest():
    far = UniformVibration(zoom_from=2)
    blend = only(1.0, Group(operation="blend", parts=(LINE, far), by=far))
    assert blend.parts[1] == blend.by == Uniform(level=0)
    summed = only(1.0, Group(operation="weighted", parts=(LINE, far), weights=(0.5, 0.5)))
    assert summed.parts[1] == Uniform(level=0)


def test_a_fill_that_is_not_there_leaves_the_stroke():
    fill = Fill(texture=UniformVibration(zoom_from=2))
    stroked = Circle(center_mm=(9, 9), radius_mm=5, stroke=Stroke(), fill=fill)
    assert only(1.0, stroked) == msgspec.structs.replace(stroked, fill=None)
    assert at(1.0, msgspec.structs.replace(stroked, stroke=None)).elements == ()


def test_a_tile_or_motion_of_nothing_is_not_there():
    far = Dots(centers_mm=((2, 2),), zoom_from=2)
    assert at(1.0, Tile(width_mm=5, height_mm=5, part=far), Moving(part=far)).elements == ()


def test_a_scene_that_would_be_too_large_is_refused():
    with pytest.raises(ValueError, match="1000"):
        at(16.0, StraightLine(start_mm=(0, 0), end_mm=(5000, 0), stroke=Stroke()))


SCENE = """
[canvas]
width_mm = 60
height_mm = 40

[[elements]]
kind = "use"
name = "stock:dots"
zoom_from = 2

[[elements]]
kind = "label"
text = "word"
place_mm = [10, 10]
zoom_to = 2

[[elements]]
kind = "image"
file = "a.png"
place_mm = [5, 5]
width_mm = 20
"""


@pytest.fixture
def path(tmp_path):
    from PIL import Image

    Image.linear_gradient("L").resize((400, 400)).save(tmp_path / "a.png")
    path = tmp_path / "a.scene"
    path.write_text(SCENE)
    return path


def test_a_loaded_scene_has_what_is_there_with_its_images_and_cells(path):
    loaded = load_scene(path, STRESS2.style)
    label, image = loaded.scene.elements
    assert len(loaded.assets.written[label].lines) == 1
    assert loaded.assets.bitmaps[image].width_mm == 20
    assert loaded.place(0).endswith("line 11")
    near = loaded.zoomed(4.0)
    _, image = near.scene.elements
    bitmap = near.assets.bitmaps[image]
    assert (bitmap.place_mm, bitmap.width_mm, bitmap.height_mm) == ((20, 20), 80, 80)
    assert bitmap.intensities.shape[1] == 400  # of which 200 would be felt from afar
    assert near.place(0).endswith("line 6")


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("zoom_from = 0", "0.5 to 16"),
        ("zoom_to = nan", "must be a number"),
        ("zoom_from = 1e9", "0.5 to 16"),
        ("zoom_from = 4\nzoom_to = 2", "never there"),
    ],
)
def test_a_zoom_beyond_sense_is_one_sentence_with_its_line(tmp_path, written, said):
    path = tmp_path / "a.scene"
    path.write_text(SCENE.replace("zoom_from = 2", written, 1))
    with pytest.raises(InputError, match=rf"line \d+: .*{said}") as raised:
        open_scene(path)
    assert "\n" not in str(raised.value)
