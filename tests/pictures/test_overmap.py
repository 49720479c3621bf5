"""The array over a map, and axes."""

import math

import numpy as np
import pytest

from vbraille.errors import InputError
from vbraille.pictures.ink import InkArea, InkRaster, InkText
from vbraille.pictures.overmap import (
    ArrayPlace,
    actuators_mm,
    array_deflections,
    array_marks,
    check_on_canvas,
    map_drawing,
    tick_mm,
)
from vbraille.render import LATERO, STRESS2_8X8, VBD
from vbraille.render.scene.assets import Assets
from vbraille.scene.patterns import Circle, Fill
from vbraille.scene.scene import Canvas, Scene
from vbraille.scene.textures import LinearGrating, Uniform, UniformVibration

CANVAS = Canvas(width_mm=60, height_mm=50)


def test_actuators_stand_where_the_convention_of_poses_says():
    places = actuators_mm(STRESS2_8X8.display, ArrayPlace(30, 20, 90))
    # A quarter turn against the clock: what was at the right is far from the reader now.
    right, left = places[0, 7], places[0, 0]
    assert right == pytest.approx((30 - 4.9, 20 - 4.2))
    assert left == pytest.approx((30 - 4.9, 20 + 4.2))
    upright = actuators_mm(STRESS2_8X8.display, ArrayPlace(30, 20))
    assert upright[0, 7] == pytest.approx((30 + 4.2, 20 - 4.9))


def test_deflections_are_those_of_the_places_and_parities():
    scene = Scene(canvas=CANVAS, elements=(LinearGrating(ridge_mm=4),))
    place = ArrayPlace(30, 25, 20)
    frame = array_deflections(scene, Assets(), STRESS2_8X8.display, place, 0.0)
    x_mm = actuators_mm(STRESS2_8X8.display, place)[..., 0]
    assert frame == pytest.approx(0.5 - 0.5 * np.cos(2 * np.pi * x_mm / 4), abs=1e-5)
    shaking = Scene(canvas=CANVAS, elements=(UniformVibration(),))
    frame = array_deflections(shaking, Assets(), STRESS2_8X8.display, place, 0.005)
    row, column = np.indices((8, 8))
    assert frame == pytest.approx(((row + column) % 2 == 0).astype(float), abs=1e-6)


@pytest.mark.parametrize(("model", "side"), [(LATERO, 1), (VBD, -1)])
def test_a_bar_stands_at_the_side_of_rest_and_goes_to_the_other(model, side):
    display = model.display
    for deflection in (0.0, 1.0):
        marks = array_marks(display, ArrayPlace(30, 25), np.full(display.shape, deflection))
        bars = next(mark for mark in marks if isinstance(mark, InkArea)).contours
        middles = np.array([bar.mean(axis=0) for bar in bars]).reshape(*display.shape, 2)
        shifts = middles[..., 0] - actuators_mm(display, ArrayPlace(30, 25))[..., 0]
        expected = side * 0.3 * display.column_pitch_mm * (1 if deflection == 0 else -1)
        assert shifts == pytest.approx(np.full(display.shape, expected))
        apart = display.column_pitch_mm - (bars[0][:, 0].max() - bars[0][:, 0].min())
        assert apart > 0


def test_an_array_beyond_the_canvas_is_refused():
    check_on_canvas(CANVAS, LATERO.display, ArrayPlace(30, 25, 45))
    for place in (ArrayPlace(4, 25), ArrayPlace(30, 46), ArrayPlace(math.nan, 25)):
        with pytest.raises(InputError, match="the array is not on the canvas"):
            check_on_canvas(CANVAS, LATERO.display, place)


def test_axes_have_ticks_in_mm_around_a_map_of_the_same_size():
    disc = Circle(center_mm=(30, 25), radius_mm=5, fill=Fill(texture=Uniform()))
    scene = Scene(canvas=CANVAS, elements=(disc,))
    drawing = map_drawing(scene, np.zeros((50, 60)), axes=True)
    raster = next(mark for mark in drawing.marks if isinstance(mark, InkRaster))
    assert (raster.width_mm, raster.height_mm) == (60, 50)
    x, y = raster.place_mm
    texts = {mark.text: mark.place_mm for mark in drawing.marks if isinstance(mark, InkText)}
    assert texts["60"][0] == pytest.approx(x + 60)
    assert "5 mm" in texts
    assert drawing.width_mm > x + 60
    assert drawing.height_mm > y + 50


def test_ticks_are_round_and_few():
    for length_mm in (7, 44, 113, 250, 3000):
        step = tick_mm(length_mm)
        assert length_mm / step <= 12
        assert step in {1, 2, 5, 10, 20, 50, 100, 200, 500, 1000}
