"""The array over a map, axes, and outlines of what is felt."""

import io
import math

import numpy as np
import pytest
from lxml import etree
from PIL import Image
from scipy.ndimage import label

from vbraille.errors import InputError
from vbraille.pictures.drawings import (
    ArrayOnMap,
    check_on_canvas,
    felt_contours,
    map_figure,
    outline_figure,
)
from vbraille.pictures.figurefiles import to_bytes
from vbraille.pictures.scenes import map_deflections
from vbraille.render import LATERO, STRESS2_8X8, VBD
from vbraille.render.labels import Assets
from vbraille.scene.patterns import (
    Circle,
    Fill,
    LinearGrating,
    Polygon,
    StraightLine,
    Stroke,
    Vibration,
)
from vbraille.scene.scene import Canvas, Scene

CANVAS = Canvas(width_mm=60, height_mm=50)


def array(display, x_mm, y_mm, angle_deg=0.0, deflection=0.0):
    return ArrayOnMap(display, x_mm, y_mm, angle_deg, np.full(display.shape, deflection))


def test_actuators_stand_where_the_convention_of_poses_says():
    turned = array(STRESS2_8X8.display, 30, 20, 90)
    places = turned.placed(turned.actuators_mm()).reshape(8, 8, 2)
    # A quarter turn against the clock: what was at the right is far from the reader now.
    assert places[0, 7] == pytest.approx((30 - 4.9, 20 - 4.2))
    assert places[0, 0] == pytest.approx((30 - 4.9, 20 + 4.2))


@pytest.mark.parametrize(("model", "side"), [(LATERO, 1), (VBD, -1)])
def test_a_bar_stands_at_the_side_of_rest_and_goes_to_the_other(model, side):
    display = model.display
    for deflection in (0.0, 1.0):
        shown = array(display, 30, 25, deflection=deflection)
        bars = shown.bars_mm()
        shifts = (bars.mean(axis=1) - shown.placed(shown.actuators_mm()))[:, 0]
        expected = side * 0.3 * display.column_pitch_mm * (1 if deflection == 0 else -1)
        assert shifts == pytest.approx(np.full(shifts.size, expected))
        assert display.column_pitch_mm > np.ptp(bars[0][:, 0])


def test_an_array_beyond_the_canvas_is_refused():
    check_on_canvas(CANVAS, array(LATERO.display, 30, 25, 45))
    for place in ((4, 25), (30, 46), (math.nan, 25)):
        with pytest.raises(InputError, match="the array is not on the canvas"):
            check_on_canvas(CANVAS, array(LATERO.display, *place))


def ink(figure, per_mm):
    """Where a drawing is black; bool[rows, columns]."""
    with Image.open(io.BytesIO(to_bytes(figure, "png", "t", "d", 25.4 * per_mm))) as image:
        return np.asarray(image.convert("L")) < 128


def test_axes_stand_around_a_map_of_the_same_size():
    per_mm = 4
    plain = ink(map_figure(CANVAS, np.ones((50, 60))), per_mm)
    assert plain.shape == (50 * per_mm, 60 * per_mm)
    assert plain.all()
    around = ink(map_figure(CANVAS, np.ones((50, 60)), rulers=(0, 60, 50, 0)), per_mm)
    assert around.shape[0] > plain.shape[0]
    assert around.shape[1] > plain.shape[1]
    assert around.mean(axis=1).max() * around.shape[1] == pytest.approx(plain.shape[1], abs=12)
    assert around[-2 * per_mm :].any()  # numbers below


DRAWN = (
    Circle(center_mm=(15, 15), radius_mm=9, stroke=Stroke(width_mm=3)),
    Polygon(vertices_mm=((30, 5), (55, 5), (40, 25)), fill=Fill(texture=LinearGrating(ridge_mm=4))),
    StraightLine(
        start_mm=(5, 40), end_mm=(55, 40), stroke=Stroke(width_mm=4, vibration=Vibration())
    ),
)


def test_black_is_what_is_felt_at_more_than_half():
    scene, per_mm = Scene(canvas=CANVAS, elements=DRAWN), 8.0
    felt = np.maximum(
        *(
            map_deflections(scene, Assets(), per_mm, noise_seed=None, time_s=time_s)
            for time_s in (0.0, 0.01)
        )
    )
    felt = np.maximum(felt, map_deflections(scene, Assets(), per_mm, noise_seed=None, time_s=0.005))
    black = ink(outline_figure(scene, Assets()), per_mm)
    wrong = np.count_nonzero(black != (felt > 0.5)) / np.count_nonzero(felt > 0.5)
    assert wrong < 0.03
    below = black[int(40 * per_mm), int(10 * per_mm) : int(50 * per_mm)]
    assert below.all()  # the line that vibrates is up all along


def test_walls_that_meet_are_joined():
    wall = Stroke(width_mm=3)
    walls = (
        Polygon(vertices_mm=((5, 5), (55, 5), (55, 45), (5, 45)), stroke=wall),
        StraightLine(start_mm=(30, 5), end_mm=(30, 45), stroke=wall),
        StraightLine(start_mm=(30, 25), end_mm=(55, 25), stroke=wall),
    )
    black = ink(outline_figure(Scene(canvas=CANVAS, elements=walls), Assets()), 8.0)
    assert label(black)[1] == 1
    assert label(~black)[1] == 4  # outside and three rooms, none open to another


def test_lines_around_what_is_felt_are_closed():
    lines = felt_contours(Scene(canvas=CANVAS, elements=DRAWN), Assets())
    assert lines
    assert all((line[0] == line[-1]).all() for line in lines)


def test_a_scene_of_which_nothing_is_felt_is_blank():
    assert not ink(outline_figure(Scene(canvas=CANVAS, elements=()), Assets()), 2.0).any()


def test_a_drawing_in_svg_has_words_and_the_size_of_the_canvas():
    figure = outline_figure(Scene(canvas=CANVAS, elements=DRAWN), Assets())
    root = etree.fromstring(to_bytes(figure, "svg", "A <b> & c", "One, two"))
    size = [float(root.get(name).removesuffix("pt")) / 72 * 25.4 for name in ("width", "height")]
    assert size == pytest.approx([60, 50], abs=0.01)
    assert root.get("role") == "img"
    assert root.findtext("{*}title") == "A <b> & c"
    assert root.findtext("{*}desc") == "One, two"
